// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Acceptance figures of ideal points, of points with a known error, and of Gaussian noise.
#include "libscan/verify/artefacts.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

constexpr std::size_t count = 2000;

// The half of a ball that faces +z, radius grown by `grown(i)`.
template <class Grown>
Points half_ball(const Eigen::Vector3d& centre, double radius_m, Grown&& grown) {
  Points points;
  for (std::uint64_t i = 0; i < count; ++i) {
    RandomStream random(1, 0, i);
    const double z = random.uniform(), angle = 2 * std::numbers::pi * random.uniform();
    const double r = std::sqrt(1 - z * z);
    points.push_back(centre + (radius_m + grown(i)) *
                                  Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z));
  }
  return points;
}
Points ideal_ball(const Eigen::Vector3d& centre, double radius_m) {
  return half_ball(centre, radius_m, [](std::uint64_t) { return 0.0; });
}

Points scaled(Points points, double factor) {
  for (auto& x : points) x *= factor;
  return points;
}

// A plate of 0.2 m, bent as the paraboloid z = b (x^2 + y^2) / 2.
Points plate(double bend_per_m, double height_m = 0) {
  Points points;
  for (int i = -20; i <= 20; ++i)
    for (int k = -20; k <= 20; ++k) {
      const double x = 0.005 * i, y = 0.005 * k;
      points.push_back({x, y, height_m + bend_per_m * (x * x + y * y) / 2});
    }
  return points;
}

// Coordinates of 1 m round at 2e-16.
TEST(Artefacts, OfAnIdealScannerAreRounding) {
  const std::vector<Points> balls{ideal_ball({0.1, 0.2, 0.7}, 0.015),
                                  ideal_ball({-0.3, 0.1, 1}, 0.015)};
  for (const Measurement& m : probing_errors(balls, 0.03)) EXPECT_LT(std::abs(m.value), 1e-13);
  const BallBar bar{balls[0], balls[1]};
  const double length = Eigen::Vector3d(0.4, 0.1, -0.3).norm();
  EXPECT_NEAR(figure(spacing_errors(std::vector{bar}, length), "sphere_spacing_error"), 0, 1e-13);
  EXPECT_NEAR(figure(flatness_errors(std::vector<Points>{plate(0, 0.7)}), "flatness"), 0, 1e-13);
  EXPECT_NEAR(
      figure(step_errors(std::vector{Step{plate(0, 0.7), plate(0, 0.701)}}, 1e-3), "step_error"), 0,
      1e-13);
}

// 100 ppm too large: 3 um on a ball of 30 mm, 51 um on a bar of 0.51 m.
TEST(Artefacts, ShowAnErrorOfScale) {
  const std::vector<Points> balls{scaled(ideal_ball({0.1, 0.2, 0.7}, 0.015), 1.0001),
                                  scaled(ideal_ball({-0.3, 0.1, 1}, 0.015), 1.0001)};
  EXPECT_NEAR(figure(probing_errors(balls, 0.03), "probing_size"), 3e-6, 1e-13);
  EXPECT_NEAR(figure(probing_errors(balls, 0.03), "probing_form"), 0, 1e-13);
  const double length = Eigen::Vector3d(0.4, 0.1, -0.3).norm();
  EXPECT_NEAR(figure(spacing_errors(std::vector{BallBar{balls[0], balls[1]}}, length),
                     "sphere_spacing_error"),
              1e-4 * length, 1e-13);
}

// The worst of several places counts, with its sign.
TEST(Artefacts, TakeTheWorstPlace) {
  const std::vector<Points> balls{ideal_ball({0, 0, 1}, 0.015), ideal_ball({0, 0, 2}, 0.014)};
  EXPECT_NEAR(figure(probing_errors(balls, 0.03), "probing_size"), -0.002, 1e-13);
}

