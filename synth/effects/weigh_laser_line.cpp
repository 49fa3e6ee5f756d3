// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the pilot's rays say about each effect, and why an effect is absent.
#include <algorithm>
#include <cstdio>
#include <string>

#include "synth/effects/weight.h"

namespace scan::synth {
namespace {

bool scatters(const Material& material) {
  return material.interior && material.interior->scattering_per_m > 0;
}
template <class Test>
bool any_material(const Scene& scene, Test test) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [&](const Object& object) { return test(scene.materials[object.material]); });
}

bool is_smooth(const Material& material) {
  return has_delta(material.bsdf);
}
bool is_transparent(const Material& material) {
  return is_transmissive(material.bsdf) && !scatters(material);
}

bool has_other_light(const LaserLine& s, const Scene& scene) {
  return s.ambient_electrons > 0 || (s.electrons_per_w_m2 > 0 && !scene.lights.empty());
}

// Why a device or scene has nothing of the effect; empty if it has.
std::string why_absent(const LaserLine& s, const Scene& scene, Effect effect) {
  switch (effect) {
    case Effect::read_noise:
      return s.sensor.read_noise_e > 0 ? "" : "the sensor has no read noise";
    case Effect::blooming:
      return s.blooming_share > 0 ? "" : "full pixels spill into a drain";
    case Effect::mirror_reflection:
      return any_material(scene, is_smooth) ? "" : "nothing in the scene is smooth";
    case Effect::refraction:
      return any_material(scene, is_transparent) ? "" : "nothing in the scene is clear";
    case Effect::subsurface:
      return any_material(scene, scatters) ? "" : "nothing in the scene is translucent";
    case Effect::medium:
      return scene.medium ? "" : "the scene stands in vacuum";
    case Effect::scene_lights:
      return has_other_light(s, scene) ? "" : "only the laser shines";
    case Effect::footprint:
      return s.sub_rays > 1 ? "" : "a pixel is sampled at its centre";
    case Effect::beam_spread:
      return s.beam_quality > 0 ? "" : "the beam is equally thick everywhere";
    case Effect::plane_bow:
      return s.plane_bow_m != 0 ? "" : "the light plane is exactly plane";
    case Effect::speckle:
      return s.speckle_contrast > 0 ? "" : "the light is incoherent";
    case Effect::defocus:
      return s.aperture_m > 0 ? "" : "the camera is a pinhole";
    case Effect::miscalibration:
      return s.plane_shift_m != 0 || s.plane_turn_rad != 0 ? "" : "the calibration is exact";
    case Effect::motion:
      return s.exposure_share > 0 ? "" : "the stage stands still during an exposure";
    case Effect::vignetting:
    case Effect::rolling_shutter:
    case Effect::wiggling:
    case Effect::range_walk:
      return "a laser line has no " + std::string(name(effect));
    default:
      return "";
  }
}

std::string in_words(Effect effect, const PilotRay& worst) {
  char text[160];
  std::snprintf(text, sizeof text, "%s: up to %.3g mm at %.3g m, where sigma is %.3g mm",
                std::string(name(effect)).c_str(), worst.left_out_m[static_cast<int>(effect)] * 1e3,
                worst.range_m, worst.sigma_m * 1e3);
  return text;
}

}  // namespace

Weighed weigh(const LaserLine& scanner, const Scene& scene, Effect effect,
              std::span<const PilotRay> rays) {
  Weighed weighed;
  weighed.why_absent = why_absent(scanner, scene, effect);
  if (!weighed.why_absent.empty()) return weighed;
  if (rays.empty()) {
    weighed.why_absent = "no light of the laser comes back";
    return weighed;
  }
  const auto index = static_cast<std::size_t>(effect);
  Weight weight;
  const PilotRay* worst = &rays.front();
  for (const PilotRay& ray : rays) {
    weight.bound_m = std::max(weight.bound_m, ray.left_out_m[index]);
    weight.bound_sigma = std::max(weight.bound_sigma, ray.left_out_m[index] / ray.sigma_m);
    if (ray.left_out_m[index] > worst->left_out_m[index]) worst = &ray;
  }
  weight.why = in_words(effect, *worst);
  weighed.weight = weight;
  return weighed;
}

}  // namespace scan::synth
