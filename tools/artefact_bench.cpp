// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Each place simulated, decoded and sorted by what its rays truly hit.
#include "tools/artefact_bench.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "libscan/core/error.h"
#include "synth/ray_caster.h"
#include "tools/noise_field.h"

namespace scan {
namespace {

constexpr std::size_t least_points = 20;

bool is_counted(const synth::Scene& scene, const Pose& world_from_view, const RayTruth& truth,
                Counts counts) {
  const Eigen::Vector3d along = truth.point_in_scanner.normalized();
  if (!(-along.dot(truth.normal_in_scanner) > 0.5)) return false;  // 60 degrees
  const synth::Object& body = scene.objects[static_cast<std::size_t>(truth.object)];
  const Pose body_from_scanner = body.world_from_object.inverse() * world_from_view;
  return counts(body, body_from_scanner * truth.point_in_scanner,
                body_from_scanner.linear() * truth.normal_in_scanner);
}

void add(BodyPoints& body, const Pose& first_from_view, const Scan& scan, std::size_t i,
         const RayTruth& truth, std::uint32_t number) {
  body.measured.push_back(first_from_view * scan.cloud.points[i]);
  if (scan.cloud.sigma_m.empty()) return;
  const std::uint32_t columns = std::max(1u, scan.grid.columns);
  if (body.stated.empty() || body.stated.back().scan != number)
    body.stated.push_back({.scan = number, .columns = columns, .noise_window = scan.noise_window});
  const Eigen::Vector3d along = truth.point_in_scanner.normalized();
  StatedPoints& stated = body.stated.back();
  stated.rays.push_back(scan.ray[i]);
  stated.truth.push_back(first_from_view * truth.point_in_scanner);
  stated.sigma_m.push_back(scan.cloud.sigma_m[i] * (first_from_view.linear() * along));
}

}  // namespace

Points drawn_points(const BodyPoints& body, std::uint64_t seed, std::uint32_t draw) {
  Points points;
  for (const StatedPoints& stated : body.stated) {
    const NoiseField noise(stated.rays, stated.columns, stated.noise_window,
                           {seed + 1, stated.scan, draw});
    for (std::size_t i = 0; i < stated.rays.size(); ++i)
      points.push_back(stated.truth[i] + noise.at(stated.rays[i]) * stated.sigma_m[i]);
  }
  return points;
}

bool counts_anywhere(const synth::Object&, const Eigen::Vector3d&, const Eigen::Vector3d&) {
  return true;
}
bool counts_on_mantle(const synth::Object&, const Eigen::Vector3d&, const Eigen::Vector3d& normal) {
  return std::abs(normal.z()) < 0.5;
}
bool counts_on_inner_face(const synth::Object& body, const Eigen::Vector3d& at,
                          const Eigen::Vector3d& normal) {
  const Eigen::Vector3d half = 0.45 * std::get<BoxShape>(std::get<Shape>(body.geometry)).size_m;
  return normal.z() > 0.9 && std::abs(at.x()) < half.x() && std::abs(at.y()) < half.y();
}

Bench::Bench(const Recipe& recipe, Console& console)
    : recipe_(recipe), console_(console), viewpoints_(true_poses(recipe.viewpoints)) {}

std::vector<std::vector<BodyPoints>> Bench::scanned(const std::string& test,
                                                    const std::vector<synth::PlacedObjects>& places,
                                                    Counts counts, std::size_t views) {
  std::vector<std::vector<BodyPoints>> all;
  synth::Scene scene = recipe_.scene.scene;
  scene.objects = places.front();
  const std::array poses = {world_from_scanner()};
  const synth::EffectSet effects =
      effects_of(plan_effects(recipe_.scanner, scene, poses, recipe_.effects));
  for (std::size_t i = 0; i < places.size(); ++i) {
    console_.progress()(test, static_cast<double>(i) / static_cast<double>(places.size()));
    scene.objects = places[i];
    all.emplace_back(places[i].size());
    for (std::size_t view = 0; view < views; ++view)
      scan_place(scene, effects, counts, viewpoints_[view * viewpoints_.size() / views],
                 all.back());
    for (std::size_t k = 0; k < places[i].size(); ++k)
      if (all.back()[k].measured.size() < least_points)
        throw Error(Trouble::computation, "artefacts: " + places[i][k].name + " at place " +
                                              std::to_string(i + 1) + " gave " +
                                              std::to_string(all.back()[k].measured.size()) +
                                              " points, needs " + std::to_string(least_points) +
                                              "; does the scanner see the whole measuring volume?");
  }
  console_.progress()(test, 1);
  return all;
}

void Bench::scan_place(const synth::Scene& scene, const synth::EffectSet& effects, Counts counts,
                       const Pose& world_from_view, std::vector<BodyPoints>& bodies) {
  const synth::RenderAddress address{.seed = recipe_.seed, .scan = place_++};
  const synth::RayCaster caster(simplified(scene, effects));
  const auto rendering = render(recipe_.scanner, caster, world_from_view, address, effects);
  const Scan scan = acquire(rendering.frames, recipe_.acquire);
  const auto rays = true_rays(recipe_.scanner, caster, world_from_view);
  const Pose first_from_view = world_from_scanner().inverse() * world_from_view;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const RayTruth& truth = rays[scan.ray[i]];
    if (truth.object < 0 || !is_counted(scene, world_from_view, truth, counts)) continue;
    add(bodies[static_cast<std::size_t>(truth.object)], first_from_view, scan, i, truth,
        address.scan);
  }
}

}  // namespace scan
