// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What each effect can do to a pulsed lidar's ranges.
//
// The decoder fits a Gaussian of width w (in samples) to the W = 3 w + 2 samples on either side of
// an echo of N electrons. For shot noise the maximum-likelihood centre is the mean of the
// electrons' times in that window, and other weights pull less: a share a of further light, delayed
// by an extra one-way length x, moves the range by at most a x / (1 + a). The pilot finds a and x.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "synth/effects/weight.h"
#include "synth/scanners/pulsed_lidar_beam.h"
#include "synth/scanners/pulsed_lidar_noise.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
constexpr double sigmas = 3;  // of noise that counts as its bound

double left_out(const PilotRay& ray, Effect effect) {
  return ray.left_out_m[static_cast<int>(effect)];
}

template <class Bound>
Weighed largest(std::span<const PilotRay> rays, std::string why, const Bound& bound_m) {
  Weight weight{.why = std::move(why)};
  for (const PilotRay& ray : rays) {
    const double bound = bound_m(ray);
    weight.bound_m = std::max(weight.bound_m, bound);
    weight.bound_sigma = std::max(weight.bound_sigma, bound / ray.sigma_m);
  }
  return {weight, ""};
}

Weighed piloted(std::span<const PilotRay> rays, Effect effect, std::string why) {
  return largest(rays, std::move(why), [&](const PilotRay& ray) { return left_out(ray, effect); });
}

template <class... Numbers>
std::string text(const char* format, Numbers... numbers) {
  char line[160];
  std::snprintf(line, sizeof line, format, numbers...);
  return line;
}

// White noise of `variance_e2` as the decoder's fit passes it on: it weighs each sample by 1 / (v +
// m), m the echo and v the floor's variance, as is best for both noises together. The centre is sum
// w m' r / sum w m'^2 to first order in the residuals r.
double white_by_fit_m(const EchoNoise& echo, double floor_e2, double variance_e2) {
  const int window = static_cast<int>(echo.half_window_m() / echo.m_per_sample);
  double passed = 0, information = 0;
  for (int i = -window; i <= window; ++i) {
    const double u = i / echo.width, model_e = echo.height_e * std::exp(-u * u / 2);
    const double slope_e = model_e * u / echo.width, weight = 1 / (floor_e2 + model_e);
    passed += weight * weight * slope_e * slope_e;
    information += weight * slope_e * slope_e;
  }
  return echo.m_per_sample * std::sqrt(variance_e2 * passed) / information;
}

// Three sigma of what is random; rounding by half a step, in every sample the worst way.
Weighed weigh_noise(const PulsedLidar& s, Effect effect, std::span<const PilotRay> rays) {
  const auto of = [&](const PilotRay& ray) {
    return echo_noise(s, ray.signal_e * echo_noise(s, 1).width * std::sqrt(2 * pi));
  };
  if (effect == Effect::shot_noise)
    return largest(rays, "photons come by chance", [&](const PilotRay& ray) {
      return sigmas * of(ray).all_m(s.ambient_electrons);
    });
  if (effect == Effect::read_noise) {
    if (s.sensor.read_noise_e == 0) return {std::nullopt, "the sensor adds no noise"};
    return largest(rays, text("the sensor adds %.3g electrons", s.sensor.read_noise_e),
                   [&](const PilotRay& ray) {
                     return sigmas *
                            white_by_fit_m(of(ray), floor_variance_e2(s), read_variance_e2(s));
                   });
  }
  return largest(rays, text("a step is %.3g electrons", s.sensor.gain_e_per_dn),
                 [&](const PilotRay& ray) {
                   const EchoNoise noise = of(ray);
                   return noise.m_per_sample * 4 * noise.width / (std::sqrt(pi) * noise.height_e) *
                          s.sensor.gain_e_per_dn / 2;
                 });
}

bool any_material(const Scene& scene, bool (*is)(const Material&)) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [&](const Object& object) { return is(scene.materials[object.material]); });
}

