// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/calibrate_light_plane.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "libscan/acquire/board_start.h"
#include "libscan/acquire/stripe_peak.h"
#include "libscan/acquire/stripe_plane.h"
#include "libscan/core/error.h"
#include "libscan/core/shortest.h"

namespace scan {
namespace {

using calibrating::BoardStripe;
using calibrating::StripePlane;

constexpr std::size_t least_points = 20;  // of a stripe on one board

// Poses of the boards, by all corners at once with the camera held.
calibrating::BundleFit fit_poses(const Board& board, const Camera& camera,
                                 std::span<const StripeOnBoard> pictures,
                                 std::span<const std::size_t> used) {
  calibrating::Bundle bundle{
      .board_m = corners_m(board), .cameras = {camera}, .fixed_cameras = true};
  for (const std::size_t i : used) {
    const std::vector<Eigen::Vector2d>& corners = pictures[i].board.corners_px;
    bundle.pictures.push_back({{corners}, calibrating::first_pose(camera, board, corners)});
  }
  return calibrating::adjust(bundle);
}

// Distance of a place on the board from the nearest edge of a square, or 0 outside.
double edge_distance_m(const Board& board, const Eigen::Vector3d& place) {
  double distance_m = board.square_m;
  for (const auto& [x, count] : {std::pair{place.x(), board.columns}, {place.y(), board.rows}}) {
    if (x < 0 || x > (count - 1) * board.square_m) return 0;
    distance_m = std::min(distance_m, std::abs(std::remainder(x, board.square_m)));
  }
  return distance_m;
}

BoardStripe stripe_on(const Board& board, const Camera& camera, const Pose& camera_from_board,
                      std::span<const StripePixel> pixels) {
  const Eigen::Vector3d normal = camera_from_board.linear().col(2);
  const double offset_m = normal.dot(camera_from_board.translation());
  const Pose board_from_camera = camera_from_board.inverse();
  BoardStripe stripe{{}, normal, Matrix6::Zero()};
  const auto place_at = [&](const Eigen::Vector2d& pixel) -> std::optional<Eigen::Vector3d> {
    const auto ray = ray_through(camera, pixel);
    if (!ray || !(offset_m / normal.dot(*ray) > 0)) return std::nullopt;
    return *ray * (offset_m / normal.dot(*ray));
  };
  for (const StripePixel& seen : pixels) {
    const Eigen::Vector2d half(0.5, 0);  // of a pixel: the slope's error is of order 1e-7
    const auto place = place_at(seen.pixel);
    const auto left = place_at(seen.pixel - half), right = place_at(seen.pixel + half);
    if (!place || !left || !right) continue;
    const Eigen::Vector3d per_px = *right - *left;
    if (edge_distance_m(board, board_from_camera * *place) > 3 * seen.width_px * per_px.norm())
      stripe.points.push_back({*place, seen.sigma_px * per_px});
  }
  return stripe;
}

// All stripes with one camera: poses, then points.
std::vector<BoardStripe> stripes_of(const Board& board, const Camera& camera,
                                    std::span<const StripeOnBoard> pictures,
                                    std::span<const std::size_t> used,
                                    std::vector<PictureUse>* uses = nullptr) {
  const calibrating::BundleFit poses = fit_poses(board, camera, pictures, used);
  std::vector<BoardStripe> stripes;
  for (std::size_t place = 0; place < used.size(); ++place) {
    stripes.push_back(stripe_on(board, camera, poses.bundle.pictures[place].first_from_board,
                                pictures[used[place]].stripe));
    const double sigma_px = std::max(poses.sigma_px, calibrating::least_sigma_px);
    stripes.back().pose_covariance = sigma_px * sigma_px * poses.pose_cofactors[place];
    if (uses) (*uses)[used[place]].rms_px = poses.picture_rms_px[place];
  }
  return stripes;
}

std::vector<std::size_t> usable(const Board& board, const Camera& camera,
                                std::span<const StripeOnBoard> pictures,
                                std::vector<PictureUse>& uses) {
  std::vector<BoardSighting> boards;
  for (const StripeOnBoard& picture : pictures) {
    boards.push_back(picture.board);
    BoardSighting& seen = boards.back();
    if (seen.left_out.empty() &&
        (seen.width_px != camera.width_px || seen.height_px != camera.height_px))
      seen.left_out = "is of another size than the camera's pictures";
  }
  std::vector<std::size_t> used;
  for (const std::size_t i : calibrating::usable(board, boards, uses)) {
    const Pose pose = calibrating::first_pose(camera, board, boards[i].corners_px);
    if (stripe_on(board, camera, pose, pictures[i].stripe).points.size() < least_points)
      uses[i].left_out = "shows fewer than 20 rows with the stripe on the board";
    else
      used.push_back(i);
  }
  if (used.size() >= 2) return used;
  std::string message = "light plane: " + std::to_string(used.size()) +
                        " pictures show board and stripe, must be at least 2";
  const auto out = std::find_if(uses.begin(), uses.end(),
                                [](const PictureUse& use) { return !use.left_out.empty(); });
  if (out != uses.end()) message += "; one " + out->left_out;
  throw Error(Trouble::input, message);
}

// How the plane's three unknowns follow the camera's: central differences, a sigma each way.
Eigen::Matrix<double, 3, 9> slope_by_camera(const Board& board, const Camera& camera,
                                            const CameraCovariance& covariance,
                                            std::span<const StripeOnBoard> pictures,
                                            std::span<const std::size_t> used,
                                            const StripePlane& plane) {
  Eigen::Matrix<double, 3, 9> by_camera = Eigen::Matrix<double, 3, 9>::Zero();
  for (int i = 0; i < 9; ++i) {
    const double sigma = std::sqrt(covariance(i, i));
    if (!(sigma > 0)) continue;
    const auto unknowns_at = [&](double sign) -> Eigen::Vector3d {
      calibrating::CameraVector moved = calibrating::unknowns_of(camera);
      moved[i] += sign * sigma;
      StripePlane at = calibrating::fit_stripe_plane(
          stripes_of(board, calibrating::with_unknowns(camera, moved), pictures, used), 0);
      if (at.normal.dot(plane.normal) < 0) at.normal *= -1, at.offset_m *= -1;
      const Eigen::Vector2d turn = plane.axes.transpose() * at.normal;
      return {turn.x(), turn.y(), at.offset_m + at.normal.dot(at.centre_m - plane.centre_m)};
    };
    by_camera.col(i) = (unknowns_at(1) - unknowns_at(-1)) / (2 * sigma);
  }
  return by_camera;
}

// Normal and offset with the joint covariance; the normal's largest component is positive.
void fill_plane(const StripePlane& plane, const Eigen::Matrix<double, 3, 9>& by_camera,
                const CameraCovariance& camera_covariance, LightPlaneCalibration& result) {
  Eigen::Index largest = 0;
  plane.normal.cwiseAbs().maxCoeff(&largest);
  const double sign = plane.normal[largest] < 0 ? -1 : 1;
  result.normal = sign * plane.normal;
  result.offset_m = sign * (plane.offset_m + plane.normal.dot(plane.centre_m));
  Eigen::Matrix<double, 4, 3> by_unknowns;
  by_unknowns << plane.axes, Eigen::Vector3d::Zero(), plane.centre_m.transpose() * plane.axes, 1;
  by_unknowns *= sign;
  const Eigen::Matrix3d noise = std::max(1.0, plane.misfit * plane.misfit) * plane.covariance;
  Eigen::Matrix<double, 13, 9> follow;  // camera and plane by the camera
  follow << CameraCovariance::Identity(), by_unknowns * by_camera;
  result.covariance = follow * camera_covariance * follow.transpose();
  result.covariance.bottomRightCorner<4, 4>() += by_unknowns * noise * by_unknowns.transpose();
}

}  // namespace

std::vector<StripePixel> find_stripe_pixels(const Image<std::uint16_t>& image, const Sensor& sensor,
                                            const LaserLineOptions& options) {
  decoding::check(sensor);
  std::vector<StripePixel> pixels;
  std::vector<double> row_e(static_cast<std::size_t>(image.width));
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column)
      row_e[static_cast<std::size_t>(column)] = decoding::electrons(sensor, image(column, row));
    const decoding::StripePeak peak = decoding::locate_stripe(row_e, sensor, options);
    if (peak.miss.empty())
      pixels.push_back({{peak.column_px, static_cast<double>(row)}, peak.sigma_px, peak.width_px});
  }
  return pixels;
}

