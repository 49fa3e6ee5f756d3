// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/reconstruct_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libscan/acquire/normals.h"
#include "libscan/core/random.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "synth/ray_caster.h"

namespace scan {
namespace {

constexpr double least_cosine = 0.2;

// Spiral of equal areas.
Eigen::Vector3d direction_of(int view, int views) {
  const double z = 1 - (2 * view + 1.0) / views;
  const double azimuth = view * std::numbers::pi * (3 - std::sqrt(5.0));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

Eigen::Vector3d random_direction(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Vector3d(x, y, z).normalized();
}

struct Seen {
  std::uint64_t lot;  // decides who stays
  int view;
  SurfaceSample sample;
};

std::vector<Seen> seen_samples(const Mesh& mesh, const std::vector<Eigen::Vector3d>& scanners,
                               std::size_t points) {
  synth::Scene scene;
  scene.materials.push_back({});
  scene.objects.push_back({"", Pose::Identity(), mesh, 0});
  const synth::RayCaster caster(scene);
  std::vector<Seen> seen;
  for (int view = 0; view < static_cast<int>(scanners.size()); ++view)
    for (const SurfaceSample& sample : sample_surface(mesh, points, 11 + view)) {
      const Eigen::Vector3d to_scanner = (scanners[view] - sample.point).normalized();
      if (to_scanner.dot(sample.normal) < least_cosine) continue;
      const synth::Hit hit{.distance_m = 0,
                           .point = sample.point,
                           .normal = sample.normal,
                           .object = 0,
                           .triangle = sample.triangle,
                           .error_m = 1e-12};
      if (caster.occluded(hit, scanners[view])) continue;
      RandomStream random(12, view, seen.size());
      const std::uint64_t high = random.bits32();
      seen.push_back({high << 32 | random.bits32(), view, sample});
    }
  return seen;
}

Pose view_error(int view, const Eigen::Vector3d& centre, const ViewOptions& options) {
  RandomStream random(13, view, 0);
  const Eigen::Vector3d shift = options.displacement_m * random_direction(random);
  const Eigen::AngleAxisd turn(options.turn_rad, random_direction(random));
  return Pose(Eigen::Translation3d(centre + shift) * turn * Eigen::Translation3d(-centre));
}

}  // namespace

Views views_of(const Mesh& mesh, const ViewOptions& options) {
  const Bounds box = bounds_of(mesh.vertices);
  std::vector<Eigen::Vector3d> scanners;
  std::vector<Pose> errors;
  for (int view = 0; view < options.views; ++view) {
    scanners.push_back(box.center() +
                       2 * box.diagonal().norm() * direction_of(view, options.views));
    errors.push_back(view_error(view, box.center(), options));
  }
  std::vector<Seen> seen = seen_samples(mesh, scanners, options.points);
  std::sort(seen.begin(), seen.end(), [](const Seen& a, const Seen& b) { return a.lot < b.lot; });
  seen.resize(std::min(seen.size(), options.points));
  Views views;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto& [lot, view, sample] = seen[i];
    const Eigen::Vector3d ray = (sample.point - scanners[view]).normalized();
    RandomStream random(14, 0, i);
    const double sigma_m = options.sigma_m / -ray.dot(sample.normal);
    const Eigen::Vector3d measured = sample.point + sigma_m * random.normal() * ray;
    views.cloud.points.push_back(errors[view] * measured);
    views.cloud.normals.push_back(errors[view].linear() * sample.normal);
    views.cloud.sigma_m.push_back(sigma_m);
    views.viewpoints.push_back(errors[view] * scanners[view]);
  }
  return views;
}

Views stanford_views(const std::filesystem::path& data) {
  const auto folder = data / "stanford-bunny" / "data";
  Views views;
  for (const NamedPose& named : read_poses(folder / "bun.conf")) {
    Scan scan = read_scan(folder / named.name);
    estimate_normals(scan);
    append(views.cloud, transformed(named.pose, scan.cloud));
    views.viewpoints.resize(views.cloud.size(), named.pose * scan.viewpoint);
  }
  return views;
}

}  // namespace scan
