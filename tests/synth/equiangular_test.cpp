// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/equiangular.h"

#include <gtest/gtest.h>

#include <limits>

namespace scan::synth {
namespace {

const Eigen::Vector3d origin(1, 2, 3), direction(0.6, 0, 0.8);

// The density is the derivative of u by distance: du / dt by differences of the sample.
TEST(Equiangular, DensityIsThatOfItsSamples) {
  for (const Eigen::Vector3d& light :
       {Eigen::Vector3d(2, 2.3, 4), Eigen::Vector3d(0, 2, 3), Eigen::Vector3d(5, 1, 9)})
    for (const double end_m : {2.0, std::numeric_limits<double>::infinity()}) {
      const Equiangular angles(nearest_to(light, origin, direction), end_m);
      EXPECT_NEAR(angles.sample(0), 0, 1e-12);
      for (const double u : {0.1, 0.5, 0.8}) {
        const double h = 1e-5;
        const double slope = 2 * h / (angles.sample(u + h) - angles.sample(u - h));
        EXPECT_NEAR(angles.density(angles.sample(u)) / slope, 1, 1e-7);
      }
      if (end_m == 2) {
        EXPECT_NEAR(angles.sample(1), 2, 1e-9);
      }
    }
}

// Equal angles: twice the distance to the light, a quarter of the density.
TEST(Equiangular, FollowsTheInverseSquare) {
  const Eigen::Vector3d light(2, 2.3, 4);
  const Equiangular angles(nearest_to(light, origin, direction), 5);
  const auto square = [&](double t) { return (origin + t * direction - light).squaredNorm(); };
  EXPECT_NEAR(angles.density(1) * square(1), angles.density(4) * square(4), 1e-12);
}

// A light on the ray itself, as a lens with the light in it: still finite, still a density.
TEST(Equiangular, BearsALightOnTheRay) {
  const Equiangular angles(nearest_to(origin, origin, direction), 10);
  EXPECT_TRUE(std::isfinite(angles.density(0)));
  EXPECT_GE(angles.sample(0), 0);
  EXPECT_NEAR(angles.sample(1), 10, 1e-6);
}

}  // namespace
}  // namespace scan::synth
