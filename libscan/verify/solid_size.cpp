// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/solid_size.h"

#include <array>
#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/core/random.h"
#include "libscan/verify/line_crossings.h"

namespace scan {
namespace {

constexpr std::size_t grids = 8, lines_per_edge = 96;
constexpr double student_7 = 2.3646;  // holds 95 % of Student's t with 7 degrees of freedom

struct Sums {
  double area_m2 = 0, volume_m3 = 0;
  Sums& operator+=(const Sums& more) {
    area_m2 += more.area_m2, volume_m3 += more.volume_m3;
    return *this;
  }
};

// Uniform among all rotations: a unit quaternion of four normal numbers.
Eigen::Matrix3d random_rotation(RandomStream& random) {
  Eigen::Quaterniond q;
  for (double& x : q.coeffs()) x = random.normal();
  return q.normalized().toRotationMatrix();
}

// The three squares around the ball that lie across the axes of a turned frame, one edge cut into
// cells whose middles are moved together.
struct Grid {
  Ball ball;
  Eigen::Matrix3d axes;
  std::array<Eigen::Vector2d, 3> shift;  // in cells

  double cell_m() const { return 2 * ball.radius_m / lines_per_edge; }
  Line line(std::size_t axis, std::size_t row, std::size_t column) const {
    const double u = (static_cast<double>(row) + shift[axis].x()) * cell_m() - ball.radius_m,
                 v = (static_cast<double>(column) + shift[axis].y()) * cell_m() - ball.radius_m;
    const Eigen::Vector3d along = axes.col(static_cast<Eigen::Index>(axis));
    return {ball.centre + u * axes.col(static_cast<Eigen::Index>((axis + 1) % 3)) +
                v * axes.col(static_cast<Eigen::Index>((axis + 2) % 3)) - ball.radius_m * along,
            along};
  }
};

Grid random_grid(const Ball& ball, std::uint64_t number) {
  RandomStream random(0, 0, number);
  Grid grid{ball, random_rotation(random), {}};
  for (Eigen::Vector2d& shift : grid.shift) {
    shift.x() = random.uniform();
    shift.y() = random.uniform();
  }
  return grid;
}

Sums sums_of_row(const PlacedShape& solid, const Grid& grid, std::size_t axis, std::size_t row) {
  Sums sums;
  const double cell_m2 = grid.cell_m() * grid.cell_m();
  std::vector<SurfaceSample> crossings;
  for (std::size_t column = 0; column < lines_per_edge; ++column) {
    const Line line = grid.line(axis, row, column);
    crossings.clear();
    add_crossings(solid, line, 2 * grid.ball.radius_m, crossings);
    for (const SurfaceSample& at : crossings) {
      sums.area_m2 += cell_m2 * std::abs(at.normal.dot(line.direction));
      const double x_m = (at.point - grid.ball.centre).dot(line.direction);
      sums.volume_m3 += std::copysign(cell_m2 * x_m / 3, x_m * at.normal.dot(line.direction));
    }
  }
  return sums;
}

Interval interval_of(const std::array<double, grids>& values) {
  double mean = 0, squares = 0;
  for (const double value : values) mean += value / grids;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double half = student_7 * std::sqrt(squares / (grids - 1) / grids);
  return {mean - half, mean + half};
}

}  // namespace

SolidSize solid_size(const PlacedShape& solid) {
  const Bounds box = bounds_of(solid);
  if (!box.sizes().allFinite())
    throw Error(Trouble::input, "true surface: a solid without bounds has no size");
  std::array<double, grids> areas_m2{}, volumes_m3{};
  for (std::size_t i = 0; i < grids; ++i) {
    const Grid grid = random_grid(ball_around(box), i);
    const Sums sums =
        ordered_sum(3 * lines_per_edge, 4, Sums(), [&](std::size_t begin, std::size_t end) {
          Sums some;
          for (std::size_t k = begin; k < end; ++k)
            some += sums_of_row(solid, grid, k / lines_per_edge, k % lines_per_edge);
          return some;
        });
    areas_m2[i] = sums.area_m2;
    volumes_m3[i] = sums.volume_m3;
  }
  return {interval_of(areas_m2), interval_of(volumes_m3)};
}

}  // namespace scan
