// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/bsdf/bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "synth/bsdf/fresnel.h"
#include "tests/synth/bsdf_kinds.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

TEST(Bsdf, DensityIntegratesToAtMostOneAndSamplesFollowIt) {
  const SphereCells cells;
  const int draws = 40000;
  int tests = 0;
  for (const Named& kind : kinds())
    for (const Eigen::Vector3d& out : views(kind.bsdf)) {
      const Bsdf& bsdf = kind.bsdf;
      // refracted at grazing angles the density ends in a step (where facets would stand upright)
      const int order = is_transmissive(bsdf) && std::abs(out.z()) < 0.2 ? 72 : 24;
      std::vector<double> expected =
          cells.integrals([&](const Eigen::Vector3d& in) { return density(bsdf, out, in); }, order);
      const double within = total(expected);
      // a lobe of 0.05 rad is resolved to 1e-3 by nodes every 0.01 rad
      ASSERT_LE(within, 1 + 1e-3) << kind.name << " " << out.z();
      expected.push_back(std::max(0.0, 1 - within));  // single directions, and none
      for (double& share : expected) share *= draws;
      std::vector<double> counts(expected.size(), 0.0);
      RandomStream random(1, 0, ++tests);
      for (int i = 0; i < draws; ++i) {
        const auto drawn = sample(bsdf, out, draw3(random));
        const bool in_density = drawn && !drawn->is_delta;
        ++counts[in_density ? cells.index(drawn->in) : cells.count()];
      }
      // 100 tests, a false alarm in one of a thousand seeds
      EXPECT_GT(goodness_of_fit(counts, expected), 1e-5) << kind.name << " " << out.z();
    }
  EXPECT_EQ(tests, 100);
}

TEST(Bsdf, WeightIsReflectanceTimesCosineOverDensity) {
  RandomStream random(2, 0, 0);
  for (const auto& [name, bsdf] : kinds())
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d out = draw_direction(random, is_transmissive(bsdf));
      const auto drawn = sample(bsdf, out, draw3(random));
      if (!drawn) continue;
      ASSERT_NEAR(drawn->in.norm(), 1, 1e-12);
      ASSERT_EQ(drawn->is_transmitted, drawn->in.z() * out.z() < 0);
      ASSERT_GE(drawn->weight, 0);
      ASSERT_EQ(drawn->is_delta, drawn->density == 0) << name;
      if (drawn->is_delta) {
        ASSERT_TRUE(has_delta(bsdf));
        continue;
      }
      const double p = density(bsdf, out, drawn->in);
      const double f = evaluate(bsdf, out, drawn->in);
      // the facet found again from both directions is off by 1e-16 over its alpha and its cosines
      ASSERT_NEAR(drawn->density, p, 1e-9 * p) << name;
      if (drawn->weight > 1e-200) {
        ASSERT_NEAR(drawn->weight * p, f * std::abs(drawn->in.z()), 1e-9 * drawn->weight * p)
            << name << " " << out.z() << " " << drawn->in.z();
      }
    }
}

TEST(Bsdf, IsReciprocal) {
  RandomStream random(4, 0, 0);
  for (const auto& [name, bsdf] : kinds()) {
    const auto* glass = std::get_if<Dielectric>(&bsdf);
    const auto index2 = [&](double z) { return glass && z < 0 ? glass->index * glass->index : 1; };
    int seen = 0;
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d out = draw_direction(random, glass);
      const Eigen::Vector3d in = draw_direction(random, glass);
      const double there = index2(out.z()) * evaluate(bsdf, out, in);
      const double back = index2(in.z()) * evaluate(bsdf, in, out);
      ASSERT_TRUE(std::isfinite(there)) << name;
      // Beckmann's tail, the exponential of hundreds, has fewer digits
      ASSERT_NEAR(there, back, 1e-12 * there + 1e-40) << name << " " << out.z() << " " << in.z();
      seen += there > 0;
    }
    const bool has_light = !std::holds_alternative<Lambert>(bsdf) || std::get<Lambert>(bsdf).albedo;
    const bool all_delta = has_delta(bsdf) && !std::holds_alternative<Plastic>(bsdf);
    EXPECT_EQ(seen > 0, has_light && !all_delta) << name;
  }
}

TEST(Bsdf, OpaqueKindsAreBlackFromBelow) {
  RandomStream random(5, 0, 0);
  for (const auto& [name, bsdf] : kinds()) {
    if (is_transmissive(bsdf)) continue;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d up = draw_direction(random, false);
      const Eigen::Vector3d down = -draw_direction(random, false);
      const Eigen::Vector3d u = draw3(random);
      ASSERT_EQ(evaluate(bsdf, up, down), 0) << name;
      ASSERT_EQ(evaluate(bsdf, down, up), 0) << name;
      ASSERT_EQ(evaluate(bsdf, down, down), 0) << name;
      ASSERT_EQ(density(bsdf, down, up), 0) << name;
      ASSERT_FALSE(sample(bsdf, down, u)) << name;
      ASSERT_EQ(albedo(bsdf, down), 0) << name;
    }
  }
}

