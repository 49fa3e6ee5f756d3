// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The leaves of the kd-tree and of the octree: points in blocks of eight, screened in float and
// decided in double. Internal to libscan/search.
#pragma once

#include <bit>

#include "libscan/search/local_frame.h"

namespace scan {

// A collector (collect.h) with a query and the float bound that follows from what it holds.
template <class Collector>
class Screen {
 public:
  Screen(const LocalFrame& frame, const Eigen::Vector3d& query_m, Collector& collector)
      : query_(frame, query_m), collector_(collector) {
    renew();
  }
  // A point or box whose squared float distance is above this may be passed by.
  float limit2() const { return limit2_; }
  const std::array<float, 3>& at() const { return query_.at; }
  void offer(const Eigen::Vector3d& point_m, std::uint32_t index) {
    collector_.offer({index, squared_distance_m2(point_m, query_.at_m)});
    if (collector_.limit2_m2() != limit2_m2_) renew();
  }

 private:
  void renew() {
    limit2_m2_ = collector_.limit2_m2();
    limit2_ = query_.limit2(limit2_m2_);
  }
  LocalQuery query_;
  Collector& collector_;
  double limit2_m2_ = 0;
  float limit2_ = 0;
};

class LeafBlocks {
 public:
  static constexpr std::uint32_t width = 8;

  // Blocks for the points in their order; the last one is filled up with NaN, which no bound
  // admits.
  void append(std::span<const LocalPoint> points, std::span<const Eigen::Vector3d> points_m);
  void resize(std::size_t blocks);
  void fill(std::size_t block, std::span<const LocalPoint> points,
            std::span<const Eigen::Vector3d> points_m);
  std::size_t size() const { return coordinates_.size(); }

  // Offers the points of a block that may be within the screen's limit.
  template <class Collector>
  void scan(std::size_t block, Screen<Collector>& screen) const {
    const Coordinates& of = coordinates_[block];
    const auto& [x, y, z] = screen.at();
    const float limit2 = screen.limit2();
    const Eight distance2 = (of.x - x).square() + (of.y - y).square() + (of.z - z).square();
    std::uint32_t hits = 0;
    for (std::uint32_t i = 0; i < width; ++i) hits |= distance2[i] <= limit2 ? bit[i] : 0;
    if constexpr (Collector::keeps_one) {
      if (hits == 0) return;
      // The nearest first: it shrinks the limit so far that the others need no look.
      const int i = nearest_of(hits, distance2);
      offer(block, i, screen);
      hits &= ~bit[i];
    }
    for (; hits != 0; hits &= hits - 1) {
      const int i = std::countr_zero(hits);
      if (distance2[i] <= screen.limit2()) offer(block, i, screen);
    }
  }

 private:
  using Eight = Eigen::Array<float, width, 1>;  // Eigen computes four at a time

  static int nearest_of(std::uint32_t hits, const Eight& distance2) {
    int nearest = std::countr_zero(hits);
    for (hits &= hits - 1; hits != 0; hits &= hits - 1) {
      const int i = std::countr_zero(hits);
      nearest = distance2[i] < distance2[nearest] ? i : nearest;
    }
    return nearest;
  }

  template <class Collector>
  void offer(std::size_t block, int i, Screen<Collector>& screen) const {
    const Exact& exact = exact_[block * width + static_cast<std::size_t>(i)];
    screen.offer(exact.point_m, exact.index);
  }

  static constexpr std::uint32_t bit[width] = {1, 2, 4, 8, 16, 32, 64, 128};
  struct Coordinates {
    Eight x, y, z;
  };
  struct alignas(32) Exact {
    Eigen::Vector3d point_m;
    std::uint32_t index;
  };
  std::vector<Coordinates> coordinates_;
  std::vector<Exact> exact_;
};

}  // namespace scan
