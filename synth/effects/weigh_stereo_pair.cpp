// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What each effect can do to a stereo pair's ranges.
//
// The matcher fits the shift between two windows by least squares: a change e_i of the difference
// of the images moves it by sum(g e) / sum(g^2) with the slope g along the row (Lucas and Kanade
// 1981), which by Cauchy and Schwarz is at most sqrt(sum e^2 / sum g^2). The pilot renders small
// windows of both images with an effect and without it and takes this bound, to first order in the
// change; reaching it would take a change that follows the slope everywhere. Z = f B / d makes
// Z^2 / (f B) of a shift.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "libscan/core/parallel.h"
#include "synth/effects/weight.h"
#include "synth/scanners/stereo_optics.h"

namespace scan::synth {
namespace {

constexpr int half_px = 2;           // the matcher's window of 5 x 5
constexpr int rays_per_window = 16;  // pilot rays are asked for by number; a window costs many

// Mean electrons of the window about a pixel, one more pixel to each side of it in a row.
struct Window {
  std::array<std::array<double, 2 * half_px + 3>, 2 * half_px + 1> electrons{};

  double slope(int row, int column) const {  // 0 .. 2 half_px
    return (electrons[row][column + 2] - electrons[row][column]) / 2;
  }
};

Window window(const StereoPair& s, const RayCaster& caster, const Pose& pose, StereoSide side,
              int column, int row) {
  Window w;
  for (int j = 0; j < 2 * half_px + 1; ++j)
    for (int i = 0; i < 2 * half_px + 3; ++i)
      w.electrons[j][i] =
          expected_electrons(s, caster, pose, side, column + i - half_px - 1, row + j - half_px);
  return w;
}

double slope_energy(const Window& w) {
  double sum = 0;
  for (int j = 0; j < 2 * half_px + 1; ++j)
    for (int i = 0; i < 2 * half_px + 1; ++i) sum += w.slope(j, i) * w.slope(j, i);
  return sum;
}

// sqrt(sum e^2) of what the effect changes in the left window but not in the right one.
double change_e(const Window& left_with, const Window& left_without, const Window& right_with,
                const Window& right_without) {
  double sum = 0;
  for (int j = 0; j < 2 * half_px + 1; ++j)
    for (int i = 1; i < 2 * half_px + 2; ++i) {
      const double left = left_with.electrons[j][i] - left_without.electrons[j][i];
      const double right = right_with.electrons[j][i] - right_without.electrons[j][i];
      sum += (left - right) * (left - right);
    }
  return std::sqrt(sum);
}

// A pixel of the pilot with all that its bounds need.
struct Spot {
  const StereoPair& s;
  const RayCaster& caster;
  const Pose& pose;
  int column, row, right_column;
  double m_per_px;  // of range per pixel of disparity
  double slope_e2;

