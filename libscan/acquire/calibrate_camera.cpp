// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/calibrate_camera.h"

#include <algorithm>
#include <cmath>

#include "libscan/acquire/board_start.h"
#include "libscan/core/error.h"

namespace scan {
namespace {

calibrating::BundleFit fit_pictures(const Board& board, std::span<const BoardSighting> sightings,
                                    std::span<const std::size_t> used,
                                    const CalibrateOptions& options) {
  std::vector<BoardSighting> seen;
  for (const std::size_t i : used) seen.push_back(sightings[i]);
  return calibrating::fit_camera(board, seen, options.distortion_terms);
}

}  // namespace

void check(const CalibrateOptions& options) {
  if (options.distortion_terms < 0 || options.distortion_terms > 5)
    throw Error(Trouble::usage, "calibration/distortion_terms: is " +
                                    std::to_string(options.distortion_terms) + ", must be 0 to 5");
}

CameraCalibration calibrate_camera(const Board& board, std::span<const BoardSighting> sightings,
                                   const CalibrateOptions& options) {
  check(board);
  check(options);
  CameraCalibration result;
  std::vector<std::size_t> used = calibrating::usable(board, sightings, result.pictures);
  calibrating::BundleFit fit = fit_pictures(board, sightings, used, options);
  while (
      calibrating::drop_far_off(fit.picture_rms_px, options.max_rms_ratio, used, result.pictures))
    fit = fit_pictures(board, sightings, used, options);
  result.camera = fit.bundle.cameras.front();
  result.rms_px = fit.rms_px;
  result.sigma_px = std::max(fit.sigma_px, calibrating::least_sigma_px);
  result.covariance = result.sigma_px * result.sigma_px * fit.cofactor;
  for (std::size_t place = 0; place < used.size(); ++place) {
    result.pictures[used[place]].rms_px = fit.picture_rms_px[place];
    result.camera_from_board.push_back(fit.bundle.pictures[place].first_from_board);
  }
  calibrating::check_determined("camera", result.camera, result.covariance,
                                options.max_relative_sigma);
  result.coverage = calibrating::coverage(board, sightings, used);
  result.ray_sigma_px = calibrating::largest_ray_sigma_px(result.camera, result.covariance);
  return result;
}

}  // namespace scan
