// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The pilot follows the laser's light to the surface and into the camera, as the truth does; each
// effect's error is then a closed form there (laser_line_errors.h).
#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/core/parallel.h"
#include "synth/effects/laser_line_errors.h"
#include "synth/effects/weight.h"
#include "synth/scanners/laser_line_paths.h"

namespace scan::synth {
namespace {

constexpr int steps_of_pilot = 24;
constexpr int paths_per_ray = 64;
constexpr double widest_px = 30;  // a stripe that is wider has no point for a decoder

struct Place {
  int step;
  double angle_rad;
};

// Spread over the sweep and the fan, the fan shifted from step to step.
std::vector<Place> places(const LaserLine& s, int rays) {
  const int steps = std::min({steps_of_pilot, s.steps, std::max(1, rays)});
  const int angles = std::max(1, rays / steps);
  std::vector<Place> all;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < angles; ++j) {
      const double share = (j + (i + 0.5) / steps) / angles;
      all.push_back({static_cast<int>((i + 0.5) * s.steps / steps), s.fan_rad * (share - 0.5)});
    }
  return all;
}

// The stripe's point as its tangent plane shows it.
struct Seen {
  StripePoint point;
  CameraRay ray;
  double incidence_rad = 0;
  double indirect_extra_m = 0;
};

// Where the view of a pixel meets the tangent plane.
Eigen::Vector3d on_tangent(const LaserView& view, const SheetHit& lit,
                           const Eigen::Vector2d& pixel) {
  const auto ray = ray_through(view.scanner.camera, pixel);
  if (!ray) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::Vector3d normal = view.world_from_camera.linear().transpose() * lit.hit.normal;
  return normal.dot(lit.x_in_camera) / normal.dot(*ray) * *ray;
}

// By differences over half a pixel to each side.
void measure(const LaserView& view, const SheetHit& lit, Seen& seen) {
  const Eigen::Vector2d half(0.5, 0), half_row(0, 0.5);
  const Eigen::Vector3d left = on_tangent(view, lit, lit.pixel - half);
  const Eigen::Vector3d right = on_tangent(view, lit, lit.pixel + half);
  const Eigen::Vector3d up = on_tangent(view, lit, lit.pixel - half_row);
  const Eigen::Vector3d down = on_tangent(view, lit, lit.pixel + half_row);
  seen.point.px_per_m = 1 / std::abs(view.sheet.normal.dot(right - left));
  seen.point.footprint_m = std::abs(right.norm() - left.norm()) + std::abs(down.norm() - up.norm());
  // on the calibrated plane, along the view
  const auto on_plane = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return view.sheet.offset_m / view.sheet.normal.dot(x) * x;
  };
  seen.point.m_per_px = std::abs(seen.ray.direction.dot(on_plane(right) - on_plane(left)));
}

std::optional<Seen> see(const LaserView& view, const SheetHit& lit) {
  if (!lit.is_hit || !lit.is_lit) return std::nullopt;
  const Camera& camera = view.scanner.camera;
  if (!(lit.pixel.x() >= 0 && lit.pixel.x() <= camera.width_px - 1 && lit.pixel.y() >= 0 &&
        lit.pixel.y() <= camera.height_px - 1))
    return std::nullopt;
  if (view.caster.occluded(lit.hit, view.world_from_camera.translation())) return std::nullopt;
  Seen seen{.point = {}, .ray = {.direction = lit.x_in_camera.normalized()}};
  seen.point.height_e = view.light(seen.ray).laser_e;
  seen.point.other_e = view.light(seen.ray).other_e;
  // a smooth surface shows nothing itself; what it spoils is weighed as if it were white
  if (has_delta(bsdf_at(view.caster.scene(), lit.hit.object, lit.hit.triangle, lit.hit.point)))
    seen.point.height_e = std::max(
        seen.point.height_e, sheet_light(view.scanner, view.sheet, lit.x_in_camera).irradiance_e);
  seen.point.range_m = lit.x_in_camera.norm();
  seen.point.depth_m = lit.x_in_camera.z();
  seen.point.from_laser_m = lit.hit.distance_m;
  seen.point.radius_m = view.sheet.radius_m(lit.hit.distance_m);
  const Eigen::Vector3d out = -(view.world_from_camera.linear() * seen.ray.direction);
  seen.incidence_rad = std::acos(std::clamp(out.dot(lit.hit.normal), -1.0, 1.0));
  measure(view, lit, seen);
  if (!(seen.point.height_e > 0) || !std::isfinite(seen.point.footprint_m) ||
      !(stripe_sigma_px(seen.point) < widest_px))
    return std::nullopt;
  return seen;
}

