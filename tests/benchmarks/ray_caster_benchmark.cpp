// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The ray caster beside raw Embree (native triangles, ROBUST, floats) on the same rays: closest
// hits and shadow rays, single and in packets, in scan order and at random.
//
// All run on one thread. Each reports `checksum`, the sum of its distances or the count of its
// shadows, and fails if that is not the others' to single precision. A table gives each rate as a
// fraction of raw Embree's. On a busy machine, add --benchmark_repetitions=5
// --benchmark_enable_random_interleaving=true.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>

#include "libscan/core/parallel.h"
#include "synth/ray_caster.h"
#include "synth/shape_rays.h"
#include "tests/benchmarks/rate_table.h"
#include "tests/benchmarks/raw_embree.h"
#include "tests/synth/ray_scenes.h"

namespace scan::synth {
namespace {

constexpr int rows = 256, columns = 1024;
constexpr std::size_t ray_count = rows * columns;

// A sphere-like room with a small ball in it, which casts shadows.
Mesh room(int rings) {
  Mesh mesh = bumpy_ball(rings, 2 * rings);
  const Mesh ball = bumpy_ball(10, 20);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& v : ball.vertices)
    mesh.vertices.push_back(0.1 * v + Eigen::Vector3d(0.2, -0.3, 0));
  for (const Triangle& t : ball.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return mesh;
}

struct Bench {
  Mesh mesh;
  RayCaster caster{scene_of({mesh})};
};

std::vector<Ray> scan_rays() {
  std::vector<Ray> rays;
  const Eigen::Vector3d eye(0.2, 0.1, 0.05);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double azimuth = 2 * std::numbers::pi * column / columns;
      const double elevation = 1.2 * (row - rows / 2) / (rows / 2);
      rays.push_back(
          {eye, Eigen::Vector3d(std::cos(azimuth) * std::cos(elevation),
                                std::sin(azimuth) * std::cos(elevation), std::sin(elevation))});
    }
  return rays;
}

std::vector<Ray> random_rays() {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < ray_count; ++i) {
    RandomStream random(1, 0, i);
    const Eigen::Vector3d eye = 0.25 * random.uniform() * random_vector(random).normalized();
    rays.push_back({eye, random_vector(random).normalized()});
  }
  return rays;
}

std::vector<Ray> rays_of(const std::string& order) {
  return order == "scan" ? scan_rays() : random_rays();
}

double closest_one_by_one(const RayCaster& caster, std::span<const Ray> rays) {
  double sum = 0;
  for (const Ray& ray : rays)
    if (const auto hit = caster.closest(ray.origin, ray.direction)) sum += hit->distance_m;
  return sum;
}

double closest_in_rows(const RayCaster& caster, std::span<const Ray> rays) {
  double sum = 0;
  std::vector<std::optional<Hit>> hits(columns);
  for (std::size_t i = 0; i < rays.size(); i += columns) {
    caster.closest(rays.subspan(i, columns), hits);
    for (const auto& hit : hits)
      if (hit) sum += hit->distance_m;
  }
  return sum;
}

double shadows_one_by_one(const RayCaster& caster, std::span<const Segment> segments) {
  double count = 0;
  for (const Segment& s : segments) count += caster.blocked(s.from, s.to);
  return count;
}

// In scan order only, where all share one lamp.
double shadows_in_rows(const RayCaster& caster, std::span<const Segment> segments) {
  double count = 0;
  std::vector<Eigen::Vector3d> from(columns);
  const std::unique_ptr<bool[]> dark(new bool[columns]);
  for (std::size_t i = 0; i < segments.size(); i += columns) {
    const std::size_t size = std::min<std::size_t>(columns, segments.size() - i);
    for (std::size_t k = 0; k < size; ++k) from[k] = segments[i + k].from;
    caster.blocked({from.data(), size}, segments[i].to, {dark.get(), size});
    count += static_cast<double>(std::count(dark.get(), dark.get() + size, true));
  }
  return count;
}

// From what the rays meet to a lamp beside the scanner, or to a point of its own for each.
std::vector<Segment> shadow_segments(const RayCaster& caster, std::span<const Ray> rays,
                                     const std::string& order) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RandomStream random(2, 0, i);
    const Eigen::Vector3d lamp = order == "scan"
                                     ? Eigen::Vector3d(0.25, 0.1, -0.4)
                                     : Eigen::Vector3d(0.4 * random_vector(random).normalized());
    if (const auto hit = caster.closest(rays[i].origin, rays[i].direction))
      segments.push_back({caster.leave(*hit, -rays[i].direction), lamp});
  }
  return segments;
}

void add_cases(const std::string& name, const Bench& bench) {
  const auto raw = std::make_shared<RawEmbree>(bench.mesh);
  const RayCaster& caster = bench.caster;
  for (const std::string order : {"scan", "random"}) {
    const auto rays = std::make_shared<std::vector<Ray>>(rays_of(order));
    const auto segments =
        std::make_shared<std::vector<Segment>>(shadow_segments(caster, *rays, order));
    const bool coherent = order == "scan";
    const std::string closest = "closest/" + name + "/" + order;
    add_rate(closest, "embree-1", rays->size(), 1e-5, [=] { return raw->closest(*rays); });
    add_rate(closest, "embree-16", rays->size(), 1e-5,
             [=] { return raw->closest_in_packets(*rays, coherent); });
    add_rate(closest, "single", rays->size(), 1e-5,
             [=, &caster] { return closest_one_by_one(caster, *rays); });
    add_rate(closest, "rows", rays->size(), 1e-5,
             [=, &caster] { return closest_in_rows(caster, *rays); });
    const std::string shadow = "shadow/" + name + "/" + order;
    add_rate(shadow, "embree-1", segments->size(), 1e-2, [=] { return raw->shadows(*segments); });
    add_rate(shadow, "embree-16", segments->size(), 1e-2,
             [=] { return raw->shadows_in_packets(*segments, coherent); });
    add_rate(shadow, "single", segments->size(), 1e-2,
             [=, &caster] { return shadows_one_by_one(caster, *segments); });
    if (coherent)
      add_rate(shadow, "rows", segments->size(), 1e-2,
               [=, &caster] { return shadows_in_rows(caster, *segments); });
  }
}

}  // namespace
}  // namespace scan::synth

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const scan::ThreadLimit one_thread(1);
  using namespace scan::synth;
  const Bench small{room(50)}, medium{room(160)}, large{room(500)};
  add_cases("10k", small);
  add_cases("100k", medium);
  add_cases("1M", large);
  return scan::run_rates({"embree-1", "embree-16"});
}
