// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/bsdf/fresnel.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <numbers>

#include "libscan/core/random.h"
#include "tests/synth/goodness.h"

namespace scan::synth {
namespace {

// By Fresnel's amplitudes in complex numbers.
double by_amplitudes(double cosine, std::complex<double> index) {
  const std::complex<double> behind = std::sqrt(1.0 - (1 - cosine * cosine) / (index * index));
  const auto s = (cosine - index * behind) / (cosine + index * behind);
  const auto p = (index * cosine - behind) / (index * cosine + behind);
  return (std::norm(s) + std::norm(p)) / 2;
}

TEST(Fresnel, GlassReflectsFourPercentFacingIt) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5), 0.04, 1e-16);
  EXPECT_NEAR(fresnel_dielectric(1, 1 / 1.5), 0.04, 1e-16);
  EXPECT_EQ(fresnel_dielectric(0, 1.5), 1);
  EXPECT_NEAR(fresnel_dielectric(0.3, 1), 0, 1e-30);
  EXPECT_EQ(fresnel_dielectric(0, 1), 0) << "no boundary at all";
}

TEST(Fresnel, OnlyOnePolarisationIsReflectedAtBrewstersAngle) {
  const double n = 1.5, cosine = 1 / std::sqrt(1 + n * n);
  // there the rays are at right angles, so s is ((1 - n^2) / (1 + n^2))^2
  const double s = std::pow((1 - n * n) / (1 + n * n), 2);
  EXPECT_NEAR(fresnel_dielectric(cosine, n), s / 2, 1e-15);
}

TEST(Fresnel, AllIsReflectedBeyondTheCriticalAngle) {
  const double n = 1 / 1.5, critical = std::sqrt(1 - n * n);
  EXPECT_EQ(fresnel_dielectric(critical * 0.999, n), 1);
  EXPECT_EQ(fresnel_dielectric(0, n), 1);
  EXPECT_LT(fresnel_dielectric(critical * 1.001, n), 1);
  EXPECT_FALSE(refract(direction_at(critical * 0.999, 1), Eigen::Vector3d::UnitZ(), n));
  EXPECT_TRUE(refract(direction_at(critical * 1.001, 1), Eigen::Vector3d::UnitZ(), n));
}

TEST(Fresnel, AgreesWithComplexAmplitudes) {
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const double cosine = random.uniform();
    const double eta = 0.05 + 4 * random.uniform();
    const double k = 8 * random.uniform();
    EXPECT_NEAR(fresnel_conductor(cosine, eta, k), by_amplitudes(cosine, {eta, k}), 1e-13);
    // for k = 0 the root loses half the digits next to the critical angle
    EXPECT_NEAR(fresnel_dielectric(cosine, eta), by_amplitudes(cosine, eta), 1e-12);
  }
}

TEST(Fresnel, MetalWithoutAbsorptionIsADielectric) {
  for (const double eta : {0.6, 0.99, 1.0, 1.3, 2.5})
    for (double cosine = 1.0 / 64; cosine <= 1; cosine += 1.0 / 64)
      EXPECT_NEAR(fresnel_conductor(cosine, eta, 0), fresnel_dielectric(cosine, eta), 1e-14)
          << eta << " " << cosine;
}

TEST(Fresnel, IsTheSameFromBothSides) {
  for (const double n : {1.33, 1.5, 2.4})
    for (double cosine = 0.01; cosine <= 1; cosine += 0.01) {
      const double behind = std::sqrt(1 - (1 - cosine * cosine) / (n * n));
      EXPECT_NEAR(fresnel_dielectric(cosine, n), fresnel_dielectric(behind, 1 / n), 1e-13);
      EXPECT_NEAR(fresnel_dielectric(cosine, n), fresnel_boundary(behind, cosine, 1 / n), 1e-15);
    }
}

TEST(Fresnel, RefractionKeepsSnellsLawAndIsReversible) {
  RandomStream random(2, 0, 0);
  for (int i = 0; i < 500; ++i) {
    const double cosine = 0.01 + 0.99 * random.uniform();
    const double turn = 6 * random.uniform();
    const double n = 1.1 + random.uniform();
    const Eigen::Vector3d in = direction_at(cosine, turn), up = Eigen::Vector3d::UnitZ();
    const auto onward = refract(in, up, n);
    ASSERT_TRUE(onward);
    EXPECT_NEAR(onward->norm(), 1, 1e-15);
    EXPECT_LT(onward->z(), 0);
    EXPECT_NEAR((n * up.cross(*onward) + up.cross(in)).norm(), 0, 1e-14);
    const auto back = refract(*onward, -up, 1 / n);
    ASSERT_TRUE(back);
    // the cosine's error is 1e-16 over the cosine itself
    EXPECT_NEAR((*back - in).norm(), 0, 1e-13);
  }
}

