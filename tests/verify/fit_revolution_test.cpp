// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fits of cylinder, cone and torus: exact shapes far away and in part, stationarity with noise,
// refusal where the points cannot tell.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/pose.h"
#include "libscan/core/random.h"
#include "libscan/verify/fit.h"

namespace scan {
namespace {

using Points = std::vector<Eigen::Vector3d>;
constexpr double deg = std::numbers::pi / 180;

const Pose far_away = [] {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, -2, 0.5).normalized()).matrix();
  pose.translation() = Eigen::Vector3d(1e6, -2e5, 3e5);
  return pose;
}();

// 600 points of a surface of revolution: `profile` gives (rho, z) and the outward normal's (rho, z)
// at a parameter in [0, 1]; `arc_rad` of the turn; noise along the normal.
struct ProfilePoint {
  Eigen::Vector2d place, normal;
};
Points turned(const std::function<ProfilePoint(double)>& profile, double arc_rad, double noise_m,
              const Pose& world_from_axis) {
  Points points;
  for (std::uint64_t i = 0; i < 600; ++i) {
    RandomStream random(3, 0, i);
    const double angle = arc_rad * (random.uniform() - 0.5);
    const ProfilePoint at = profile(random.uniform());
    const Eigen::Vector2d p = at.place + noise_m * random.normal() * at.normal;
    points.push_back(world_from_axis *
                     Eigen::Vector3d(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()));
  }
  return points;
}

ProfilePoint cylinder(double t) {
  return {{0.5, 2 * t - 1}, {1, 0}};
}
ProfilePoint cone(double t) {  // half-angle 20 degrees, radius 0.5 at z = 0
  const double z = 2 * t - 1;
  return {{0.5 + z * std::tan(20 * deg), z}, {std::cos(20 * deg), -std::sin(20 * deg)}};
}
// The outer half of the tube: a part, as a scanner sees it.
ProfilePoint torus(double t) {
  const double angle = (t - 0.5) * std::numbers::pi;
  const Eigen::Vector2d out(std::cos(angle), std::sin(angle));
  return {Eigen::Vector2d(1, 0) + 0.3 * out, out};
}

// The nominal axis, 10 degrees and a tenth of the size off.
Axis guess_near(const Pose& world_from_axis) {
  const Eigen::Vector3d direction(std::sin(10 * deg), 0, std::cos(10 * deg));
  return {world_from_axis * Eigen::Vector3d(0.05, -0.1, 0.1), world_from_axis.linear() * direction};
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}
double distance_to_axis(const Eigen::Vector3d& x, const Axis& axis) {
  return (x - axis.point_m).cross(axis.direction).norm();
}

// Coordinates at 1e6 m round at 1.2e-10 m; over 600 points of a full turn the parameters' rounding
// is below one point's, over an arc of 60 degrees the depth of the axis and the radius trade
// against each other with a factor of about 24 / t^4 = 20 on the mean over 600 points (1/25): 1e-9
// in all.
class FitFarAway : public testing::TestWithParam<double> {};

TEST_P(FitFarAway, IsExactForACylinder) {
  const auto fit = fit_cylinder(turned(cylinder, GetParam(), 0, far_away), guess_near(far_away));
  EXPECT_NEAR(fit.radius_m, 0.5, 1e-9);
  EXPECT_LT(angle_between(fit.axis.direction, far_away.linear().col(2)), 1e-9);
  EXPECT_LT(distance_to_axis(far_away.translation(), fit.axis), 1e-9);
  EXPECT_LT(fit.rms_m, 1e-9);
}

TEST_P(FitFarAway, IsExactForACone) {
  const auto fit = fit_cone(turned(cone, GetParam(), 0, far_away), guess_near(far_away));
  EXPECT_NEAR(fit.half_angle_rad, 20 * deg, 1e-9);
  EXPECT_LT((fit.axis.direction - far_away.linear().col(2)).norm(), 1e-9);
  EXPECT_LT(distance_to_axis(far_away.translation(), fit.axis), 1e-9);
  const double height = far_away.linear().col(2).dot(fit.axis.point_m - far_away.translation());
  EXPECT_NEAR(fit.radius_m, 0.5 + height * std::tan(20 * deg), 1e-9);
  EXPECT_LT(fit.rms_m, 1e-9);
}

