// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The pilot follows the laser's light to the surface and into the camera, as the truth does; each
// effect's error is then a closed form there (laser_line_errors.h).
#include <algorithm>
#include <cmath>
#include <limits>

#include "synth/effects/convex.h"
#include "synth/effects/laser_line_errors.h"
#include "synth/effects/pilot_rounds.h"
#include "synth/effects/stripe_light.h"

namespace scan::synth {
namespace {

constexpr int steps_of_pilot = 24;
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

// What a pilot shares among its rays.
struct PilotScan {
  const LaserLine& scanner;
  const Scene& scene;  // as it is
  const RayCaster&
      opaque;              // translucent bodies are Lambert surfaces: what they do is a closed form
  const RayCaster& solid;  // besides, without clear bodies, behind which there is something
  const LaserSheet sheet;
  const LightTransport transport;  // in `opaque`
  const bool has_smooth;           // a mirror or clear body, which may show a ghost anywhere
};

// The stripe's point as its tangent plane shows it.
struct Seen {
  StripePoint point;
  CameraRay ray;
  double incidence_rad = 0;
  StripeLight light;
};

// Where the view of a pixel meets the tangent plane.
Eigen::Vector3d on_tangent(const LaserView& view, const SheetHit& lit,
                           const Eigen::Vector2d& pixel) {
  const auto ray = ray_through(view.scanner.camera, pixel);
  if (!ray) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::Vector3d normal = view.world_from_camera.linear().transpose() * lit.hit.normal;
  return normal.dot(lit.x_in_camera) / normal.dot(*ray) * *ray;
}

// On the calibrated plane, along the view; infinite beyond its horizon.
double range_on_plane_m(const LaserView& view, const Eigen::Vector2d& pixel) {
  const auto ray = ray_through(view.scanner.camera, pixel);
  if (!ray) return 0;
  const double depth_m = view.sheet.offset_m / view.sheet.normal.dot(*ray);
  return depth_m > 0 ? depth_m * ray->norm() : std::numeric_limits<double>::infinity();
}

// By differences over half a pixel to each side.
void measure(const LaserView& view, const SheetHit& lit, Seen& seen) {
  const Eigen::Vector2d half(0.5, 0);
  const Eigen::Vector3d left = on_tangent(view, lit, lit.pixel - half);
  const Eigen::Vector3d right = on_tangent(view, lit, lit.pixel + half);
  seen.point.px_per_m = 1 / std::abs(view.sheet.normal.dot(right - left));
  const auto on_plane = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return view.sheet.offset_m / view.sheet.normal.dot(x) * x;
  };
  seen.point.m_per_px = std::abs(seen.ray.direction.dot(on_plane(right) - on_plane(left)));
  const LaserLine& s = view.scanner;
  for (const double column : {0.0, s.camera.width_px - 1.0}) {
    const double range_m =
        std::clamp(range_on_plane_m(view, {column, lit.pixel.y()}), s.min_range_m, s.max_range_m);
    seen.point.rest_of_view_m =
        std::max(seen.point.rest_of_view_m, std::abs(range_m - seen.point.range_m));
  }
}

// Where views of the window's pixels leave the tangent plane.
void look_around(const LaserView& view, const SheetHit& lit, double reach_px, Seen& seen) {
  const Scene& scene = view.caster.scene();
  const auto colour = [&](const Hit& hit) {
    return albedo(bsdf_at(scene, hit.object, hit.triangle, hit.point), Eigen::Vector3d::UnitZ());
  };
  const double own = colour(lit.hit);
  for (const double column : {-reach_px, -0.5, 0.0, 0.5, reach_px})
    for (const double row : {-0.5, 0.5}) {
      const Eigen::Vector2d pixel = lit.pixel + Eigen::Vector2d(column, row);
      const Eigen::Vector3d flat = on_tangent(view, lit, pixel);
      if (!std::isfinite(flat.norm())) continue;
      const auto met = view.caster.closest(view.world_from_camera.translation(),
                                           view.world_from_camera.linear() * flat.normalized());
      const double off_m = met ? std::abs(met->distance_m - flat.norm()) : seen.point.range_m;
      seen.point.step_m = std::max(seen.point.step_m, off_m);
      seen.point.near_edge |=
          !met || met->object != lit.hit.object || std::abs(colour(*met) - own) > 0.01 * own;
    }
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
  if (!(seen.point.height_e > 0) || !std::isfinite(seen.point.rest_of_view_m) ||
      !(stripe_sigma_px(seen.point) < widest_px))
    return std::nullopt;
  return seen;
}

// Bodies and fog, and the light of a few paths.
void weigh_light(const PilotScan& scan, const LaserView& view, const SheetHit& lit,
                 std::uint64_t index, bool with_paths, Seen& seen) {
  StripePoint& p = seen.point;
  const Scene& scene = scan.scene;
  const Eigen::Vector3d in = (lit.x_in_camera - scan.sheet.origin).normalized();
  const double cosine = lit.hit.normal.dot(view.world_from_camera.linear() * in);
  const Material& material = scene.materials[view.caster.scene().objects[lit.hit.object].material];
  const Wander wander = wander_in(material, std::sqrt(std::max(0.0, 1 - cosine * cosine)));
  p.met_smooth = scan.has_smooth;
  p.wander_m = wander.mean_m;
  p.spread_m = wander.spread_m;
  if (scene.medium) {
    p.veil_e = veil_e(view, *scene.medium, seen.ray, lit.x_in_camera);
    p.lost_in_fog = extinction_per_m(*scene.medium) * (p.range_m + p.from_laser_m);
  }
  const double window = window_px(stripe_sigma_px(p));
  look_around(view, lit, window, seen);
  if (!with_paths || light_meets_once(scene, view.world_from_camera.translation())) return;
  const LaserView whole_view{scan.scanner, scan.sheet, scan.opaque, view.world_from_camera};
  seen.light = stripe_light(whole_view, scan.transport, lit.pixel, window, index);
  p.uneven_e = seen.light.uneven_e;
  p.elsewhere_e = seen.light.elsewhere_e;
  p.other_e += seen.light.others_e;
}

PilotRay pilot_ray(const LaserLine& device, const Seen& seen) {
  const StripePoint& p = seen.point;
  PilotRay ray{.range_m = p.range_m,
               .sigma_m = noise_m(device, p),
               .signal_e = p.height_e,
               .incidence_rad = seen.incidence_rad,
               .range_spread_m = p.step_m,
               .indirect_share = seen.light.share_e / p.height_e,
               .indirect_extra_m = seen.light.extra_m,
               .met_smooth = p.met_smooth};
  for (const Effect effect : all_effects())
    ray.left_out_m[static_cast<std::size_t>(effect)] = left_out_m(device, p, effect);
  return ray;
}

// Where nothing is seen behind clear bodies, these themselves.
std::optional<PilotRay> follow(const PilotScan& scan, const Pose& world_from_camera,
                               double angle_rad, std::uint64_t index, bool with_paths) {
  for (const RayCaster* caster : {&scan.solid, &scan.opaque}) {
    const LaserView view{scan.scanner, scan.sheet, *caster, world_from_camera};
    const SheetHit lit = view.shine(angle_rad, 0);
    std::optional<Seen> seen = see(view, lit);
    if (!seen) continue;
    weigh_light(scan, view, lit, index, with_paths, *seen);
    return pilot_ray(scan.scanner, *seen);
  }
  return std::nullopt;
}

template <class Test>
bool any_object(const Scene& scene, Test test) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [&](const Object& object) { return test(scene.materials[object.material]); });
}

}  // namespace