TEST(Bsdf, StaysFiniteAtTheEdges) {
  std::vector<Named> all = kinds();
  for (const double roughness : {least_roughness, 1.0})
    for (const Microfacets facets : {ggx, beckmann}) {
      all.push_back({"metal", Conductor{0.2, 3, roughness, facets}});
      all.push_back({"glass", Dielectric{1.5, roughness, facets}});
      all.push_back({"plastic", Plastic{0.5, 1.5, roughness, facets}});
    }
  std::vector<Eigen::Vector3d> edges = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}};
  for (const double z : {1e-12, 1e-160, 1e-310}) {
    edges.push_back(direction_at(z, 1));
    edges.push_back(direction_at(-z, 4));
  }
  const double last = 1 - 0x1p-53;
  for (const auto& [name, bsdf] : all)
    for (const Eigen::Vector3d& out : edges) {
      for (const Eigen::Vector3d& in : edges) {
        EXPECT_TRUE(std::isfinite(evaluate(bsdf, out, in) * in.z())) << name << out << in;
        EXPECT_GE(density(bsdf, out, in), 0) << name << out << in;
      }
      EXPECT_TRUE(std::isfinite(albedo(bsdf, out))) << name << out;
      for (const double x : {0.0, last})
        for (const double y : {0.0, 0.5, last})
          for (const double z : {0.0, 0.5, last}) {
            const auto drawn = sample(bsdf, out, {x, y, z});
            if (!drawn) continue;
            EXPECT_TRUE(drawn->in.allFinite()) << name << out;
            EXPECT_TRUE(std::isfinite(drawn->weight)) << name << out;
            EXPECT_TRUE(std::isfinite(drawn->density)) << name << out;
          }
    }
}

TEST(Bsdf, SmoothSurfacesSendLightInSingleDirections) {
  const Eigen::Vector3d out = direction_at(0.6, 0.5), mirrored(-out.x(), -out.y(), out.z());
  const auto metal = sample(Conductor{0.14, 3.7, 0}, out, {0.9, 0.5, 0.5});
  ASSERT_TRUE(metal && metal->is_delta);
  EXPECT_EQ(metal->in, mirrored);
  EXPECT_EQ(metal->weight, fresnel_conductor(0.6, 0.14, 3.7));
  const double r = fresnel_dielectric(0.6, 1.5);
  const auto back = sample(Dielectric{1.5, 0}, out, {r * 0.99, 0, 0});
  const auto through = sample(Dielectric{1.5, 0}, out, {r * 1.01, 0, 0});
  ASSERT_TRUE(back && through && back->is_delta && through->is_delta);
  EXPECT_EQ(back->in, mirrored);
  EXPECT_FALSE(back->is_transmitted);
  EXPECT_TRUE(through->is_transmitted);
  EXPECT_NEAR(through->in.head<2>().norm() * 1.5, 0.8, 1e-15) << "Snell";
  EXPECT_EQ(back->weight, 1);
  const auto coat = sample(Plastic{0.5, 1.5, 0}, out, {0, 0.5, 0.5});
  ASSERT_TRUE(coat && coat->is_delta);
  EXPECT_EQ(coat->in, mirrored);
  const auto below = sample(Conductor{0.14, 3.7, least_roughness / 2}, out, {0.5, 0.5, 0.5});
  ASSERT_TRUE(below);
  EXPECT_TRUE(below->is_delta) << "below the least alpha";
}

// The lobes are what sample() draws: the same directions, with drawn weights in the mean. 1000
// steps of the number that picks the lobe resolve that to 1e-3.
TEST(Bsdf, DeltaLobesAreTheMeanOfSamples) {
  for (const auto& [name, bsdf] : kinds())
    for (const Eigen::Vector3d& out : views(bsdf)) {
      DeltaLobes lobes = delta_lobes(bsdf, out);
      EXPECT_EQ(has_delta(bsdf), lobes[0].has_value()) << name;
      if (lobes[1]) {
        EXPECT_GE(lobes[0]->weight, lobes[1]->weight) << name;
      }
      for (int i = 0; i < 1000; ++i) {
        const auto drawn = sample(bsdf, out, {(i + 0.5) / 1000, 0.3, 0.6});
        if (!drawn || !drawn->is_delta) continue;
        auto& lobe = lobes[lobes[0]->is_transmitted == drawn->is_transmitted ? 0 : 1];
        ASSERT_TRUE(lobe && lobe->is_delta) << name;
        EXPECT_LT((lobe->in - drawn->in).norm(), 1e-15) << name;
        lobe->weight -= drawn->weight / 1000;
      }
      // at most one draw falls on the wrong side of the lobes' border
      for (const auto& lobe : lobes)
        if (lobe) {
          EXPECT_NEAR(lobe->weight, 0, 1.001e-3) << name;
        }
    }
}

