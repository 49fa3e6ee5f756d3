// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Paths of light transport per second, beside bare calls of the ray caster, on one thread.
//
// The scene is a room of Lambert planes with a mesh in it, so every path has its full length. What
// an effect costs shows when it is called for: smooth surfaces, fog, lights of the scene.
#include <benchmark/benchmark.h>

#include "tests/synth/light_paths.h"
#include "tests/synth/ray_scenes.h"

namespace scan::synth {
namespace {

Scene room() {
  Scene scene;
  scene.materials = {{.name = "matt", .bsdf = Lambert{0.7}, .texture = {}, .interior = {}}};
  const Object box{.name = "walls",
                   .world_from_object = Pose::Identity(),
                   .geometry = Shape(BoxShape{{6, 5, 4}}),
                   .material = 0};
  const Object ball{.name = "ball",
                    .world_from_object = at(0.5, 0.3, 0.2),
                    .geometry = bumpy_ball(100, 200),
                    .material = 0};
  scene.objects = {box, ball};
  return scene;
}

Ray view_of(int i) {
  const Eigen::Vector3d toward(std::sin(0.37 * i), std::cos(0.53 * i), 0.4 * std::sin(0.11 * i));
  return {{-2, -1.5, 0.5}, (toward + Eigen::Vector3d(1.3, 1, 0)).normalized()};
}

void closest_hits(benchmark::State& state) {
  const Scene scene = room();
  const RayCaster caster(scene);
  int i = 0;
  for (auto _ : state) {
    const Ray view = view_of(++i);
    benchmark::DoNotOptimize(caster.closest(view.origin, view.direction));
  }
  state.SetItemsProcessed(state.iterations());
}

void paths(benchmark::State& state, const Scene& scene, const TransportOptions& options,
           const Eigen::Vector3d& light) {
  const RayCaster caster(scene);
  const LightTransport transport(caster, options);
  const PointEmitter emitter{.place = light};
  SampleSequence random(1, 0, 0, 0);
  Tally tally;
  int i = 0;
  for (auto _ : state) {
    random.start(i);
    trace_path(transport, view_of(++i), emitter, random, tally);
  }
  benchmark::DoNotOptimize(tally.device);
  state.SetItemsProcessed(state.iterations());
}

const Eigen::Vector3d beside(-2, -1.3, 0.5), at_the_lens(-2, -1.5, 0.5);

void direct(benchmark::State& state) {
  paths(state, room(), {.most_scatterings = 1}, beside);
}
void direct_at_the_lens(benchmark::State& state) {
  paths(state, room(), {.most_scatterings = 1}, at_the_lens);
}
void scatterings(benchmark::State& state) {
  paths(state, room(), {.most_scatterings = static_cast<int>(state.range(0))}, beside);
}
void with_emission(benchmark::State& state) {
  paths(state, room(), {.most_scatterings = 4, .sample_emission = true}, beside);
}
void with_mirror(benchmark::State& state) {
  Scene scene = room();
  scene.materials.push_back({.name = "mirror",
                             .bsdf = Conductor{.eta = 1, .k = 6, .roughness = 0},
                             .texture = {},
                             .interior = {}});
  scene.objects.push_back({.name = "mirror",
                           .world_from_object = at(-1, 1.5, 1),
                           .geometry = Shape(BoxShape{{0.5, 0.1, 0.5}}),
                           .material = 1});
  paths(state, scene, {.most_scatterings = 4}, beside);
}
void with_fog(benchmark::State& state) {
  Scene scene = room();
  scene.medium = fog(50, 0.8, 0.95);
  paths(state, scene, {.most_scatterings = 4}, beside);
}
void with_sky(benchmark::State& state) {
  Scene scene = room();
  scene.lights = {Environment{}};
  paths(state, scene, {.most_scatterings = 4}, beside);
}

BENCHMARK(closest_hits);
BENCHMARK(direct);
BENCHMARK(direct_at_the_lens);
BENCHMARK(scatterings)->Arg(2)->Arg(4)->Arg(8);
BENCHMARK(with_emission);
BENCHMARK(with_mirror);
BENCHMARK(with_fog);
BENCHMARK(with_sky);

}  // namespace
}  // namespace scan::synth

BENCHMARK_MAIN();
