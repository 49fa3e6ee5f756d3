// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What each effect can do to a phase camera's ranges.
//
// A phase phi_f is a range phi_f / kappa_f, kappa_f = 4 pi f / c. With equal amplitudes the decoder
// weighs the frequencies by kappa_f^2, so phases off by beta_f move the range by
// sum(kappa_f beta_f) / sum(kappa_f^2). That a wrong number of wraps is taken is left out: where
// frequencies disagree the decoder gives no point.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "libscan/core/parallel.h"
#include "libscan/core/units.h"
#include "synth/effects/convex.h"
#include "synth/effects/weight.h"
#include "synth/scanners/phase_paths.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
constexpr int paths_per_ray = 64;
constexpr int paths_per_lone_ray = 1;    // where all light is direct
constexpr double no_direct_light = 1e6;  // indirect share where there is indirect light alone

double kappa(double frequency_hz) {
  return 4 * pi * frequency_hz / speed_of_light_m_s;
}

// Range error of phases off by phase_error(kappa_f).
template <class PhaseError>
double range_m(const PhaseCamera& s, PhaseError&& phase_error) {
  double sum = 0, weights = 0;
  for (const double frequency_hz : s.frequencies_hz) {
    const double k = kappa(frequency_hz);
    sum += k * phase_error(k);
    weights += k * k;
  }
  return sum / weights;
}

double arc_sine(double x) {
  return x < 1 ? std::asin(x) : pi;
}

// A pixel of the pilot with what its bounds need.
struct Spot {
  const PhaseCamera& s;
  const RayCaster& caster;
  const Pose& world_from_scanner;
  Eigen::Vector2d place;
  double constant_e = 0;  // with light of all kinds
  double own_e = 0;       // the device's direct light

  double amplitude_e() const { return s.contrast * own_e; }
  // 1 sigma of range by that variance of each tap: var(phi) = variance / (2 A^2) (Lange 2000), over
  // the frequencies together by the root of sum(kappa_f^2).
  double sigma_m(double variance_e2) const {
    double squares = 0;
    for (const double frequency_hz : s.frequencies_hz) squares += std::pow(kappa(frequency_hz), 2);
    return std::sqrt(variance_e2 / 2) / amplitude_e() / std::sqrt(squares);
  }
};

double& left_out(PilotRay& ray, Effect effect) {
  return ray.left_out_m[static_cast<std::size_t>(effect)];
}

// Noise: three of its own sigmas. Rounding moves each tap by half a step at most, so the phasor of
// length 2 A by a step in each component: asin(sqrt(2) step / (2 A)).
void weigh_noise(const Spot& spot, PilotRay& ray) {
  const Sensor& sensor = spot.s.sensor;
  left_out(ray, Effect::shot_noise) = 3 * spot.sigma_m(spot.constant_e);
  left_out(ray, Effect::read_noise) = 3 * spot.sigma_m(std::pow(sensor.read_noise_e, 2));
  const double angle = arc_sine(sensor.gain_e_per_dn / (std::sqrt(2) * spot.amplitude_e()));
  left_out(ray, Effect::quantisation) = range_m(spot.s, [&](double) { return angle; });
}

// Indirect light of share a of the direct, extra lengths x_i, psi_i = kappa |x_i|: the phasor's
// angle theta obeys sum a_i sin(psi_i - theta) = sin(theta); sin(psi - theta) <= psi - sin(theta)
// for psi >= 0, so sin(theta) <= a mean(psi) / (1 + a), for any distribution of lengths; and
// sin(theta)
// <= a, the tangent to the circle of radius a (physics: bias a Delta / (1 + a) for small psi).
void weigh_indirect(const Spot& spot, PilotRay& ray) {
  const double a = ray.indirect_share;
  const double bound_m = range_m(spot.s, [&](double k) {
    return arc_sine(std::min(a, a / (1 + a) * k * ray.indirect_extra_m));
  });
  for (const Effect effect : {Effect::interreflection, Effect::mirror_reflection,
                              Effect::refraction, Effect::subsurface, Effect::medium})
    left_out(ray, effect) = bound_m;
  if (!ray.met_smooth) return;
  // the range of what is seen in the mirror or behind the glass: anything
  left_out(ray, Effect::mirror_reflection) = spot.s.max_range_m;
  left_out(ray, Effect::refraction) = spot.s.max_range_m;
}

// Ranges and lengths between the lens and what the rays at those places see, largest less smallest.
template <class Views>
double spread_m(const Spot& spot, const Views& views) {
  double least = 1e300, most = -1e300;
  for (const std::optional<LensRay>& view : views) {
    if (!view) continue;
    const auto seen = first_surface(spot.caster, spot.world_from_scanner, view->ray);
    if (!seen) continue;  // no light, no change of phase
    const double length_m = seen->hit.distance_m + view->extra_m;
    least = std::min(least, length_m);
    most = std::max(most, length_m);
  }
  return std::max(0.0, most - least);
}

