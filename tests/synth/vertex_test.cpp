// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/vertex.h"

#include <gtest/gtest.h>

#include "tests/synth/light_paths.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, -2) / 3;

Hit surface_point() {
  return {.distance_m = 1, .point = {0.3, 0.2, 0.1}, .normal = normal, .object = 0, .triangle = 0};
}

Scene scene_of(const Bsdf& bsdf) {
  Scene scene;
  scene.materials = {{.name = "", .bsdf = bsdf, .texture = {}, .interior = {}}};
  scene.objects = {sphere_at(Eigen::Vector3d::Zero(), 1)};
  return scene;
}

// f |cos| is albedo cos / pi, whichever side of a shell is seen.
TEST(Vertex, OfAMattSurfaceFollowsLambert) {
  const Scene scene = scene_of(Lambert{0.6});
  const auto optics = optics_of(scene);
  const Eigen::Vector3d across = normal.unitOrthogonal();
  for (const double side : {1.0, -1.0}) {
    const Vertex vertex =
        surface_vertex(scene, optics[0], surface_point(), side * normal, Surroundings());
    const Eigen::Vector3d in = 0.6 * side * normal + 0.8 * across;
    EXPECT_NEAR(scattering(vertex, in), 0.6 * 0.6 / std::numbers::pi, 1e-15);
    EXPECT_NEAR(density(vertex, in), 0.6 / std::numbers::pi, 1e-15);
    EXPECT_NEAR(cosine(vertex, in), 0.6, 1e-15);
    EXPECT_EQ(scattering(vertex, -in), 0);
  }
}

// sample() draws with density(), and its weight is scattering over density: the mean weight is the
// integral of scattering, the albedo.
TEST(Vertex, SamplesWhatItEvaluates) {
  const Scene scene = scene_of(Conductor{.roughness = 0.3});
  const auto optics = optics_of(scene);
  const Eigen::Vector3d out = (normal + 0.7 * normal.unitOrthogonal()).normalized();
  const Vertex vertex = surface_vertex(scene, optics[0], surface_point(), out, Surroundings());
  SampleSequence random(1, 0, 0, 0);
  for (int i = 0; i < 100; ++i) {
    random.start(i);
    const auto drawn = sample(vertex, random.next_3d());
    if (!drawn) continue;
    EXPECT_NEAR(drawn->density, density(vertex, drawn->in), 1e-6 * drawn->density);
    EXPECT_NEAR(drawn->weight * drawn->density, scattering(vertex, drawn->in),
                1e-6 * drawn->weight * drawn->density);
    EXPECT_NEAR(drawn->in.norm(), 1, 1e-15);
  }
}

// In a medium the phase function is all; light that goes straight on has in = -out.
TEST(Vertex, InAMediumFollowsThePhaseFunction) {
  const Medium medium{.scattering_per_m = 1, .phase = HenyeyGreenstein{0.8}};
  const Eigen::Vector3d out = normal;
  const Vertex vertex = medium_vertex(medium, {1, 2, 3}, out, Surroundings());
  EXPECT_EQ(scattering(vertex, -out), phase_value(medium.phase, 1));
  EXPECT_EQ(scattering(vertex, out), phase_value(medium.phase, -1));
  EXPECT_EQ(density(vertex, -out), scattering(vertex, -out));
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  SampleSequence random(1, 0, 0, 0);
  for (int i = 0; i < 4096; ++i) {
    random.start(i);
    mean += sample(vertex, random.next_3d())->in / 4096;
  }
  // the mean direction is g along the way on; 4096 samples of standard deviation below 1
  EXPECT_LT((mean + 0.8 * out).norm(), 5 / std::sqrt(4096.0));
}

// Snell: a glass ball in water bends by 1.33 / 1.5, and the way in and out keeps the bodies around.
TEST(Vertex, BodyInABodyRefractsByTheRatioOfIndices) {
  Scene scene = scene_of(Dielectric{.index = 1.33});
  scene.materials.push_back(
      {.name = "glass", .bsdf = Dielectric{.index = 1.5}, .texture = {}, .interior = {}});
  scene.objects.push_back(sphere_at(Eigen::Vector3d::Zero(), 0.5, 1));
  const auto optics = optics_of(scene);
  Surroundings water;
  water.enter(optics[0]);
  const Eigen::Vector3d out = 0.8 * normal + 0.6 * normal.unitOrthogonal();
  const Vertex from_water = surface_vertex(scene, optics[1], surface_point(), out, water);
  const auto into_glass = sample(from_water, {0.999999, 0.5, 0.5});
  ASSERT_TRUE(into_glass && into_glass->is_transmitted);
  EXPECT_NEAR(into_glass->in.cross(normal).norm(), 0.6 * 1.33 / 1.5, 1e-12);
  const Surroundings glass = around(from_water, into_glass->in);
  EXPECT_EQ(glass.index(), 1.5);
  const Vertex from_glass =
      surface_vertex(scene, optics[1], surface_point(), into_glass->in, glass);
  const auto into_water = sample(from_glass, {0.999999, 0.5, 0.5});
  ASSERT_TRUE(into_water && into_water->is_transmitted);
  EXPECT_LT((into_water->in - out).norm(), 1e-12);
  EXPECT_EQ(around(from_glass, into_water->in).index(), 1.33);
}

}  // namespace
}  // namespace scan::synth