std::vector<PilotRay> pilot(const LaserLine& scanner, const RayCaster& caster,
                            const Pose& world_from_scanner, int rays) {
  check(scanner);
  const Scene& scene = caster.scene();
  std::optional<RayCaster> opaque, solid;  // where they differ from the scene
  if (any_object(scene, [](const Material& m) { return m.interior.has_value(); }))
    opaque.emplace(simplified(scene, EffectSet::all().without(Effect::subsurface)));
  if (any_object(scene, is_clear))
    solid.emplace(without_clear_objects(opaque ? opaque->scene() : scene));
  const RayCaster& lit = opaque ? *opaque : caster;
  const PilotScan scan{
      .scanner = scanner,
      .scene = scene,
      .opaque = lit,
      .solid = solid ? *solid : lit,
      .sheet = laser_sheet(scanner),
      .transport = LightTransport(lit, transport_options(EffectSet::all(), true)),
      .has_smooth = any_object(scene, [](const Material& m) { return has_delta(m.bsdf); })};
  const std::vector<Pose> poses = scanner_from_camera(scanner);
  const std::vector<Place> all = places(scanner, rays);
  EffectSet by_paths = {Effect::interreflection};
  by_paths.set(Effect::scene_lights, scanner.electrons_per_w_m2 > 0 && !scene.lights.empty());
  return look_in_rounds(all.size(), by_paths, [&](std::size_t i, bool with_paths) {
    return follow(scan, world_from_scanner * poses[all[i].step], all[i].angle_rad, i, with_paths);
  });
}

}  // namespace scan::synth
