// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The largest of each effect's bounds on a stereo pair's ranges, and why; the bounds themselves are
// found by pilot_stereo_pair.cpp.
#include <algorithm>
#include <cmath>

#include "synth/effects/weight.h"
#include "synth/scanners/stereo_optics.h"

namespace scan::synth {
namespace {

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
    const double bound_m = ray.left_out_m[static_cast<std::size_t>(effect)];
    weight.bound_m = std::max(weight.bound_m, bound_m);
    weight.bound_sigma = std::max(weight.bound_sigma, bound_m / ray.sigma_m);
  }
  return {weight, ""};
}

// Half sentences if the device has something of the effect and if it has not.
struct Words {
  const char* why;
  const char* why_absent;
};
Words device_words(Effect effect) {
  switch (effect) {
    case Effect::footprint:
      return {"the texture is finer than a pixel here and there",
              "a pixel is one ray by the recipe"};
    case Effect::defocus:
      return {"the lenses blur edges out of focus", "the lenses are pinholes"};
    case Effect::vignetting:
      return {"the images darken towards their corners", "the lenses do not vignette"};
    case Effect::motion:
      return {"the pair moves while a row is exposed", "nothing moves during an exposure"};
    case Effect::rolling_shutter:
      return {"the pair moves from row to row", "all rows see the same instant"};
    case Effect::miscalibration:
      return {"the right camera is not where the calibration says",
              "the cameras are as calibrated"};
    default:
      return {"", "a stereo pair has nothing of the kind"};
  }
}

// Half a sentence why the scene has nothing of the effect; empty if it has.
std::string absent_in_scene(const StereoPair& s, const Scene& scene, Effect effect) {
  const auto none = [&](auto&& is) {
    return std::none_of(scene.objects.begin(), scene.objects.end(),
                        [&](const Object& object) { return is(scene.materials[object.material]); });
  };
  switch (effect) {
    case Effect::interreflection:
      // light over other surfaces brightens a matt place alike for both cameras
      if (s.projector_electrons == 0 && scene.lights.empty())
        return "uniform ambient light is all that there is";
      if (none([](const Material& m) {
            return !std::holds_alternative<Lambert>(m.bsdf) &&
                   !std::holds_alternative<OrenNayar>(m.bsdf);
          }))
        return "matt surfaces look alike to both cameras, however they are lit";
      break;
    case Effect::mirror_reflection:
      if (none([](const Material& m) { return has_delta(m.bsdf); }))
        return "no surface of the scene is smooth";
      break;
    case Effect::refraction:
      if (none(is_clear)) return "the scene has no clear body";
      break;
    case Effect::subsurface:
      if (none([](const Material& m) { return m.interior && m.interior->scattering_per_m > 0; }))
        return "no body is translucent";
      break;
    case Effect::medium:
      if (!scene.medium) return "the scene stands in clear air";
      break;
    case Effect::scene_lights:
      if (scene.lights.empty()) return "the scene has no lights of its own";
      break;
    default:
      break;
  }
  return {};
}

const char* why_in_scene(Effect effect) {
  switch (effect) {
    case Effect::interreflection:
      return "light from other surfaces is reflected glossily";
    case Effect::mirror_reflection:
    case Effect::refraction:
      return "the cameras see a mirror or a clear body";
    case Effect::subsurface:
      return "the cameras see into a translucent body";
    case Effect::medium:
      return "the medium takes light on its way and adds a veil";
    default:
      return "the scene's lights make a part of the images";
  }
}

}  // namespace

Weighed weigh(const StereoPair& s, const Scene& scene, Effect effect,
              std::span<const PilotRay> rays) {
  switch (effect) {
    case Effect::shot_noise:
    case Effect::read_noise:
      return weigh_noise(s, effect, rays);
    case Effect::quantisation:
      return {std::nullopt, "the images have 8 bits whatever else is simulated"};
    case Effect::interreflection:
    case Effect::mirror_reflection:
    case Effect::refraction:
    case Effect::subsurface:
    case Effect::medium:
    case Effect::scene_lights: {
      std::string absent = absent_in_scene(s, scene, effect);
      if (!absent.empty()) return {std::nullopt, std::move(absent)};
      Weighed weighed = weigh_measured(effect, rays, why_in_scene(effect));
      if (weighed.weight->bound_m == 0) return {std::nullopt, "the cameras see nothing of it"};
      return weighed;
    }
    default: {
      const Words words = device_words(effect);
      if (!has_effect(s, effect)) return {std::nullopt, words.why_absent};
      return weigh_measured(effect, rays, words.why);
    }
  }
}

}  // namespace scan::synth
