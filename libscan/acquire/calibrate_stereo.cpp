// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/calibrate_stereo.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/acquire/board_start.h"
#include "libscan/core/error.h"

namespace scan {
namespace {

using calibrating::Bundle;
using calibrating::BundleFit;

// One side of the pairs; what the other side lacks counts for it, too.
std::vector<BoardSighting> side_of(std::span<const BoardPair> pairs,
                                   BoardSighting BoardPair::*side) {
  std::vector<BoardSighting> sightings;
  for (const BoardPair& pair : pairs) {
    BoardSighting& seen = sightings.emplace_back(pair.*side);
    seen.left_out = !pair.left.left_out.empty()    ? "left picture " + pair.left.left_out
                    : !pair.right.left_out.empty() ? "right picture " + pair.right.left_out
                                                   : "";
    if (seen.left_out.empty() &&
        (pair.left.width_px != pair.right.width_px || pair.left.height_px != pair.right.height_px))
      seen.left_out = "has a left and a right picture of different sizes";
  }
  return sightings;
}

std::vector<BoardSighting> chosen(const std::vector<BoardSighting>& all,
                                  std::span<const std::size_t> used) {
  std::vector<BoardSighting> some;
  for (const std::size_t i : used) some.push_back(all[i]);
  return some;
}

// The joint adjustment begins where each camera by itself ends.
BundleFit fit_pairs(const Board& board, const std::vector<BoardSighting>& left,
                    const std::vector<BoardSighting>& right, int terms) {
  const BundleFit one = calibrating::fit_camera(board, left, terms),
                  other = calibrating::fit_camera(board, right, terms);
  Bundle bundle{.board_m = corners_m(board),
                .cameras = {one.bundle.cameras.front(), other.bundle.cameras.front()},
                .second_from_first = other.bundle.pictures.front().first_from_board *
                                     one.bundle.pictures.front().first_from_board.inverse(),
                .distortion_terms = terms};
  for (std::size_t i = 0; i < left.size(); ++i)
    bundle.pictures.push_back(
        {{left[i].corners_px, right[i].corners_px}, one.bundle.pictures[i].first_from_board});
  return calibrating::adjust(bundle);
}

// Distance in the right picture from the epipolar line E l of a left ray l, E = [t] R (Hartley and
// Zisserman 2003, section 9.6).
double epipolar_rms_px(const Bundle& bundle) {
  const Eigen::Matrix3d essential =
      cross_matrix(bundle.second_from_first.translation()) * bundle.second_from_first.linear();
  double squares = 0, count = 0;
  for (const auto& picture : bundle.pictures)
    for (std::size_t k = 0; k < bundle.board_m.size(); ++k) {
      const auto left = ray_through(bundle.cameras[0], picture.corners_px[0][k]);
      const auto right = ray_through(bundle.cameras[1], picture.corners_px[1][k]);
      if (!left || !right) continue;
      const Eigen::Vector3d line = essential * *left;
      const double off_px = bundle.cameras[1].fy_px * right->dot(line) / line.head<2>().norm();
      squares += off_px * off_px;
      ++count;
    }
  return std::sqrt(squares / count);
}

void fill_figures(const BundleFit& fit, RigCalibration& result) {
  const Bundle& bundle = fit.bundle;
  result.rig = {bundle.cameras[0], bundle.cameras[1], bundle.second_from_first};
  result.rms_px = fit.rms_px;
  result.sigma_px = std::max(fit.sigma_px, calibrating::least_sigma_px);
  result.covariance = result.sigma_px * result.sigma_px * fit.cofactor;
  const Eigen::Vector3d shift = bundle.second_from_first.translation();
  result.baseline_m = shift.norm();
  // a turn from the left leaves the length of the translation as it is
  const Eigen::Vector3d along = shift / result.baseline_m;
  result.baseline_sigma_m =
      std::sqrt(along.dot(result.covariance.bottomRightCorner<3, 3>() * along));
  result.epipolar_rms_px = epipolar_rms_px(bundle);
  result.nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& picture : bundle.pictures)
    for (const Eigen::Vector3d& corner : bundle.board_m) {
      const double depth_m = (picture.first_from_board * corner).z();
      result.nearest_m = std::min(result.nearest_m, depth_m);
      result.farthest_m = std::max(result.farthest_m, depth_m);
    }
}

// Cameras at one place see no depth: the right pictures were the left ones.
void check_baseline(const RigCalibration& found, double max_relative_sigma) {
  if (found.baseline_sigma_m <= max_relative_sigma * found.baseline_m) return;
  const auto in_um = [](double metres) { return std::to_string(std::lround(1e6 * metres)); };
  throw Error(Trouble::computation,
              "stereo rig: its baseline is " + in_um(found.baseline_m) + " um with a sigma of " +
                  in_um(found.baseline_sigma_m) + " um, which must be at most " +
                  std::to_string(std::lround(100 * max_relative_sigma)) + " % of it",
              "are the right pictures those of the right camera?");
}

}  // namespace

RigCalibration calibrate_stereo(const Board& board, std::span<const BoardPair> pairs,
                                const CalibrateOptions& options) {
  check(board);
  check(options);
  if (!has_one_orientation(board))
    throw Error(Trouble::usage,
                "board: " + std::to_string(board.columns) + "x" + std::to_string(board.rows) +
                    " inner corners look the same when turned by half; for stereo one count must "
                    "be even and the other odd");
  RigCalibration result;
  const auto left = side_of(pairs, &BoardPair::left), right = side_of(pairs, &BoardPair::right);
  std::vector<std::size_t> used = calibrating::usable(board, left, result.pairs);
  BundleFit fit =
      fit_pairs(board, chosen(left, used), chosen(right, used), options.distortion_terms);
  while (calibrating::drop_far_off(fit.picture_rms_px, options.max_rms_ratio, used, result.pairs))
    fit = fit_pairs(board, chosen(left, used), chosen(right, used), options.distortion_terms);
  fill_figures(fit, result);
  for (std::size_t place = 0; place < used.size(); ++place)
    result.pairs[used[place]].rms_px = fit.picture_rms_px[place];
  calibrating::check_determined("left camera", result.rig.left, result.covariance.block<9, 9>(0, 0),
                                options.max_relative_sigma);
  calibrating::check_determined("right camera", result.rig.right,
                                result.covariance.block<9, 9>(9, 9), options.max_relative_sigma);
  check_baseline(result, options.max_relative_sigma);
  result.coverage_left = calibrating::coverage(board, left, used);
  result.coverage_right = calibrating::coverage(board, right, used);
  return result;
}

}  // namespace scan
