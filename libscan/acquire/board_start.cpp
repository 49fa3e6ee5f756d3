// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/board_start.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "libscan/core/error.h"

namespace scan::calibrating {
namespace {

std::vector<cv::Point3f> object_points(const Board& board) {
  std::vector<cv::Point3f> points;
  for (const Eigen::Vector3d& x : corners_m(board))
    points.emplace_back(static_cast<float>(x.x()), static_cast<float>(x.y()), 0.0F);
  return points;
}

}  // namespace

Camera first_camera(const Board& board, std::span<const BoardSighting> sightings) {
  const int width = sightings.front().width_px, height = sightings.front().height_px;
  const std::vector<std::vector<cv::Point3f>> objects(sightings.size(), object_points(board));
  std::vector<std::vector<cv::Point2f>> pictures;
  for (const BoardSighting& sighting : sightings) {
    auto& points = pictures.emplace_back();
    for (const Eigen::Vector2d& corner : sighting.corners_px)
      points.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
  }
  const cv::Mat guess = cv::initCameraMatrix2D(objects, pictures, {width, height}, 1.0);
  const double side = std::max(width, height);
  double focal = guess.at<double>(0, 0);
  if (!(focal > 0.2 * side && focal < 50 * side)) focal = side;
  return {.width_px = width,
          .height_px = height,
          .fx_px = focal,
          .fy_px = focal,
          .cx_px = (width - 1) / 2.0,
          .cy_px = (height - 1) / 2.0};
}

Pose first_pose(const Camera& camera, const Board& board,
                std::span<const Eigen::Vector2d> corners_px) {
  std::vector<cv::Point2d> rays;
  for (const Eigen::Vector2d& corner : corners_px) {
    const auto ray = ray_through(camera, corner);
    if (!ray)
      throw Error(Trouble::computation,
                  "calibration: a corner lies where the camera's distortion has no inverse");
    rays.emplace_back(ray->x(), ray->y());
  }
  cv::Mat turn_vector, shift, turn;
  if (!cv::solvePnP(object_points(board), rays, cv::Mat::eye(3, 3, CV_64F), cv::noArray(),
                    turn_vector, shift, false, cv::SOLVEPNP_IPPE))
    throw Error(Trouble::computation, "calibration: a board's corners allow no pose");
  cv::Rodrigues(turn_vector, turn);
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 9; ++i) rotation(i / 3, i % 3) = turn.at<double>(i / 3, i % 3);
  return make_pose(nearest_rotation(rotation),
                   {shift.at<double>(0), shift.at<double>(1), shift.at<double>(2)});
}

BundleFit fit_camera(const Board& board, std::span<const BoardSighting> sightings,
                     int distortion_terms) {
  const Camera camera = first_camera(board, sightings);
  Bundle bundle{
      .board_m = corners_m(board), .cameras = {camera}, .distortion_terms = distortion_terms};
  for (const BoardSighting& sighting : sightings)
    bundle.pictures.push_back(
        {{sighting.corners_px}, first_pose(camera, board, sighting.corners_px)});
  return adjust(bundle);
}

}  // namespace scan::calibrating