bool is_mirror(const Material& material) {
  return has_delta(material.bsdf);
}
bool is_see_through(const Material& material) {
  return is_transmissive(material.bsdf);
}
bool is_translucent(const Material& material) {
  return is_transmissive(material.bsdf) && material.interior &&
         material.interior->scattering_per_m > 0;
}

// Behind a mirror or glass any range of the window may come out.
Weighed weigh_smooth(const PulsedLidar& s, bool there, const char* kind,
                     std::span<const PilotRay> rays) {
  if (!there) return {std::nullopt, text("the scene has no %s", kind)};
  return largest(rays, text("the scene has a %s", kind), [&](const PilotRay& ray) {
    return std::max(s.max_range_m - ray.range_m, ray.range_m - s.min_range_m);
  });
}

Weighed weigh_light(const PulsedLidar& s, const Scene& scene, Effect effect,
                    std::span<const PilotRay> rays) {
  switch (effect) {
    case Effect::interreflection:
      return piloted(rays, effect, "light comes over other surfaces as well");
    case Effect::mirror_reflection:
      return weigh_smooth(s, any_material(scene, is_mirror), "mirror", rays);
    case Effect::refraction:
      return weigh_smooth(s, any_material(scene, is_see_through), "clear body", rays);
    case Effect::subsurface:
      if (!any_material(scene, is_translucent))
        return {std::nullopt, "the scene has no translucent body"};
      return piloted(rays, effect, "light stays in translucent bodies for a while");
    case Effect::medium:
      if (!scene.medium) return {std::nullopt, "the air is clear"};
      return piloted(rays, effect,
                     text("the air takes %.3g of the light per metre",
                          scene.medium->absorption_per_m + scene.medium->scattering_per_m));
    default:
      if (scene.lights.empty() || s.electrons_per_w_m2 == 0)
        return {std::nullopt, "no other lights shine into the receiver"};
      return piloted(rays, effect, "other lights add noise");
  }
}

Weighed weigh_device(const PulsedLidar& s, Effect effect, std::span<const PilotRay> rays) {
  if (effect == Effect::footprint) {
    if (s.sub_rays == 1 || (s.divergence_rad == 0 && s.exit_radius_m == 0))
      return {std::nullopt, "the beam is a line"};
    return piloted(rays, effect,
                   text("the beam is %.3g mm wide at the exit and opens by %.3g mrad",
                        2e3 * s.exit_radius_m, 1e3 * s.divergence_rad));
  }
  if (effect == Effect::motion) {
    if (!is_moving(s)) return {std::nullopt, "the scanner stands still"};
    return piloted(rays, effect,
                   text("the scanner moves at %.3g m/s and turns by %.3g rad/s",
                        s.motion.velocity_m_s.norm(), s.motion.angular_velocity_rad_s.norm()));
  }
  if (s.range_walk.per_decade_s == 0)
    return {std::nullopt, "the detector's delay does not depend on the signal"};
  return piloted(rays, effect,
                 text("the delay changes by %.3g ns per decade of the signal",
                      1e9 * s.range_walk.per_decade_s));
}

}  // namespace

Weighed weigh(const PulsedLidar& scanner, const Scene& scene, Effect effect,
              std::span<const PilotRay> rays) {
  switch (effect) {
    case Effect::shot_noise:
    case Effect::read_noise:
    case Effect::quantisation:
      return weigh_noise(scanner, effect, rays);
    case Effect::interreflection:
    case Effect::mirror_reflection:
    case Effect::refraction:
    case Effect::subsurface:
    case Effect::medium:
    case Effect::scene_lights:
      return weigh_light(scanner, scene, effect, rays);
    case Effect::footprint:
    case Effect::motion:
    case Effect::range_walk:
      return weigh_device(scanner, effect, rays);
    case Effect::beam_spread:
      return {std::nullopt, "a lidar's divergence is in its footprint"};
    case Effect::rolling_shutter:
      return {std::nullopt, "pulses fired one after another are motion"};
    default:
      return {std::nullopt, "a pulsed lidar has no " + std::string(name(effect))};
  }
}

}  // namespace scan::synth
