// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stripe_walk.h"

#include <cmath>

namespace scan::decoding {
namespace {

// The place of another step's ray as the camera of this step sees it.
std::optional<LitPlace> place_of(const StripeImages& frames, std::size_t step, const LitRay& ray) {
  const LaserLineCalibration& calibration = frames.calibration;
  const Eigen::Vector3d x = frames.scanner_from_camera[step].inverse() * ray.point;
  const auto pixel = project(calibration.camera, x);
  if (!pixel) return std::nullopt;
  return LitPlace{calibration.plane_normal.dot(x) - calibration.plane_offset_m,
                  pixel->x(),
                  ray.height_e,
                  ray.width_px,
                  ray.sigma_px,
                  x};
}

}  // namespace

Walk::Walk(const StripeImages& frames, std::span<const LitRay> rays, std::size_t ray)
    : frames_(frames),
      rays_(rays),
      rows_(static_cast<std::size_t>(frames.calibration.camera.height_px)),
      step_(ray / rows_),
      row_(ray % rows_) {}

const LitRay& Walk::ray_at(long at) const {
  return rays_[static_cast<std::size_t>(static_cast<long>(step_) + at) * rows_ + row_];
}

std::optional<LitPlace> Walk::next(long& at, long direction, double least_px) const {
  for (; is_step(at); at += direction) {
    if (!(ray_at(at).width_px > 0)) return std::nullopt;
    const auto place = place_of(frames_, step_, ray_at(at));
    if (!place) return std::nullopt;
    if (std::abs(place->column_px - ray_at(0).column_px) >= least_px) return place;
  }
  return std::nullopt;
}

double Walk::moves_px(long at) const {
  if (!is_step(at)) return 0;
  const auto place =
      place_of(frames_, static_cast<std::size_t>(static_cast<long>(step_) + at), ray_at(0));
  return place ? std::abs(place->column_px - ray_at(0).column_px) : 0;
}

bool Walk::is_step(long at) const {
  const long step = static_cast<long>(step_) + at;
  return step >= 0 && step < static_cast<long>(frames_.images.size());
}

}  // namespace scan::decoding
