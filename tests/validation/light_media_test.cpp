// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light in fog and translucent bodies against closed forms, quadrature and published tables.
#include <gtest/gtest.h>

#include "tests/synth/light_paths.h"
#include "tests/synth/plain_tracer.h"
#include "tests/synth/ray_scenes.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

constexpr double pi = std::numbers::pi;

// Device light by one scattering and its mean path, then all of the scene's lights' light.
std::vector<Mean> trace(const Scene& scene, const Ray& view, const PointEmitter& emitter,
                        int samples, const TransportOptions& options) {
  const RayCaster caster(scene);
  const LightTransport transport(caster, options);
  return means_of(
      samples, {},
      [&](SampleSequence& random, Tally& tally) {
        trace_path(transport, view, emitter, random, tally);
      },
      [](const Tally& tally, int count) {
        return std::vector<double>{tally.electrons[1] / count, tally.moment[1] / count,
                                   tally.other / count};
      });
}

const PointEmitter beside{.place = {0.4, 0.1, 0}, .intensity = 5};
const Ray ahead{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};

double direct(double wall_m) {
  const Eigen::Vector3d to_light = beside.place - Eigen::Vector3d(0, 0, wall_m);
  return 0.6 * beside.intensity * wall_m / std::pow(to_light.norm(), 3);
}

// Air that absorbs takes exp(-a) of the way to the wall and back, and no chance is in it.
TEST(Absorption, FollowsBeerAndLambert) {
  Scene scene;
  scene.materials = {plain(0.6)};
  scene.objects = {plane_at(3)};
  scene.medium = Medium{.absorption_per_m = 0.2};
  const double way_m = 3 + (beside.place - Eigen::Vector3d(0, 0, 3)).norm();
  const auto means = trace(scene, ahead, beside, 4, {.most_scatterings = 1});
  EXPECT_NEAR(means[0].value, direct(3) * std::exp(-0.2 * way_m), 1e-12);
  EXPECT_NEAR(means[1].value / means[0].value, way_m, 1e-12);
}

// Clear glass in absorbing air: the air takes its part on the way that is left to it.
TEST(Absorption, LeavesOutWhatIsInGlass) {
  Scene scene;
  scene.materials = {
      plain(0.6),
      {.name = "glass", .bsdf = Dielectric{.index = 1.5}, .texture = {}, .interior = {}}};
  scene.objects = {plane_at(3), plane_at(1.5, 0, 1)};
  scene.objects[1].geometry = Shape(BoxShape{{1, 1, 1}});
  const PointEmitter lens{.place = Eigen::Vector3d::Zero(), .intensity = 5};
  const auto clear = trace(scene, ahead, lens, 64, {.most_scatterings = 1, .most_smooth = 2});
  scene.medium = Medium{.absorption_per_m = 0.2};
  const auto dim = trace(scene, ahead, lens, 64, {.most_scatterings = 1, .most_smooth = 2});
  // the same paths, two surfaces each way: 2 m of 3 m in air, there and back
  EXPECT_NEAR(dim[0].value / clear[0].value, std::exp(-0.2 * 4), 1e-9);
}

struct Moments {
  double electrons = 0, times_path = 0;
};

// Fog's single scattering along the view, and the wall behind it:
// integral of pi s p(cos) exp(-e (t + r)) I / r^2 dt, by Gauss and Legendre's rule.
Moments single_scattering(const Medium& fog, double wall_m) {
  const Quadrature rule = gauss_legendre(400);
  const double extinction = fog.absorption_per_m + fog.scattering_per_m;
  Moments sum;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double t = wall_m * rule.node[i];
    const Eigen::Vector3d to_light = beside.place - Eigen::Vector3d(0, 0, t);
    const double r = to_light.norm(), cosine = to_light.z() / r;
    const double electrons = rule.weight[i] * wall_m * pi * fog.scattering_per_m *
                             phase_value(fog.phase, cosine) * std::exp(-extinction * (t + r)) *
                             beside.intensity / (r * r);
    sum.electrons += electrons;
    sum.times_path += electrons * (t + r);
  }
  const double way_m = wall_m + (beside.place - Eigen::Vector3d(0, 0, wall_m)).norm();
  const double by_wall = direct(wall_m) * std::exp(-extinction * way_m);
  return {sum.electrons + by_wall, sum.times_path + by_wall * way_m};
}

