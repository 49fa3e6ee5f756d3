// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/diffusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "synth/bsdf/fresnel.h"
#include "synth/medium/quadrature.h"
#include "tests/synth/slab_walk.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// Integral over the cosine of a function of H, nodes dense towards grazing.
template <class F>
double over_cosines(F&& f, int count = 40) {
  double sum = 0;
  for (const QuadratureNode& node : gauss_legendre(count))
    sum += 2 * node.x * node.weight * f(node.x * node.x);
  return sum;
}

// Reduced extinction 1 per metre.
Medium body(double reduced_albedo, double mean_cosine = 0) {
  return {.absorption_per_m = 1 - reduced_albedo,
          .scattering_per_m = reduced_albedo / (1 - mean_cosine),
          .phase = HenyeyGreenstein{mean_cosine}};
}

Slab slab(const Medium& medium, double index) {
  return {medium.absorption_per_m, medium.scattering_per_m, mean_cosine(medium.phase), index};
}

// The explicit integral against the nonlinear integral equation that defines H (Chandrasekhar 1960,
// ch. V eq. 12), its moments (eq. 15, 56) and the table of H for albedo 1 (four digits).
TEST(ChandrasekharH, SolvesItsEquation) {
  const double tolerance = 1e-11;  // with 20 nodes it were 6e-11, and each node more divides it
  for (const double w : {0.1, 0.5, 0.9, 0.999, 1.0}) {
    for (const double mu : {0.05, 0.3, 1.0}) {
      const double integral =
          over_cosines([&](double m) { return m * chandrasekhar_h(w, m) / (mu + m); });
      EXPECT_NEAR(1 / chandrasekhar_h(w, mu), std::sqrt(1 - w) + w / 2 * integral, tolerance);
    }
    EXPECT_NEAR(over_cosines([&](double m) { return chandrasekhar_h(w, m); }),
                2 / w * (1 - std::sqrt(1 - w)), tolerance);
  }
  EXPECT_NEAR(over_cosines([&](double m) { return m * chandrasekhar_h(1, m); }), 2 / std::sqrt(3.0),
              tolerance);
  EXPECT_NEAR(chandrasekhar_h(1, 0.5), 2.0128, 5e-5);
  EXPECT_NEAR(chandrasekhar_h(1, 1), 2.9078, 5e-5);
  EXPECT_EQ(chandrasekhar_h(0.7, 0), 1);
}

// Without a boundary 1 - 2 sqrt(1 - albedo) times the first moment of H: a single integral where
// diffuse_albedo() sums the reflection function over pairs of directions, with half the nodes.
TEST(DiffuseAlbedo, IsChandrasekharsWithoutABoundary) {
  for (const double w : {0.1, 0.5, 0.9, 0.99, 0.9999}) {
    const double moment = over_cosines([&](double m) { return m * chandrasekhar_h(w, m); });
    EXPECT_NEAR(diffuse_albedo(body(w), 1), 1 - 2 * std::sqrt(1 - w) * moment, 1e-11) << w;
  }
}

// What a body does not absorb comes back: all that enters. Quadrature and the passes' cut leave
// 2e-12 at the highest index.
TEST(DiffuseAlbedo, ReturnsAllThatEntersIfNothingAbsorbs) {
  for (const double index : {1.0, 1.1, 1.33, 1.5, 2.4}) {
    EXPECT_NEAR(diffuse_albedo(body(1), index), 1 - fresnel_dielectric_mean(index), 1e-11) << index;
    EXPECT_NEAR(diffuse_albedo(body(1, 0.9), index), 1 - fresnel_dielectric_mean(index), 1e-11);
    EXPECT_EQ(diffuse_albedo({.absorption_per_m = 3}, index), 0);
  }
}

TEST(DiffuseAlbedo, AgreesWithARandomWalk) {
  for (const double index : {1.0, 1.5})
    for (const double albedo : {0.6, 0.95}) {
      const StreamMean walk = light_of(slab(body(albedo), index), 32000).reflected;
      EXPECT_NEAR(diffuse_albedo(body(albedo), index), walk.mean, 4.5 * walk.error)
          << index << " " << albedo;
      EXPECT_LT(walk.error, 0.004);
    }
}

// Similarity: within 1 % of forward scattering with reduced albedo 0.95, plus the walk's error.
TEST(DiffuseAlbedo, TreatsForwardScatteringBySimilarity) {
  for (const double index : {1.0, 1.33}) {
    const StreamMean walk = light_of(slab(body(0.95, 0.7), index), 32000).reflected;
    EXPECT_NEAR(diffuse_albedo(body(0.95, 0.7), index) / walk.mean, 1,
                0.01 + 4.5 * walk.error / walk.mean);
  }
}

TEST(PenetrationPath, AgreesWithARandomWalk) {
  for (const double index : {1.0, 1.5})
    for (const double albedo : {0.6, 0.95}) {
      const StreamMean walk = light_of(slab(body(albedo), index), 32000).path_m;
      EXPECT_NEAR(penetration_path_m(body(albedo), index), index * walk.mean,
                  4.5 * index * walk.error)
          << index << " " << albedo;
      EXPECT_LT(walk.error, 0.02 * walk.mean);
    }
}

// Twice the coefficients, half the way; a single scattering at faint albedo: R is in proportion to
// scattering / extinction, so the mean path -d ln(R) / d(absorption) is 1 / extinction.
TEST(PenetrationPath, HasItsLimits) {
  Medium medium = body(0.8, 0.5);
  const double path_m = penetration_path_m(medium, 1.4);
  medium.absorption_per_m *= 2;
  medium.scattering_per_m *= 2;
  EXPECT_NEAR(penetration_path_m(medium, 1.4) / path_m, 0.5, 1e-12);
  for (const double faint : {1e-9, 1e-15, 1e-30})
    EXPECT_NEAR(penetration_path_m({.absorption_per_m = 4, .scattering_per_m = faint}, 1), 0.25,
                1e-5)
        << "2e-6 short of the limit, and rounding";
  EXPECT_EQ(penetration_path_m({.absorption_per_m = 4}, 1.5), 0);
  EXPECT_EQ(penetration_path_m({.scattering_per_m = 4}, 1.5),
            std::numeric_limits<double>::infinity());
}

