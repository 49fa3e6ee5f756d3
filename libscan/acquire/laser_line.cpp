// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/laser_line.h"

#include <cmath>
#include <string>

#include "libscan/acquire/ray_outcome.h"
#include "libscan/acquire/reason.h"
#include "libscan/acquire/stripe_bias.h"
#include "libscan/acquire/stripe_peak.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

using decoding::missed;
using decoding::RayOutcome;

void check(const StripeImages& frames) {
  const LaserLineCalibration& calibration = frames.calibration;
  scan::check(calibration.camera);
  decoding::check(calibration.sensor);
  if (!(std::abs(calibration.plane_normal.norm() - 1) <= 1e-6))
    throw Error(Trouble::input, "laser line/plane_normal: length " +
                                    std::to_string(calibration.plane_normal.norm()) +
                                    ", must be 1");
  if (!std::isfinite(calibration.plane_offset_m))
    throw Error(Trouble::input, "laser line/plane_offset_m: must be finite");
  if (frames.images.size() != frames.scanner_from_camera.size())
    throw Error(Trouble::input, "laser line: " + std::to_string(frames.images.size()) +
                                    " images but " +
                                    std::to_string(frames.scanner_from_camera.size()) + " poses");
  for (std::size_t step = 0; step < frames.images.size(); ++step) {
    const auto& image = frames.images[step];
    if (image.width != calibration.camera.width_px || image.height != calibration.camera.height_px)
      throw Error(Trouble::input, "laser line/image " + std::to_string(step) + ": " +
                                      std::to_string(image.width) + " x " +
                                      std::to_string(image.height) +
                                      " px, the camera's calibration has another size");
  }
}

// Where the viewing ray of a pixel meets the light plane, camera frame, with the derivative by the
// pixel's column. The ray is r(u) with z = 1; the point P = t r, t = offset / (n . r), so
// dP/du = t (r' - r (n . r') / (n . r)). The covariance is of rank one along dP/du: the image row
// is a choice, not a measurement.
RayOutcome triangulate(const LaserLineCalibration& calibration, const decoding::StripePeak& peak,
                       int row) {
  constexpr double difference_px = 0.01;  // r' by central differences: error of order 1e-4 / f^3
  const auto ray_at = [&](double column) {
    return ray_through(calibration.camera, Eigen::Vector2d(column, row));
  };
  const auto ray = ray_at(peak.column_px);
  const auto left = ray_at(peak.column_px - difference_px);
  const auto right = ray_at(peak.column_px + difference_px);
  if (!ray || !left || !right) return missed(reason::undetermined);
  const Eigen::Vector3d slope = (*right - *left) / (2 * difference_px);
  const double sine = calibration.plane_normal.dot(*ray);
  const double sine_slope = calibration.plane_normal.dot(slope);
  // The ray might as well be parallel to the plane if three sigmas of the peak reach that far.
  if (!(std::abs(sine) > 3 * std::abs(sine_slope) * peak.sigma_px))
    return missed(reason::undetermined);
  const double depth_m = calibration.plane_offset_m / sine;
  if (!std::isfinite(depth_m) || !(depth_m > 0)) return missed(reason::undetermined);
  if (depth_m < calibration.min_range_m || depth_m > calibration.max_range_m)
    return missed(reason::out_of_range);
  RayOutcome outcome;
  outcome.point = depth_m * *ray;
  const Eigen::Vector3d shift_m = peak.sigma_px * depth_m * (slope - *ray * (sine_slope / sine));
  outcome.covariance = shift_m * shift_m.transpose();
  outcome.sigma_m = std::abs(shift_m.dot(ray->normalized()));
  outcome.intensity = peak.height_e / calibration.sensor.gain_e_per_dn;
  return outcome;
}

struct Reading {
  RayOutcome outcome;
  decoding::StripePeak peak = {};  // where there is an outcome
};

// Where a stripe was found at a step, scanner frame.
RayOutcome placed(const StripeImages& frames, const decoding::StripePeak& peak, std::size_t step,
                  int row) {
  RayOutcome outcome = triangulate(frames.calibration, peak, row);
  if (!outcome.miss.empty()) return outcome;
  const Pose& scanner_from_camera = frames.scanner_from_camera[step];
  outcome.point = scanner_from_camera * outcome.point;
  outcome.covariance =
      scanner_from_camera.linear() * outcome.covariance * scanner_from_camera.linear().transpose();
  return outcome;
}

Reading decode_row(const StripeImages& frames, const LaserLineOptions& options, std::size_t step,
                   int row) {
  const Image<std::uint16_t>& image = frames.images[step];
  const Sensor& sensor = frames.calibration.sensor;
  std::vector<double> row_e(static_cast<std::size_t>(image.width));
  for (int column = 0; column < image.width; ++column)
    row_e[column] = decoding::electrons(sensor, image(column, row));
  const decoding::StripePeak peak = decoding::locate_stripe(row_e, sensor, options);
  if (!peak.miss.empty()) return {missed(peak.miss)};
  return {placed(frames, peak, step, row), peak};
}

// The outcomes with the stripes moved back by what form and brightness moved them, and what stays
// unknown of that in their sigmas.
std::vector<RayOutcome> corrected(const StripeImages& frames, std::span<const Reading> readings) {
  std::vector<decoding::LitRay> rays;
  rays.reserve(readings.size());
  for (const auto& [outcome, peak] : readings)
    rays.push_back(outcome.miss.empty()
                       ? decoding::LitRay{outcome.point, peak.column_px, peak.width_px,
                                          peak.height_e, peak.sigma_px}
                       : decoding::LitRay{});
  const auto shifts = decoding::stripe_shifts(frames, rays);
  const auto rows = static_cast<std::size_t>(frames.calibration.camera.height_px);
  std::vector<RayOutcome> outcomes(readings.size());
  parallel_for(outcomes.size(), [&](std::size_t ray) {
    outcomes[ray] = readings[ray].outcome;
    if (!outcomes[ray].miss.empty()) return;
    if (!shifts[ray]) {
      outcomes[ray] = missed(reason::inconsistent);
      return;
    }
    decoding::StripePeak peak = readings[ray].peak;
    peak.column_px -= shifts[ray]->shift_px;
    peak.sigma_px = std::hypot(peak.sigma_px, shifts[ray]->unknown_px);
    outcomes[ray] = placed(frames, peak, ray / rows, static_cast<int>(ray % rows));
  });
  return outcomes;
}

}  // namespace

Scan acquire_laser_line(const StripeImages& frames, const LaserLineOptions& options) {
  check(frames);
  const auto rows = static_cast<std::size_t>(frames.calibration.camera.height_px);
  std::vector<Reading> readings(frames.images.size() * rows);
  parallel_for(readings.size(), [&](std::size_t ray) {
    readings[ray] = decode_row(frames, options, ray / rows, static_cast<int>(ray % rows));
  });
  return decoding::collect(
      corrected(frames, readings),
      {static_cast<std::uint32_t>(frames.images.size()), static_cast<std::uint32_t>(rows)});
}

}  // namespace scan