TEST(Fog, ScattersOnceAsTheIntegralSays) {
  for (const PhaseFunction& phase : std::vector<PhaseFunction>{
           HenyeyGreenstein{0}, HenyeyGreenstein{0.7}, HenyeyGreenstein{-0.5}, Rayleigh{}}) {
    Scene scene;
    scene.materials = {plain(0.6)};
    scene.objects = {plane_at(3)};
    scene.medium =
        Medium{.absorption_per_m = 0.1, .scattering_per_m = 0.3, .phase = phase, .density = {}};
    const auto means = trace(scene, ahead, beside, 4096, {.most_scatterings = 1});
    const Moments truth = single_scattering(*scene.medium, 3);
    expect_mean(means[0], truth.electrons, 0.02, "electrons");
    expect_mean(means[1], truth.times_path, 0.02, "electrons times path");
  }
}

// A light close to the lens: the near fog is bright, as the inverse square. Equal angles (beside
// flights) keep 2048 paths within 1 %, where flights alone scatter by 10 %.
TEST(Fog, IsBrightNearTheLight) {
  const PointEmitter close{.place = {0.03, 0, 0.001}, .intensity = 5};
  Scene scene;
  scene.materials = {plain(0.6)};
  scene.objects = {plane_at(3)};
  scene.medium = fog(60, 0.8, 1);
  const auto means = trace(scene, ahead, close, 2048, {.most_scatterings = 1});
  // by the substitution t = h tan(a) near the light
  const Quadrature rule = gauss_legendre(200);
  const double s = scene.medium->scattering_per_m, h = 0.03;
  const auto way_m = [&](double t) { return t + (close.place - Eigen::Vector3d(0, 0, t)).norm(); };
  double truth = 0.6 * 5 * 2.999 / std::pow(way_m(3) - 3, 3) * std::exp(-s * way_m(3));
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double angle = rule.node[i] * std::atan(3 / h), t = h * std::tan(angle);
    const double r = way_m(t) - t, stretch = std::atan(3 / h) * h / std::pow(std::cos(angle), 2);
    truth += rule.weight[i] * stretch * pi * s * phase_value(scene.medium->phase, (0.001 - t) / r) *
             std::exp(-s * (t + r)) * 5 / (r * r);
  }
  expect_mean(means[0], truth, 0.01, "electrons");
}

// A sheet of laser light in fog: the view crosses it within half a millimetre, and there all that
// it sees is scattered. A Gaussian in t, flux over the sheet's width:
// pi s p exp(-e (t0 + r)) times the integral of irradiance along the view.
TEST(Fog, ShowsAThinSheetOfLight) {
  const Eigen::Vector3d eye(0.5, 0, 0), met(0, 0.1, 1);
  const BeamEmitter sheet{.spread = {0.0002, 0.3}, .peak = 1};
  Scene scene;
  scene.materials = {plain(0)};
  scene.objects = {plane_at(3)};
  scene.medium = fog(20, 0.5, 1);
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.most_scatterings = 1});
  const Ray view{eye, (met - eye).normalized()};
  const auto means = means_of(
      1024, {},
      [&](SampleSequence& random, Tally& tally) {
        trace_path(transport, view, sheet, random, tally);
      },
      [](const Tally& tally, int count) { return std::vector<double>{tally.device / count}; });
  const Quadrature rule = gauss_legendre(200);
  const double middle_m = (met - eye).norm(), s = scene.medium->scattering_per_m;
  double truth = 0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double t = middle_m + 0.01 * (rule.node[i] - 0.5);  // over 20 standard deviations
    const Eigen::Vector3d at_point = view.origin + t * view.direction;
    const double r = at_point.norm();
    truth += 0.01 * rule.weight[i] * pi * s *
             phase_value(scene.medium->phase, -view.direction.dot(at_point / r)) *
             std::exp(-s * (t + r)) * sheet.irradiance(at_point / r, r);
  }
  expect_mean(means[0], truth, 0.01, "electrons");
}

