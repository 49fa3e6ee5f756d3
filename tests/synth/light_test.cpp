// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "libscan/core/random.h"

namespace scan::synth {
namespace {

constexpr double pi = std::numbers::pi;

AreaLight panel() {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  return {.world_from_light = make_pose(turn, {0.4, -0.2, 1.5}),
          .width_m = 0.8,
          .height_m = 0.5,
          .radiance_w_m2_sr = 3};
}

// A dim sky with a bright spot and a dark band.
Environment sky() {
  Environment light{.radiance_w_m2_sr = 2, .map = Image<float>(12, 7, 0.1f)};
  light.map(5, 2) = 40;
  light.map(0, 3) = 7;
  for (int column = 0; column < 12; ++column) light.map(column, 5) = 0;
  return light;
}

Eigen::Vector2d random_square(RandomStream& random) {
  const double u = random.uniform();
  const double v = random.uniform();
  return {u, v};
}

// Chi-square of directions drawn by sample_light against light_along's density, over cells of equal
// solid angle in (cos theta, azimuth) about `axis`, whose expected counts come from the midpoint
// rule with `fine`^2 points per cell. Cells expecting fewer than 10 are put together.
struct ChiSquare {
  double value = 0;
  int freedom = -1;
  double density_sum = 0;  // integral of the density over the sphere
};
ChiSquare chi_square(const PreparedLight& light, const Eigen::Vector3d& x,
                     const Eigen::Matrix3d& world_from_axis, double least_cosine, int rows,
                     int columns, int fine) {
  const int draws = 200000;
  std::vector<double> expected(rows * columns, 0.0), counts(rows * columns, 0.0);
  const double height = (1 - least_cosine) / (rows * fine), width = 2 * pi / (columns * fine);
  ChiSquare test;
  for (int r = 0; r < rows * fine; ++r)
    for (int c = 0; c < columns * fine; ++c) {
      const double z = least_cosine + (r + 0.5) * height, azimuth = (c + 0.5) * width;
      const double across = std::sqrt(1 - z * z);
      const Eigen::Vector3d d(across * std::cos(azimuth), across * std::sin(azimuth), z);
      const double share = light_along(light, x, world_from_axis * d).density * height * width;
      expected[(r / fine) * columns + c / fine] += draws * share;
      test.density_sum += share;
    }
  RandomStream random(11, 0, 0);
  for (int i = 0; i < draws; ++i) {
    const LightSample drawn = sample_light(light, x, random_square(random));
    const Eigen::Vector3d d = world_from_axis.transpose() * drawn.direction;
    double azimuth = std::atan2(d.y(), d.x());
    if (azimuth < 0) azimuth += 2 * pi;
    const int r =
        std::clamp(static_cast<int>((d.z() - least_cosine) / (height * fine)), 0, rows - 1);
    counts[r * columns + std::min(columns - 1, static_cast<int>(azimuth / (width * fine)))] += 1;
  }
  double rest_expected = 0, rest_count = 0;
  const auto add = [&](double e, double n) {
    test.value += (n - e) * (n - e) / e;
    ++test.freedom;
  };
  for (int i = 0; i < rows * columns; ++i) {
    if (expected[i] < 10) {
      rest_expected += expected[i];
      rest_count += counts[i];
    } else {
      add(expected[i], counts[i]);
    }
  }
  if (rest_expected >= 10) add(rest_expected, rest_count);
  return test;
}

// Passed by chance once in about 30 000 seeds (Wilson and Hilferty 1931, z = 4).
double chi_square_limit(int freedom) {
  const double a = 2.0 / (9 * freedom);
  return freedom * std::pow(1 - a + 4 * std::sqrt(a), 3);
}

// The frame whose z looks from x at the panel's middle, and the cosine of the cone around it.
Eigen::Matrix3d towards(const Eigen::Vector3d& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), direction).toRotationMatrix();
}

TEST(AreaLight, SamplesByItsDensity) {
  const AreaLight lamp = panel();
  const PreparedLight light{lamp};
  for (const Eigen::Vector3d& seen_from :
       {Eigen::Vector3d(0.1, 0.2, 0.7), Eigen::Vector3d(0.9, 0.3, 0.2),
        Eigen::Vector3d(0, 0, 90)}) {
    const Eigen::Vector3d x = lamp.world_from_light * seen_from;
    const Eigen::Vector3d middle = lamp.world_from_light.translation() - x;
    // a cone that holds all corners
    double least_cosine = 1;
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0}) {
        const Eigen::Vector3d corner(sx * lamp.width_m / 2, sy * lamp.height_m / 2, 0);
        const Eigen::Vector3d way = lamp.world_from_light * corner - x;
        least_cosine = std::min(least_cosine, way.normalized().dot(middle.normalized()));
      }
    least_cosine -= 0.01 * (1 - least_cosine);
    const ChiSquare test =
        chi_square(light, x, towards(middle.normalized()), least_cosine, 12, 16, 50);
    EXPECT_GT(test.freedom, 50);
    // Midpoint rule over a jump at the border: about 1 / 600 of the cone's width per border cell;
    // the counts' own noise is 1 / sqrt(200 000 / 192 cells) = 3 %.
    EXPECT_NEAR(test.density_sum, 1, 2e-3);
    EXPECT_LT(test.value, chi_square_limit(test.freedom)) << seen_from.transpose();
  }
}

