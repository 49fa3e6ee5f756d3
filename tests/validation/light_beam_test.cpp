// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Narrow emitters: emission sampling and path tracing are two routes to one number.
#include <gtest/gtest.h>

#include <cstdio>

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

// Electrons per number of scatterings, 0 to 7.
std::vector<Mean> reflections(const LightTransport& transport, const BeamEmitter& beam,
                              const Ray& view, int samples, std::uint64_t address = 0) {
  return means_of(
      samples, {},
      [&](SampleSequence& random, Tally& tally) {
        trace_path(transport, view, beam, random, tally);
      },
      [](const Tally& tally, int count) {
        std::vector<double> means = tally.electrons;
        for (double& mean : means) mean /= count;
        return means;
      },
      address);
}

// A laser in an integrating sphere: whatever spot it lights, k reflections bring
// albedo^k flux / (4 pi R^2) for k > 1 (see light_transport_test), half of the light of a first
// reflection that the lens does not see.
TEST(EmissionSampling, LightsAnIntegratingSphereEvenly) {
  const double radius_m = 0.7, albedo = 0.8;
  const Scene scene = scene_of({sphere_at(Eigen::Vector3d::Zero(), radius_m)}, {plain(albedo)});
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.most_scatterings = 7, .sample_emission = true});
  const BeamEmitter beam{
      .world_from_beam = look_at({0.2, 0.1, 0}, {1, 2, 3}, Eigen::Vector3d::UnitZ()),
      .spread = {0.003, 0.03},
      .peak = 1000};
  const Ray view{{0.1, -0.3, 0.2}, Eigen::Vector3d(1, -2, 0.4).normalized()};
  const auto means = reflections(transport, beam, view, 4096);
  EXPECT_EQ(means[1].value, 0);
  for (int k = 2; k <= 7; ++k)
    expect_mean(means[k],
                std::pow(albedo, k) * beam.flux() / (4 * std::numbers::pi * radius_m * radius_m),
                0.03, "electrons");
}

// A floor, z = 0, seen at one point, and a wall, x = 0, with a spot or stripe of light.
struct LitCorner {
  Eigen::Vector3d lens = {1.2, -0.4, 0.9}, seen = {0.1, 0.05, 0};
  BeamEmitter beam{
      .world_from_beam = look_at({0.8, 0.3, 0.6}, {0, 0.05, 0.12}, Eigen::Vector3d::UnitZ()),
      .spread = {0.06, 0.02},
      .peak = 100};
  double albedo_floor = 0.6, albedo_wall = 0.8;
  Ray view{lens, (seen - lens).normalized()};

  Scene scene() const {
    Object floor{.name = "floor", .geometry = Shape(PlaneShape{}), .material = 0};
    Object wall = floor;
    const Eigen::AngleAxisd turn(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
    wall.world_from_object = make_pose(turn.toRotationMatrix(), Eigen::Vector3d::Zero());
    wall.material = 1;
    return scene_of({floor, wall}, {plain(albedo_floor), plain(albedo_wall)});
  }

  // Second reflection: the beam's flux, a normal distribution of its tangents, spread over the
  // wall.
  double integral(int n) const {
    const Quadrature rule = gauss_legendre(n);
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x = 16 * rule.node[i] - 8, y = 16 * rule.node[j] - 8;
        const double share = rule.weight[i] * rule.weight[j] * 256 *
                             std::exp(-(x * x + y * y) / 2) / (2 * std::numbers::pi);
        const Eigen::Vector3d toward = beam.world_from_beam.linear() *
                                       Eigen::Vector3d(x * beam.spread.x(), y * beam.spread.y(), 1);
        const Eigen::Vector3d from = beam.position();
        const Eigen::Vector3d at = from - from.x() / toward.x() * toward;
        const Eigen::Vector3d on = seen - at;
        if (toward.x() >= 0 || at.z() <= 0) continue;  // it lights the floor there
        const double form = on.x() * -on.z() / std::pow(on.norm(), 4);
        sum += share * beam.flux() * form * albedo_floor * albedo_wall / std::numbers::pi;
      }
    return sum;
  }
};

TEST(EmissionSampling, AgreesWithPathTracingAndQuadrature) {
  const LitCorner corner;
  const Scene scene = corner.scene();
  const RayCaster caster(scene);
  // the beam's tails beyond the floor's edge, at 5 standard deviations, blunt the quadrature
  const double truth = corner.integral(300);
  ASSERT_NEAR(corner.integral(200), truth, 1e-5 * truth);
  const LightTransport with(caster, {.most_scatterings = 2, .sample_emission = true});
  const LightTransport without(caster, {.most_scatterings = 2});
  const auto all = reflections(with, corner.beam, corner.view, 2048);
  const Mean a = all[2];
  EXPECT_EQ(all[3].value, 0);  // beyond most_scatterings
  const Mean b = reflections(without, corner.beam, corner.view, 16384, 1)[2];
  expect_mean(a, truth, 0.01, "with emission sampling");
  expect_mean(b, truth, 0.05, "without");
  const double ratio = std::pow(b.error / a.error, 2) * 16384 / 2048;
  RecordProperty("variance_ratio", std::to_string(ratio));
  std::printf("variance of path tracing over emission sampling: %.3g\n", ratio);
  EXPECT_GT(ratio, 10);
}