  Window left(const StereoPair& device) const {
    return window(device, caster, pose, StereoSide::left, column, row);
  }
  Window right(const StereoPair& device) const {
    return window(device, caster, pose, StereoSide::right, right_column, row);
  }
  double bound_m(double change) const { return m_per_px * change / std::sqrt(slope_e2); }
};

bool is_set(const StereoPair& s, Effect effect) {
  const bool moves = !s.velocity_m_s.isZero(0) || !s.angular_velocity_rad_s.isZero(0);
  switch (effect) {
    case Effect::footprint:
      return s.sub_rays > 1;
    case Effect::defocus:
      return s.aperture_m > 0;
    case Effect::vignetting:
      return s.vignetting > 0;
    case Effect::motion:
      return moves && s.exposure_s > 0;
    case Effect::rolling_shutter:
      return moves && s.row_time_s > 0;
    case Effect::miscalibration:
      return !s.right_rotation_error_rad.isZero(0) || !s.right_position_error_m.isZero(0);
    default:
      return false;
  }
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

// The window's slope down the columns over that along the rows: what a shift by a row costs.
double slope_ratio(const Window& w) {
  double down = 0;
  for (int j = 0; j < 2 * half_px; ++j)
    for (int i = 1; i < 2 * half_px + 2; ++i)
      down += std::pow(w.electrons[j + 1][i] - w.electrons[j][i], 2);
  return std::sqrt(down / std::max(slope_energy(w), 1e-300));
}

void weigh_windows(const Spot& spot, const Window& left, PilotRay& ray) {
  const Window right = spot.right(spot.s);
  for (const Effect effect :
       {Effect::footprint, Effect::defocus, Effect::vignetting, Effect::motion}) {
    if (!is_set(spot.s, effect)) continue;
    const StereoPair without = with_effects(spot.s, EffectSet::all().without(effect));
    ray.left_out_m[static_cast<int>(effect)] =
        spot.bound_m(change_e(left, spot.left(without), right, spot.right(without)));
  }
}

void weigh_shifts(const Spot& spot, const Window& left, const Eigen::Vector3d& x, PilotRay& ray) {
  if (is_set(spot.s, Effect::miscalibration)) {
    const Eigen::Vector2d shift = right_shift_px(spot.s, x).cwiseAbs();
    ray.left_out_m[static_cast<int>(Effect::miscalibration)] =
        spot.m_per_px * (shift.x() + slope_ratio(left) * shift.y());
  }
  if (is_set(spot.s, Effect::rolling_shutter)) {
    const double time_s =
        spot.s.row_time_s * std::abs(spot.row - (spot.s.calibration.height_px - 1) / 2.0);
    const double way_m = (moved(spot.s, time_s) * x - x).norm();
    ray.left_out_m[static_cast<int>(Effect::rolling_shutter)] =
        way_m / std::max(std::cos(ray.incidence_rad), 0.05);
  }
}

// None where the matcher finds nothing: no surface, no room for a window, no texture.
std::optional<PilotRay> look(const StereoPair& s, const RayCaster& caster, const Pose& pose,
                             int column, int row) {
  const StereoCalibration& c = s.calibration;
  const auto seen = first_surface(caster, pose, calibrated_ray(c, StereoSide::left, {column, row}));
  if (!seen || !(seen->point.z() > 0)) return std::nullopt;
  const double z_m = seen->point.z(), range_m = seen->point.norm();
  const Scene& scene = caster.scene();
  if (has_delta(bsdf_at(scene, seen->hit.object, seen->hit.triangle, seen->hit.point)))
    return PilotRay{.range_m = range_m,
                    .sigma_m = 0.1 * range_m * z_m / (c.focal_px * c.baseline_m),
                    .met_smooth = true};
  Spot spot{.s = s,
            .caster = caster,
            .pose = pose,
            .column = column,
            .row = row,
            .right_column = column - static_cast<int>(
                                         std::lround(c.focal_px * c.baseline_m / z_m - c.doffs_px)),
            .m_per_px = range_m * z_m / (c.focal_px * c.baseline_m),
            .slope_e2 = 0};
  const Window left = spot.left(s);
  spot.slope_e2 = slope_energy(left);
  const double signal_e = left.electrons[half_px][half_px + 1];
  const double noise_e2 = signal_e + s.sensor.read_noise_e * s.sensor.read_noise_e +
                          s.sensor.gain_e_per_dn * s.sensor.gain_e_per_dn / 12;
  // both images are noisy; less texture than noise gives no match
  if (!(spot.slope_e2 > 2 * noise_e2)) return std::nullopt;
  PilotRay ray{.range_m = range_m,
               .sigma_m = spot.m_per_px * std::sqrt(2 * noise_e2 / spot.slope_e2),
               .signal_e = signal_e,
               .incidence_rad =
                   std::acos(std::clamp(-seen->normal.dot(seen->point.normalized()), -1.0, 1.0))};
  const double windows_e = std::sqrt((2.0 * half_px + 1) * (2 * half_px + 1)) * signal_e;
  ray.left_out_m[static_cast<int>(Effect::interreflection)] = spot.bound_m(windows_e);
  weigh_windows(spot, left, ray);
  weigh_shifts(spot, left, seen->point, ray);
  return ray;
}

Weighed weigh_noise(const StereoPair& s, Effect effect, std::span<const PilotRay> rays) {
  Weight weight;
  for (const PilotRay& ray : rays) {
    const double step_e2 = s.sensor.gain_e_per_dn * s.sensor.gain_e_per_dn / 12;
    const double read_e2 = s.sensor.read_noise_e * s.sensor.read_noise_e;
    const double part_e2 = effect == Effect::shot_noise ? ray.signal_e : read_e2;
    const double share = 3 * std::sqrt(part_e2 / (ray.signal_e + read_e2 + step_e2));
    weight.bound_sigma = std::max(weight.bound_sigma, share);
    weight.bound_m = std::max(weight.bound_m, share * ray.sigma_m);
  }
  weight.why = effect == Effect::shot_noise ? "photons come by chance" : "the sensor adds noise";
  return {weight, ""};
}

Weighed weigh_measured(Effect effect, std::span<const PilotRay> rays, const char* why) {
  Weight weight{.why = why};
  for (const PilotRay& ray : rays) {
    const double bound_m = ray.left_out_m[static_cast<int>(effect)];
    weight.bound_m = std::max(weight.bound_m, bound_m);
    weight.bound_sigma = std::max(weight.bound_sigma, bound_m / ray.sigma_m);
  }
  return {weight, ""};
}

// Behind a mirror or glass stands something else than where it seems: any range may come out.
Weighed weigh_smooth(std::span<const PilotRay> rays, bool there, const char* kind) {
  if (!there) return {std::nullopt, std::string("the scene has no ") + kind};
  Weight weight{.why = std::string("the cameras see a ") + kind};
  double nearest_m = 1e300, farthest_m = 0;
  for (const PilotRay& ray : rays) {
    nearest_m = std::min(nearest_m, ray.range_m);
    farthest_m = std::max(farthest_m, ray.range_m);
  }
  for (const PilotRay& ray : rays) {
    if (!ray.met_smooth) continue;
    weight.bound_m = std::max(farthest_m - nearest_m, ray.range_m);
    weight.bound_sigma = std::max(weight.bound_sigma, weight.bound_m / ray.sigma_m);
  }
  if (weight.bound_m == 0) return {std::nullopt, std::string("no camera sees a ") + kind};
  return {weight, ""};
}

template <class Kind>
bool any_of_kind(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    return std::holds_alternative<Kind>(scene.materials[object.material].bsdf);
  });
}

bool is_translucent(const Material& material) {
  return material.interior && material.interior->scattering_per_m > 0;
}

// Light that comes over other surfaces, or out of the depth of a body, brightens a matt place alike
// for both cameras, so it moves no match; gloss shows each camera another brightness, up to all of
// the indirect light, which is not more than the light that there is.
Weighed weigh_indirect(const StereoPair& s, const Scene& scene, std::span<const PilotRay> rays) {
  if (s.projector_electrons == 0 && scene.lights.empty())
    return {std::nullopt, "uniform ambient light is all that there is"};
  if (!any_of_kind<Conductor>(scene) && !any_of_kind<Plastic>(scene) &&
      !any_of_kind<Dielectric>(scene))
    return {std::nullopt, "matt surfaces look alike to both cameras, however they are lit"};
  Weight weight{.why = "light from other surfaces is reflected glossily"};
  for (const PilotRay& ray : rays) {
    weight.bound_m =
        std::max(weight.bound_m, ray.left_out_m[static_cast<int>(Effect::interreflection)]);
    weight.bound_sigma = std::max(weight.bound_sigma, weight.bound_m / ray.sigma_m);
  }
  return {weight, ""};
}

// Brightness and texture come from the lights, so with the noise the whole match depends on them.
Weighed weigh_lights(const Scene& scene, std::span<const PilotRay> rays) {
  if (scene.lights.empty()) return {std::nullopt, "the scene has no lights of its own"};
  Weight weight{.bound_sigma = 3, .why = "the scene's lights make a part of the images"};
  for (const PilotRay& ray : rays) weight.bound_m = std::max(weight.bound_m, 3 * ray.sigma_m);
  return {weight, ""};
}

// Airlight over the signal is a veil without texture: it adds noise, not shift, but a share of the
// light is lost.
Weighed weigh_medium(const Scene& scene, std::span<const PilotRay> rays) {
  if (!scene.medium) return {std::nullopt, "the scene stands in clear air"};
  const double per_m = scene.medium->absorption_per_m + scene.medium->scattering_per_m;
  Weight weight{.why = "the medium takes light on its way"};
  for (const PilotRay& ray : rays) {
    const double share = 1 - std::exp(-per_m * ray.range_m);
    weight.bound_sigma = std::max(weight.bound_sigma, 3 * share);
    weight.bound_m = std::max(weight.bound_m, 3 * share * ray.sigma_m);
  }
  return {weight, ""};
}

}  // namespace

