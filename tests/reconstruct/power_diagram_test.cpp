// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/power_diagram.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "libscan/core/random.h"

namespace scan {
namespace {

std::vector<Eigen::Vector3d> random_points(std::size_t count) {
  RandomStream random(5, 0, 0);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    points.emplace_back(x, y, z);
  }
  return points;
}

// Coordinates of order 1 and a determinant of 1e-6 at least, or exact: 1e-9.
TEST(VoronoiCells, CornersAreAsFarFromFourPointsAndFartherFromAllOthers) {
  const auto points = random_points(150);
  const VoronoiCells cells = voronoi_cells(points);
  std::vector<std::vector<std::size_t>> touched(cells.corners.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const std::uint32_t corner : cells.of_point[i]) touched[corner].push_back(i);
  ASSERT_GT(touched.size(), 500u);  // some 6.8 for each inner point
  for (std::size_t c = 0; c < touched.size(); ++c) {
    ASSERT_EQ(touched[c].size(), 4u);
    const double radius = (points[touched[c][0]] - cells.corners[c]).norm();
    for (const std::size_t i : touched[c])
      EXPECT_NEAR((points[i] - cells.corners[c]).norm(), radius, 1e-9 * (1 + radius));
    for (const auto& x : points) EXPECT_GT((x - cells.corners[c]).norm(), radius * (1 - 1e-9));
  }
}

TEST(VoronoiCells, OfPointsInOnePlaneHaveNoCorners) {
  std::vector<Eigen::Vector3d> points = random_points(20);
  for (auto& x : points) x[2] = 1;
  EXPECT_TRUE(voronoi_cells(points).corners.empty());
}

double power(const Eigen::Vector3d& x, const Ball& ball) {
  return (x - ball.centre).squaredNorm() - ball.radius * ball.radius;
}

std::vector<Ball> random_balls(std::size_t count) {
  RandomStream random(6, 0, 0);
  std::vector<Ball> balls;
  for (const auto& x : random_points(count)) balls.push_back({x, 0.3 * random.uniform()});
  return balls;
}

// The corner of four balls, by their planes of equal power.
Eigen::Vector3d corner_of(const std::array<std::uint32_t, 4>& corner,
                          const std::vector<Ball>& balls) {
  Eigen::Matrix3d rows;
  Eigen::Vector3d right;
  const Ball& first = balls[corner[0]];
  for (int k = 0; k < 3; ++k) {
    const Ball& other = balls[corner[k + 1]];
    rows.row(k) = 2 * (other.centre - first.centre).transpose();
    right[k] = other.centre.squaredNorm() - other.radius * other.radius -
               first.centre.squaredNorm() + first.radius * first.radius;
  }
  return rows.fullPivLu().solve(right);
}

TEST(PowerDiagram, HasEqualPowerAtItsCornersAndNoneLess) {
  const auto balls = random_balls(100);
  const PowerDiagram diagram = power_diagram(balls);
  ASSERT_GT(diagram.corners.size(), 200u);
  for (const auto& corner : diagram.corners) {
    const Eigen::Vector3d x = corner_of(corner, balls);
    const double least = power(x, balls[corner[0]]);
    for (const Ball& ball : balls) EXPECT_GT(power(x, ball), least - 1e-9 * (1 + x.squaredNorm()));
  }
}

TEST(PowerDiagram, FacesBelongToTheirTwoBallsAndFaceTheSecond) {
  const auto balls = random_balls(100);
  const PowerDiagram diagram = power_diagram(balls);
  std::size_t bounded = 0;
  for (const PowerFace& face : diagram.faces) {
    const auto corners = diagram.corners_of(face);
    ASSERT_LT(face.first, face.second);
    if (corners.empty()) {
      EXPECT_TRUE(diagram.is_unbounded[face.first] && diagram.is_unbounded[face.second]);
      continue;
    }
    ++bounded;
    Eigen::Vector3d twice_area = Eigen::Vector3d::Zero();
    const auto place = [&](std::size_t k) {
      return corner_of(diagram.corners[corners[k % corners.size()]], balls);
    };
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const auto& corner = diagram.corners[corners[k]];
      EXPECT_EQ(std::count(corner.begin(), corner.end(), face.first), 1);
      EXPECT_EQ(std::count(corner.begin(), corner.end(), face.second), 1);
      twice_area += (place(k) - place(0)).cross(place(k + 1) - place(0));
    }
    const Eigen::Vector3d across = balls[face.second].centre - balls[face.first].centre;
    EXPECT_NEAR(twice_area.normalized().dot(across.normalized()), 1, 1e-6);
  }
  EXPECT_GT(bounded, 300u);
}

}  // namespace
}  // namespace scan
