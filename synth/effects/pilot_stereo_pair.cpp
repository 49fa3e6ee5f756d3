// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What each effect can do to a stereo pair's ranges, at some of its pixels.
//
// A change of the images moves a match by what stereo_windows.h says of it, to first order in the
// change, so r / d times a shift is the range's error; the pilot renders small windows of both
// images with an effect and without it. A shift u that is known for itself turns a parallax d into
// ranges r d / (d -+ u), by Z = f B / d. No match is looked for outside the search range; its far
// end may be infinitely far, and is taken as a parallax of one pixel.
#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "synth/effects/stereo_windows.h"
#include "synth/effects/weight.h"
#include "synth/scanners/stereo_optics.h"
#include "synth/scanners/stereo_paths.h"
#include "synth/scanners/surface_frame.h"

namespace scan::synth {
namespace {

constexpr int rays_per_window = 16;  // pilot rays are asked for by number; a window costs many
constexpr int paths_per_window = 64;
constexpr double smooth_sigma_px = 0.1;  // of what a smooth surface shows, which no window tells

double& left_out(PilotRay& ray, Effect effect) {
  return ray.left_out_m[static_cast<std::size_t>(effect)];
}

// A pixel of the pilot with all that its bounds need.
struct Spot {
  const StereoPair& s;
  const RayCaster& caster;
  const Pose& pose;
  int column, row;
  SeenSurface seen;

  double range_m() const { return seen.point.norm(); }
  double parallax_px() const {
    return s.calibration.focal_px * s.calibration.baseline_m / seen.point.z();
  }
  double m_per_px() const { return range_m() / parallax_px(); }  // of a small shift
  // A shift towards the far end counts more than one towards the near end.
  double bound_m(double shift_px) const {
    const StereoCalibration& c = s.calibration;
    const double first_px = c.min_disparity_px + c.doffs_px, d = parallax_px();
    const double last_px = first_px + c.disparities_px - 1;
    const double farther = std::min(shift_px, std::max(0.0, d - std::max(1.0, first_px)));
    const double nearer = std::min(shift_px, std::max(0.0, last_px - d));
    return range_m() * std::max(farther / (d - farther), nearer / (d + nearer));
  }
  double first_order_m(double shift_px) const {
    return std::min(shift_px * m_per_px(), anything_m());
  }
  double anything_m() const { return bound_m(HUGE_VAL); }

  WindowPair windows(const StereoPair& device) const {
    const double right_px = column - (parallax_px() - s.calibration.doffs_px);
    const double first = std::floor(right_px);
    return {
        .left = window_at(device, caster, pose, StereoSide::left, column, row),
        .right = window_at(device, caster, pose, StereoSide::right, static_cast<int>(first), row),
        .between = right_px - first};
  }
  const Material& material() const {
    const Scene& scene = caster.scene();
    return scene.materials[scene.objects[seen.hit.object].material];
  }
};

// Light of all kinds at a pixel, by a few paths.
struct PathLight {
  double total_e = 0;   // with fog, and all that comes over other surfaces
  double lights_e = 0;  // of the scene's lights
};

PathLight path_light(const Spot& spot, const LightTransport& transport) {
  struct Receiver {
    const StereoPair& s;
    PathLight light;
    void device_light(double e, double /*path_m*/, int /*scatterings*/) { light.total_e += e; }
    void other_light(double w_m2) {
      light.total_e += s.electrons_per_w_m2 * w_m2;
      light.lights_e += s.electrons_per_w_m2 * w_m2;
    }
    void ambient(double share) { light.total_e += s.ambient_electrons * share; }
  };
  Receiver receiver{spot.s, {}};
  const ProjectorLight projector(spot.s, spot.pose);
  const ScannerRay ray =
      calibrated_ray(spot.s.calibration, StereoSide::left, Eigen::Vector2d(spot.column, spot.row));
  const Ray view{.origin = spot.pose * ray.origin, .direction = spot.pose.linear() * ray.direction};
  SampleSequence random(1, 0xfffffffe, static_cast<std::uint64_t>(spot.column) << 32 | spot.row, 0);
  for (int i = 0; i < paths_per_window; ++i) {
    random.start(static_cast<std::uint32_t>(i));
    trace_path(transport, view, projector, random, receiver);
  }
  return {receiver.light.total_e / paths_per_window, receiver.light.lights_e / paths_per_window};
}

// How the surface's texture is lit. On a matt surface the scene's lights light it as ambient light
// does; a medium takes a share of what passes it and adds a veil without texture.
struct Lighting {
  double lights_e = 0;       // of the scene's lights, of a white surface
  double transmittance = 1;  // from surface to lens
  double veil_e = 0;         // what adds to the surface's own light

