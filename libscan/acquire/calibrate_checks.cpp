// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which pictures serve a calibration, and what they leave open.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "libscan/acquire/board_bundle.h"
#include "libscan/acquire/calibrate_camera.h"
#include "libscan/core/error.h"
#include "libscan/core/median.h"

namespace scan::calibrating {
namespace {

std::string size_text(const BoardSighting& sighting) {
  return std::to_string(sighting.width_px) + " x " + std::to_string(sighting.height_px) + " px";
}

// The named unknowns that make up most of a direction, each with its sign: "fx + fy - cx".
std::string direction_text(const Eigen::Vector4d& direction) {
  constexpr std::array names = {"fx", "fy", "cx", "cy"};
  Eigen::Index largest = 0;
  const double most = direction.cwiseAbs().maxCoeff(&largest);
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const double part = direction[i] / direction[largest];
    if (std::abs(direction[i]) < most / 3) continue;
    text += (text.empty() ? (part < 0 ? "-" : "")
             : part < 0   ? " - "
                          : " + ") +
            std::string(names[static_cast<std::size_t>(i)]);
  }
  return text;
}

// Whether a pixel is inside the quadrilateral of a board's four outer corners.
bool is_inside(const Board& board, const BoardSighting& sighting, const Eigen::Vector2d& pixel) {
  const std::size_t columns = static_cast<std::size_t>(board.columns);
  const std::size_t count = sighting.corners_px.size();
  const std::array outline = {std::size_t{0}, columns - 1, count - 1, count - columns};
  bool left = false, right = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d& a = sighting.corners_px[outline[i]];
    const Eigen::Vector2d side = sighting.corners_px[outline[(i + 1) % 4]] - a, to = pixel - a;
    const double turn = side.x() * to.y() - side.y() * to.x();
    (turn < 0 ? left : right) = true;
  }
  return left != right;
}

}  // namespace

std::vector<std::size_t> usable(const Board& board, std::span<const BoardSighting> sightings,
                                std::vector<PictureUse>& uses) {
  std::vector<std::size_t> used;
  uses.assign(sightings.size(), {});
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const BoardSighting& sighting = sightings[i];
    uses[i].left_out = sighting.left_out;
    if (!sighting.left_out.empty()) continue;
    if (!used.empty() && size_text(sighting) != size_text(sightings[used.front()]))
      uses[i].left_out =
          "is " + size_text(sighting) + ", the others are " + size_text(sightings[used.front()]);
    else
      used.push_back(i);
  }
  if (!used.empty()) return used;
  const std::string reason = uses.empty() ? "" : "; the first " + uses.front().left_out;
  throw Error(Trouble::input,
              "calibration: none of " + std::to_string(sightings.size()) +
                  " pictures can be used for a board of " + std::to_string(board.columns) + "x" +
                  std::to_string(board.rows) + reason,
              "a board is counted by its inner corners: 10 x 7 squares have 9x6");
}

bool drop_far_off(std::span<const double> rms_px, double ratio, std::vector<std::size_t>& used,
                  std::vector<PictureUse>& uses) {
  const double limit_px = ratio * quantile({rms_px.begin(), rms_px.end()}, 0.5);
  std::vector<std::size_t> kept;
  for (std::size_t place = 0; place < used.size(); ++place)
    if (rms_px[place] > limit_px)
      uses[used[place]] = {"its corners fit the others' camera too badly", rms_px[place]};
    else
      kept.push_back(used[place]);
  std::swap(used, kept);
  return used.size() < kept.size();
}

void check_determined(const std::string& name, const Camera& camera,
                      const CameraCovariance& covariance, double max_relative_sigma) {
  const Eigen::Vector4d per_focal(1 / camera.fx_px, 1 / camera.fy_px, 1 / camera.fx_px,
                                  1 / camera.fy_px);
  const Eigen::Matrix4d relative =
      per_focal.asDiagonal() * covariance.topLeftCorner<4, 4>() * per_focal.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(relative);
  const double sigma = std::sqrt(std::max(0.0, solver.eigenvalues()[3]));
  if (sigma <= max_relative_sigma) return;
  const std::string percent = sigma > 10 ? "above 1000" : std::to_string(std::lround(100 * sigma));
  throw Error(Trouble::computation,
              name + ": the pictures leave " + direction_text(solver.eigenvectors().col(3)) +
                  " undetermined: its sigma is " + percent +
                  " % of the focal length, must be at most " +
                  std::to_string(std::lround(100 * max_relative_sigma)) + " %",
              "take pictures with the board tilted by 30 to 45 degrees about different axes");
}

double coverage(const Board& board, std::span<const BoardSighting> sightings,
                std::span<const std::size_t> used) {
  constexpr int cells = 64;  // each way
  const BoardSighting& first = sightings[used.front()];
  int covered = 0;
  for (int cell = 0; cell < cells * cells; ++cell) {
    const int column = cell % cells, row = cell / cells;
    const Eigen::Vector2d pixel((column + 0.5) * first.width_px / cells - 0.5,
                                (row + 0.5) * first.height_px / cells - 0.5);
    covered += std::any_of(used.begin(), used.end(),
                           [&](std::size_t i) { return is_inside(board, sightings[i], pixel); });
  }
  return static_cast<double>(covered) / (cells * cells);
}

double largest_ray_sigma_px(const Camera& camera, const CameraCovariance& covariance) {
  constexpr int steps = 8;  // the picture's corners and edges among them
  double largest = 0;
  for (int i = 0; i < (steps + 1) * (steps + 1); ++i) {
    const int column = i % (steps + 1), row = i / (steps + 1);
    const Eigen::Vector2d pixel((camera.width_px - 1.0) * column / steps,
                                (camera.height_px - 1.0) * row / steps);
    const auto ray = ray_through(camera, pixel);
    if (!ray) continue;  // beyond the fold of the distortion there is no ray
    const auto by_camera = project_with_derivatives(camera, *ray).by_camera;
    const Eigen::Matrix2d spread = by_camera * covariance * by_camera.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread, Eigen::EigenvaluesOnly);
    largest = std::max(largest, std::sqrt(std::max(0.0, solver.eigenvalues()[1])));
  }
  return largest;
}

}  // namespace scan::calibrating