TEST_P(FitFarAway, IsExactForATorus) {
  const auto fit = fit_torus(turned(torus, GetParam(), 0, far_away), guess_near(far_away));
  EXPECT_NEAR(fit.major_radius_m, 1, 1e-9);
  EXPECT_NEAR(fit.minor_radius_m, 0.3, 1e-9);
  EXPECT_LT((fit.axis.point_m - far_away.translation()).norm(), 1e-9);
  EXPECT_LT(angle_between(fit.axis.direction, far_away.linear().col(2)), 1e-9);
  EXPECT_LT(fit.rms_m, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Arcs, FitFarAway, testing::Values(360 * deg, 120 * deg, 60 * deg));

// A cone that narrows along the guess is returned with its axis turned round.
TEST(FitCone, WidensAlongItsAxis) {
  Axis guess = guess_near(Pose::Identity());
  guess.direction = -guess.direction;
  const auto fit = fit_cone(turned(cone, 360 * deg, 0, Pose::Identity()), guess);
  EXPECT_NEAR(fit.half_angle_rad, 20 * deg, 1e-12);
  EXPECT_NEAR(fit.axis.direction.z(), 1, 1e-12);
}

// The sum of squares as a function of one change of the fit, by a formula of the test's own, has
// its minimum where the fit is: the parabola through three values has its vertex within 1e-6 of the
// step (1e-4 of the size), which rounding of the sums (1e-16 / 1e-8) allows and a fit of another
// cost, off by noise^2 = 1e-4 of the size, does not meet.
double vertex(const std::function<double(double)>& sum) {
  const double h = 1e-4, a = sum(-h), b = sum(0), c = sum(h);
  return h * (a - c) / (2 * (a - 2 * b + c));
}

double squares(const Points& points, const std::function<double(const Eigen::Vector3d&)>& d) {
  double sum = 0;
  for (const auto& x : points) sum += d(x) * d(x);
  return sum;
}

Axis changed(const Axis& axis, int parameter, double by) {
  const Eigen::Vector3d u = axis.direction.unitOrthogonal(), v = axis.direction.cross(u);
  Axis result = axis;
  const std::array<Eigen::Vector3d, 2> across = {u, v};
  if (parameter < 2)
    result.point_m += by * across[static_cast<std::size_t>(parameter)];
  else
    result.direction =
        (axis.direction + by * across[static_cast<std::size_t>(parameter - 2)]).normalized();
  return result;
}

TEST(FitCylinder, MinimisesOrthogonalDistance) {
  const Points points = turned(cylinder, 200 * deg, 0.01, Pose::Identity());
  const auto fit = fit_cylinder(points, guess_near(Pose::Identity()));
  const auto sum = [&](const Axis& axis, double radius) {
    return squares(points,
                   [&](const Eigen::Vector3d& x) { return distance_to_axis(x, axis) - radius; });
  };
  for (int parameter = 0; parameter < 4; ++parameter)
    EXPECT_LT(std::abs(vertex(
                  [&](double by) { return sum(changed(fit.axis, parameter, by), fit.radius_m); })),
              1e-6);
  EXPECT_LT(std::abs(vertex([&](double by) { return sum(fit.axis, fit.radius_m + by); })), 1e-6);
  EXPECT_NEAR(fit.rms_m, std::sqrt(sum(fit.axis, fit.radius_m) / 600), 1e-12);
  EXPECT_NEAR(fit.rms_m, 0.01, 5 * 0.01 / std::sqrt(2 * 600));  // five standard deviations
}

TEST(FitTorus, MinimisesOrthogonalDistance) {
  const Points points = turned(torus, 200 * deg, 0.01, Pose::Identity());
  const auto fit = fit_torus(points, guess_near(Pose::Identity()));
  const auto sum = [&](const Axis& axis, double major, double minor) {
    return squares(points, [&](const Eigen::Vector3d& x) {
      const double z = (x - axis.point_m).dot(axis.direction);
      return std::hypot(distance_to_axis(x, axis) - major, z) - minor;
    });
  };
  const double major = fit.major_radius_m, minor = fit.minor_radius_m;
  for (int parameter = 0; parameter < 4; ++parameter)
    EXPECT_LT(std::abs(vertex(
                  [&](double by) { return sum(changed(fit.axis, parameter, by), major, minor); })),
              1e-6);
  EXPECT_LT(
      std::abs(vertex([&](double by) {
        return sum({fit.axis.point_m + by * fit.axis.direction, fit.axis.direction}, major, minor);
      })),
      1e-6);
  EXPECT_LT(std::abs(vertex([&](double by) { return sum(fit.axis, major + by, minor); })), 1e-6);
  EXPECT_LT(std::abs(vertex([&](double by) { return sum(fit.axis, major, minor + by); })), 1e-6);
}

TEST(FitCone, MinimisesOrthogonalDistance) {
  const Points points = turned(cone, 200 * deg, 0.01, Pose::Identity());
  const auto fit = fit_cone(points, guess_near(Pose::Identity()));
  const auto sum = [&](const Axis& axis, double angle, double radius) {
    return squares(points, [&](const Eigen::Vector3d& x) {
      const double z = (x - axis.point_m).dot(axis.direction);
      return (distance_to_axis(x, axis) - radius) * std::cos(angle) - z * std::sin(angle);
    });
  };
  const double angle = fit.half_angle_rad, radius = fit.radius_m;
  for (int parameter = 0; parameter < 4; ++parameter)
    EXPECT_LT(std::abs(vertex(
                  [&](double by) { return sum(changed(fit.axis, parameter, by), angle, radius); })),
              1e-6);
  EXPECT_LT(std::abs(vertex([&](double by) { return sum(fit.axis, angle + by, radius); })), 1e-6);
  EXPECT_LT(std::abs(vertex([&](double by) { return sum(fit.axis, angle, radius + by); })), 1e-6);
}

TEST(FitRevolution, RefusesPointsThatDoNotTell) {
  const Axis z;
  const Points few(4, Eigen::Vector3d(1, 2, 3));
  EXPECT_THROW(fit_cylinder(few, z), Error);
  EXPECT_THROW(fit_cone(few, z), Error);
  EXPECT_THROW(fit_torus(few, z), Error);
  // one ring of a cylinder leaves its axis free to tilt into a cone or a sphere's
  const Points ring = turned(
      [](double) {
        return ProfilePoint{{0.5, 0}, {1, 0}};
      },
      360 * deg, 0, Pose::Identity());
  EXPECT_THROW(fit_cylinder(ring, z), Error);
  EXPECT_THROW(fit_cone(ring, z), Error);
  EXPECT_THROW(fit_torus(ring, z), Error);
  // a sphere is a torus of any axis
  const Points sphere = turned(
      [](double t) {
        const Eigen::Vector2d out(std::cos((t - 0.5) * 3), std::sin((t - 0.5) * 3));
        return ProfilePoint{out, out};
      },
      360 * deg, 0, Pose::Identity());
  EXPECT_THROW(fit_torus(sphere, z), Error);
  EXPECT_THROW(fit_cylinder(turned(cylinder, 6, 0, Pose::Identity()), {{0, 0, 0}, {0, 0, 0}}),
               Error);
  Points broken = turned(cylinder, 6, 0, Pose::Identity());
  broken[3].x() = std::nan("");
  EXPECT_THROW(fit_cylinder(broken, z), Error);
}

}  // namespace
}  // namespace scan
