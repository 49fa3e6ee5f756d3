// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/bsdf/microfacet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/random.h"
#include "synth/sampling/warp.h"
#include "tests/synth/goodness.h"

namespace scan::synth {
namespace {

const Microfacets both[] = {Microfacets::ggx, Microfacets::beckmann};

TEST(Microfacets, CoverTheSurfaceOnce) {
  const SphereCells cells;
  for (const Microfacets kind : both)
    for (const double alpha : {0.15, 0.4, 1.0}) {
      const auto projected = [&](const Eigen::Vector3d& h) {
        return facet_density({kind, alpha}, h) * h.z();
      };
      EXPECT_NEAR(total(cells.integrals(projected)), 1, 1e-9);
    }
}

TEST(Microfacets, SeenFromAnywhereFillTheProjectedSurface) {
  // Smith's identity (Heitz 2014, eq. 14): G1(out) integral of max(0, out.h) D(h) dh = out.z
  const SphereCells cells;
  for (const Microfacets kind : both)
    for (const double alpha : {0.15, 0.4, 1.0})
      for (const double cosine : {0.9, 0.5, 0.1}) {
        const FacetSpread facets{kind, alpha};
        const Eigen::Vector3d out = direction_at(cosine, 0.3);
        const auto seen = [&](const Eigen::Vector3d& h) {
          return facet_density(facets, h) * std::max(0.0, out.dot(h));
        };
        // the kink of max(0, .) leaves 1e-4 of the largest cell
        EXPECT_NEAR(total(cells.integrals(seen)) / (1 + facet_lambda(facets, out)), cosine, 2e-4)
            << alpha << " " << cosine;
      }
}

TEST(Microfacets, DensityAndWeightOfTheSamplerGiveBackTheDistribution) {
  RandomStream random(3, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const double alpha = 0.01 + random.uniform();
    const double cosine = 0.01 + 0.99 * random.uniform();
    const double u = random.uniform(), v = random.uniform();
    const FacetSpread facets{both[i % 2], alpha};
    const Eigen::Vector3d out = direction_at(cosine, u);
    const Eigen::Vector3d h = sample_facet(facets, out, u, v);
    const double direct = facet_density(facets, h) * out.dot(h) / cosine;
    const double drawn = facet_weight(facets, out, h) * sampled_facet_density(facets, out, h);
    EXPECT_NEAR(drawn, direct, 1e-11 * direct);
  }
}

TEST(Microfacets, BeckmannsWarpHasTheSameNormals) {
  RandomStream random(4, 0, 0);
  for (int i = 0; i < 200; ++i) {
    const double cosine = 0.2 + 0.8 * random.uniform();
    const Eigen::Vector3d h = direction_at(cosine, 1);
    const double direct = facet_density({Microfacets::beckmann, 0.5}, h) * h.z();
    EXPECT_NEAR(beckmann_normal_density(h, 0.5), direct, 1e-13 * direct);
  }
}

TEST(Microfacets, LambdaKeepsItsLimits) {
  for (const Microfacets kind : both) {
    EXPECT_EQ(facet_lambda({kind, 0.3}, {0, 0, 1}), 0);
    // grazing: alpha tan / 2 for GGX, alpha tan / (2 sqrt(pi)) for Beckmann
    const double steep = 1e6 * (kind == Microfacets::ggx ? 1 : 1 / std::sqrt(std::numbers::pi));
    EXPECT_NEAR(facet_lambda({kind, 0.2}, {1, 0, 1e-7}) / steep, 1, 1e-5);
    EXPECT_EQ(facet_lambda({kind, 0.2}, {0.6, 0, 0.8}), facet_lambda({kind, 0.2}, {0.6, 0, -0.8}));
  }
}

TEST(Microfacets, MeanOverFacetsAgreesWithDraws) {
  const FacetSpread facets{Microfacets::beckmann, 0.4};
  const auto slope = [](const Eigen::Vector3d& out, const Eigen::Vector3d& h) {
    return out.dot(h) + h.x();
  };
  const double cosine = 0.4;
  const Eigen::Vector3d out = direction_at(cosine, 0);
  RandomStream random(5, 0, 0);
  double sum = 0, squares = 0;
  const int draws = 200000;
  for (int i = 0; i < draws; ++i) {
    const double u = random.uniform(), v = random.uniform();
    const double value = slope(out, sample_facet(facets, out, u, v));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / draws;
  const double error = std::sqrt((squares / draws - mean * mean) / draws);
  EXPECT_NEAR(facet_mean(facets, cosine, slope), mean, 4 * error);
}

}  // namespace
}  // namespace scan::synth