TEST(Fresnel, MeanIsTheIntegralOverTheHemisphere) {
  const std::vector<Node> nodes = gauss_nodes(200);
  for (const double n : {1.0, 1 + 1e-9, 1 + 1e-7, 1.0001, 1.1, 1.33, 1.5, 2.4, 1 / 1.33, 1 / 1.5}) {
    // cosine = t^2 for the grazing rise; from inside the part beyond the critical angle is whole
    const double critical = n < 1 ? std::sqrt(1 - n * n) : 0;
    double sum = critical * critical;
    for (const Node& node : nodes) {
      const double cosine = critical + (1 - critical) * node.x * node.x;
      sum += node.weight * 2 * node.x * (1 - critical) * 2 * cosine * fresnel_dielectric(cosine, n);
    }
    // the quadrature is exact to 1e-9 but for the root at the critical angle or the narrow rise of
    // an index near 1, which holds (n - 1) / 3 in all
    EXPECT_NEAR(fresnel_dielectric_mean(n), sum, 1e-7) << n;
  }
  // published: 9.18 % (Duntley 1942; Walsh 1926) and from inside 59.6 %
  EXPECT_NEAR(fresnel_dielectric_mean(1.5), 0.0918, 5e-5);
  EXPECT_NEAR(fresnel_dielectric_mean(1 / 1.5), 0.596, 5e-4);
}

TEST(Fresnel, PaneSumsItsInternalReflections) {
  // physics.md 7.6 by the series, term by term: (1 - r)^2 (1 + r^2 + r^4 + ...) = (1-r)/(1+r)
  const double r = fresnel_dielectric(1, 1.5);
  double through = 0, term = (1 - r) * (1 - r);
  for (int i = 0; i < 40; ++i, term *= r * r) through += term;
  EXPECT_NEAR(through, 0.9231, 5e-5);
  EXPECT_NEAR(through * through, 0.8521, 5e-5);
}

double reflectance(std::string_view name, double wavelength_m) {
  const auto index = refractive_index(name, wavelength_m);
  return index ? fresnel_conductor(1, index->eta, index->k) : -1;
}

TEST(RefractiveIndex, GivesPublishedReflectancesOfMetals) {
  // handbook values of clean films facing the light (Hass 1965; Palik 1985), read to 0.02
  EXPECT_NEAR(reflectance("aluminium", 650e-9), 0.905, 0.02);
  EXPECT_NEAR(reflectance("aluminium", 850e-9), 0.867, 0.02) << "its interband dip";
  EXPECT_NEAR(reflectance("aluminium", 1550e-9), 0.975, 0.02);
  EXPECT_NEAR(reflectance("gold", 650e-9), 0.955, 0.02);
  EXPECT_NEAR(reflectance("gold", 450e-9), 0.39, 0.02);
  EXPECT_NEAR(reflectance("silver", 532e-9), 0.98, 0.02);
  EXPECT_NEAR(reflectance("copper", 650e-9), 0.95, 0.02);
  EXPECT_NEAR(reflectance("copper", 450e-9), 0.55, 0.02);
  EXPECT_NEAR(reflectance("iron", 650e-9), 0.56, 0.04);  // handbooks differ by as much
  EXPECT_NEAR(reflectance("chromium", 650e-9), 0.55, 0.02);
}

TEST(RefractiveIndex, GivesTheClearBodiesAtTheSodiumLine) {
  const auto eta = [](std::string_view name) { return refractive_index(name, 589.3e-9)->eta; };
  EXPECT_NEAR(eta("bk7"), 1.5167, 1e-4);        // Schott: n_D
  EXPECT_NEAR(eta("water"), 1.3330, 1e-3);      // the table has three digits
  EXPECT_NEAR(eta("acrylic"), 1.4915, 1.5e-3);  // grades differ by as much
  EXPECT_NEAR(eta("polycarbonate"), 1.585, 1e-3);
  EXPECT_EQ(refractive_index("bk7", 1064e-9)->k, 0);
  EXPECT_NEAR(refractive_index("bk7", 1064e-9)->eta, 1.50663, 1e-5);  // Schott's data sheet
  EXPECT_NEAR(refractive_index("acrylic", 1550e-9)->eta, 1.481, 1e-3);
}

TEST(RefractiveIndex, KnowsTheLasersOfScanners) {
  for (const std::string_view name : refractive_index_names())
    for (const double nm :
         {405.0, 450.0, 532.0, 633.0, 650.0, 780.0, 808.0, 850.0, 905.0, 1064.0, 1550.0}) {
      const bool measured =
          (name != "acrylic" || nm > 420) && (name != "polycarbonate" || (nm > 437 && nm < 1052));
      const auto index = refractive_index(name, nm * 1e-9);
      ASSERT_EQ(index.has_value(), measured) << name << " at " << nm;
      if (index) {
        EXPECT_GT(index->eta, 0);
      }
    }
  EXPECT_EQ(refractive_index_names().size(), 10u);
  EXPECT_FALSE(refractive_index("kryptonite", 650e-9));
  EXPECT_FALSE(refractive_index("gold", 100e-9));
  EXPECT_FALSE(refractive_index("gold", 1.62e-6));
  EXPECT_FALSE(refractive_index("bk7", 650)) << "nanometres for metres";
  EXPECT_FALSE(refractive_index("water", std::nan("")));
}

TEST(RefractiveIndex, IsLinearBetweenEntries) {
  const auto low = *refractive_index("gold", 0.6168e-6),
             high = *refractive_index("gold", 0.6595e-6);
  EXPECT_NEAR(low.eta, 0.21, 1e-12);
  EXPECT_NEAR(high.k, 3.697, 1e-12);
  const auto middle = *refractive_index("gold", 0.5 * (0.6168e-6 + 0.6595e-6));
  EXPECT_NEAR(middle.eta, (low.eta + high.eta) / 2, 1e-12);
  EXPECT_NEAR(middle.k, (low.k + high.k) / 2, 1e-12);
}

}  // namespace
}  // namespace scan::synth