LightPlaneCalibration calibrate_light_plane(const Board& board, const Camera& camera,
                                            const CameraCovariance& camera_covariance,
                                            std::span<const StripeOnBoard> pictures,
                                            const LightPlaneOptions& options) {
  check(board);
  check(camera);
  LightPlaneCalibration result;
  const std::vector<std::size_t> used = usable(board, camera, pictures, result.pictures);
  const auto stripes = stripes_of(board, camera, pictures, used, &result.pictures);
  for (const BoardStripe& stripe : stripes) result.points += stripe.points.size();
  const StripePlane plane = calibrating::fit_stripe_plane(stripes, options.min_spread);
  if (!(plane.spread >= options.min_spread))
    throw Error(Trouble::computation,
                "light plane: all stripes lie on one line, the turn about it is undetermined: "
                "their spread across is " +
                    shortest(std::round(1000 * plane.spread) / 1000) +
                    " of that along, must be at least " + shortest(options.min_spread),
                "move the board nearer and farther between the pictures");
  const auto by_camera = slope_by_camera(board, camera, camera_covariance, pictures, used, plane);
  fill_plane(plane, by_camera, camera_covariance, result);
  result.rms_m = plane.rms_m;
  result.misfit = plane.misfit;
  return result;
}

}  // namespace scan
