// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pictures of a board as a camera would take them, and the corners without a picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "libscan/acquire/board.h"
#include "libscan/core/camera.h"
#include "libscan/core/pose.h"
#include "libscan/core/random.h"

namespace scan::test {

inline const Board test_board{.columns = 9, .rows = 6, .square_m = 0.02};

// Bends corners of the picture inwards by 20 px.
inline Camera bent_camera() {
  return {.width_px = 800,
          .height_px = 600,
          .fx_px = 900,
          .fy_px = 905,
          .cx_px = 395,
          .cy_px = 305,
          .k1 = -0.15,
          .k2 = 0.08,
          .p1 = 0.0008,
          .p2 = -0.0005};
}

// camera_from_board for a board held before the camera, its middle on the ray through `pixel`,
// `z_m` away, turned by `tilt_rad` about the axis at `axis_rad` in the picture.
inline Pose held_board(const Camera& camera, const Board& board, const Eigen::Vector2d& pixel,
                       double z_m, double tilt_rad, double axis_rad) {
  const Eigen::Vector3d axis(std::cos(axis_rad), std::sin(axis_rad), 0);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(tilt_rad, axis).toRotationMatrix();
  const Eigen::Vector3d middle((board.columns - 1) * board.square_m / 2,
                               (board.rows - 1) * board.square_m / 2, 0);
  return make_pose(turn, z_m * ray_through(camera, pixel).value() - turn * middle);
}

// A board held in many ways, in sight as a whole: the whole picture is visited.
inline std::vector<Pose> held_boards(const Camera& camera, const Board& board, std::uint64_t seed,
                                     int count) {
  std::vector<Pose> poses;
  RandomStream random(seed, 0, 0);
  while (static_cast<int>(poses.size()) < count) {
    const double column = camera.width_px * random.uniform();
    const double row = camera.height_px * random.uniform();
    const double z_m = 0.22 + 0.15 * random.uniform();
    const double tilt_rad = (10 + 30 * random.uniform()) * std::numbers::pi / 180;
    const double axis_rad = 2 * std::numbers::pi * random.uniform();
    const Pose pose = held_board(camera, board, {column, row}, z_m, tilt_rad, axis_rad);
    const std::vector<Eigen::Vector3d> corners = corners_m(board);
    const bool in_sight = std::all_of(corners.begin(), corners.end(), [&](const auto& corner) {
      const auto pixel = project(camera, pose * corner);
      return pixel && pixel->x() > 15 && pixel->x() < camera.width_px - 16 && pixel->y() > 15 &&
             pixel->y() < camera.height_px - 16;
    });
    if (in_sight) poses.push_back(pose);
  }
  return poses;
}

// The corners with normal noise, as if found in a picture.
inline BoardSighting sighting(const Camera& camera, const Board& board, const Pose& pose,
                              double sigma_px, RandomStream& random) {
  BoardSighting seen{.width_px = camera.width_px, .height_px = camera.height_px};
  for (const Eigen::Vector3d& corner : corners_m(board)) {
    const double right = sigma_px * random.normal();
    const double down = sigma_px * random.normal();
    seen.corners_px.push_back(project(camera, pose * corner).value() +
                              Eigen::Vector2d(right, down));
  }
  return seen;
}

// Reflectance at a place of the board plane: dark and light squares, a light margin of one square,
// darkness beyond. The square beyond the first corner, towards -x and -y, is light.
inline double board_reflectance(const Board& board, double x_m, double y_m) {
  const double column = std::floor(x_m / board.square_m), row = std::floor(y_m / board.square_m);
  if (column < -2 || row < -2 || column > board.columns || row > board.rows) return 0.3;
  if (column < -1 || row < -1 || column >= board.columns || row >= board.rows) return 0.9;
  return std::fmod(std::abs(column + row), 2) == 1 ? 0.1 : 0.9;
}

// Where the ray through a pixel meets the board, board frame (x, y).
inline Eigen::Vector2d on_board(const Camera& camera, const Pose& board_from_camera,
                                const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d ray = board_from_camera.linear() * ray_through(camera, pixel).value();
  const Eigen::Vector3d eye = board_from_camera.translation();
  return (eye - ray * (eye.z() / ray.z())).head<2>();
}

// Grey levels of the board with the areas of pixels sampled 8 x 8 where an edge runs through, a
// blur by a normal kernel and normal noise.
inline Image<std::uint8_t> picture_of(const Camera& camera, const Board& board, const Pose& pose,
                                      double blur_px, double noise_dn, std::uint64_t seed) {
  const Pose board_from_camera = pose.inverse();
  const auto level = [&](double column, double row) {
    const Eigen::Vector2d at = on_board(camera, board_from_camera, {column, row});
    return 230 * board_reflectance(board, at.x(), at.y());
  };
  const int width = camera.width_px, height = camera.height_px;
  Image<float> corners(width + 1, height + 1), sharp(width, height);
  for (int row = 0; row <= height; ++row)
    for (int column = 0; column <= width; ++column)
      corners(column, row) = static_cast<float>(level(column - 0.5, row - 0.5));
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const float first = corners(column, row);
      sharp(column, row) = first;
      if (corners(column + 1, row) == first && corners(column, row + 1) == first &&
          corners(column + 1, row + 1) == first)
        continue;
      double sum = 0;
      for (int i = 0; i < 64; ++i)
        sum += level(column + (i % 8 - 3.5) / 8, row + (i / 8 - 3.5) / 8);
      sharp(column, row) = static_cast<float>(sum / 64);
    }
  const int reach = static_cast<int>(std::ceil(4 * blur_px));
  std::vector<double> kernel;
  for (int i = -reach; i <= reach; ++i)
    kernel.push_back(blur_px > 0 ? std::exp(-i * i / (2 * blur_px * blur_px)) : 1);
  const auto blurred = [&](const Image<float>& from, int across, int down) {
    Image<float> to(width, height);
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column) {
        double sum = 0, weight = 0;
        for (int i = -reach; i <= reach; ++i) {
          const int x = std::clamp(column + i * across, 0, width - 1);
          const int y = std::clamp(row + i * down, 0, height - 1);
          sum += kernel[static_cast<std::size_t>(i + reach)] * from(x, y);
          weight += kernel[static_cast<std::size_t>(i + reach)];
        }
        to(column, row) = static_cast<float>(sum / weight);
      }
    return to;
  };
  const Image<float> soft = blurred(blurred(sharp, 1, 0), 0, 1);
  Image<std::uint8_t> picture(width, height);
  RandomStream random(seed, 1, 0);
  for (std::size_t i = 0; i < soft.pixels.size(); ++i)
    picture.pixels[i] = static_cast<std::uint8_t>(
        std::clamp(std::round(soft.pixels[i] + noise_dn * random.normal()), 0.0, 255.0));
  return picture;
}

}  // namespace scan::test
