// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Views that are split at smooth surfaces against views that choose one way by chance.
#include <gtest/gtest.h>

#include <string>

#include "synth/transport/vertex.h"
#include "tests/synth/light_paths.h"
#include "tests/synth/ray_scenes.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

Material made_of(const Bsdf& bsdf) {
  return {.name = "", .bsdf = bsdf, .texture = {}, .interior = {}};
}

// The receiver behind the smooth surfaces that a view has passed.
struct Behind {
  Tally& tally;
  double way_m;
  void device_light(double e, double path_m, int scatterings) {
    tally.device_light(e, path_m + way_m, scatterings);
  }
  void other_light(double e) { tally.other_light(e); }
};

// One way over the smooth surfaces in front of a view, chosen by chance at each; all else, and all
// opaque surfaces, stand in air.
void choose_a_way(const LightTransport& transport, Ray view, const PointEmitter& emitter,
                  SampleSequence& random, Tally& tally) {
  double way_m = 0;
  Surroundings inside;
  for (int k = 0; k <= 16; ++k) {
    const auto hit = transport.caster().closest(view.origin, view.direction);
    if (!hit) return;
    const ObjectOptics& optics = transport.optics(hit->object);
    if (!optics.is_smooth) {
      Behind behind{tally, way_m};
      return trace_path(transport, view, emitter, random, behind);
    }
    way_m += inside.index() * hit->distance_m;
    const Vertex vertex =
        surface_vertex(transport.caster().scene(), optics, *hit, -view.direction, inside);
    const auto next = sample(vertex, random.next_3d());
    if (!next || !(random.next() < next->weight)) return;
    inside = around(vertex, next->in);
    view = {leave(transport.caster(), vertex, next->in), next->in};
  }
}

// A pane, a glass ball and a mirror in front of walls that light each other: following all that
// smooth surfaces show gives the means of choosing among it by chance, at less variance.
TEST(Splitting, AgreesWithChoosingByChance) {
  Scene scene;
  scene.materials = {plain(0.6), made_of(Dielectric{.index = 1.5}),
                     made_of(Conductor{.eta = 0.05, .k = 4, .roughness = 0})};
  scene.objects = {plane_at(3),
                   plate(-1, -1, 1),
                   sphere_at({0.1, 0, 1.5}, 0.2, 1),
                   {.name = "pane",
                    .world_from_object = at(0, 0, 0.9),
                    .geometry = Shape(BoxShape{{1, 1, 0.01}}),
                    .material = 1},
                   plate(2.5, 0.1, 0.4, 2)};
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.most_scatterings = 3});
  const PointEmitter emitter{.place = {0.3, 0.1, 0}, .intensity = 10};
  const auto figures = [](const Tally& tally, int count) {
    return std::vector<double>{tally.electrons[1] / count, tally.device / count,
                               (tally.moment[1] + tally.moment[2] + tally.moment[3]) / count};
  };
  for (const double x : {0.02, 0.12}) {  // through the ball, and beside it into the mirror
    const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d(x, 0.01, 1).normalized()};
    const auto split = means_of(
        64, {},
        [&](SampleSequence& random, Tally& tally) {
          trace_path(transport, view, emitter, random, tally);
        },
        figures);
    const auto chosen = means_of(
        256, {},
        [&](SampleSequence& random, Tally& tally) {
          choose_a_way(transport, view, emitter, random, tally);
        },
        figures, 1);
    for (std::size_t k = 0; k < split.size(); ++k) {
      expect_same(split[k], chosen[k], 0.1, "electrons");
      // For as many samples; of light scattered once all chance but 1e-2 of the view's is gone, of
      // the rest some stays.
      const double ratio = 4 * std::pow(chosen[k].error / split[k].error, 2);
      RecordProperty("variance_ratio_" + std::to_string(x) + "_" + std::to_string(k),
                     std::to_string(ratio));
      EXPECT_GT(ratio, k == 0 ? 1000 : 1);
    }
  }
}

struct Ambient {
  double share = 0;
  void device_light(double, double, int) {}
  void other_light(double) {}
  void ambient(double part) { share += part; }
};

// Of a wall behind a pane the share of uniform light is its albedo times what the pane lets
// through, (1 - r) / (1 + r) in all; the last inner reflections are drawn: r^2 (1 - r) of the view
// stays in the pane by 4 %.
TEST(Splitting, TellsAmbientOfEachBranchWithItsShare) {
  Scene scene;
  scene.materials = {plain(0.5), made_of(Dielectric{.index = 1.5})};
  scene.objects = {plane_at(2), plane_at(0.9, 0, 1)};
  scene.objects[1].geometry = Shape(BoxShape{{1, 1, 0.01}});
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.most_scatterings = 1});
  const PointEmitter emitter{.place = {0.3, 0.1, 0}};
  SampleSequence random(1, 0, 0, 0);
  Ambient ambient;
  const int samples = 256;
  for (int i = 0; i < samples; ++i) {
    random.start(i);
    trace_path(transport, {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}, emitter, random,
               ambient);
  }
  const double r = 0.04;
  EXPECT_NEAR(ambient.share / samples, 0.5 * (1 - r) / (1 + r),
              5 * 0.5 * r * r * (1 - r) * std::sqrt(r * (1 - r) / samples));
}

}  // namespace
}  // namespace scan::synth
