// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ray_bricks.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace scan {
namespace {

using Place = std::array<std::int64_t, 3>;

std::uint64_t key_of(const Place& p) {
  return std::uint64_t(p[0]) | std::uint64_t(p[1]) << 21 | std::uint64_t(p[2]) << 42;
}

Place nearest_corner(const Eigen::Vector3d& u, double cells) {
  Place corner;
  for (int a = 0; a < 3; ++a) corner[a] = static_cast<std::int64_t>(std::lround(u[a] * cells));
  return corner;
}

}  // namespace

RayBricks::RayBricks(std::span<const Eigen::Vector3d> places, int depth) : cells_(1 << depth) {
  for (const auto& place : places)
    for (int i = 0; i < 8; ++i) {  // bricks that a place is less than half a brick away from
      Place brick;
      for (int a = 0; a < 3; ++a)
        brick[a] = static_cast<std::int64_t>(
            std::floor(place[a] * cells_ / width + ((i >> a & 1) == 1 ? 0.5 : -0.5)));
      if (*std::min_element(brick.begin(), brick.end()) >= 0) keys_.push_back(key_of(brick));
    }
  std::sort(keys_.begin(), keys_.end());
  keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  sums_.reset(new std::atomic<std::int32_t>[3 * keys_.size() * width * width * width]());
}

std::int64_t RayBricks::slot_of(const Eigen::Vector3d& u) const {
  const Place corner = nearest_corner(u, cells_);
  if (*std::min_element(corner.begin(), corner.end()) < 0) return -1;
  const std::uint64_t key = key_of({corner[0] / width, corner[1] / width, corner[2] / width});
  const auto at = std::lower_bound(keys_.begin(), keys_.end(), key);
  if (at == keys_.end() || *at != key) return -1;
  return ((at - keys_.begin()) * width + corner[2] % width) * width * width +
         corner[1] % width * width + corner[0] % width;
}

void RayBricks::count(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const double length = (to - from).norm() * cells_;
  const Eigen::Vector3d direction = unit * (from - to).normalized();
  const auto steps = static_cast<std::int64_t>(length);
  for (std::int64_t i = 0; i <= steps; ++i) {
    const std::int64_t slot = slot_of(to + (from - to) * (static_cast<double>(i) / length));
    for (int a = 0; slot >= 0 && a < 3; ++a)
      sums_[3 * slot + a].fetch_add(static_cast<std::int32_t>(std::lround(direction[a])),
                                    std::memory_order_relaxed);
  }
}

double RayBricks::rays_through(const Eigen::Vector3d& u, const Eigen::Vector3d& normal) const {
  double sum = 0;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d offset(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    const std::int64_t slot = slot_of(u + offset / cells_);
    for (int a = 0; slot >= 0 && a < 3; ++a)
      sum += normal[a] * sums_[3 * slot + a].load(std::memory_order_relaxed);
  }
  return sum / (27 * unit);
}

}  // namespace scan
