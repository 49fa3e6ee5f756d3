// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Frame time of a phase camera of one megapixel and three frequencies, beside its bare rays.
#include <benchmark/benchmark.h>

#include <cmath>

#include "libscan/core/parallel.h"
#include "synth/scanners/phase_exposure.h"

namespace scan::synth {
namespace {

PhaseCamera camera(int sub_rays) {
  PhaseCamera s;
  s.camera = {.width_px = 1024,
              .height_px = 1024,
              .fx_px = 900,
              .fy_px = 900,
              .cx_px = 511.5,
              .cy_px = 511.5};
  s.frequencies_hz = {16e6, 80e6, 120e6};
  s.sub_rays = sub_rays;
  return s;
}

// A wavy mesh of 180,000 triangles that fills the view.
const RayCaster& waves() {
  static const RayCaster caster = [] {
    constexpr std::uint32_t n = 300;
    Mesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j)
      for (std::uint32_t i = 0; i <= n; ++i) {
        const double x = -1 + 2.0 * i / n, y = -1 + 2.0 * j / n;
        mesh.vertices.push_back({x, y, 1.5 + 0.05 * std::sin(5 * x) * std::cos(4 * y)});
      }
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = j * (n + 1) + i, below = a + n + 1;
        mesh.triangles.push_back({a, below, a + 1});
        mesh.triangles.push_back({a + 1, below, below + 1});
      }
    return RayCaster({.objects = {{.name = "waves",
                                   .world_from_object = Pose::Identity(),
                                   .geometry = mesh,
                                   .material = 0}},
                      .materials = {{.name = "grey", .bsdf = Lambert{0.5}, .texture = {}}}});
  }();
  return caster;
}

void bare_rays(benchmark::State& state) {
  const ThreadLimit limit(1);
  const PhaseCamera s = camera(1);
  std::vector<Ray> rays(ViewBatch::most);
  std::vector<std::optional<Hit>> hits(ViewBatch::most);
  for (auto _ : state)
    for (int row = 0; row < 1024; ++row)
      for (int column = 0; column < 1024; column += static_cast<int>(ViewBatch::most)) {
        for (std::size_t i = 0; i < rays.size(); ++i)
          rays[i] = {
              .origin = Eigen::Vector3d::Zero(),
              .direction =
                  ray_through(s.camera, {column + static_cast<double>(i), row})->normalized()};
        waves().closest(rays, hits);
        benchmark::DoNotOptimize(hits.data());
      }
  state.SetItemsProcessed(state.iterations() * 1024 * 1024);
}
BENCHMARK(bare_rays)->Unit(benchmark::kMillisecond);

// Mean light of all pixels by one ray each, or by 3 x 3 where they are called for.
void light(benchmark::State& state) {
  const ThreadLimit limit(1);
  const PhaseCamera s = camera(static_cast<int>(state.range(0)));
  const std::vector<Tone> tones = tones_of(s);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        direct_light(s, tones, waves(), Pose::Identity(), {0, 1024}).constant_e.data());
  state.SetItemsProcessed(state.iterations() * 1024 * 1024);
}
BENCHMARK(light)->Arg(1)->Arg(3)->Unit(benchmark::kMillisecond);

// The whole frame of twelve taps, without noise (0) or with it (1).
void frame(benchmark::State& state) {
  const ThreadLimit limit(1);
  const PhaseCamera s = camera(static_cast<int>(state.range(0)));
  EffectSet effects{Effect::quantisation, Effect::footprint};
  if (state.range(1)) effects.set(Effect::shot_noise).set(Effect::read_noise);
  for (auto _ : state)
    benchmark::DoNotOptimize(render(s, waves(), Pose::Identity(), {}, effects).statistics.paths);
  state.SetItemsProcessed(state.iterations() * 1024 * 1024);
}
BENCHMARK(frame)->ArgsProduct({{1, 3}, {0, 1}})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace scan::synth

BENCHMARK_MAIN();
