// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fits of exact shapes, stationarity with noise, and refusal where the points cannot tell.
#include "libscan/verify/fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/random.h"

namespace scan {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// A cap of the given half-angle around +z, with radial noise.
Points cap(const Eigen::Vector3d& centre, double radius, double half_angle, double noise) {
  Points points;
  for (std::uint64_t i = 0; i < 500; ++i) {
    RandomStream random(1, 0, i);
    const double z = 1 - random.uniform() * (1 - std::cos(half_angle));
    const double angle = 2 * std::numbers::pi * random.uniform(), r = std::sqrt(1 - z * z);
    const Eigen::Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
    points.push_back(centre + (radius + noise * random.normal()) * direction);
  }
  return points;
}

// At 1e6 m a coordinate rounds at 1.2e-10 m, for a radius of 1 m a tenth of the promised 1e-9.
TEST(FitSphere, IsExactFarFromTheOrigin) {
  const Eigen::Vector3d centre(1e6, -2e5, 3e5);
  const SphereFit fit = fit_sphere(cap(centre, 1, std::numbers::pi, 0));
  EXPECT_LT((fit.centre_m - centre).norm(), 1e-9);
  EXPECT_NEAR(fit.radius_m, 1, 1e-9);
  EXPECT_LT(fit.rms_m, 1e-9);
}

TEST(FitSphere, IsExactForFourPoints) {
  const SphereFit fit = fit_sphere(Points{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}});
  EXPECT_LT(fit.centre_m.norm(), 1e-14);
  EXPECT_NEAR(fit.radius_m, 1, 1e-14);
}

// Centre depth and radius of a cap trade against each other with a factor of about 8 / t^2 of the
// rounding 1e-16: 3e-13 at t = 0.05.
TEST(FitSphere, ResolvesASmallCap) {
  const SphereFit fit = fit_sphere(cap({1, 2, 3}, 0.5, 0.05, 0));
  EXPECT_NEAR(fit.radius_m, 0.5, 1e-11);
}

// The gradient of the sum of squared orthogonal distances vanishes at a Gauss fit: for the radius,
// the residuals sum to zero; for the centre, so do residuals times directions. An algebraic fit
// fails this by about noise^2 per point, 500 * 1e-4.
TEST(FitSphere, MinimisesOrthogonalDistance) {
  const Points points = cap({1, 2, 3}, 0.5, 1, 0.01);
  const SphereFit fit = fit_sphere(points);
  double sum = 0, squares = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const auto& x : points) {
    const double residual = (x - fit.centre_m).norm() - fit.radius_m;
    sum += residual;
    squares += residual * residual;
    moment += residual * (x - fit.centre_m).normalized();
  }
  EXPECT_LT(std::abs(sum), 1e-9);
  EXPECT_LT(moment.norm(), 1e-9);
  EXPECT_NEAR(fit.rms_m, std::sqrt(squares / 500), 1e-14);
  EXPECT_NEAR(fit.rms_m, 0.01, 5 * 0.01 / std::sqrt(2 * 500));  // five standard deviations
}

Points grid_on_plane(const Eigen::Vector3d& origin, const Eigen::Vector3d& u,
                     const Eigen::Vector3d& v) {
  Points points;
  for (int i = -5; i <= 5; ++i)
    for (int k = -5; k <= 5; ++k) points.push_back(origin + i * u + k * v);
  return points;
}

TEST(FitSphere, RefusesPointsThatDoNotTell) {
  EXPECT_THROW(fit_sphere(Points{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), Error);
  EXPECT_THROW(fit_sphere(Points(10, Eigen::Vector3d(1, 2, 3))), Error);
  EXPECT_THROW(fit_sphere(grid_on_plane({1, 2, 3}, {0.1, 0.02, 0.3}, {0, 0.4, -0.1})), Error);
  Points broken = cap({0, 0, 0}, 1, 2, 0);
  broken[3].x() = std::nan("");
  EXPECT_THROW(fit_sphere(broken), Error);
}

TEST(FitPlane, IsExactFarFromTheOrigin) {
  const Eigen::Vector3d u(0.1, 0.02, 0.3), v(0, 0.4, -0.1), origin(1e6, 2e6, -3e5);
  const PlaneFit fit = fit_plane(grid_on_plane(origin, u, v));
  EXPECT_LT((fit.point_m - origin).norm(), 1e-9);
  // rounding of 2.3e-10 m over a lever of 1 m
  EXPECT_NEAR(std::abs(fit.normal.dot(u.cross(v).normalized())), 1, 1e-15);
  EXPECT_LT(std::abs(fit.normal.dot(u.normalized())), 1e-9);
  EXPECT_NEAR(fit.normal.norm(), 1, 1e-15);
  EXPECT_LT(fit.rms_m, 1e-9);
}

TEST(FitPlane, MeasuresAKnownRoughness) {
  Points points = grid_on_plane({0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0});
  double sign = 1;
  for (auto& point : points) point.z() += 1e-3 * (sign = -sign);
  const PlaneFit fit = fit_plane(points);
  // 121 points: 61 at -1e-3, 60 at +1e-3, a checkerboard that is even in x and y, so untilted
  EXPECT_NEAR(fit.rms_m, 1e-3 * std::sqrt(1 - 1.0 / (121 * 121)), 1e-15);
  EXPECT_LT(fit.normal.head<2>().norm(), 1e-14);
}

TEST(FitPlane, IsExactForThreePoints) {
  const PlaneFit fit = fit_plane(Points{{1, 0, 5}, {0, 1, 5}, {0, 0, 5}});
  EXPECT_NEAR(std::abs(fit.normal.z()), 1, 1e-15);
  EXPECT_NEAR(fit.rms_m, 0, 1e-15);
}

TEST(FitPlane, RefusesPointsThatDoNotTell) {
  EXPECT_THROW(fit_plane(Points{{1, 0, 0}, {0, 1, 0}}), Error);
  EXPECT_THROW(fit_plane(Points{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}), Error);
  EXPECT_THROW(fit_plane(Points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}),
               Error);
}

}  // namespace
}  // namespace scan
