// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/outliers.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/median.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr double alone = 2;           // reach over the neighbours' median reach
constexpr double thin = 2;            // reach over that of the median point
constexpr double least_flatness = 3;  // width over thickness where neighbours spread in a plane
constexpr double most_slope = 0.5;    // sine of the angle from a plane to a neighbour
constexpr double least_cosine = 0.5;  // between the planes' normals

bool agree(const LocalPlanes& all, std::span<const Eigen::Vector3d> points, std::size_t i,
           std::size_t j) {
  const Eigen::Vector3d &n = all.planes[i].normal, &m = all.planes[j].normal;
  const Eigen::Vector3d apart = points[j] - points[i];
  const double most_rise_m = most_slope * apart.norm();
  return std::abs(n.dot(apart)) < most_rise_m && std::abs(m.dot(apart)) < most_rise_m &&
         std::abs(n.dot(m)) > least_cosine;
}

// How many of the point's neighbours fulfil a condition.
template <class Condition>
std::size_t count_around(const LocalPlanes& all, std::size_t i, Condition&& condition) {
  const auto around = std::span(all.around).subspan(i * all.neighbours, all.neighbours);
  return static_cast<std::size_t>(std::count_if(around.begin(), around.end(), condition));
}

bool lies_on_sheet(const LocalPlanes& all, std::span<const Eigen::Vector3d> points, std::size_t i) {
  const auto agrees_with_half = [&](std::size_t j) {
    return 2 * count_around(all, j, [&](std::size_t k) { return agree(all, points, j, k); }) >=
           all.neighbours;
  };
  return agrees_with_half(i) && 4 * count_around(all, i, agrees_with_half) >= 3 * all.neighbours;
}

}  // namespace

std::vector<char> outlying(const LocalPlanes& all, std::span<const Eigen::Vector3d> points) {
  const std::size_t count = all.planes.size();
  std::vector<char> out(count, 0);
  if (all.neighbours < 3) return out;
  std::vector<double> reaches(count);
  for (std::size_t i = 0; i < count; ++i) reaches[i] = all.planes[i].reach_m;
  const double usual_m = median(reaches);
  parallel_chunks(count, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<double> theirs(all.neighbours);
    for (std::size_t i = begin; i < end; ++i) {
      const LocalPlane& plane = all.planes[i];
      for (std::size_t n = 0; n < all.neighbours; ++n)
        theirs[n] = all.planes[all.around[i * all.neighbours + n]].reach_m;
      const bool is_flat = plane.width_m > least_flatness * plane.thickness_m;
      const bool lies_alone = plane.reach_m > alone * median(theirs);
      const bool lies_thinly =
          plane.reach_m > thin * usual_m && !is_flat && !lies_on_sheet(all, points, i);
      const bool lies_beside =
          plane.offset_m > plane.width_m / 2 && plane.offset_m > 4 * plane.thickness_m;
      out[i] = lies_alone || lies_thinly || lies_beside;
    }
  });
  return out;
}

}  // namespace scan
