// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/grains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace scan {
namespace {

constexpr double cells_per_reach = 5;  // at least; twice as many at most

using Key = std::array<std::int32_t, 5>;  // octave of the width, cell, side

int side_of(const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(2 * axis) + (normal[axis] < 0);
}

Key key_of(const Eigen::Vector3d& foot, const Eigen::Vector3d& normal, double reach) {
  const int octave = std::ilogb(reach / cells_per_reach);
  const Eigen::Vector3i cell = (foot / std::ldexp(1.0, octave)).array().floor().cast<int>();
  return {octave, cell[0], cell[1], cell[2], side_of(normal)};
}

}  // namespace

std::vector<std::uint32_t> grains_of(std::span<const Eigen::Vector3d> feet,
                                     std::span<const Eigen::Vector3d> normals,
                                     std::span<const double> reach) {
  std::vector<Key> keys;
  for (std::size_t i = 0; i < feet.size(); ++i)
    keys.push_back(key_of(feet[i], normals[i], reach[i]));
  std::vector<std::uint32_t> order(feet.size()), grain_of(feet.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
  });
  std::uint32_t grain = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && keys[order[k]] != keys[order[k - 1]]) ++grain;
    grain_of[order[k]] = grain;
  }
  return grain_of;
}

std::vector<Grain> summed_grains(std::span<const std::uint32_t> grain_of,
                                 const GrainSamples& samples) {
  std::vector<Grain> grains(*std::max_element(grain_of.begin(), grain_of.end()) + 1);
  for (std::size_t i = 0; i < grain_of.size(); ++i) {
    Grain& grain = grains[grain_of[i]];
    const double trust = samples.trust[i];
    grain.trust += trust;
    grain.points += trust * samples.points[i];
    grain.feet += trust * samples.feet[i];
    grain.normals += trust * samples.normals[i];
    grain.points_along_normals += trust * samples.points[i].dot(samples.normals[i]);
  }
  return grains;
}

}  // namespace scan
