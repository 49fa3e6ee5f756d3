// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/texture.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "libscan/core/random.h"
#include "tests/synth/one_object.h"

namespace scan::synth {
namespace {

TEST(Texture, MovesWithItsObject) {
  Scene scene = one_object(NoiseTexture{0.02, 4, 0.8});
  const Eigen::Vector3d x(0.03, -0.05, 0.08);
  const auto albedo = [&](const Eigen::Vector3d& x_in_world) {
    return std::get<Lambert>(bsdf_at(scene, 0, 0, x_in_world)).albedo;
  };
  const double before = albedo(x);
  const Pose pose = exp((Vector6() << 1, 2, 0.3, 1, 2, 3).finished());
  scene.objects[0].world_from_object = pose;
  // a slope of at most about 2 / finest wavelength (2.5 mm) carries roundings of 1e-15 m
  EXPECT_NEAR(albedo(pose * x), before, 1e-11);
}

TEST(Texture, CheckersAlternateWithTheirPeriod) {
  const CheckerTexture checker{0.02, 0.75};
  const auto at = [&](double x, double y, double z) {
    return texture_factor(checker, {{x, y, z}});
  };
  EXPECT_EQ(at(0, 0, 0), 1);
  EXPECT_EQ(at(0.01, 0, 0), 0.25);
  EXPECT_EQ(at(0.02, 0, 0), 1);
  EXPECT_EQ(at(0.01, 0.01, 0), 1);
  EXPECT_EQ(at(-0.01, 0, 0), 0.25);
  EXPECT_EQ(at(0.0049, 0, 0), 1);
  EXPECT_EQ(at(0.0051, 0, 0), 0.25);
}

TEST(Texture, CheckersOnAFaceDoNotFlipByRounding) {
  const CheckerTexture checker{0.02, 0.75};
  for (int cell = -3; cell <= 3; ++cell)
    for (const double offset : {-1e-12, 0.0, 1e-12})
      EXPECT_EQ(texture_factor(checker, {{0.001, 0.002, 0.01 * cell + offset}}),
                cell % 2 == 0 ? 1 : 0.25);
}

TEST(Texture, PictureLiesCentredOnThePlaneAndRepeats) {
  ImageTexture picture{Image<float>(4, 2), 0.04};  // pixels of 10 mm
  for (int i = 0; i < 8; ++i) picture.factors.pixels[i] = static_cast<float>(i) / 8;
  const auto at = [&](double x, double y) { return texture_factor(picture, {{x, y, 0.3}}); };
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column)
      for (const int turn : {-2, 0, 3})
        EXPECT_NEAR(at(0.01 * column - 0.015 + 0.04 * turn, 0.005 - 0.01 * row - 0.02 * turn),
                    (4 * row + column) / 8.0, 1e-12);
  EXPECT_NEAR(at(-0.01, 0.005), 0.5 / 8, 1e-12) << "half way along the first row";
  EXPECT_NEAR(at(-0.015, 0), 2.0 / 8, 1e-12) << "half way down the first column";
  EXPECT_NEAR(at(0.02, 0.005), 1.5 / 8, 1e-12) << "from the last column over to the first";
}

// A square of 0.2 m in space whose first triangle shows the left upper half of a picture of 2 x 2
// pixels. Between the centres of pixels the factor is bilinear, so it is known in closed form.
TEST(Texture, PictureIsLaidOnAMeshByItsCoordinates) {
  Scene scene = one_object(MeshTexture{Image<float>(2, 2)});
  auto& factors = std::get<MeshTexture>(scene.materials[0].texture).factors;
  factors.pixels = {0.0f, 0.25f, 0.5f, 1.0f};
  scene.objects[0].geometry =
      Mesh{{{1, 0, 0}, {1, 0.2, 0}, {1, 0.2, -0.2}, {1, 0, -0.2}}, {{0, 2, 1}, {0, 3, 2}}};
  scene.objects[0].texture_corners = {{{{0, 0}, {1, 1}, {1, 0}}}, {{{0, 0}, {0, 1}, {1, 1}}}};
  EXPECT_EQ(complaint_of(scene), "");
  for (const double u : {0.3, 0.5, 0.7})
    for (const double v : {0.3, 0.45, 0.7}) {
      const double a = 2 * u - 0.5, b = 2 * v - 0.5;
      const double expected = (1 - b) * 0.25 * a + b * (0.5 * (1 - a) + a);
      const std::uint32_t triangle = u >= v ? 0 : 1;
      const auto bsdf = std::get<Lambert>(
          bsdf_at(scene, 0, triangle,
                  scene.objects[0].world_from_object * Eigen::Vector3d(1, 0.2 * u, -0.2 * v)));
      EXPECT_NEAR(bsdf.albedo, 0.6 * expected, 1e-9) << u << " " << v;  // floats of 2^-24 are exact
    }
  scene.objects[0].texture_corners.pop_back();
  EXPECT_NE(complaint_of(scene).find("texture_corners has 1 entries, must have 2"),
            std::string::npos);
  scene.objects[0].texture_corners.clear();
  EXPECT_NE(complaint_of(scene).find("a picture without a width"), std::string::npos);
}

TEST(Texture, NoiseIsUniformOnItsLatticeAndSmoothBetween) {
  double sum = 0, squares = 0;
  const int side = 30;
  for (int i = 0; i < side * side * side; ++i) {
    const double v =
        value_noise(Eigen::Vector3d(i % side, i / side % side, i / side / side).array() - 15);
    ASSERT_GE(v, 0);
    ASSERT_LT(v, 1);
    sum += v;
    squares += v * v;
  }
  const double count = side * side * side;
  // uniform: mean 1/2, variance 1/12; four standard errors
  EXPECT_NEAR(sum / count, 0.5, 4 / std::sqrt(12 * count));
  EXPECT_NEAR(squares / count - std::pow(sum / count, 2), 1.0 / 12,
              4 * std::sqrt(1.0 / 180 / count));

  RandomStream random(1, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    Eigen::Vector3d x(20 * random.uniform() - 10, 20 * random.uniform() - 10,
                      20 * random.uniform() - 10);
    if (i % 2) x.x() = std::round(x.x());  // across a cell's face too
    const double h = 1e-4, slope = (value_noise(x + h * Eigen::Vector3d::UnitX()) -
                                    value_noise(x - h * Eigen::Vector3d::UnitX())) /
                                   (2 * h);
    ASSERT_LT(std::abs(slope), 1.875 + 1e-3);  // the blend's steepest slope, 15/8
    if (i % 2) {
      ASSERT_NEAR(slope, 0, 1e-6) << "level at the lattice";
    }
  }
}

TEST(Texture, NoiseKeepsTheContrastAsked) {
  const NoiseTexture noise{0.01, 4, 0.8};
  double low = 1, high = 0;
  for (int i = 0; i < 20000; ++i) {
    RandomStream random(2, 0, i);
    const double f =
        texture_factor(noise, {{random.uniform(), random.uniform(), random.uniform()}});
    low = std::min(low, f);
    high = std::max(high, f);
  }
  EXPECT_GE(low, 0.2);
  EXPECT_LE(high, 1);
  EXPECT_LT(low, 0.4);
  EXPECT_GT(high, 0.8);
}

}  // namespace
}  // namespace scan::synth