TEST(Environment, SamplesItsMapByRadiance) {
  const PreparedLight light{sky()};
  const Eigen::Vector3d x(5, 6, 7);
  const ChiSquare test = chi_square(light, x, Eigen::Matrix3d::Identity(), -1, 20, 24, 40);
  // Rows of the map are no rows of equal cosine: the midpoint rule errs by half a fine row (1/800)
  // at the spot's two borders, 1/160 of the 0.32 high spot's share.
  EXPECT_NEAR(test.density_sum, 1, 5e-3);
  EXPECT_GT(test.freedom, 50);
  EXPECT_LT(test.value, chi_square_limit(test.freedom));
}

// So every sample brings the same light: radiance over density is the whole sky's light, the sum of
// radiance times solid angle, 2 pi / 12 (cos top - cos bottom) for each of a row's 12 cells.
TEST(Environment, DensityIsProportionalToRadiance) {
  const Environment described = sky();
  double total = 0;
  for (int row = 0; row < 7; ++row)
    for (int column = 0; column < 12; ++column)
      total += 2 * described.map(column, row) * 2 * pi / 12 *
               (std::cos(pi * row / 7) - std::cos(pi * (row + 1) / 7));
  const PreparedLight light{described};
  RandomStream random(12, 0, 0);
  for (int i = 0; i < 200; ++i) {
    const LightSample drawn = sample_light(light, Eigen::Vector3d::Zero(), random_square(random));
    EXPECT_NEAR(drawn.radiance / drawn.density / total, 1, 1e-12);
  }
}

TEST(Environment, ConstantSamplesEvenly) {
  const PreparedLight light{Environment{.radiance_w_m2_sr = 2}};
  const ChiSquare test =
      chi_square(light, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), -1, 20, 24, 2);
  EXPECT_NEAR(test.density_sum, 1, 1e-12);
  EXPECT_LT(test.value, chi_square_limit(test.freedom));
}

// What is sampled is what is seen along the direction.
TEST(Light, SampleAgreesWithWhatIsSeenAlongIt) {
  const AreaLight lamp = panel();
  for (const Light& described : {Light(lamp), Light(sky()), Light(Environment{})}) {
    const PreparedLight light{described};
    for (std::uint64_t i = 0; i < 1000; ++i) {
      RandomStream random(3, 0, i);
      const Eigen::Vector2d u = random_square(random), side = random_square(random);
      const double z = 0.05 + 3 * random.uniform();
      const Eigen::Vector3d x =
          lamp.world_from_light * Eigen::Vector3d(side.x() - 0.5, side.y() - 0.5, z);
      const LightSample drawn = sample_light(light, x, u);
      const LightSample seen = light_along(light, x, drawn.direction);
      EXPECT_NEAR(drawn.direction.norm(), 1, 1e-14);
      EXPECT_EQ(drawn.radiance, seen.radiance);
      EXPECT_NEAR(seen.density / drawn.density, 1, 1e-9);
      if (std::isfinite(drawn.distance_m)) {
        EXPECT_NEAR(seen.distance_m, drawn.distance_m, 1e-12 * drawn.distance_m);
      }
    }
  }
}

// Radiance times cosine over density, over a grid of 256 x 256 midpoints of the unit square.
double irradiance(const PreparedLight& light, const Eigen::Vector3d& x,
                  const Eigen::Vector3d& normal) {
  const int side = 256;
  double sum = 0;
  for (int i = 0; i < side * side; ++i) {
    const Eigen::Vector2d u((i % side + 0.5) / side, (i / side + 0.5) / side);
    const LightSample drawn = sample_light(light, x, u);
    sum += drawn.radiance * std::max(0.0, drawn.direction.dot(normal)) / drawn.density;
  }
  return sum / (side * side);
}

// Lambert's formula for a polygon above the horizon: L / 2 sum of angle times cosine between the
// normal and the side's plane.
double lambert_irradiance(const AreaLight& lamp, const Eigen::Vector3d& x,
                          const Eigen::Vector3d& normal) {
  const double w = lamp.width_m / 2, h = lamp.height_m / 2;
  std::array<Eigen::Vector3d, 4> corners;
  const std::array<Eigen::Vector3d, 4> local = {{{-w, -h, 0}, {-w, h, 0}, {w, h, 0}, {w, -h, 0}}};
  for (int i = 0; i < 4; ++i) corners[i] = (lamp.world_from_light * local[i] - x).normalized();
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d &a = corners[i], &b = corners[(i + 1) % 4];
    sum += std::acos(a.dot(b)) * a.cross(b).normalized().dot(normal);
  }
  return lamp.radiance_w_m2_sr / 2 * sum;
}

