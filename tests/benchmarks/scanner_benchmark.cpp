// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scanners against bare ray casting: direct-light frames of each scanner on bumpy balls of 10^4 to
// 10^6 triangles, beside Embree alone (native triangles, ROBUST, rtcIntersect1) on the same rays
// and threads, one pass of it after each frame.
//
// `of_raw` is the rate of all rays that a frame needs over Embree's, by the clock on the wall, and
// `of_raw_cpu` by the processors' time, which other work on the machine disturbs less. Phase camera
// and lidar have their light at the eye: there are no rays towards it, on either side. After the
// runs the cost's exponents, by a straight line through the logarithms: against rays (pixels,
// pulses, steps) and against triangles. `peak_mib` is the process's so far. Environment
// LIBSCAN_BENCHMARK_FULL=1 adds 10^7 rays and the large jobs: a phase frame of a megapixel with up
// to 9 sub-rays, ten million pulses, and 400 laser steps, each over a million triangles.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "libscan/core/cost.h"
#include "libscan/core/parallel.h"
#include "synth/scanner.h"
#include "synth/scanners/pulsed_lidar_beam.h"
#include "tests/benchmarks/raw_embree.h"

namespace scan::synth {
namespace {

// A ball of radius 0.35 with bumps, of about `triangles` triangles, 1.2 m before the scanner.
Scene bumpy_ball(int triangles) {
  const int rows = std::max(4, static_cast<int>(std::sqrt(triangles / 4.0)));
  const int columns = 2 * rows;
  Mesh mesh;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double polar = std::numbers::pi * i / rows;
      const double around = 2 * std::numbers::pi * j / columns;
      const double r = 0.35 + 0.02 * std::sin(9 * polar) * std::cos(11 * around);
      mesh.vertices.emplace_back(r * std::sin(polar) * std::cos(around), r * std::cos(polar),
                                 1.2 + r * std::sin(polar) * std::sin(around));
    }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(i * columns + j % columns);
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  Object ball;
  ball.name = "ball";
  ball.geometry = std::move(mesh);
  return {.objects = {std::move(ball)}, .materials = {{.name = "matt"}}};
}

PhaseCamera phase_camera(int width, int sub_rays) {
  const double focal = 1.2 * width;
  return {.camera = {width, width * 3 / 4, focal, focal, width / 2.0, width * 3 / 8.0},
          .frequencies_hz = {80e6},
          .sub_rays = sub_rays,
          .sensor = {.read_noise_e = 10}};
}

PulsedLidar lidar(int columns) {
  return {.pattern = RasterPattern{columns * 3 / 4, columns, 0.6, 0.8},
          .sensor = {.read_noise_e = 10},
          .min_range_m = 0.5,
          .max_range_m = 2};
}

LaserLine laser(int steps) {
  return {.camera = {640, 480, 900, 900, 319.5, 239.5},
          .baseline_m = 0.5,
          .triangulation_rad = 0.4,
          .fan_rad = 0.8,
          .steps = steps,
          .step_m = 0.6 / steps,
          .sensor = {.read_noise_e = 10},
          .min_range_m = 0.3};
}

const Scene& scene_of(int triangles) {
  static std::map<int, Scene> scenes;
  auto [found, is_new] = scenes.try_emplace(triangles);
  if (is_new) found->second = bumpy_ball(triangles);
  return found->second;
}

std::vector<Eigen::Vector3d> directions_of(const PhaseCamera& s) {
  std::vector<Eigen::Vector3d> directions;
  for (int row = 0; row < s.camera.height_px; ++row)
    for (int column = 0; column < s.camera.width_px; ++column)
      directions.push_back(ray_through(s.camera, Eigen::Vector2d(column, row))->normalized());
  return directions;
}
std::vector<Eigen::Vector3d> directions_of(const PulsedLidar& s) {
  return ray_directions(s);
}

const EffectSet sensor_effects = {Effect::shot_noise, Effect::read_noise, Effect::quantisation,
                                  Effect::footprint};

// By the clock and by all processors.
struct Times {
  double wall_s = 0, cpu_s = 0;
};
template <class Work>
void add_time(Times& times, Work&& work) {
  const std::clock_t start = std::clock();
  const Stopwatch watch;
  work();
  times.wall_s += watch.seconds();
  times.cpu_s += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void trace_alone(const RawEmbree& raw, const std::vector<Eigen::Vector3d>& directions) {
  std::atomic<std::size_t> hits = 0;
  parallel_chunks(directions.size(), 512, [&](std::size_t first, std::size_t last) {
    std::size_t found = 0;
    for (std::size_t i = first; i < last; ++i) found += raw.hits(directions[i]);
    hits += found;
  });
  benchmark::DoNotOptimize(hits.load());
}

// Seconds of jobs by their size.
std::map<std::string, std::map<double, double>>& costs() {
  static std::map<std::string, std::map<double, double>> all;
  return all;
}

template <class Device>
double timed_frame(benchmark::State& state, const RayCaster& caster, const Device& device,
                   const EffectSet& effects, Times& times) {
  const double before_s = times.wall_s;
  add_time(times, [&] {
    benchmark::DoNotOptimize(render(device, caster, Pose::Identity(), {}, effects));
  });
  state.SetIterationTime(times.wall_s - before_s);
  return times.wall_s - before_s;
}

template <class Device>
void frame_beside_raw(benchmark::State& state, const Device& device, const EffectSet& effects) {
  const int triangles = static_cast<int>(state.range(0));
  const RayCaster caster(scene_of(triangles));
  const RawEmbree raw(std::get<Mesh>(scene_of(triangles).objects[0].geometry));
  const auto directions = directions_of(device);
  trace_alone(raw, directions);
  Times ours, theirs;
  for (auto _ : state) {
    timed_frame(state, caster, device, effects, ours);
    add_time(theirs, [&] { trace_alone(raw, directions); });
  }
  const double rays = static_cast<double>(directions.size() * state.iterations());
  state.counters["rays_per_second"] = rays / ours.wall_s;
  state.counters["raw_per_second"] = rays / theirs.wall_s;
  state.counters["of_raw"] = theirs.wall_s / ours.wall_s;
  state.counters["of_raw_cpu"] = theirs.cpu_s / ours.cpu_s;
}

template <class Device>
void frame(benchmark::State& state, const std::string& name, const Device& device, int triangles) {
  const RayCaster caster(scene_of(triangles));
  Times times;
  double least_s = INFINITY;
  for (auto _ : state)
    least_s = std::min(least_s, timed_frame(state, caster, device, sensor_effects, times));
  costs()[name][static_cast<double>(state.range(0))] = least_s;
  state.counters["seconds"] = times.wall_s / static_cast<double>(state.iterations());
  state.counters["peak_mib"] = peak_memory_mib();
}

// Exponent of the cost by least squares.
double exponent(const std::map<double, double>& seconds_of) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [size, seconds] : seconds_of) {
    const double u = std::log(size), v = std::log(seconds);
    ++n, x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void print_exponents() {
  for (const auto& [name, seconds_of] : costs())
    if (seconds_of.size() > 1)
      std::printf("%-22s cost ~ size^%.2f over %g to %g\n", name.c_str(), exponent(seconds_of),
                  seconds_of.begin()->first, seconds_of.rbegin()->first);
}

constexpr int million = 1'000'000;

// Columns of an image of 4 by 3 with about so many pixels.
int columns_of(double pixels) {
  return static_cast<int>(std::lround(std::sqrt(pixels / 0.75) / 4)) * 4;
}

template <class Run>
void add(const char* name, const Run& run, std::initializer_list<int> sizes, int iterations = 0) {
  auto* job = benchmark::RegisterBenchmark(name, run);
  for (const int size : sizes) job->Arg(size);
  if (iterations > 0) job->Iterations(iterations);
  job->UseManualTime()->Unit(benchmark::kMillisecond);
}

void add_ratios() {
  using State = benchmark::State;
  const auto sizes = {10'000, 100'000, million};
  add(
      "phase_frame", [](State& s) { frame_beside_raw(s, phase_camera(640, 1), sensor_effects); },
      sizes);
  add(
      "phase_frame_without_noise", [](State& s) { frame_beside_raw(s, phase_camera(640, 1), {}); },
      sizes);
  add(
      "lidar_scan", [](State& s) { frame_beside_raw(s, lidar(640), sensor_effects); }, sizes);
  add(
      "lidar_scan_without_noise", [](State& s) { frame_beside_raw(s, lidar(640), {}); }, sizes);
}

void add_scaling(bool full) {
  using State = benchmark::State;
  constexpr int triangles = 100'000;
  for (const int rays : {10'000, 100'000, million, 10 * million}) {
    if (rays > million && !full) continue;
    add("phase_by_pixels",
        [](State& s) {
          const int columns = columns_of(static_cast<double>(s.range(0)));
          frame(s, "phase_by_pixels", phase_camera(columns, 1), triangles);
        },
        {rays});
    add("lidar_by_pulses",
        [](State& s) {
          const int columns = columns_of(static_cast<double>(s.range(0)));
          frame(s, "lidar_by_pulses", lidar(columns), triangles);
        },
        {rays});
  }
  add("laser_by_steps",
      [](State& s) { frame(s, "laser_by_steps", laser(static_cast<int>(s.range(0))), triangles); },
      {2, 8, 32});
  const auto sizes = {10'000, 100'000, million};
  const auto by_triangles = [&](const char* name, const auto& device) {
    add(
        name, [device, name](State& s) { frame(s, name, device, static_cast<int>(s.range(0))); },
        sizes);
  };
  by_triangles("phase_by_triangles", phase_camera(640, 1));
  by_triangles("lidar_by_triangles", lidar(640));
  by_triangles("laser_by_triangles", laser(8));
}

void add_large_jobs() {
  using State = benchmark::State;
  add(
      "phase_megapixel",
      [](State& s) { frame(s, "phase_megapixel", phase_camera(1156, 3), million); }, {million}, 1);
  add(
      "lidar_ten_million", [](State& s) { frame(s, "lidar_ten_million", lidar(3652), million); },
      {million}, 1);
  add(
      "laser_sweep", [](State& s) { frame(s, "laser_sweep", laser(400), million); }, {million}, 1);
}

}  // namespace
}  // namespace scan::synth

int main(int argc, char** argv) {
  const bool full = std::getenv("LIBSCAN_BENCHMARK_FULL") != nullptr;
  scan::synth::add_ratios();
  scan::synth::add_scaling(full);
  if (full) scan::synth::add_large_jobs();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  scan::synth::print_exponents();
}
