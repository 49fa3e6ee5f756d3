// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/basins_pairs.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/error.h"
#include "libscan/verify/surface_error.h"
#include "synth/scene.h"

namespace scan::test {
namespace {

using Eigen::Vector3d;

constexpr double noise_m = 0.001;
constexpr double least_reach_m = 0.05;
constexpr double step_m = 0.1;

PlacedShape at(double x, double y, double z, Shape shape) {
  return {Pose(Eigen::Translation3d(x, y, z)), std::move(shape)};
}

CombinedShape united(double blend_m, std::vector<PlacedShape> parts) {
  return {CombinedShape::Operation::unite, blend_m, std::move(parts)};
}

Shape vessel() {
  return united(0.3, {at(0.125, 0.075, 0.3, SphereShape{1}), at(0, 0, -0.3, TorusShape{0.95, 0.3}),
                      at(0.6, 0, -0.7, BoxShape{Vector3d(1.2, 0.8, 1), 0.1})});
}

Shape boxes() {
  PlacedShape turned = at(1.4, 0.4, 0, BoxShape{Vector3d(1, 1.4, 1.2)});
  turned.parent_from_shape.rotate(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()));
  return united(0, {at(0, 0, 0, BoxShape{Vector3d(2, 1.6, 1)}), turned,
                    at(-0.4, 0.2, 0.8, BoxShape{Vector3d(0.7, 0.5, 0.8)})});
}

Shape flask() {
  return united(0, {at(0, 0, 0, CylinderShape{1, 4}), at(1.2, 0, 0, BoxShape{{0.8, 0.1, 3}})});
}

double wave_height_m(double x, double y) {
  return 0.2 * std::sin(2.1 * x + 0.4) * std::cos(1.7 * y) + 0.15 * x * y +
         0.06 * std::sin(5 * x) * std::sin(6 * y + 1);
}

Mesh waves() {
  constexpr int cells = 100;
  Mesh mesh;
  for (int r = 0; r <= cells; ++r)
    for (int c = 0; c <= cells; ++c) {
      const double x = 2.0 * c / cells - 1, y = 2.0 * r / cells - 1;
      mesh.vertices.emplace_back(x, y, wave_height_m(x, y));
    }
  for (int r = 0; r < cells; ++r)
    for (int c = 0; c < cells; ++c) {
      const auto a = std::uint32_t(r * (cells + 1) + c), b = a + cells + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

TrueSurface surface_of(const std::string& shape) {
  if (shape == "waves") return {.meshes = {waves()}};
  const auto alone = [](Shape solid) {
    return TrueSurface{.shapes = {{Pose::Identity(), std::move(solid)}}};
  };
  if (shape == "vessel") return alone(vessel());
  if (shape == "boxes") return alone(boxes());
  if (shape == "flask") return alone(flask());
  if (const auto found = synth::catalogue_shape(shape)) return alone(*found);
  throw Error(Trouble::usage, "shape: " + shape + ", must be one of the study's six");
}

// `share` of a sample's points, from one end of its longest axis or the other, with noise.
PointCloud part_of(const std::string& shape, double share, bool low_end, std::size_t count,
                   std::uint64_t seed) {
  PointCloud all;
  const auto wanted = static_cast<std::size_t>(std::ceil(double(count) / share));
  for (const SurfaceSample& sample : sample_truth(surface_of(shape), wanted, seed))
    all.points.push_back(sample.point);
  const Bounds box = bounds_of(all.points);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  std::stable_sort(all.points.begin(), all.points.end(), [&](const Vector3d& a, const Vector3d& b) {
    return low_end ? a[axis] < b[axis] : a[axis] > b[axis];
  });
  PointCloud part;
  const auto kept = static_cast<std::size_t>(std::lround(share * double(all.size())));
  for (std::size_t i = 0; i < kept; ++i) {
    RandomStream random(seed, 10, i);
    const double a = random.normal(), b = random.normal(), c = random.normal();
    part.points.push_back(all.points[i] / box.diagonal().norm() + noise_m * Vector3d(a, b, c));
  }
  return part;
}

}  // namespace

PairCase basin_pair(const std::string& shape, double overlap, std::size_t count,
                    std::uint64_t seed) {
  // Each covers a share s of the surface, and 2 s - 1 = overlap * s of it is in both.
  const double share = 1 / (2 - overlap);
  RandomStream random(seed, 11, 0);
  PairCase pair{.name = shape};
  pair.truth = Eigen::Translation3d(random_direction(random)) * random_motion(random, 30, 0);
  pair.source = part_of(shape, share, true, count, 2 * seed);
  pair.target = transformed(pair.truth, part_of(shape, share, false, count, 2 * seed + 1));
  return pair;
}

void start_off(PairCase& pair, double turn_deg, double shift_m, std::uint64_t seed) {
  RandomStream random(seed, 12, 0);
  const Vector3d centre = centroid(pair.source);
  pair.guess = pair.truth * Eigen::Translation3d(centre) *
               random_motion(random, turn_deg, shift_m) * Eigen::Translation3d(-centre);
  pair.reach_m = std::max(least_reach_m, moved_rms_m(pair, pair.guess));
  pair.step_m = step_m;
}

double moved_rms_m(const PairCase& pair, const Pose& pose) {
  double squares = 0;
  for (const Vector3d& x : pair.source.points) squares += (pose * x - pair.truth * x).squaredNorm();
  return std::sqrt(squares / double(pair.source.size()));
}

}  // namespace scan::test
