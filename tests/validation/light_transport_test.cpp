// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light between Lambert surfaces against closed forms and quadrature.
#include <gtest/gtest.h>

#include "libscan/core/parallel.h"
#include "tests/synth/light_paths.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

Scene scene_of(std::vector<Object> objects, std::vector<Material> materials) {
  Scene scene;
  scene.objects = std::move(objects);
  scene.materials = std::move(materials);
  return scene;
}

std::vector<double> per_path(const std::vector<double>& sums, int samples) {
  std::vector<double> means;
  for (const double sum : sums) means.push_back(sum / samples);
  return means;
}

// An integrating sphere of radius R. A Lambert sphere lit at one point lights itself evenly, so
// with emitted light 4 pi I the irradiance by k - 1 reflections is albedo^(k-1) I / R^2.
struct IntegratingSphere {
  double albedo;
  double radius_m = 0.7;
  Scene scene = scene_of({sphere_at({0.1, 0.2, -0.3}, 0.7)}, {plain(albedo)});
  RayCaster caster{scene};
};

// The sum over all reflections is I / R^2 albedo / (1 - albedo); paths that go on by chance
// (Russian roulette) must not change it. The limit of 2000 reflections leaves 0.9^2000 = 1e-91.
TEST(IntegratingSphere, MultipliesLightByAlbedoOverOneMinusAlbedo) {
  for (const double albedo : {0.2, 0.5, 0.8, 0.9}) {
    const IntegratingSphere sphere{albedo};
    const LightTransport transport(sphere.caster, {.most_scatterings = 2000});
    const PointEmitter emitter{.place = {0.1, 0.2, -0.3}, .intensity = 3};
    const Ray view{{0.3, 0.1, -0.5}, Eigen::Vector3d(1, 2, 3).normalized()};
    const auto mean = means_of(
        4096, {},
        [&](SampleSequence& random, Tally& tally) {
          trace_path(transport, view, emitter, random, tally);
        },
        [](const Tally& tally, int samples) { return per_path({tally.device}, samples); });
    expect_mean(mean[0], 3 / (0.7 * 0.7) * albedo / (1 - albedo), 0.02, "electrons");
  }
}

// From a light that is not in the middle the first reflection is uneven, all further ones are even.
TEST(IntegratingSphere, EachReflectionCarriesOneMoreAlbedo) {
  const IntegratingSphere sphere{0.8};
  const LightTransport transport(sphere.caster, {.most_scatterings = 7});
  const PointEmitter emitter{.place = {0.25, 0.2, -0.3}, .intensity = 1};
  const Ray view{{0.3, 0.1, -0.5}, Eigen::Vector3d(1, 2, 3).normalized()};
  const auto means = means_of(
      4096, {},
      [&](SampleSequence& random, Tally& tally) {
        trace_path(transport, view, emitter, random, tally);
      },
      [](const Tally& tally, int samples) { return per_path(tally.electrons, samples); });
  EXPECT_EQ(means[0].value, 0);
  for (int k = 2; k <= 7; ++k)
    expect_mean(means[k], std::pow(0.8, k) / (0.7 * 0.7), 0.02, "electrons");
}

// Even light from a Lambert sphere's wall meets the wall again at evenly spread points, 4 R / 3
// away in the mean; with lens and light in the middle k reflections take 2 R + (k - 1) 4 R / 3.
TEST(IntegratingSphere, PathsAreAsLongAsItsChords) {
  const IntegratingSphere sphere{0.8};
  const LightTransport transport(sphere.caster, {.most_scatterings = 7});
  const PointEmitter emitter{.place = {0.1, 0.2, -0.3}, .intensity = 1};
  const Ray view{{0.1, 0.2, -0.3}, Eigen::Vector3d(1, 2, 3).normalized()};
  const auto means = means_of(
      4096, {},
      [&](SampleSequence& random, Tally& tally) {
        trace_path(transport, view, emitter, random, tally);
      },
      [](const Tally& tally, int) {
        std::vector<double> lengths_m(8);
        for (int k = 1; k <= 7; ++k) lengths_m[k] = tally.moment[k] / tally.electrons[k];
        return lengths_m;
      });
  for (int k = 1; k <= 7; ++k)
    expect_mean(means[k], (2 + (k - 1) * 4 / 3.0) * 0.7, 0.01, "mean length");
}

// Two perpendicular planes, z = 0 and x = 0, seen and lit from x, z > 0.
struct Corner {
  double albedo_floor = 0.6, albedo_wall = 0.8;
  Eigen::Vector3d light = {0.5, 0.3, 0.7}, lens = {1.2, -0.4, 0.9}, seen = {0.4, 0.1, 0};
  double frequency_hz = 80e6;