// A sheet of laser light as thin as a scanner's, 0.2 mm at 1 m: path tracing alone meets it once in
// hundreds of paths.
TEST(EmissionSampling, FindsAThinSheet) {
  LitCorner corner;
  corner.beam.spread = {0.0002, 0.2};
  const Scene scene = corner.scene();
  const RayCaster caster(scene);
  const LightTransport with(caster, {.most_scatterings = 2, .sample_emission = true});
  const LightTransport without(caster, {.most_scatterings = 2});
  const Mean a = reflections(with, corner.beam, corner.view, 1024)[2];
  const Mean b = reflections(without, corner.beam, corner.view, 32768, 1)[2];
  expect_same(a, b, 0.5, "second reflection");
  const double ratio = std::pow(b.error / a.error, 2) * 32768 / 1024;
  RecordProperty("variance_ratio", std::to_string(ratio));
  std::printf("variance of path tracing over emission sampling: %.3g\n", ratio);
  EXPECT_GT(ratio, 100);
}

// The laser shines up to a brick that shows it where it stood, mirrored in z = 0.5; the beam is
// even in its y.
Scene over_brick(LitCorner& corner, const Bsdf& surface) {
  Scene scene = corner.scene();
  scene.materials.push_back({.name = "brick", .bsdf = surface, .texture = {}, .interior = {}});
  scene.objects.push_back(
      {.name = "brick",
       .world_from_object = make_pose(Eigen::Matrix3d::Identity(), {0.65, 0.3, 0.505}),
       .geometry = Shape(BoxShape{{0.5, 0.5, 0.01}}),
       .material = 2});
  corner.beam.world_from_beam = look_at({0.8, 0.3, 0.4}, {0, 0.05, 0.88}, Eigen::Vector3d::UnitZ());
  return scene;
}

// The same spot by way of a perfect mirror: emission sampling follows it, connections find it, and
// each way is counted once.
TEST(EmissionSampling, FollowsMirrors) {
  LitCorner corner;
  const double truth = corner.integral(200);
  const Scene scene = over_brick(corner, Conductor{.eta = 1e-6, .k = 5, .roughness = 0});
  const RayCaster caster(scene);
  const LightTransport with(caster, {.most_scatterings = 2, .sample_emission = true});
  const LightTransport without(caster, {.most_scatterings = 2});
  expect_mean(reflections(with, corner.beam, corner.view, 1024)[2], truth, 0.02, "with");
  expect_mean(reflections(without, corner.beam, corner.view, 4096, 1)[2], truth, 0.1, "without");
}

// Black lacquer mirrors as well, but emitted rays end on it: connections alone count those ways.
TEST(EmissionSampling, LeavesCoatsToConnections) {
  LitCorner corner;
  const Scene scene = over_brick(corner, Plastic{.albedo = 0, .index = 2, .roughness = 0});
  const RayCaster caster(scene);
  const LightTransport with(caster, {.most_scatterings = 2, .sample_emission = true});
  const LightTransport without(caster, {.most_scatterings = 2});
  expect_same(reflections(with, corner.beam, corner.view, 4096)[2],
              reflections(without, corner.beam, corner.view, 4096, 1)[2], 0.2, "electrons");
}

// Glossy surfaces: where the direction that a path takes tells more than the beam does, the balance
// heuristic leaves the work to it.
TEST(EmissionSampling, AgreesWithPathTracingOnMetal) {
  LitCorner corner;
  Scene scene = corner.scene();
  for (Material& material : scene.materials)
    material.bsdf = Conductor{.eta = 0.2, .k = 3, .roughness = 0.15};
  const RayCaster caster(scene);
  const LightTransport with(caster, {.most_scatterings = 2, .sample_emission = true});
  const LightTransport without(caster, {.most_scatterings = 2});
  // the beam's way (0.8, 0.25, 0.48) off wall and floor as off mirrors, at (0, 0.05, 0.12) and
  // (0.2, -0.0125, 0), half a roughness aside
  const Eigen::Vector3d eye(1, -0.26, 0.55);
  const Ray view{eye, (Eigen::Vector3d(0.2, -0.0125, 0) - eye).normalized()};
  const Mean a = reflections(with, corner.beam, view, 8192)[2];
  const Mean b = reflections(without, corner.beam, view, 8192, 1)[2];
  expect_same(a, b, 0.05, "electrons");
  EXPECT_LT(a.error, b.error);
}

}  // namespace
}  // namespace scan::synth
