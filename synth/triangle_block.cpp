// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/triangle_block.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "libscan/core/parallel.h"

namespace scan::synth {
namespace {

using Lanes [[gnu::vector_size(16)]] = float;
using Mask [[gnu::vector_size(16)]] = int;

Lanes load(const float (&from)[TriangleBlock::lanes]) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
Lanes lower(Lanes a, Lanes b) {
  return a < b ? a : b;
}
Lanes upper(Lanes a, Lanes b) {
  return a < b ? b : a;
}
Lanes magnitude(Lanes a) {
  return upper(a, -a);
}

struct Corner {
  Lanes x, y, z;  // across the ray twice, along its largest axis
};

Corner in_ray_frame(const float (&corner)[3][TriangleBlock::lanes], const CoarseRay& ray) {
  const Lanes z = load(corner[ray.axis[2]]) - ray.origin[ray.axis[2]];
  return {load(corner[ray.axis[0]]) - ray.origin[ray.axis[0]] - ray.shear_x * z,
          load(corner[ray.axis[1]]) - ray.origin[ray.axis[1]] - ray.shear_y * z, ray.scale_z * z};
}

unsigned bits_of(Mask mask) {
  return (mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8);
}

constexpr std::size_t lanes = TriangleBlock::lanes;

struct Item {
  Eigen::Vector3f middle;
  std::uint32_t triangle;
};

// Halves the items across the widest extent of their middles, in whole blocks, until one block is
// left of each.
void sort_into_blocks(std::span<Item> items) {
  if (items.size() <= lanes) return;
  Eigen::AlignedBox3f box;
  for (const Item& item : items) box.extend(item.middle);
  Eigen::Index axis;
  box.sizes().maxCoeff(&axis);
  const std::size_t blocks = (items.size() + lanes - 1) / lanes;
  const std::size_t half = blocks / 2 * lanes;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [axis](const Item& a, const Item& b) {
                     return std::pair(a.middle(axis), a.triangle) <
                            std::pair(b.middle(axis), b.triangle);
                   });
  const std::span<Item> parts[] = {items.first(half), items.subspan(half)};
  const auto sort_part = [&](std::size_t i) { sort_into_blocks(parts[i]); };
  if (items.size() < 4096) {
    sort_part(0);
    sort_part(1);
  } else {
    parallel_for(2, sort_part, 1);
  }
}

// The block of the first items.
void fill(TriangleBlock& block, std::span<const Item> items,
          std::span<const Eigen::Vector3d> vertices, std::span<const Triangle> triangles) {
  block.count = static_cast<std::uint32_t>(std::min(lanes, items.size()));
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    block.triangle[lane] = items[lane < block.count ? lane : 0].triangle;
    block.vertices[lane] = triangles[block.triangle[lane]];
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        block.corner[corner][axis][lane] =
            static_cast<float>(vertices[block.vertices[lane][corner]](axis));
  }
}

void reorder(std::vector<Eigen::Vector3d>& vertices, std::span<TriangleBlock> blocks) {
  constexpr std::uint32_t unnamed = ~0U;
  std::vector<std::uint32_t> place(vertices.size(), unnamed);
  std::vector<Eigen::Vector3d> ordered;
  ordered.reserve(vertices.size());
  for (TriangleBlock& block : blocks)
    for (Triangle& corners : block.vertices)
      for (std::uint32_t& corner : corners) {
        if (place[corner] == unnamed) {
          place[corner] = static_cast<std::uint32_t>(ordered.size());
          ordered.push_back(vertices[corner]);
        }
        corner = place[corner];
      }
  vertices = std::move(ordered);
}

}  // namespace

// The signs of the edge functions, as in triangle.cpp, with their bound of rounding: for corners
// across the ray of at most m, each off by s, a function is off by 4 m s + 2 s^2, and by 4 e m^2 of
// its own; as m is at most 4 r = s / (5 e), the latter is below m s.
unsigned candidates(const TriangleBlock& block, const CoarseRay& ray, float near_m, float far_m) {
  const Corner a = in_ray_frame(block.corner[0], ray);
  const Corner b = in_ray_frame(block.corner[1], ray);
  const Corner c = in_ray_frame(block.corner[2], ray);
  const Lanes u = c.x * b.y - c.y * b.x;
  const Lanes v = a.x * c.y - a.y * c.x;
  const Lanes w = b.x * a.y - b.y * a.x;
  const Lanes across =
      upper(upper(upper(magnitude(a.x), magnitude(a.y)), upper(magnitude(b.x), magnitude(b.y))),
            upper(magnitude(c.x), magnitude(c.y)));
  const Lanes slack = ray.slack_m * (5 * across + 2 * ray.slack_m);
  const Mask inside = (lower(lower(u, v), w) >= -slack) | (upper(upper(u, v), w) <= slack);
  const Mask ahead = (lower(lower(a.z, b.z), c.z) <= far_m + ray.slack_m) &
                     (upper(upper(a.z, b.z), c.z) >= near_m - ray.slack_m);
  return bits_of(inside & ahead) & ((1U << block.count) - 1);
}

std::vector<TriangleBlock> make_blocks(std::vector<Eigen::Vector3d>& vertices,
                                       std::span<const Triangle> triangles,
                                       const std::vector<std::uint32_t>& which) {
  std::vector<Item> items(which.size());
  parallel_for(
      items.size(),
      [&](std::size_t i) {
        const auto [a, b, c] = triangles[which[i]];
        const Eigen::Vector3d sum = vertices[a] + vertices[b] + vertices[c];
        items[i] = {sum.cast<float>(), which[i]};
      },
      4096);
  sort_into_blocks(items);
  std::vector<TriangleBlock> blocks((items.size() + lanes - 1) / lanes);
  parallel_for(
      blocks.size(),
      [&](std::size_t i) {
        fill(blocks[i], std::span(items).subspan(lanes * i), vertices, triangles);
      },
      1024);
  reorder(vertices, blocks);
  return blocks;
}

}  // namespace scan::synth