  Scene scene() const {
    Object floor{.name = "floor", .geometry = Shape(PlaneShape{}), .material = 0};
    Object wall = floor;
    const Eigen::AngleAxisd turn(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
    wall.world_from_object = make_pose(turn.toRotationMatrix(), Eigen::Vector3d::Zero());
    wall.material = 1;
    return scene_of({floor, wall}, {plain(albedo_floor), plain(albedo_wall)});
  }

  // What one point of the wall sends over the seen point of the floor: electrons per area.
  std::complex<double> over(double y_m, double z_m) const {
    const Eigen::Vector3d at(0, y_m, z_m);
    const Eigen::Vector3d from_light = at - light, on = seen - at;
    const double irradiance = -from_light.x() / std::pow(from_light.norm(), 3);
    const double form = on.x() * -on.z() / std::pow(on.norm(), 4);
    const double electrons = albedo_floor * albedo_wall * irradiance * form / std::numbers::pi;
    const double path_m = from_light.norm() + on.norm() + (lens - seen).norm();
    return std::polar(electrons, 2 * std::numbers::pi * frequency_hz * path_m / speed_of_light_m_s);
  }

  // Over the whole wall, y = seen.y + s tan(a), z = s t / (1 - t): Gauss and Legendre's rule of
  // order n in each; beyond n = 192 the result changes by less than 1e-5, most of it from phases
  // far out.
  std::complex<double> integral(int n, bool with_phase) const {
    const Quadrature rule = gauss_legendre(n);
    std::complex<double> sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double angle = std::numbers::pi * (rule.node[i] - 0.5), t = rule.node[j];
        const double y_m = seen.y() + 0.5 * std::tan(angle), z_m = 0.5 * t / (1 - t);
        const double stretch =
            0.5 * std::numbers::pi / std::pow(std::cos(angle), 2) * 0.5 / ((1 - t) * (1 - t));
        const std::complex<double> value = over(y_m, z_m);
        sum += rule.weight[i] * rule.weight[j] * stretch * (with_phase ? value : std::abs(value));
      }
    return sum;
  }
};

TEST(Corner, SecondReflectionAgreesWithQuadrature) {
  const Corner corner;
  const double truth = corner.integral(256, false).real();
  const std::complex<double> phasor = corner.integral(256, true);
  ASSERT_NEAR(corner.integral(192, false).real(), truth, 1e-5 * truth);
  ASSERT_LT(std::abs(corner.integral(192, true) - phasor), 1e-5 * truth);
  const Scene scene = corner.scene();
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.most_scatterings = 2});
  const PointEmitter emitter{.place = corner.light};
  const Ray view{corner.lens, (corner.seen - corner.lens).normalized()};
  const auto means = means_of(
      8192, {.frequency_hz = corner.frequency_hz},
      [&](SampleSequence& random, Tally& tally) {
        trace_path(transport, view, emitter, random, tally);
      },
      [](const Tally& tally, int samples) {
        return per_path({tally.electrons[1], tally.electrons[2], tally.phasor[2].real(),
                         tally.phasor[2].imag()},
                        samples);
      });
  const Eigen::Vector3d to_light = corner.light - corner.seen;
  expect_mean(means[0], 0.6 * to_light.z() / std::pow(to_light.norm(), 3), 1e-9, "direct");
  expect_mean(means[1], truth, 0.005, "second reflection");
  expect_mean(means[2], phasor.real(), 0.05, "phasor, real part");
  expect_mean(means[3], phasor.imag(), 0.05, "phasor, imaginary part");
}

TEST(LightTransport, IsTheSameForAnyThreadCount) {
  const Corner corner;
  const Scene scene = corner.scene();
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.sample_emission = true});
  const PointEmitter emitter{.place = corner.light};
  expect_same_for_any_thread_count([&] {
    std::vector<double> pixels(200);
    parallel_for(pixels.size(), [&](std::size_t i) {
      const Eigen::Vector3d toward = corner.seen + Eigen::Vector3d(0, 0.01 * i, 0) - corner.lens;
      SampleSequence random(1, 0, i, 0);
      Tally tally;
      for (int k = 0; k < 16; ++k) {
        random.start(k);
        trace_path(transport, {corner.lens, toward.normalized()}, emitter, random, tally);
      }
      pixels[i] = tally.device;
    });
    return pixels;
  });
}

}  // namespace
}  // namespace scan::synth