// Gaussian residuals: 95 % lie within +- 1.96 sigma. The order statistics near the ends of the
// narrowest interval spread by sqrt(0.025 0.975 / 2000) / density(1.96) = 0.06 sigma each, and the
// narrowest of all intervals lies below by about as much: 3.92 -0.4 +0.2 sigma. The range without
// six of 2000 points reaches the quantile 0.9985, 2.97 sigma, on both sides: 5.94, with a spread of
// sqrt(0.0015 / 2000) / density(2.97) = 0.18 sigma each, at three of them.
TEST(Artefacts, OfGaussianNoiseAreItsQuantiles) {
  const double sigma = 1e-4;
  const auto noise = [&](std::uint64_t i) { return sigma * RandomStream(2, 0, i).normal(); };
  const auto figures =
      probing_errors(std::vector<Points>{half_ball({0.1, 0.2, 0.7}, 0.015, noise)}, 0.03);
  EXPECT_GT(figure(figures, "probing_form_95"), 3.52 * sigma);
  EXPECT_LT(figure(figures, "probing_form_95"), 4.12 * sigma);
  EXPECT_NEAR(figure(figures, "probing_form"), 5.94 * sigma, 3 * std::sqrt(2) * 0.18 * sigma);
  EXPECT_EQ(measurement(figures, "probing_form").count, count);
}

// Six of 2000 points may be left out, a seventh may not.
TEST(Artefacts, LeaveOutThreePointsInAThousand) {
  const auto form_with = [](std::uint64_t strays) {
    return figure(probing_errors(std::vector<Points>{half_ball(
                                     {0, 0, 1}, 0.015,
                                     [&](std::uint64_t i) { return i < strays ? 1e-3 : 0.0; })},
                                 0.03),
                  "probing_form");
  };
  EXPECT_LT(form_with(6), 1e-12);
  EXPECT_GT(form_with(7), 9e-4);
}

// Of 1681 points five may be left out: the four corners and one of the next, 5 mm inside one edge;
// so the range is that of the next above the middle. The fifth, r = 6.5e-5 m off the plane, no
// longer balances its like: the plane tilts by r 0.1 / (1676 mean(x^2)) = 1.1e-6 about each axis,
// which changes the range by at most 2 * 0.2 * 1.1e-6.
TEST(Artefacts, FlatnessOfABentPlateIsItsRise) {
  const double b = 1e-2, corner = b * (0.1 * 0.1 + 0.095 * 0.095) / 2;
  const auto figures = flatness_errors(std::vector<Points>{plate(b)});
  EXPECT_NEAR(figure(figures, "flatness"), corner, 5e-7);
}

TEST(Artefacts, OfACylinder) {
  CylinderPlace place;
  place.true_axis = {{0.1, 0.2, 0.7}, Eigen::Vector3d(1, 2, 2) / 3};
  const Eigen::Vector3d u = place.true_axis.direction.unitOrthogonal();
  const Eigen::Vector3d tilted =
      Eigen::AngleAxisd(1e-3, u) * place.true_axis.direction;  // as a tilted light plane makes it
  const Eigen::Vector3d v = tilted.unitOrthogonal(), w = tilted.cross(v);
  for (std::uint64_t i = 0; i < count; ++i) {
    RandomStream random(5, 0, i);
    const double angle = 2 * random.uniform(), along = 0.1 * (random.uniform() - 0.5);
    place.points.push_back(place.true_axis.point_m + along * tilted +
                           0.0201 * (std::cos(angle) * v + std::sin(angle) * w));
  }
  const auto figures = cylinder_errors(std::vector{place}, 0.04);
  EXPECT_NEAR(figure(figures, "cylinder_diameter_error"), 2e-4, 1e-12);
  EXPECT_NEAR(figure(figures, "cylinder_axis_error"), 1e-3, 1e-12);
  EXPECT_LT(figure(figures, "cylindricity"), 1e-12);
  EXPECT_LT(figure(figures, "cylindricity_95"), 1e-12);
}