// Little absorption: R falls as its root s, so the path grows as 1 / s; the next term is in
// proportion to s, 20 s or less.
TEST(PenetrationPath, GrowsAsTheRootOfFaintAbsorption) {
  const auto path_m = [](double absorption_per_m) {
    return penetration_path_m({.absorption_per_m = absorption_per_m, .scattering_per_m = 1}, 1.3);
  };
  EXPECT_NEAR(path_m(1e-12) / path_m(1e-10) / 10, 1, 20e-5);
}

// The closed integrals against Simpson's rule in ln(radius); 4000 steps over 16 e-folds leave 1e-9.
TEST(Dipole, HasItsIntegrals) {
  const Dipole d = dipole(body(0.98), 1.4);
  const auto moment = [&](double from_m, int power) {
    const int steps = 4000;
    const double low = std::log(from_m), h = (std::log(400.0) - low) / steps;
    double sum = 0;
    for (int i = 0; i <= steps; ++i) {
      const double r = std::exp(low + i * h);
      const double value = 2 * pi * std::pow(r, 2 + power) * radial_exitance_per_m2(d, r);
      sum += value * (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2) * h / 3;
    }
    return sum;
  };
  const double centre = pi * 1e-8 * radial_exitance_per_m2(d, 0);  // within 0.1 mm
  const double tail = 1e-9;  // beyond 400 m exp(-400 sqrt(0.06)) is nothing
  EXPECT_NEAR(moment(1e-4, 0) + centre, diffuse_reflectance(d), tail);
  EXPECT_NEAR(moment(2, 0), reflectance_beyond(d, 2), tail);
  EXPECT_NEAR(moment(1e-4, 2) / diffuse_reflectance(d),
              std::pow(lateral_spread_m(body(0.98), 1.4), 2), 1e-6);
}

// Jensen et al. 2001, eq. 5: the reflectance in terms of the reduced albedo.
TEST(Dipole, HasThePublishedReflectance) {
  for (const double albedo : {0.5, 0.9, 0.999}) {
    const double inside = fresnel_dielectric_mean(1 / 1.3);
    const double a = (1 + inside) / (1 - inside), root = std::sqrt(3 * (1 - albedo));
    EXPECT_NEAR(diffuse_reflectance(dipole(body(albedo, 0.8), 1.3)),
                albedo / 2 * (1 + std::exp(-4.0 / 3 * a * root)) * std::exp(-root), 1e-14);
  }
}

// Where diffusion holds: total within 2 %, rms radius within 6 %, rings from 1 to 12 mean free
// paths within 12 % (the dipole's known error is largest near the beam), plus the walk's own error.
TEST(Dipole, AgreesWithARandomWalkWhereDiffusionHolds) {
  const std::vector<double> radii_m = {1, 3, 6, 9, 14};
  for (const double index : {1.0, 1.4}) {
    Slab beam = slab(body(0.99), index);
    beam.beam = true;
    const SlabLight walk = light_of(beam, 32000, radii_m);
    const Dipole d = dipole(body(0.99), index);
    EXPECT_NEAR(diffuse_reflectance(d) / walk.reflected.mean, 1,
                0.02 + 4.5 * walk.reflected.error / walk.reflected.mean);
    EXPECT_NEAR(std::pow(lateral_spread_m(body(0.99), index), 2) / walk.square_radius_m2.mean, 1,
                0.12 + 4.5 * walk.square_radius_m2.error / walk.square_radius_m2.mean);
    for (std::size_t k = 0; k + 1 < radii_m.size(); ++k) {
      const double share =
          reflectance_beyond(d, radii_m[k]) - reflectance_beyond(d, radii_m[k + 1]);
      const StreamMean& ring = walk.rings[k];
      const double residual = radii_m[k] < 6 ? 0.32 : 0.12;
      EXPECT_NEAR(share / ring.mean, 1, residual + 4.5 * ring.error / ring.mean) << radii_m[k];
      RecordProperty("residual_percent_" + std::to_string(k), int(100 * (share / ring.mean - 1)));
    }
  }
}

// What the header promises for a reduced albedo of 0.9, as root mean square; below, an upper bound.
TEST(LateralSpread, AgreesWithARandomWalk) {
  for (const double index : {1.0, 1.5})
    for (const double albedo : {0.3, 0.9}) {
      Slab beam = slab(body(albedo, 0.7), index);
      beam.beam = true;
      const StreamMean square_m2 = light_of(beam, 32000).square_radius_m2;
      const double ratio = lateral_spread_m(body(albedo, 0.7), index) / std::sqrt(square_m2.mean);
      const double error = 4.5 * square_m2.error / square_m2.mean / 2;
      EXPECT_GT(ratio, (albedo < 0.9 ? 1 : 0.75) - error);
      EXPECT_LT(ratio, (albedo < 0.9 ? 1.5 : 1.25) + error);
      EXPECT_LT(error, 0.15) << "or the test tells little";
    }
}

TEST(LateralSpread, IsInfiniteOnlyWithoutAbsorption) {
  EXPECT_EQ(lateral_spread_m({.scattering_per_m = 4}, 1.5),
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(lateral_spread_m({.absorption_per_m = 4}, 1.5), 0);
}

}  // namespace
}  // namespace scan::synth