std::vector<PilotRay> pilot(const StereoPair& scanner, const RayCaster& caster, const Pose& pose,
                            int rays) {
  const StereoCalibration& c = scanner.calibration;
  const int windows = std::max(16, rays / rays_per_window);
  const double stride = std::sqrt(1.0 * c.width_px * c.height_px / windows);
  const int columns = std::max(1, static_cast<int>(c.width_px / stride));
  const int rows = std::max(1, static_cast<int>(c.height_px / stride));
  std::vector<std::optional<PilotRay>> seen(static_cast<std::size_t>(columns) * rows);
  parallel_for(seen.size(), [&](std::size_t i) {
    const int column = static_cast<int>((i % columns + 0.5) * c.width_px / columns);
    const int row = static_cast<int>((i / columns + 0.5) * c.height_px / rows);
    seen[i] = look(scanner, caster, pose, column, row);
  });
  std::vector<PilotRay> found;
  for (const auto& ray : seen)
    if (ray) found.push_back(*ray);
  return found;
}

Weighed weigh(const StereoPair& s, const Scene& scene, Effect effect,
              std::span<const PilotRay> rays) {
  const auto measured = [&](const char* why, const char* why_absent) -> Weighed {
    if (!is_set(s, effect)) return {std::nullopt, why_absent};
    return weigh_measured(effect, rays, why);
  };
  switch (effect) {
    case Effect::shot_noise:
    case Effect::read_noise:
      return weigh_noise(s, effect, rays);
    case Effect::quantisation:
      return {std::nullopt, "the images have 8 bits whatever else is simulated"};
    case Effect::footprint:
      return measured("the texture is finer than a pixel here and there",
                      "a pixel is one ray by the recipe");
    case Effect::defocus:
      return measured("the lenses blur edges out of focus", "the lenses are pinholes");
    case Effect::vignetting:
      return measured("the images darken towards their corners", "the lenses do not vignette");
    case Effect::motion:
      return measured("the pair moves while a row is exposed", "nothing moves during an exposure");
    case Effect::rolling_shutter:
      return measured("the pair moves from row to row", "all rows see the same instant");
    case Effect::miscalibration:
      return measured("the right camera is not where the calibration says",
                      "the cameras are as calibrated");
    case Effect::interreflection:
      return weigh_indirect(s, scene, rays);
    case Effect::mirror_reflection:
      return weigh_smooth(rays, any_of_kind<Conductor>(scene), "mirror");
    case Effect::refraction:
      return weigh_smooth(rays,
                          std::any_of(scene.materials.begin(), scene.materials.end(), is_clear),
                          "clear body");
    case Effect::subsurface:
      if (std::none_of(scene.materials.begin(), scene.materials.end(), is_translucent))
        return {std::nullopt, "no body is translucent"};
      return weigh_indirect(s, scene, rays);
    case Effect::medium:
      return weigh_medium(scene, rays);
    case Effect::scene_lights:
      return weigh_lights(scene, rays);
    default:
      return {std::nullopt, "a stereo pair has nothing of the kind"};
  }
}

}  // namespace scan::synth