// Other light at the stripe, by a few paths, with three standard errors added.
void trace_others(const LaserView& view, const LightTransport& transport, std::uint64_t index,
                  Seen& seen) {
  const SheetEmitter emitter(view);
  SampleSequence random(1, 0, index, 0);
  const Ray backwards{.origin = view.world_from_camera * seen.ray.origin,
                      .direction = view.world_from_camera.linear() * seen.ray.direction};
  const double way_m = straight_way_m(view, seen.ray);
  double sum = 0, squares = 0, way_e = 0, other = 0;
  for (int i = 0; i < paths_per_ray; ++i) {
    PathSums sums{.direct_way_m = way_m};
    random.start(static_cast<std::uint32_t>(i));
    trace_path(transport, backwards, emitter, random, sums);
    sum += sums.indirect_e;
    squares += sums.indirect_e * sums.indirect_e;
    way_e += sums.indirect_way_e;
    other += sums.other_w_m2;
  }
  const double n = paths_per_ray, mean = sum / n;
  const double error = std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1));
  seen.point.indirect_share = (mean + 3 * error) / seen.point.height_e;
  seen.point.other_e += other / n * view.scanner.electrons_per_w_m2;
  if (sum > 0) seen.indirect_extra_m = std::max(0.0, (way_e / sum - way_m) / 2);
}

// What the scene has besides opaque rough surfaces.
struct SceneTraits {
  bool has_smooth = false;
  double wander_m = 0;
  double extinction_per_m = 0;
};

bool scatters(const Material& material) {
  return material.interior && material.interior->scattering_per_m > 0;
}

SceneTraits traits_of(const Scene& scene) {
  SceneTraits traits;
  for (const Material& material : scene.materials) {
    traits.has_smooth = traits.has_smooth || has_delta(material.bsdf);
    if (!scatters(material)) continue;
    const Medium& body = *material.interior;
    const double reduced_per_m =
        body.absorption_per_m + body.scattering_per_m * (1 - mean_cosine(body.phase));
    traits.wander_m = std::max(traits.wander_m, 1 / reduced_per_m);
  }
  if (scene.medium)
    traits.extinction_per_m = scene.medium->absorption_per_m + scene.medium->scattering_per_m;
  return traits;
}

struct Outcome {
  std::optional<Seen> seen;
  bool met_smooth = false;
};

// Whether the laser's ray ends on something smooth, or its point is seen through something such.
bool meets_smooth(const LaserView& view, const SheetHit& lit) {
  if (!lit.is_hit) return false;
  const Scene& scene = view.caster.scene();
  if (has_delta(bsdf_at(scene, lit.hit.object, lit.hit.triangle, lit.hit.point))) return true;
  const Eigen::Vector3d eye = view.world_from_camera.translation();
  const auto first = view.caster.closest(eye, (lit.hit.point - eye).normalized());
  return first && has_delta(bsdf_at(scene, first->object, first->triangle, first->point));
}

Outcome follow(const LaserView& view, const LightTransport& transport, const SceneTraits& traits,
               double angle_rad, std::uint64_t index) {
  const SheetHit lit = view.shine(angle_rad, 0);
  Outcome outcome{see(view, lit), traits.has_smooth && meets_smooth(view, lit)};
  if (!outcome.seen) return outcome;
  outcome.seen->point.wander_m = traits.wander_m;
  outcome.seen->point.extinction_per_m = traits.extinction_per_m;
  trace_others(view, transport, index, *outcome.seen);
  return outcome;
}

PilotRay pilot_ray(const LaserLine& device, const Seen& seen) {
  const StripePoint& p = seen.point;
  PilotRay ray{.range_m = p.range_m,
               .sigma_m = noise_m(device, p),
               .signal_e = p.height_e,
               .incidence_rad = seen.incidence_rad,
               .range_spread_m = p.footprint_m,
               .indirect_share = p.indirect_share,
               .indirect_extra_m = seen.indirect_extra_m,
               .met_smooth = p.met_smooth};
  for (const Effect effect : all_effects())
    ray.left_out_m[static_cast<std::size_t>(effect)] = left_out_m(device, p, effect);
  return ray;
}

}  // namespace

std::vector<PilotRay> pilot(const LaserLine& scanner, const RayCaster& caster,
                            const Pose& world_from_scanner, int rays) {
  check(scanner);
  const LaserSheet sheet = laser_sheet(scanner);
  const std::vector<Pose> poses = scanner_from_camera(scanner);
  const LightTransport transport(caster, transport_options(EffectSet::all(), true));
  const SceneTraits traits = traits_of(caster.scene());
  const std::vector<Place> all = places(scanner, rays);
  std::vector<Outcome> outcomes(all.size());
  parallel_for(all.size(), [&](std::size_t i) {
    const LaserView view{scanner, sheet, caster, world_from_scanner * poses[all[i].step]};
    outcomes[i] = follow(view, transport, traits, all[i].angle_rad, i);
  });
  const bool met_smooth =
      std::any_of(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return o.met_smooth; });
  std::vector<PilotRay> found;
  for (Outcome& outcome : outcomes) {
    if (!outcome.seen) continue;
    outcome.seen->point.met_smooth = met_smooth;
    found.push_back(pilot_ray(scanner, *outcome.seen));
  }
  return found;
}

}  // namespace scan::synth
