// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The largest of each effect's bounds on a phase camera's ranges, and why; the bounds themselves
// are found by pilot_phase_camera.cpp.
#include <algorithm>
#include <cstdio>

#include "synth/effects/weight.h"

namespace scan::synth {
namespace {

// Half a sentence why nothing of the effect is in the scene; empty if something is.
std::string absent_in_scene(const PhaseCamera& s, const Scene& scene, Effect effect) {
  const auto none = [&](auto&& is) {
    return std::none_of(scene.materials.begin(), scene.materials.end(), is);
  };
  switch (effect) {
    case Effect::mirror_reflection:
      if (none([](const Material& m) { return has_delta(m.bsdf); }))
        return "no surface of the scene is smooth";
      break;
    case Effect::refraction:
      if (none([](const Material& m) { return is_transmissive(m.bsdf); }))
        return "nothing in the scene lets light through";
      break;
    case Effect::subsurface:
      if (none([](const Material& m) { return m.interior && m.interior->scattering_per_m > 0; }))
        return "no object scatters light inside";
      break;
    case Effect::medium:
      if (!scene.medium) return "the scene stands in clear air";
      break;
    case Effect::scene_lights:
      if (scene.lights.empty()) return "the scene has no lights";
      if (s.electrons_per_w_m2 == 0) return "the sensor does not respond to the scene's lights";
      break;
    default:
      break;
  }
  return {};
}

// The same of the device.
std::string absent_in_device(const PhaseCamera& s, Effect effect) {
  const bool still = s.velocity_m_s.isZero(0) && s.angular_velocity_rad_s.isZero(0);
  switch (effect) {
    case Effect::read_noise:
      return s.sensor.read_noise_e == 0 ? "the sensor reads without noise" : "";
    case Effect::footprint:
      return s.sub_rays > 1 ? "" : "a pixel is a single ray";
    case Effect::defocus:
      return s.aperture_m > 0 ? "" : "the aperture is a point";
    case Effect::vignetting:
      return s.vignetting > 0 ? "" : "the lens does not vignette";
    case Effect::miscalibration:
      return s.range_offset_m != 0 || s.pixel_offset_m > 0 ? "" : "the device is calibrated";
    case Effect::motion:
      return s.tap_interval_s > 0 && !still ? "" : "the camera stands still while it exposes";
    case Effect::wiggling:
      return s.harmonics.size() > 1 ? "" : "the modulation has no odd harmonics";
    case Effect::blooming:
    case Effect::beam_spread:
    case Effect::plane_bow:
    case Effect::speckle:
    case Effect::rolling_shutter:
    case Effect::range_walk:
      return "a phase camera has nothing of the kind";
    default:
      return {};
  }
}

std::string why(Effect effect, double bound_m, const PilotRay& worst) {
  char text[160];
  std::string_view cause;
  switch (effect) {
    case Effect::interreflection:
    case Effect::mirror_reflection:
    case Effect::refraction:
    case Effect::subsurface:
    case Effect::medium:
      if (worst.met_smooth && effect != Effect::interreflection)
        return "a smooth surface stands in the view";
      std::snprintf(text, sizeof text,
                    "indirect light is at most %.3g of the direct, %.3g m of way apart",
                    worst.indirect_share, worst.indirect_extra_m);
      return text;
    case Effect::footprint:
      std::snprintf(text, sizeof text, "ranges differ by up to %.3g mm within a pixel",
                    worst.range_spread_m * 1e3);
      return text;
    default:
      cause = name(effect);
  }
  std::snprintf(text, sizeof text, "%.*s moves the range by up to %.3g mm at %.3g m",
                static_cast<int>(cause.size()), cause.data(), bound_m * 1e3, worst.range_m);
  return text;
}

}  // namespace

Weighed weigh(const PhaseCamera& s, const Scene& scene, Effect effect,
              std::span<const PilotRay> rays) {
  std::string absent = absent_in_device(s, effect);
  if (absent.empty()) absent = absent_in_scene(s, scene, effect);
  if (!absent.empty()) return {.weight = std::nullopt, .why_absent = std::move(absent)};
  if (rays.empty()) return {.weight = std::nullopt, .why_absent = "the camera sees nothing"};
  Weight weight;
  const PilotRay* worst = &rays.front();
  for (const PilotRay& ray : rays) {
    const double bound_m = ray.left_out_m[static_cast<std::size_t>(effect)];
    if (bound_m > weight.bound_m) worst = &ray;
    weight.bound_m = std::max(weight.bound_m, bound_m);
    weight.bound_sigma = std::max(weight.bound_sigma, bound_m / ray.sigma_m);
  }
  weight.why = why(effect, weight.bound_m, *worst);
  return {.weight = weight, .why_absent = {}};
}

}  // namespace scan::synth