TEST(AreaLight, IrradianceIsLambertsFormula) {
  const AreaLight lamp = panel();
  const PreparedLight light{lamp};
  for (const Eigen::Vector3d& seen_from :
       {Eigen::Vector3d(0, 0, 0.6), Eigen::Vector3d(0.7, -0.4, 0.5), Eigen::Vector3d(0, 3, 0.8),
        Eigen::Vector3d(5, 5, 60)}) {
    const Eigen::Vector3d x = lamp.world_from_light * seen_from;
    const Eigen::Vector3d normal = (lamp.world_from_light.translation() - x).normalized();
    const double truth = lambert_irradiance(lamp, x, normal);
    ASSERT_GT(truth, 0);
    // midpoint rule of a smooth integrand: error of order 1 / 256^2
    EXPECT_NEAR(irradiance(light, x, normal) / truth, 1, 1.0 / (256 * 256))
        << seen_from.transpose();
  }
}

TEST(AreaLight, IsDarkBehind) {
  const AreaLight lamp = panel();
  const PreparedLight light{lamp};
  const Eigen::Vector3d x = lamp.world_from_light * Eigen::Vector3d(0, 0, -0.5);
  EXPECT_EQ(sample_light(light, x, {0.5, 0.5}).radiance, 0);
  EXPECT_EQ(light_along(light, x, lamp.world_from_light.linear().col(2)).radiance, 0);
}

TEST(Environment, ConstantGivesPiL) {
  const PreparedLight light{Environment{.radiance_w_m2_sr = 2}};
  // the cosine's kink at the horizon leaves an error of order 1 / 256^2 in the midpoint rule
  for (const Eigen::Vector3d& normal : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.6, 0, -0.8)})
    EXPECT_NEAR(irradiance(light, {1, 2, 3}, normal), 2 * pi, 2 * pi * 4 / (256.0 * 256));
}

// The same from a map whose cells are all alike, which goes another way through the code.
TEST(Environment, EvenMapGivesPiL) {
  Environment even{.radiance_w_m2_sr = 0.5, .map = Image<float>(8, 4, 4.0f)};
  EXPECT_NEAR(irradiance(PreparedLight(even), {1, 2, 3}, {0.48, 0.64, 0.6}), 2 * pi,
              2 * pi * 4 / (256.0 * 256));
}

TEST(Environment, RowZeroIsUpAndColumnZeroTurnsFromXToY) {
  Environment light{.map = Image<float>(8, 4, 1.0f)};
  light.map(1, 0) = 5;  // azimuth 45 to 90 degrees, polar angle 0 to 45
  const double azimuth = 60 * pi / 180, polar = 20 * pi / 180;
  const Eigen::Vector3d d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                          std::cos(polar));
  const PreparedLight prepared{light};
  EXPECT_EQ(light_along(prepared, Eigen::Vector3d::Zero(), d).radiance, 5);
  EXPECT_EQ(light_along(prepared, Eigen::Vector3d::Zero(), {d.x(), -d.y(), d.z()}).radiance, 1);
  EXPECT_EQ(light_along(prepared, Eigen::Vector3d::Zero(), {d.x(), d.y(), -d.z()}).radiance, 1);
}

TEST(Environment, DarkMapGivesNothing) {
  const PreparedLight light{Environment{.map = Image<float>(8, 4, 0.0f)}};
  const LightSample drawn = sample_light(light, {1, 2, 3}, {0.3, 0.6});
  EXPECT_EQ(drawn.radiance, 0);
  EXPECT_TRUE(drawn.direction.allFinite());
}

TEST(PointLight, ShinesByTheInverseSquare) {
  const PreparedLight light{PointLight{.position_m = {1, 2, 5}, .intensity_w_sr = 8}};
  const LightSample drawn = sample_light(light, {1, 2, 1}, {0.1, 0.9});
  EXPECT_EQ(drawn.direction, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(drawn.distance_m, 4);
  EXPECT_EQ(drawn.radiance, 0.5);
  EXPECT_EQ(drawn.density, 0);
  EXPECT_EQ(light_along(light, {1, 2, 1}, Eigen::Vector3d::UnitZ()).radiance, 0);
  EXPECT_EQ(sample_light(light, {1, 2, 5}, {0.1, 0.9}).radiance, 0);  // at the light itself
}

}  // namespace
}  // namespace scan::synth
