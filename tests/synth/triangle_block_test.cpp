// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/triangle_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "synth/triangle_packet.h"
#include "tests/synth/ray_scenes.h"

namespace scan::synth {
namespace {

constexpr double reach_m = 2;

// Needles, caps and whole triangles of all sizes within the reach.
Mesh scrap(std::uint32_t count) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    RandomStream random(41, 0, i);
    const Eigen::Vector3d a = random_vector(random).normalized() * random.uniform();
    const Eigen::Vector3d along =
        random_vector(random).normalized() * std::pow(10, -7 * random.uniform());
    const double share = random.uniform(), width = std::pow(10, -7 * random.uniform());
    const Eigen::Vector3d across = along.norm() * width * random_vector(random).normalized();
    mesh.vertices.insert(mesh.vertices.end(), {a, a + along, a + share * along + across});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

struct Shot {
  ShearedRay ray;
  CoarseRay coarse_ray;
};

// At a corner, at an edge or at the inside, steeply or along the plane.
Shot shot_at(const Mesh& mesh, const Triangle& t, std::uint64_t i) {
  RandomStream random(42, 0, i);
  const Eigen::Vector3d a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
  const double v = i % 3 == 0 ? 0 : random.uniform();
  const double w = i % 3 < 2 ? 0 : random.uniform() * (1 - v);
  const Eigen::Vector3d target = a + v * (b - a) + w * (c - a);
  Eigen::Vector3d away = random_vector(random).normalized();
  const double tilt = std::pow(10, -12 * random.uniform());
  if (i % 2) away = ((b - a).normalized() + random.normal() * (c - a).normalized() + tilt * away);
  const Eigen::Vector3d origin = target + random.uniform() * away.normalized();
  Shot shot;
  shear(origin, (target - origin).normalized(), shot.ray);
  round_off(shot.ray, reach_m, shot.coarse_ray);
  return shot;
}

// Puts the mesh's vertices into the blocks' order.
std::vector<TriangleBlock> blocks_of(Mesh& mesh) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  auto blocks = make_blocks(mesh.vertices, mesh.triangles, all);
  for (const TriangleBlock& block : blocks)
    for (std::uint32_t lane = 0; lane < block.count; ++lane)
      mesh.triangles[block.triangle[lane]] = block.vertices[lane];
  return blocks;
}

TEST(TriangleBlock, HoldsEachTriangleOnce) {
  for (const std::uint32_t count : {1U, 4U, 5U, 6U, 7U, 8U, 1001U}) {
    Mesh mesh = scrap(count);
    const Mesh before = mesh;
    std::vector<int> seen(count);
    const auto blocks = blocks_of(mesh);
    EXPECT_EQ(blocks.size(), (count + 3) / 4);
    for (const TriangleBlock& block : blocks)
      for (std::uint32_t lane = 0; lane < block.count; ++lane) {
        ++seen[block.triangle[lane]];
        for (int corner = 0; corner < 3; ++corner)
          EXPECT_EQ(mesh.vertices[block.vertices[lane][corner]],
                    before.vertices[before.triangles[block.triangle[lane]][corner]]);
      }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; })) << count;
  }
}

// What double precision hits is proposed, by the single ray and in every packet, for an interval
// that holds the hit.
TEST(TriangleBlock, LeavesOutNothingThatDoublePrecisionHits) {
  Mesh mesh = scrap(4000);
  const auto blocks = blocks_of(mesh);
  int hits = 0;
  for (std::uint64_t i = 0; i < 100; ++i)
    for (const TriangleBlock& block : blocks) {
      const std::uint32_t lane = static_cast<std::uint32_t>(i) % block.count;
      const Triangle& t = mesh.triangles[block.triangle[lane]];
      const Shot shot = shot_at(mesh, t, 1000003 * i + block.triangle[lane]);
      const auto distance =
          line_distance(shot.ray, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
      if (!distance) continue;
      ++hits;
      const auto at_m = static_cast<float>(*distance);
      ASSERT_TRUE(candidates(block, shot.coarse_ray, at_m, at_m) >> lane & 1) << i;
      CoarsePacket packet;
      const auto place = static_cast<unsigned>(i) % 16;
      put(packet, place, shot.coarse_ray);
      const std::vector<float> limits(16, at_m);
      for (const unsigned width : {4U, 8U, 16U}) {
        unsigned rays_of[TriangleBlock::lanes];
        candidates(block, packet, place / width * width, width, limits.data(), limits.data(),
                   rays_of);
        ASSERT_TRUE(rays_of[lane] >> place % width & 1) << i << " in a packet of " << width;
      }
    }
  EXPECT_GT(hits, 40000);
}

// The bound is tight enough: of ordinary rays and triangles few are proposed in vain.
TEST(TriangleBlock, ProposesFewThatAreNotHit) {
  Mesh mesh = bumpy_ball(100, 200);
  const auto blocks = blocks_of(mesh);
  std::size_t proposed = 0, hit = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    RandomStream random(43, 0, i);
    Shot shot;
    shear(0.2 * random_vector(random), random_vector(random).normalized(), shot.ray);
    round_off(shot.ray, reach_m, shot.coarse_ray);
    for (const TriangleBlock& block : blocks) {
      const unsigned found = candidates(block, shot.coarse_ray, -10, 10);
      for (std::uint32_t lane = 0; lane < block.count; ++lane) {
        if (!(found >> lane & 1)) continue;
        ++proposed;
        const auto [a, b, c] = block.vertices[lane];
        hit += line_distance(shot.ray, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])
                   .has_value();
      }
    }
  }
  EXPECT_GE(hit, 190u);  // two per line, but for starts outside
  // The bound is 2.4e-6 m wide on either side of edges of about 0.03 m.
  EXPECT_LE(proposed - hit, 5u);
}

}  // namespace
}  // namespace scan::synth