TEST(Bsdf, TellsWhatItDoes) {
  EXPECT_FALSE(has_delta(Lambert{}) || has_delta(OrenNayar{}) || has_delta(Conductor{}));
  EXPECT_TRUE(has_delta(Conductor{1, 7, 0}) && has_delta(Dielectric{}) &&
              has_delta(Plastic{0.5, 1.5, 0}));
  EXPECT_FALSE(has_delta(Dielectric{1.5, 0.1}) || has_delta(Plastic{}));
  EXPECT_TRUE(has_delta(Dielectric{1, 0.5})) << "no boundary: straight on";
  EXPECT_TRUE(is_transmissive(Dielectric{}));
  EXPECT_FALSE(is_transmissive(Plastic{}) || is_transmissive(Conductor{}));
}

TEST(Bsdf, PlasticSumsTheLightBetweenBaseAndCoat) {
  // physics: enter, then reflect between base (albedo a) and the coat's inside (i) any number of
  // times; term by term
  const double a = 0.7, n = 1.5, inside = fresnel_dielectric_mean(1 / n), cosine = 0.6;
  double escaped = 0, upward = a * (1 - fresnel_dielectric(cosine, n));
  for (int bounce = 0; bounce < 200; ++bounce, upward *= inside * a)
    escaped += upward * (1 - inside);
  const Eigen::Vector3d in = direction_at(cosine, 0);
  EXPECT_NEAR(albedo(Plastic{a, n, 0}, in), fresnel_dielectric(cosine, n) + escaped, 1e-14);
}

// Oren and Nayar 1994, eqs. 27 to 29, in the paper's own angles.
double by_angles(const OrenNayar& clay, double theta_out, double theta_in, double turn) {
  const double s2 = clay.slope_rad * clay.slope_rad, a = std::max(theta_out, theta_in);
  const double b = std::min(theta_out, theta_in), c = std::cos(turn);
  const double c1 = 1 - 0.5 * s2 / (s2 + 0.33);
  const double c2 =
      0.45 * s2 / (s2 + 0.09) * (c >= 0 ? std::sin(a) : std::sin(a) - std::pow(2 * b / pi, 3));
  const double c3 = 0.125 * s2 / (s2 + 0.09) * std::pow(4 * a * b / (pi * pi), 2);
  const double once = c1 + c * c2 * std::tan(b) + (1 - std::abs(c)) * c3 * std::tan((a + b) / 2);
  const double twice = 0.17 * s2 / (s2 + 0.13) * (1 - c * std::pow(2 * b / pi, 2));
  return clay.albedo / pi * (once + clay.albedo * twice);
}

TEST(Bsdf, ClayFollowsThePublishedFormulas) {
  RandomStream random(6, 0, 0);
  for (int i = 0; i < 500; ++i) {
    const OrenNayar clay{0.95 * random.uniform(), 0.6 * random.uniform()};
    const double theta_out = 1.5 * random.uniform();
    const double theta_in = 1.5 * random.uniform();
    const double turn = 2 * pi * random.uniform();
    const Eigen::Vector3d out = direction_at(std::cos(theta_out), 0.3);
    const Eigen::Vector3d in = direction_at(std::cos(theta_in), 0.3 + turn);
    const double f = by_angles(clay, theta_out, theta_in, turn);
    EXPECT_NEAR(evaluate(clay, out, in), f, 1e-12);
  }
}

TEST(Bsdf, AlbedoIsTheSameFromAnyThread) {
  const Bsdf bsdf = Plastic{0.31, 1.47, 0.23, beckmann};
  std::vector<double> found(64);
  parallel_for(
      found.size(),
      [&](std::size_t i) {
        found[i] = albedo(bsdf, {0.6, 0, 0.8});
      },
      1);
  for (const double value : found) EXPECT_EQ(value, found[0]);
}

std::string complaint_of(const Bsdf& bsdf) {
  try {
    check(bsdf, "paint");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Bsdf, CheckNamesFieldValueAndLimit) {
  for (const auto& [name, bsdf] : kinds()) EXPECT_EQ(complaint_of(bsdf), "") << name;
  const double nan = std::nan("");
  const auto expect = [](const Bsdf& bsdf, const std::string& message) {
    EXPECT_EQ(complaint_of(bsdf).substr(0, message.size()), message);
  };
  expect(Lambert{1.5}, "paint/albedo is 1.5");
  expect(Lambert{-0.1}, "paint/albedo is -0.1");
  expect(Lambert{nan}, "paint/albedo is nan");
  expect(OrenNayar{0.96, 0.3}, "paint/albedo is 0.96");
  expect(OrenNayar{0.5, -1}, "paint/slope_rad is -1");
  expect(Conductor{0, 3, 0.1}, "paint/eta is 0");
  expect(Conductor{1, -3, 0.1}, "paint/k is -3");
  expect(Conductor{1, 3, nan}, "paint/roughness is nan");
  expect(Dielectric{0.9, 0.1}, "paint/index is 0.9");
  expect(Dielectric{1.5, -0.1}, "paint/roughness is -0.1");
  expect(Plastic{1.1, 1.5, 0.1}, "paint/albedo is 1.1");
  expect(Plastic{0.5, 0.5, 0.1}, "paint/index is 0.5");
  expect(Plastic{0.5, 1.5, 2}, "paint/roughness is 2");
  EXPECT_NE(complaint_of(Lambert{1.5}).find("from 0"), std::string::npos);
}

}  // namespace
}  // namespace scan::synth