// The sum of phasors whose arguments span less than pi has its own within that span; if they span
// more it may be anywhere.
double mixed_m(const PhaseCamera& s, double spread) {
  return range_m(s, [&](double k) { return std::min(pi, k * spread); });
}

// What is seen through the corners of the pixel, and besides through the rim of the lens.
void weigh_blur(const Spot& spot, PilotRay& ray) {
  const PhaseCamera& s = spot.s;
  std::vector<std::optional<LensRay>> pixel, lens;
  PhaseCamera sharp = s;
  sharp.aperture_m = 0;
  for (const auto& [x, y] : {std::pair(0, 0), {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
    const Eigen::Vector2d corner = spot.place + 0.5 * Eigen::Vector2d(x, y);
    if (s.sub_rays > 1) pixel.push_back(lens_ray(sharp, corner, {0, 0}));
    if (s.aperture_m == 0) continue;
    lens.push_back(lens_ray(s, corner, std::sqrt(0.5) * Eigen::Vector2d(x, y)));
    lens.push_back(lens_ray(s, corner, Eigen::Vector2d(x, 0)));
    lens.push_back(lens_ray(s, corner, Eigen::Vector2d(0, y)));
  }
  ray.range_spread_m = spread_m(spot, pixel);
  left_out(ray, Effect::footprint) = mixed_m(s, ray.range_spread_m);
  left_out(ray, Effect::defocus) = mixed_m(s, spread_m(spot, lens));
}

// Vignetting moves no range; without it the signal is stronger and three sigmas are smaller.
void weigh_vignetting(const Spot& spot, PilotRay& ray) {
  const PhaseCamera& s = spot.s;
  const auto view = lens_ray(s, spot.place, {0, 0});
  const double share = view ? view->share : 1;
  const double fixed_e2 = tap_variance_e2(s.sensor, spot.constant_e) - spot.constant_e;
  const double open_m = share * spot.sigma_m(std::max(0.0, fixed_e2) + spot.constant_e / share);
  left_out(ray, Effect::vignetting) = std::max(0.0, 3 * (ray.sigma_m - open_m));
}

// A range that changes by u m/s and light that changes by the factor g per second, over taps T
// apart; the time t_f in the middle of the four of a frequency. In (C3 - C1, C0 - C2) of length 2
// A: the phase at t_f, kappa u t_f; half of kappa u T, since the two differences' middles are T
// apart; g T / 2 by their amplitudes, likewise; and g T B in each of I and Q for taps of a
// difference are 2 T apart, sqrt(2) g T B / A in angle, B = A / contrast of the device's own light.
void weigh_motion(const Spot& spot, PilotRay& ray) {
  const PhaseCamera& s = spot.s;
  const double slope = std::tan(std::min(ray.incidence_rad, 1.5));
  const double turn = s.angular_velocity_rad_s.norm(), speed = s.velocity_m_s.norm();
  const double u = speed / std::cos(std::min(ray.incidence_rad, 1.5)) + turn * ray.range_m * slope;
  const double g = 2 * u / ray.range_m + turn * slope;
  const double interval_s = s.tap_interval_s;
  const auto frequencies = static_cast<double>(s.frequencies_hz.size());
  double shifted = 0, weights = 0;
  for (std::size_t f = 0; f < s.frequencies_hz.size(); ++f) {
    const double k = kappa(s.frequencies_hz[f]);
    shifted += k * k * u * (4 * static_cast<double>(f) + 1.5 - (4 * frequencies - 1) / 2);
    weights += k * k;
  }
  const double ripple_m = range_m(s, [&](double k) {
    return k * u / 2 + g / 2 + std::sqrt(2) * g / std::max(s.contrast, 1e-9);
  });
  left_out(ray, Effect::motion) = interval_s * (std::abs(shifted) / weights + ripple_m);
}

// Wiggling: the phasor 1 + sum of h_n exp(+-i (n +- 1) phi) over odd n.
void weigh_device(const Spot& spot, PilotRay& ray) {
  const PhaseCamera& s = spot.s;
  double odd = 0;
  for (std::size_t i = 1; i < s.harmonics.size(); i += 2) odd += std::abs(s.harmonics[i]);
  left_out(ray, Effect::wiggling) = range_m(s, [&](double) { return arc_sine(odd); });
  left_out(ray, Effect::miscalibration) = std::abs(s.range_offset_m) + 3 * s.pixel_offset_m;
}

void weigh_all(const Spot& spot, double without_scene_lights_e, PilotRay& ray) {
  weigh_noise(spot, ray);
  weigh_indirect(spot, ray);
  weigh_blur(spot, ray);
  weigh_vignetting(spot, ray);
  weigh_motion(spot, ray);
  weigh_device(spot, ray);
  // Scene lights move no range; without them three sigmas are smaller.
  left_out(ray, Effect::scene_lights) =
      3 * (ray.sigma_m - spot.sigma_m(tap_variance_e2(spot.s.sensor, without_scene_lights_e)));
}

bool is_smooth(const Material& material) {
  return has_delta(material.bsdf) && !std::holds_alternative<Plastic>(material.bsdf);
}

// Direct and ambient light along a view.
double constant_e(const PathView& view, const LensRay& ray) {
  const PhaseCamera& s = view.scanner;
  const RayCaster& caster = view.transport.caster();
  ViewBatch batch;
  batch.add(view.world_from_scanner, ray, 0);
  batch.trace(s, caster, view.world_from_scanner);
  double sum_e = 0;
  const Eigen::Matrix3d scanner_from_world = view.world_from_scanner.linear().transpose();
  DirectLight{s, caster.scene(), {}, scanner_from_world}.add(batch, 0, {sum_e, {}});
  return sum_e;
}

// What is seen and the light that comes back, with the scanner's sigma there.
std::optional<PilotRay> look(const PathView& view, const PixelPlace& pixel, std::uint64_t index) {
  const PhaseCamera& s = view.scanner;
  const RayCaster& caster = view.transport.caster();
  const auto ray = lens_ray(s, Eigen::Vector2d(pixel.column, pixel.row), {0, 0});
  if (!ray) return std::nullopt;
  const auto seen = first_surface(caster, view.world_from_scanner, ray->ray);
  if (!seen) return std::nullopt;
  const Scene& scene = caster.scene();
  const IndirectLight light = indirect_light(
      view, pixel, index,
      light_meets_once(scene, view.world_from_scanner.translation()) ? paths_per_lone_ray
                                                                     : paths_per_ray);
  PilotRay result{.range_m = seen->hit.distance_m};
  result.incidence_rad = std::acos(std::clamp(-seen->normal.dot(ray->ray.direction), 0.0, 1.0));
  result.met_smooth = is_smooth(scene.materials[scene.objects[seen->hit.object].material]);
  const double indirect_e = light.indirect_e + 3 * light.indirect_error_e;
  result.indirect_share = indirect_e > 0 && light.direct_e * no_direct_light <= indirect_e
                              ? no_direct_light
                              : indirect_e / std::max(light.direct_e, 1e-300);
  result.indirect_extra_m = light.extra_m;
  // in a mirror or behind glass the signal is what comes over them
  result.signal_e = light.direct_e + (result.met_smooth ? light.indirect_e : 0);
  const double other_e = result.met_smooth ? light.indirect_e : 0;
  const double without_lights_e = constant_e(view, *ray) + other_e;
  const double own_e = std::max(result.signal_e, 1.0);
  const Spot spot{s,
                  caster,
                  view.world_from_scanner,
                  Eigen::Vector2d(pixel.column, pixel.row),
                  without_lights_e + light.other_e,
                  own_e};
  result.sigma_m = spot.sigma_m(tap_variance_e2(s.sensor, spot.constant_e));
  weigh_all(spot, without_lights_e, result);
  return result;
}

}  // namespace

std::vector<PilotRay> pilot(const PhaseCamera& s, const RayCaster& caster,
                            const Pose& world_from_scanner, int rays) {
  check(s);
  const LightTransport transport(caster, transport_options(EffectSet::all(), false));
  const PathView view{s, transport, world_from_scanner, {}, {.seed = 1, .scan = 0xfffffffe}};
  const double stride =
      std::max(1.0, std::sqrt(1.0 * s.camera.width_px * s.camera.height_px / std::max(1, rays)));
  const int across = static_cast<int>(std::ceil(s.camera.width_px / stride));
  const int down = static_cast<int>(std::ceil(s.camera.height_px / stride));
  std::vector<std::optional<PilotRay>> seen(static_cast<std::size_t>(across) * down);
  parallel_for(
      seen.size(),
      [&](std::size_t i) {
        const auto [column, row] = place_of(i, across);
        const PixelPlace pixel{
            std::min(s.camera.width_px - 1, static_cast<int>((column + 0.5) * stride)),
            std::min(s.camera.height_px - 1, static_cast<int>((row + 0.5) * stride))};
        seen[i] = look(view, pixel, i);
      },
      8);
  std::vector<PilotRay> result;
  for (const auto& ray : seen)
    if (ray) result.push_back(*ray);
  return result;
}

}  // namespace scan::synth