  StereoPair on(StereoPair s) const {
    s.ambient_electrons = transmittance * (s.ambient_electrons + lights_e);
    s.projector_electrons *= transmittance * transmittance;
    return s;
  }
};

Lighting lighting_of(const Spot& spot, const LightTransport* transport) {
  Lighting lighting;
  if (!transport) return lighting;
  const Scene& scene = spot.caster.scene();
  const PathLight light = path_light(spot, *transport);
  const SurfaceFrame surface(spot.seen, scene);
  const double albedo = surface.albedo(-spot.seen.point.normalized());
  if (scene.medium)
    lighting.transmittance = std::exp(-extinction_per_m(*scene.medium) * spot.range_m());
  lighting.lights_e = light.lights_e / std::max(lighting.transmittance * albedo, 0.01);
  const double own_e = expected_electrons(lighting.on(spot.s), spot.caster, spot.pose,
                                          StereoSide::left, spot.column, spot.row);
  lighting.veil_e = std::max(0.0, light.total_e - own_e);
  return lighting;
}

// 1 sigma of range on that window: both images are noisy.
double sigma_m(const Spot& spot, const StereoWindow& window, double veil_e) {
  const double noise_e = reading_noise_e(spot.s, window.centre() + veil_e);
  return spot.m_per_px() * noise_e * std::sqrt(2 / varying_slope_energy(window));
}

// How far the image of a point moves in the right camera by what the calibration does not know.
Eigen::Vector2d right_shift_px(const StereoPair& s, const Eigen::Vector3d& x) {
  const StereoPair ideal = with_effects(s, EffectSet::all().without(Effect::miscalibration));
  const auto seen_at = [&](const StereoPair& device) -> Eigen::Vector2d {
    const Eigen::Vector3d in_camera = scanner_from_camera(device, StereoSide::right).inverse() * x;
    return s.calibration.focal_px * in_camera.head<2>() / in_camera.z();
  };
  return seen_at(s) - seen_at(ideal);
}

void weigh_windows(const Spot& spot, const StereoPair& lit, const WindowPair& windows,
                   PilotRay& ray) {
  for (const Effect effect :
       {Effect::footprint, Effect::defocus, Effect::vignetting, Effect::motion}) {
    if (!has_effect(lit, effect)) continue;
    const StereoPair without = with_effects(lit, EffectSet::all().without(effect));
    left_out(ray, effect) = spot.first_order_m(change_px(windows, spot.windows(without)));
  }
}

void weigh_shifts(const Spot& spot, const StereoWindow& left, PilotRay& ray) {
  const Eigen::Vector3d& x = spot.seen.point;
  if (has_effect(spot.s, Effect::miscalibration)) {
    const Eigen::Vector2d shift = right_shift_px(spot.s, x).cwiseAbs();
    left_out(ray, Effect::miscalibration) = spot.bound_m(shift.x() + slope_ratio(left) * shift.y());
  }
  if (has_effect(spot.s, Effect::rolling_shutter)) {
    const double time_s =
        spot.s.row_time_s * std::abs(spot.row - (spot.s.calibration.height_px - 1) / 2.0);
    const double way_m = (moved(spot.s, time_s) * x - x).norm();
    left_out(ray, Effect::rolling_shutter) = way_m / std::max(std::cos(ray.incidence_rad), 0.05);
  }
}

// Light and fog move no match on a matt surface, but three sigmas change.
void weigh_light(const Spot& spot, const Lighting& lighting, PilotRay& ray) {
  const auto change_m = [&](const Lighting& other) {
    const StereoWindow window = window_at(other.on(spot.s), spot.caster, spot.pose,
                                          StereoSide::left, spot.column, spot.row);
    const double other_m = sigma_m(spot, window, other.veil_e);
    return std::min(3 * std::abs(ray.sigma_m - other_m), spot.anything_m());
  };
  Lighting dark = lighting, clear = lighting;
  dark.lights_e = 0;
  clear.transmittance = 1, clear.veil_e = 0;
  left_out(ray, Effect::scene_lights) = change_m(dark);
  left_out(ray, Effect::medium) = change_m(clear);
}

// A body's texture is seen where its light was scattered last, on the mean of a ray's places. The
// deepest mean is that of light that all comes from the depth: 1 / extinction times the second over
// the first moment of Milne's solution, whose light grows as depth + 0.7104 free paths
// (Chandrasekhar 1960, Radiative Transfer, III): (2 + 0.7104) / (1 + 0.7104) = 1.585.
double depth_m(const Material& material) {
  if (!material.interior || !(material.interior->scattering_per_m > 0)) return 0;
  return 1.585 / extinction_per_m(*material.interior);
}

// Gloss shows each camera another brightness, and what it mirrors may be all the texture there is:
// anything may come out, as from a mirror or clear body.
void weigh_gloss(const Spot& spot, PilotRay& ray) {
  const Bsdf& bsdf = spot.material().bsdf;
  if (std::holds_alternative<Lambert>(bsdf) || std::holds_alternative<OrenNayar>(bsdf)) return;
  left_out(ray, Effect::interreflection) = left_out(ray, Effect::scene_lights) = spot.anything_m();
  ray.met_smooth = has_delta(bsdf);
  if (ray.met_smooth)
    left_out(ray, Effect::mirror_reflection) = left_out(ray, Effect::refraction) =
        spot.anything_m();
}

// What there is to tell of any surface, whether or not it has a texture.
PilotRay look_at_surface(const Spot& spot) {
  PilotRay ray{.range_m = spot.range_m(), .sigma_m = smooth_sigma_px * spot.m_per_px()};
  ray.incidence_rad =
      std::acos(std::clamp(-spot.seen.normal.dot(spot.seen.point.normalized()), -1.0, 1.0));
  weigh_gloss(spot, ray);
  left_out(ray, Effect::subsurface) = depth_m(spot.material());
  return ray;
}

// False where the matcher finds nothing: both images are noisy, and less texture than noise gives
// no match.
bool look_at_texture(const Spot& spot, const LightTransport* transport, PilotRay& ray) {
  const Lighting lighting = lighting_of(spot, transport);
  const StereoPair lit = lighting.on(spot.s);
  const WindowPair windows = spot.windows(lit);
  ray.signal_e = windows.left.centre() + lighting.veil_e;
  const double noise_e = reading_noise_e(spot.s, ray.signal_e);
  if (!(varying_slope_energy(windows.left) > 2 * noise_e * noise_e)) return false;
  ray.sigma_m = sigma_m(spot, windows.left, lighting.veil_e);
  weigh_windows(spot, lit, windows, ray);
  weigh_shifts(spot, windows.left, ray);
  if (transport && ray.left_out_m[static_cast<std::size_t>(Effect::interreflection)] == 0)
    weigh_light(spot, lighting, ray);
  return true;
}

// None where nothing is to be seen or matched.
std::optional<PilotRay> look(const StereoPair& s, const RayCaster& caster, const Pose& pose,
                             const LightTransport* transport, int column, int row) {
  const auto seen =
      first_surface(caster, pose, calibrated_ray(s.calibration, StereoSide::left, {column, row}));
  if (!seen || !(seen->point.z() > 0)) return std::nullopt;
  const Spot spot{s, caster, pose, column, row, *seen};
  PilotRay ray = look_at_surface(spot);
  const bool shows_more = left_out(ray, Effect::interreflection) > 0 || ray.met_smooth ||
                          left_out(ray, Effect::subsurface) > 0;
  if (ray.met_smooth || look_at_texture(spot, transport, ray) || shows_more) return ray;
  return std::nullopt;
}

}  // namespace

std::vector<PilotRay> pilot(const StereoPair& scanner, const RayCaster& caster, const Pose& pose,
                            int rays) {
  const StereoCalibration& c = scanner.calibration;
  const int windows = std::max(16, rays / rays_per_window);
  const double stride = std::sqrt(1.0 * c.width_px * c.height_px / windows);
  const int columns = std::max(1, static_cast<int>(c.width_px / stride));
  const int rows = std::max(1, static_cast<int>(c.height_px / stride));
  std::optional<LightTransport> transport;
  if (caster.scene().medium || !caster.scene().lights.empty())
    transport.emplace(caster, transport_options(EffectSet::all(), false));
  std::vector<std::optional<PilotRay>> seen(static_cast<std::size_t>(columns) * rows);
  parallel_for(seen.size(), [&](std::size_t i) {
    const int column = static_cast<int>((i % columns + 0.5) * c.width_px / columns);
    const int row = static_cast<int>((i / columns + 0.5) * c.height_px / rows);
    seen[i] = look(scanner, caster, pose, transport ? &*transport : nullptr, column, row);
  });
  std::vector<PilotRay> found;
  for (const auto& ray : seen)
    if (ray) found.push_back(*ray);
  return found;
}

}  // namespace scan::synth
