// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which side of the samples' surface a place away from it is on, whatever the gaps.
#pragma once

#include "libscan/reconstruct/samples.h"

namespace scan {

// Gauss's integral over the samples, sum of area n . (p - x) / (4 pi |p - x|^3) (Barill et al.
// 2018), in groups of one cell of 1/32: 1 inside a closed surface, 0 outside, halfway on it; a hole
// takes from it the share of directions that leave through it.
class WindingNumber {
 public:
  explicit WindingNumber(const Samples& samples);

  double at(const Eigen::Vector3d& x) const;
  // The mean on the surface: 1/2 if it is closed, 0 for a plane sheet.
  double on_surface() const { return on_surface_; }

 private:
  struct Group {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // times area / (4 pi)
    double area = 0;
  };
  std::vector<Group> groups_;
  double on_surface_ = 0;
};

}  // namespace scan