// A cloud that only scatters, in light of one radiance from all sides, cannot be seen.
TEST(WhiteFurnace, ConservativeCloudVanishes) {
  Scene scene;
  DensityGrid cloud{.box_m = {Eigen::Vector3d(-1, -1, 1), Eigen::Vector3d(1, 1, 3)},
                    .cells = {2, 2, 2},
                    .density = {1, 0.5f, 0.2f, 0.9f, 1, 0.1f, 0.6f, 0.4f}};
  scene.medium = Medium{.absorption_per_m = 0,
                        .scattering_per_m = 4,
                        .phase = HenyeyGreenstein{0.5},
                        .density = cloud};
  scene.lights = {Environment{.radiance_w_m2_sr = 1}};
  const auto means = trace(scene, ahead, {.intensity = 0}, 2048, {.most_scatterings = 400});
  expect_mean(means[2], pi, 0.02, "electrons");
}

Material translucent(const Dielectric& boundary, double albedo, double extinction_per_m,
                     const PhaseFunction& phase = {}) {
  return {.name = "translucent",
          .bsdf = boundary,
          .texture = {},
          .interior = Medium{.absorption_per_m = (1 - albedo) * extinction_per_m,
                             .scattering_per_m = albedo * extinction_per_m,
                             .phase = phase,
                             .density = {}}};
}

// The body's inner reflections are followed by one path each, and beyond their first scattering by
// chance; without a boundary there are none.
TEST(WhiteFurnace, ConservativeBodyVanishes) {
  for (const double index : {1.0, 1.3}) {
    Scene scene;
    scene.materials = {translucent({.index = index}, 1, 10)};
    scene.objects = {sphere_at({0, 0, 2}, 0.2)};
    scene.lights = {Environment{.radiance_w_m2_sr = 1}};
    const auto means = trace(scene, ahead, {.intensity = 0}, 32, {.most_smooth = 64});
    expect_mean(means[2], pi, 0.01, "electrons");
  }
}

// A body with a rough boundary, lit from one side, against a tracer that only walks.
TEST(Subsurface, RoughBodyAgreesWithAPlainWalk) {
  Scene scene;
  scene.materials = {translucent({.index = 1.4, .roughness = 0.3}, 0.95, 20)};
  scene.objects = {sphere_at({0, 0, 2}, 0.2)};
  Image<float> half(2, 1);
  half.pixels = {1, 0};
  scene.lights = {Environment{.radiance_w_m2_sr = 1, .map = half}};
  const auto means = trace(scene, ahead, {.intensity = 0}, 4096, {.most_scatterings = 1});
  const RayCaster caster(scene);
  const PlainTracer tracer(caster, 10000);
  const Mean plain_mean = means_of(
      4096, {},
      [&](SampleSequence& random, Tally& tally) { tally.other += tracer.path(ahead, random); },
      [](const Tally& tally, int count) { return std::vector<double>{tally.other / count}; }, 1)[0];
  expect_same(means[2], plain_mean, 0.05, "electrons");
}

// Chandrasekhar's H function for isotropic scattering (Radiative Transfer 1950, section V.38, eq.
// 12): 1 / H(mu) = sqrt(1 - a) + a / 2 integral of mu' H(mu') / (mu + mu') dmu'.
double h_function(double albedo, double mu) {
  const Quadrature rule = gauss_legendre(64);
  std::vector<double> h(64, 1);
  const auto next = [&](double at) {
    double sum = 0;
    for (int i = 0; i < 64; ++i) sum += rule.weight[i] * rule.node[i] * h[i] / (at + rule.node[i]);
    return 1 / (std::sqrt(1 - albedo) + albedo / 2 * sum);
  };
  for (int step = 0; step < 400; ++step) {
    std::vector<double> better(64);
    for (int i = 0; i < 64; ++i) better[i] = next(rule.node[i]);
    h = better;
  }
  return next(mu);
}

