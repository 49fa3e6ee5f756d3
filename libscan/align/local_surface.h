// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the neighbours of a point say of the surface there: what alignment may believe of a normal.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libscan/search/kd_tree.h"

namespace scan {

enum class LocalShape : std::uint8_t { unknown, line, surface, volume };

struct LocalFit {
  LocalShape shape = LocalShape::unknown;
  // Of the line, or normal of the surface (up to sign), from the nearer half of the neighbours.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  // The normal once more, from the further half alone: its noise is independent. Zero: none.
  Eigen::Vector3d second_normal = Eigen::Vector3d::Zero();
};

// Fits are made when first asked for and kept. Repeated points count once.
class LocalSurface {
 public:
  explicit LocalSurface(std::span<const Eigen::Vector3d> points);

  // Median distance of a point to its nearest other point, metres; 0 for fewer than two points.
  double spacing_m() const { return spacing_m_; }

  // Makes the fits of these points, so that `fit` may be read; not to be called from two threads.
  void prepare(std::span<const std::uint32_t> indices);
  const LocalFit& fit(std::uint32_t index) const { return fits_[index]; }

 private:
  LocalFit fit_at(const Eigen::Vector3d& point) const;

  std::span<const Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3d> distinct_;
  KdTree tree_;
  std::vector<LocalFit> fits_;
  std::vector<bool> made_;
  double spacing_m_ = 0;
};

}  // namespace scan
