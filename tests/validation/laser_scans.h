// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scans of a laser line, rendered and decoded, ray by ray.
#pragma once

#include <cmath>
#include <vector>

#include "libscan/acquire/laser_line.h"
#include "tests/synth/laser_bench.h"

namespace scan::synth {

// Where each ray's point is seen and how far it is; NaN for a miss. Shape does not matter: a stripe
// that is cut or mottled is a point, too.
struct DecodedRays {
  std::vector<double> column_px;
  std::vector<double> range_m;
};

inline DecodedRays decoded(const LaserLine& s, const Scene& scene, const EffectSet& effects,
                           std::uint64_t seed = 3) {
  const RayCaster caster(simplified(scene, effects));
  const Rendering rendering = render(s, caster, Pose::Identity(), {.seed = seed}, effects);
  const auto& frames = std::get<StripeImages>(rendering.frames);
  const Scan scan = acquire_laser_line(frames, {.max_shape_error = 1e9});
  const auto rays = static_cast<std::size_t>(s.steps) * s.camera.height_px;
  DecodedRays found{std::vector<double>(rays, NAN), std::vector<double>(rays, NAN)};
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const std::size_t ray = scan.ray[i];
    const Eigen::Vector3d x =
        frames.scanner_from_camera[ray / s.camera.height_px].inverse() * scan.cloud.points[i];
    found.column_px[ray] = project(s.camera, x)->x();
    found.range_m[ray] = x.norm();
  }
  return found;
}

// Centre of gravity of a row's light.
inline double centroid_px(const Image<std::uint16_t>& image, int row) {
  double sum = 0, moment = 0;
  for (int column = 0; column < image.width; ++column) {
    sum += image(column, row);
    moment += column * double(image(column, row));
  }
  return moment / sum;
}

// Range of each ray by the centroid of its whole row.
inline std::vector<double> centroid_ranges(const LaserLine& s, const Scene& scene,
                                           const EffectSet& effects, std::uint64_t seed = 1) {
  const RayCaster caster(simplified(scene, effects));
  const Rendering rendering = render(s, caster, Pose::Identity(), {.seed = seed}, effects);
  const auto& frames = std::get<StripeImages>(rendering.frames);
  std::vector<double> ranges;
  for (const auto& image : frames.images)
    for (int row = 0; row < image.height; ++row) {
      const Eigen::Vector3d ray = *ray_through(s.camera, {centroid_px(image, row), double(row)});
      ranges.push_back(frames.calibration.plane_offset_m /
                       frames.calibration.plane_normal.dot(ray) * ray.norm());
    }
  return ranges;
}

struct Differences {
  double rms = 0;
  double largest = 0;
  double count = 0;
};

inline Differences differences(const std::vector<double>& a, const std::vector<double>& b) {
  Differences d;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) || std::isnan(b[i])) continue;
    d.rms += (a[i] - b[i]) * (a[i] - b[i]);
    d.largest = std::max(d.largest, std::abs(a[i] - b[i]));
    ++d.count;
  }
  d.rms = std::sqrt(d.rms / d.count);
  return d;
}

// A plane through `point` with the normal -`towards`, in two halves that meet in a line along y:
// white on the side of -x, black by `ratio` on the other.
inline Scene reflectance_step(const Eigen::Vector3d& point, const Eigen::Vector3d& towards,
                              double ratio) {
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY(), x = y.cross(towards).normalized();
  Scene scene;
  scene.materials = {plain(1), plain(1 / ratio)};
  for (const int side : {-1, 1}) {
    Mesh half;
    const Eigen::Vector3d far = point + side * 0.5 * x;
    half.vertices = {point - 0.5 * y, far - 0.5 * y, far + 0.5 * y, point + 0.5 * y};
    half.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.objects.push_back({.name = side < 0 ? "white" : "dark",
                             .world_from_object = Pose::Identity(),
                             .geometry = half,
                             .material = side < 0 ? 0 : 1});
  }
  return scene;
}

}  // namespace scan::synth