// A half-space that scatters evenly into all directions, without a boundary to speak of, in even
// light returns 1 - sqrt(1 - a) H(mu) of it.
TEST(Subsurface, HalfSpaceReflectsByChandrasekharsFunction) {
  for (const double albedo : {0.5, 0.9, 0.99})
    for (const double mu : {0.3, 1.0}) {
      Scene scene;
      scene.materials = {translucent({.index = 1}, albedo, 1000)};
      scene.objects = {plane_at(1, std::acos(mu))};
      scene.lights = {Environment{.radiance_w_m2_sr = 1}};
      const auto means = trace(scene, ahead, {.intensity = 0}, 1024, {.most_scatterings = 1});
      const double truth = pi * (1 - std::sqrt(1 - albedo) * h_function(albedo, mu));
      expect_mean(means[2], truth, 0.1, "electrons");
    }
}

// The same half-space lit by the device from afar, E facing the light: with mu, mu0 the cosines of
// view and light, a E mu0 H(mu) H(mu0) / (4 (mu + mu0)) electrons (section III.21, eq. 123). The
// light's 1000 m are 1e6 mean free paths.
TEST(Subsurface, HalfSpaceScattersTheDevicesLight) {
  const double mu = 0.8, mu0 = 0.5;
  for (const double albedo : {0.5, 0.95}) {
    Scene scene;
    scene.materials = {translucent({.index = 1}, albedo, 1000)};
    scene.objects = {plane_at(1, std::acos(mu))};
    const Eigen::Vector3d normal(-std::sqrt(1 - mu * mu), 0, -mu);
    const Eigen::Vector3d across(0, 1, 0);
    const PointEmitter sun{.place = Eigen::Vector3d(0, 0, 1) +
                                    1000 * (mu0 * normal + std::sqrt(1 - mu0 * mu0) * across),
                           .intensity = 1e6};
    const RayCaster caster(scene);
    ASSERT_NEAR(caster.closest(ahead.origin, ahead.direction)->normal.dot(normal), 1, 1e-12);
    const auto means = trace(scene, ahead, sun, 512, {.most_scatterings = 1});
    const double truth =
        albedo * mu0 * h_function(albedo, mu) * h_function(albedo, mu0) / (4 * (mu + mu0));
    expect_mean(means[0], truth, 0.1, "electrons");
  }
}

// A slab two mean free paths thick, albedo 0.9, g = 0.75, no boundary to speak of: van de Hulst's
// table (Multiple Light Scattering 1980, table 35) has 0.09739 reflected of a perpendicular beam
// and 0.66096 transmitted; by reciprocity so much of light from one side or from the other comes
// back along the beam's way.
TEST(Subsurface, SlabAgreesWithVanDeHulst) {
  Scene scene;
  scene.materials = {translucent({.index = 1}, 0.9, 100, HenyeyGreenstein{0.75})};
  scene.objects = {{.name = "slab",
                    .world_from_object = at(0, 0, 1),
                    .geometry = Shape(BoxShape{{10, 10, 0.02}}),
                    .material = 0}};
  Image<float> half(1, 2);
  for (const bool behind : {false, true}) {
    half.pixels = {behind ? 1.f : 0.f, behind ? 0.f : 1.f};
    scene.lights = {Environment{.radiance_w_m2_sr = 1, .map = half}};
    const auto means = trace(scene, ahead, {.intensity = 0}, 4096, {.most_scatterings = 1});
    expect_mean(means[2], pi * (behind ? 0.66096 : 0.09739), 0.05, "electrons");
  }
}

}  // namespace
}  // namespace scan::synth