// Of three balls two stand true and the third is 20 um too far along x: the pair on x shows all of
// it, the other at 45 degrees 20 um / sqrt(2).
TEST(Artefacts, LengthErrorIsThatOfTheWorstPair) {
  const Eigen::Vector3d a(0, 0, 1), b(0.5, 0.5, 1), c(0.5, 0, 1), off(2e-5, 0, 0);
  const std::vector<PlacedBall> balls{{ideal_ball(a, 0.015), a},
                                      {ideal_ball(b, 0.015), b},
                                      {ideal_ball(Eigen::Vector3d(c + off), 0.015), c}};
  EXPECT_NEAR(figure(length_errors(balls), "length_error"), 2e-5, 1e-12);
  EXPECT_NEAR(figure(length_errors(std::span(balls).first(2)), "length_error"), 0, 1e-13);
  EXPECT_THROW(length_errors(std::span(balls).first(1)), Error);
}

// Ranges that are 100 ppm long, and a constant 5 mm, which is not relative.
TEST(Artefacts, RelativeRangeErrorShowsScaleAndNoOffset) {
  std::vector<PlacedPlate> plates;
  for (const double range_m : {1.0, 2.0, 5.0})
    plates.push_back({plate(0, 1.0001 * range_m + 5e-3), {0, 0, range_m}});
  EXPECT_NEAR(figure(relative_range_errors(plates, {0, 0, 2}), "relative_range_error"), 4e-4,
              1e-12);
  EXPECT_THROW(relative_range_errors({}, {0, 0, 1}), Error);
}

TEST(Artefacts, RepeatabilityIsTheStandardDeviation) {
  const Measurement size{.name = "probing_size", .value = 1, .unit = "m"};
  const std::vector<double> values{1e-6, 3e-6, 5e-6};
  const Measurement spread = repeatability(size, values);
  EXPECT_EQ(spread.name, "probing_size_repeatability");
  EXPECT_NEAR(spread.value, 2e-6, 1e-18);
  EXPECT_EQ(spread.count, 3u);
  EXPECT_THROW(repeatability(size, std::span(values).first(1)), Error);
}

TEST(Artefacts, RefuseNothing) {
  EXPECT_THROW(probing_errors({}, 0.03), Error);
  EXPECT_THROW(spacing_errors({}, 0.3), Error);
  EXPECT_THROW(flatness_errors({}), Error);
  EXPECT_THROW(cylinder_errors({}, 0.03), Error);
  EXPECT_THROW(step_errors({}, 0.03), Error);
  EXPECT_THROW(form_of({}), Error);
}

// 19 of 20 residuals: all but the lowest, which is the last window of the list.
TEST(Artefacts, TheNarrowestWidthMayBeTheLast) {
  std::vector<double> residuals_m{-100};
  for (int i = 1; i <= 19; ++i) residuals_m.push_back(i);
  EXPECT_EQ(form_of(residuals_m).width_95_m, 18);
  residuals_m.front() = 200;
  EXPECT_EQ(form_of(residuals_m).width_95_m, 18);
}

// Two balls, one of them 20 um too far: neighbours in the list are a pair.
TEST(Artefacts, LengthErrorIsThatOfNeighboursToo) {
  const Eigen::Vector3d a(0, 0, 1), b(0.5, 0, 1);
  const std::vector<PlacedBall> balls{{ideal_ball(a, 0.015), a},
                                      {ideal_ball(Eigen::Vector3d(b.x() + 2e-5, 0, 1), 0.015), b}};
  EXPECT_NEAR(figure(length_errors(balls), "length_error"), 2e-5, 1e-12);
}

// Tilted by 60 degrees and 10 um too far along the sight: its plane is off by half of that.
TEST(Artefacts, RelativeRangeErrorGoesAlongTheSight) {
  const Eigen::Matrix3d tilt =
      Eigen::AngleAxisd(std::numbers::pi / 3, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const auto tilted = [&](double range_m, double error_m) {
    PlacedPlate placed{plate(0), {0, 0, range_m}};
    for (auto& x : placed.points) x = tilt * x + Eigen::Vector3d(0, 0, range_m + error_m);
    return placed;
  };
  const std::vector<PlacedPlate> plates{tilted(1, 0), tilted(2, 1e-5)};
  EXPECT_NEAR(figure(relative_range_errors(plates, {0, 0, 1}), "relative_range_error"), 1e-5,
              1e-12);
}

}  // namespace
}  // namespace scan
