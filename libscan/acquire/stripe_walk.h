// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// From a laser stripe to those of the steps before and behind it, along one row.
#pragma once

#include <optional>
#include <span>

#include "libscan/core/raw_frames.h"

namespace scan::decoding {

// A place that the light plane met at this or another step, as this step's image sees it.
struct LitPlace {
  double offset_m = 0;  // from this step's light plane, along its normal
  double column_px = 0;
  double height_e = 0;                              // of its own stripe
  double width_px = 0;                              // 1 sigma of it
  double sigma_px = 0;                              // of the column
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // camera frame of this step
};

// What was found at a ray: its point in the scanner frame and its stripe; no width: nothing.
struct LitRay {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double column_px = 0;
  double width_px = 0;  // 1 sigma of the stripe
  double height_e = 0;
  double sigma_px = 0;  // of the column
};

// From `ray` (of step * rows + row) the steps of its row, counted from its own, signed. The frames
// and rays outlive it.
class Walk {
 public:
  Walk(const StripeImages& frames, std::span<const LitRay> rays, std::size_t ray);

  // The next place in a direction (1, -1) from step `at` on that is seen that far from the ray's
  // own; `at` moves to its step, at the end of the sweep beyond. None if the body ends before.
  std::optional<LitPlace> next(long& at, long direction, double least_px) const;
  // How far a step moves the body's place in the image.
  double moves_px(long at) const;
  bool is_step(long at) const;

 private:
  const LitRay& ray_at(long at) const;

  const StripeImages& frames_;
  std::span<const LitRay> rays_;
  std::size_t rows_, step_, row_;
};

}  // namespace scan::decoding
