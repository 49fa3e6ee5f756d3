// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/surface_weights.h"

#include <gtest/gtest.h>

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

// Beyond four lengths the kernel's tail, -9 / (2 pi r^5), which is that of -x^3, holds -3 / 64 of
// its weight and is left out. What a wave makes of it, between 1 and -0.41 of that, is missing, and
// the rest grows by 3 / 64. Cells let these waves pass to 1 / (1 + (0.9 / 1.885)^8) = 0.997.
TEST(SurfaceWeights, AnswerWavesAsTheFitDoes) {
  for (const double x : {0.3, 0.6, 0.9})
    EXPECT_NEAR(answer_to(x, 0.25), 1 / (1 + x * x * x), 3.0 / 64 * (1 + 0.41) + 0.003) << x;
}

TEST(SurfaceWeights, AddUpToOneAndLeaveTheBackOut) {
  const SurfaceResult square = smoothed_square(side, length_m);
  PointCloud cloud = square_points(80, 0.5);
  const PointCloud back = square_points(80, 0.5);
  append(cloud, back);
  for (std::size_t i = back.size(); i < cloud.size(); ++i) cloud.normals[i] = -cloud.normals[i];
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

}  // namespace
}  // namespace scan
