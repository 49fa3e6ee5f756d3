// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/surface_weights.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "libscan/reconstruct/local_smoothing.h"
#include "tests/reconstruct/plane_patch.h"

namespace scan {
namespace {

constexpr int side = 40;
constexpr double length_m = 2;

// What the weights at the middle make of waves along x over points `pitch` apart.
double answer_to(double x, double pitch) {
  const SurfaceResult square = smoothed_square(side, length_m);
  const PointCloud cloud = square_points(static_cast<int>(side / pitch), pitch);
  const SurfaceWeights weights(square.surface, square.vertex_smoothing_m, cloud);
  double answer = 0;
  for (const WeighedPoint& p : weights.at(middle_of(side)))
    answer += p.weight * std::cos(x / length_m * cloud.points[p.point].x());
  return answer;
}

// What fits on cells that end with half a wave leave of waves of k lengths^-1.
double answer_of_fits(double k) {
  return 1 / (1 + k * k * k) / (1 + std::pow(k / (std::numbers::pi * lengths_per_cell), 8));
}

// The kernel is cut off at four lengths and grows until its weight is 1. Of a wave x its part of
// frequency k leaves the integral of J0(k r) J0(x r) r over r < a = 4, which is Lommel's
//   a (k J1(k a) J0(x a) - x J0(k a) J1(x a)) / (k^2 - x^2).
double answer_of_cut_off_kernel(double x) {
  constexpr double a = 4, step = 0.0101;  // k is never an x of the test
  const auto j = [](int order, double at) { return std::cyl_bessel_j(order, at); };
  double wave = 0, all = 0;
  for (double k = step / 2; k < 12; k += step) {
    wave += answer_of_fits(k) * k * a *
            (k * j(1, k * a) * j(0, x * a) - x * j(0, k * a) * j(1, x * a)) / (k * k - x * x);
    all += answer_of_fits(k) * a * j(1, k * a);
  }
  return wave / all;
}

// The points make a sum of the integral, an eighth of a length apart: as exact as their number
// within four lengths, 3217, which is uncertain by some 32^(2/3) at the rim, where the kernel is
// 0.0014: 2e-4. What is cut off is in the answer: without the tail -9 / (2 pi r^5) of -x^3 it lies
// up to 3 / 64 (1 + 0.41) from that of fits.
TEST(SurfaceWeights, AnswerWavesAsTheFitDoes) {
  for (const double x : {0.3, 0.6, 0.9, 1.5, 2.0}) {
    EXPECT_NEAR(answer_to(x, 0.25), answer_of_cut_off_kernel(x), 5e-4) << x;
    EXPECT_NEAR(answer_to(x, 0.25), answer_of_fits(x), 3.0 / 64 * (1 + 0.41)) << x;
  }
}

Eigen::Vector3d leaning(double degrees) {
  const double turn = degrees * std::numbers::pi / 180;
  return {std::sin(turn), 0, std::cos(turn)};
}

TEST(SurfaceWeights, AddUpToOneAndLeaveTheBackOut) {
  const SurfaceResult square = smoothed_square(side, length_m);
  PointCloud cloud = square_points(80, 0.5);
  const PointCloud back = square_points(80, 0.5);
  append(cloud, back);
  for (std::size_t i = back.size(); i < cloud.size(); ++i) cloud.normals[i] = -cloud.normals[i];
  for (std::size_t i = 0; i < back.size(); ++i)  // 55 degrees are borne, 65 are not
    cloud.normals[i + (i % 2 ? back.size() : 0)] = leaning(i % 2 ? 65 : 55);
  const SurfaceWeights weights(square.surface, square.vertex_smoothing_m, cloud);
  for (const std::size_t v : {std::size_t{0}, middle_of(side)}) {
    double sum = 0;
    for (const WeighedPoint& p : weights.at(v)) {
      EXPECT_LT(p.point, back.size());
      sum += p.weight;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

// A stray a length above weighs 1 / 16 of what one on the surface does, half a length being
// tolerated; a vertex far from all points hangs on some of them.
TEST(SurfaceWeights, TrustStraysLessAndAlwaysFindAPoint) {
  const SurfaceResult square = smoothed_square(side, length_m);
  PointCloud cloud = square_points(80, 0.5);
  cloud.points.push_back({0.5, 0, length_m});
  cloud.normals.push_back(Eigen::Vector3d::UnitZ());
  const SurfaceWeights strays(square.surface, square.vertex_smoothing_m, cloud);
  PointCloud noisy = cloud;
  noisy.sigma_m.assign(cloud.size(), length_m);  // within four sigma it is none
  const SurfaceWeights usual(square.surface, square.vertex_smoothing_m, noisy);
  const auto of = [&](const SurfaceWeights& weights) {
    for (const WeighedPoint& p : weights.at(middle_of(side)))
      if (p.point + 1 == cloud.size()) return p.weight;
    return 0.0;
  };
  EXPECT_NE(of(usual), 0);
  EXPECT_NEAR(of(strays) / of(usual), 1.0 / 16, 0.001);  // the sum of all changes by less
  const PointCloud far = square_points(2, 1);
  const SurfaceWeights few(square.surface, square.vertex_smoothing_m, far);
  EXPECT_FALSE(few.at(0).empty());
}

// A wave of x = 0.8 whose mesh is what the fit leaves of it, the points being exact: what was taken
// is (1 - R)^2 a^2 / 2 in the mean. The pools of two lengths hold a quarter of a wave, and the
// kernel's own R is off by 0.01 (above) where 1 - R is 0.34: to 15 %.
TEST(SurfaceWeights, TellWhatSmoothingTook) {
  constexpr double x = 0.8, left = 1 / (1 + x * x * x), height = 0.02;
  SurfaceResult square = smoothed_square(side, length_m);
  PointCloud cloud = square_points(160, 0.25);
  const auto wave = [](const Eigen::Vector3d& at) {
    return height * std::cos(x / length_m * at.x());
  };
  for (auto& vertex : square.surface.vertices) vertex.z() = left * wave(vertex);
  for (auto& point : cloud.points) point.z() = wave(point);
  const SurfaceWeights weights(square.surface, square.vertex_smoothing_m, cloud);
  std::vector<double> once_m;
  for (std::size_t v = 0; v < square.surface.vertices.size(); ++v)
    once_m.push_back(weights.mean_residual_m(weights.at(v)));
  const std::vector<double> taken = weights.taken_m2(once_m);
  double mean = 0, count = 0, truth = 0;
  for (std::size_t v = 0; v < taken.size(); ++v) {
    const Eigen::Vector3d& at = square.surface.vertices[v];
    if (std::max(std::abs(at.x()), std::abs(at.y())) > 8) continue;  // clear of the rim
    mean += taken[v], count += 1;
    truth += std::pow((1 - left) * wave(at), 2);
  }
  EXPECT_NEAR(mean / truth, 1, 0.15);
}

// A paraboloid of 1 m^-1 / 100 through the vertices: facets lie below it by as much as the planes
// of their corners lie above, here 1 / 800 m, but for squares of slopes (0.01).
TEST(SurfaceWeights, FindNoResidualOnABentSurface) {
  const auto bowl = [](Eigen::Vector3d x) {
    x.z() = 0.005 * x.head<2>().squaredNorm();
    return x;
  };
  SurfaceResult square = smoothed_square(side, length_m);
  for (auto& vertex : square.surface.vertices) vertex = bowl(vertex);
  PointCloud cloud;
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(0.7, 0.2), {0.2, 0.7}, {-0.5, 0.5}, {1, -0.4}})
    cloud.points.push_back(bowl({at.x(), at.y(), 0}));
  const SurfaceWeights weights(square.surface, square.vertex_smoothing_m, cloud);
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    EXPECT_NEAR(weights.mean_residual_m(std::array{WeighedPoint{i, 1}}), 0, 1e-6) << i;
}

// Residuals that change sign from vertex to vertex leave nothing when smoothed: they are raised by
// no more than four. Those farther than two lengths from the middle do not count there.
TEST(SurfaceWeights, RaiseNoiseByFourAndLookTwoLengthsAround) {
  const SurfaceResult square = smoothed_square(side, length_m);
  const PointCloud cloud = square_points(160, 0.25);
  const SurfaceWeights weights(square.surface, square.vertex_smoothing_m, cloud);
  std::vector<double> near_m, far_m;
  for (const Eigen::Vector3d& at : square.surface.vertices) {
    const double sign = std::fmod(std::abs(at.x() + at.y()), 2) == 0 ? 1 : -1;
    const bool is_near = at.norm() <= 2 * length_m;
    near_m.push_back(is_near ? sign : 0);
    far_m.push_back(is_near ? 0 : sign);
  }
  EXPECT_DOUBLE_EQ(weights.taken_m2(near_m)[middle_of(side)], 4);
  EXPECT_EQ(weights.taken_m2(far_m)[middle_of(side)], 0);
}

}  // namespace
}  // namespace scan
