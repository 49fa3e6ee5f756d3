// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scanners against bare ray casting: direct-light frames of each scanner on bumpy balls of 10^4 to
// 10^6 triangles, beside Embree alone (native triangles, ROBUST, rtcIntersect1) on the same rays
// and threads.
//
// `rays_per_second` counts all rays that a frame needs, those towards the light included; `of_raw`
// is that over Embree's rate in the same process. `peak_mib` is the process's so far. Environment
// LIBSCAN_BENCHMARK_FULL=1 adds the large jobs: a phase frame of a megapixel with 9 sub-rays, ten
// million pulses, and 400 laser steps over a million triangles.
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>

#include "libscan/core/cost.h"
#include "libscan/core/parallel.h"
#include "synth/scanner.h"

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

// Embree alone over the same triangles.
class RawEmbree {
 public:
  explicit RawEmbree(const Mesh& mesh) : device_(rtcNewDevice(nullptr)) {
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    for (const Eigen::Vector3d& v : mesh.vertices)
      for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(v[k]);
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t corner : t) *indices++ = corner;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~RawEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  RawEmbree(const RawEmbree&) = delete;
  RawEmbree& operator=(const RawEmbree&) = delete;

  bool hits(const Eigen::Vector3d& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.dir_x = static_cast<float>(direction.x());
    ray.ray.dir_y = static_cast<float>(direction.y());
    ray.ray.dir_z = static_cast<float>(direction.z());
    ray.ray.tfar = INFINITY;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

 private:
  RTCDevice device_;
  RTCScene scene_ = nullptr;
};

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

std::map<int, double>& raw_rates() {
  static std::map<int, double> rates;
  return rates;
}

const Scene& scene_of(int triangles) {
  static std::map<int, Scene> scenes;
  auto [found, is_new] = scenes.try_emplace(triangles);
  if (is_new) found->second = bumpy_ball(triangles);
  return found->second;
}

std::vector<Eigen::Vector3d> pixel_directions(const PhaseCamera& s) {
  std::vector<Eigen::Vector3d> directions;
  for (int row = 0; row < s.camera.height_px; ++row)
    for (int column = 0; column < s.camera.width_px; ++column)
      directions.push_back(ray_through(s.camera, Eigen::Vector2d(column, row))->normalized());
  return directions;
}

void embree_alone(benchmark::State& state) {
  const int triangles = static_cast<int>(state.range(0));
  const RawEmbree raw(std::get<Mesh>(scene_of(triangles).objects[0].geometry));
  const auto directions = pixel_directions(phase_camera(640, 1));
  double seconds = 0;
  std::atomic<std::size_t> hits = 0;
  for (auto _ : state) {
    const Stopwatch watch;
    parallel_chunks(directions.size(), 4096, [&](std::size_t first, std::size_t last) {
      std::size_t found = 0;
      for (std::size_t i = first; i < last; ++i) found += raw.hits(directions[i]);
      hits += found;
    });
    seconds += watch.seconds();
  }
  const double rate = static_cast<double>(directions.size() * state.iterations()) / seconds;
  raw_rates()[triangles] = rate;
  state.counters["rays_per_second"] = rate;
  state.counters["hit_share"] =
      static_cast<double>(hits) / static_cast<double>(directions.size() * state.iterations());
}

template <class Device>
void frame(benchmark::State& state, const Device& device, double rays, const EffectSet& effects) {
  const int triangles = static_cast<int>(state.range(0));
  const RayCaster caster(scene_of(triangles));
  double seconds = 0;
  for (auto _ : state) {
    const Stopwatch watch;
    benchmark::DoNotOptimize(render(device, caster, Pose::Identity(), {}, effects));
    seconds += watch.seconds();
  }
  const double rate = rays * static_cast<double>(state.iterations()) / seconds;
  state.counters["seconds"] = seconds / static_cast<double>(state.iterations());
  state.counters["rays_per_second"] = rate;
  if (raw_rates().contains(triangles)) state.counters["of_raw"] = rate / raw_rates()[triangles];
  state.counters["peak_mib"] = peak_memory_mib();
}

const EffectSet sensor_effects = {Effect::shot_noise, Effect::read_noise, Effect::quantisation,
                                  Effect::footprint};

void phase_frame(benchmark::State& state) {
  frame(state, phase_camera(640, 1), 640.0 * 480, sensor_effects);
}
void phase_frame_without_noise(benchmark::State& state) {
  frame(state, phase_camera(640, 1), 640.0 * 480, {});
}
void lidar_scan(benchmark::State& state) {
  frame(state, lidar(640), 640.0 * 480, sensor_effects);
}
void lidar_scan_without_noise(benchmark::State& state) {
  frame(state, lidar(640), 640.0 * 480, {});
}
void laser_steps(benchmark::State& state) {
  frame(state, laser(8), 8.0 * 640 * 480, sensor_effects);
}
void phase_megapixel(benchmark::State& state) {
  frame(state, phase_camera(1156, 3), 9.0 * 1156 * 867, sensor_effects);
}
void lidar_ten_million(benchmark::State& state) {
  frame(state, lidar(3652), 3652.0 * 2739, sensor_effects);
}
void laser_sweep(benchmark::State& state) {
  frame(state, laser(400), 400.0 * 640 * 480, sensor_effects);
}

constexpr int million = 1'000'000;

[[maybe_unused]] const bool registered = [] {
  const auto sizes = [](benchmark::internal::Benchmark* b) {
    b->Arg(10'000)->Arg(100'000)->Arg(million)->UseRealTime()->Unit(benchmark::kMillisecond);
  };
  sizes(benchmark::RegisterBenchmark("embree_alone", embree_alone));
  sizes(benchmark::RegisterBenchmark("phase_frame", phase_frame));
  sizes(benchmark::RegisterBenchmark("phase_frame_without_noise", phase_frame_without_noise));
  sizes(benchmark::RegisterBenchmark("lidar_scan", lidar_scan));
  sizes(benchmark::RegisterBenchmark("lidar_scan_without_noise", lidar_scan_without_noise));
  sizes(benchmark::RegisterBenchmark("laser_steps", laser_steps));
  if (!std::getenv("LIBSCAN_BENCHMARK_FULL")) return true;
  for (auto* job : {benchmark::RegisterBenchmark("phase_megapixel", phase_megapixel),
                    benchmark::RegisterBenchmark("lidar_ten_million", lidar_ten_million),
                    benchmark::RegisterBenchmark("laser_sweep", laser_sweep)})
    job->Arg(million)->Iterations(1)->UseRealTime()->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace scan::synth

BENCHMARK_MAIN();
