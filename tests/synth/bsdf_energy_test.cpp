// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light that leaves over light that comes: albedo, white furnace and what is lost.
#include "synth/bsdf/bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "synth/bsdf/fresnel.h"
#include "tests/synth/bsdf_kinds.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

struct Mean {
  double value, standard_error;
};

// Light that leaves over light that comes: the mean weight of samples.
Mean mean_weight(const Bsdf& bsdf, const Eigen::Vector3d& out, int draws) {
  RandomStream random(3, 0, 0);
  double sum = 0, squares = 0;
  for (int i = 0; i < draws; ++i) {
    const auto drawn = sample(bsdf, out, draw3(random));
    const double weight = drawn ? drawn->weight : 0;
    sum += weight;
    squares += weight * weight;
  }
  const double mean = sum / draws;
  return {mean, std::sqrt(std::max(0.0, squares / draws - mean * mean) / draws)};
}

TEST(Bsdf, AlbedoIsTheMeanWeightAndAtMostOne) {
  for (const auto& [name, bsdf] : kinds())
    for (const Eigen::Vector3d& out : views(bsdf)) {
      const double share = albedo(bsdf, out);
      ASSERT_LE(share, 1 + 1e-12) << name << " " << out.z();
      ASSERT_GE(share, 0) << name;
      const Mean drawn = mean_weight(bsdf, out, 40000);
      // four standard errors, and the table's own 5e-4
      EXPECT_NEAR(drawn.value, share, 4 * drawn.standard_error + 5e-4) << name << " " << out.z();
    }
}

TEST(Bsdf, AlbedoIsTheIntegralOfEvaluate) {
  const SphereCells cells;
  for (const Named& kind : kinds()) {
    const Bsdf& bsdf = kind.bsdf;
    if (has_delta(bsdf)) continue;
    for (const Eigen::Vector3d& out : views(bsdf)) {
      const auto part = [&](const Eigen::Vector3d& in) {
        return evaluate(bsdf, out, in) * std::abs(in.z());
      };
      // 40 nodes a cell resolve all lobes to 5e-4, the table's own error
      EXPECT_NEAR(total(cells.integrals(part, 40)), albedo(bsdf, out), 1e-3)
          << kind.name << " " << out.z();
    }
  }
}

TEST(Bsdf, WhiteFurnaceKeepsItsLight) {
  const double exact = 1e-15;
  for (const double cosine : {1.0, 0.7, 0.2, 0.01}) {
    const Eigen::Vector3d out = direction_at(cosine, 2);
    EXPECT_EQ(albedo(Lambert{1}, out), 1);
    EXPECT_EQ(albedo(Dielectric{1.5, 0}, out), 1);
    EXPECT_EQ(albedo(Dielectric{1.5, 0}, -out), 1);
    EXPECT_NEAR(albedo(Plastic{1, 1.5, 0}, out), 1, exact);
    EXPECT_NEAR(albedo(Plastic{1, 1.5, 0.4}, out), 1, exact);
    // its faces absorb 4 eta / k^2 = 4e-7 facing them, at most some 1e-5 at any angle
    EXPECT_NEAR(albedo(Conductor{0.001, 100, 0.5}, out), 1, 2e-5);
    EXPECT_NEAR(albedo(OrenNayar{0.8, 0}, out), 0.8, 1e-12) << "no slopes: Lambert";
  }
}

// What facets hide from light once reflected or refracted, for want of a second bounce: by the
// definition of the visible normals, over the facets' slopes.
double light_lost(const Dielectric& glass, double cosine) {
  const double a = glass.roughness;
  const Eigen::Vector3d out = direction_at(cosine, 0);
  const auto lambda = [&](double z) {  // GGX
    return (std::sqrt(1 + a * a * (1 - z * z) / (z * z)) - 1) / 2;
  };
  double kept = 0;
  const int steps = 600;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      // slope^2 / alpha^2 = u / (1 - u) is uniform in u for GGX's projected normals; 1 - u = s^2
      // tames the steep ones
      const double s = (i + 0.5) / steps, turn = 2 * pi * (j + 0.5) / steps;
      const double slope = a * std::sqrt(1 / (s * s) - 1);
      const Eigen::Vector3d h =
          Eigen::Vector3d(slope * std::cos(turn), slope * std::sin(turn), 1).normalized();
      const double facing = out.dot(h);
      if (facing <= 0) continue;
      const double area = 2 * s * facing / (h.z() * cosine) / (steps * steps);
      const double r = fresnel_dielectric(facing, glass.index);
      const double back = (2 * facing * h - out).z();
      if (back > 0) kept += area * r / (1 + lambda(cosine) + lambda(back));
      const auto through = refract(out, h, glass.index);
      if (through && through->z() < 0)
        kept += area * (1 - r) / ((1 + lambda(cosine)) * (1 + lambda(through->z())));
    }
  return 1 - kept;
}

TEST(Bsdf, RoughGlassLosesOnlyWhatItsFacetsHide) {
  for (const double roughness : {0.05, 0.2, 0.5})
    for (const double cosine : {1.0, 0.5, 0.2}) {
      const Dielectric glass{1.5, roughness, ggx};
      const double loss = light_lost(glass, cosine);
      // the sum over slopes converges as 1 / steps at its edges: 600 steps give 5e-4
      EXPECT_NEAR(albedo(glass, direction_at(cosine, 1)), 1 - loss, 1e-3);
      // as stated for users: below 1 % for alpha 0.05 facing it
      if (roughness == 0.05 && cosine == 1) {
        EXPECT_LT(loss, 0.01);
      }
    }
}

}  // namespace
}  // namespace scan::synth
