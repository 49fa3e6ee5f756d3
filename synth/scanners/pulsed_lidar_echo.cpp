// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar_echo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "libscan/core/units.h"

namespace scan::synth {
namespace {

constexpr double reference_range_m = 10;  // of electrons_at_10m
constexpr double window_margin_sigmas = 4;
// A surface at the lens would send back more than any sensor holds; this many still count as
// Poisson.
constexpr double most_electrons = 1e15;
constexpr double pulse_reach_sigmas = 9;  // a share of 2e-19 of the pulse lies beyond
constexpr double share_of_noise = 0.1;    // what the closed form may err by
constexpr int least_rings = 4;            // fewer cost no more than the pilot
constexpr std::size_t rays_at_once = 64;

// What opposite pilot rays tell of a quantity f over the beam: f = centre + slope . place + ...
struct Trend {
  Eigen::Vector2d slope;  // per D
  double bend = 0;        // largest deviation of a pair's mean from the centre
  double skew = 0;        // largest deviation of a pair's difference from the slope
};

constexpr int pairs = 3;

Eigen::Vector2d pair_direction(int pair) {
  const double angle = std::numbers::pi * pair / pairs;
  return {std::cos(angle), std::sin(angle)};
}

// `rim` holds the quantity at +pair_direction, -pair_direction, pair by pair.
Trend trend(double centre, const std::array<double, 2 * pairs>& rim, double radius) {
  Trend result{.slope = Eigen::Vector2d::Zero()};
  for (int k = 0; k < pairs; ++k)
    result.slope += (rim[2 * k] - rim[2 * k + 1]) / 2 * pair_direction(k) * (2.0 / pairs / radius);
  for (int k = 0; k < pairs; ++k) {
    const double half = (rim[2 * k] - rim[2 * k + 1]) / 2;
    const double mean = (rim[2 * k] + rim[2 * k + 1]) / 2;
    result.bend = std::max(result.bend, std::abs(mean - centre));
    result.skew =
        std::max(result.skew, std::abs(half - radius * result.slope.dot(pair_direction(k))));
  }
  return result;
}

// Of a beam that is not sampled across.
BeamRay centre_ray(const Eigen::Vector3d& direction) {
  return {.origin = Eigen::Vector3d::Zero(), .direction = direction};
}

Ray view_along(const Pose& world_from_scanner, const BeamRay& ray) {
  return {.origin = world_from_scanner * ray.origin,
          .direction = world_from_scanner.linear() * ray.direction};
}

// Of a surface, straight back, over that of a white Lambert one.
double white_share(const Scene& scene, const Hit& hit, double cosine) {
  const Material& material = scene.materials[scene.objects[hit.object].material];
  const auto* matt = std::get_if<Lambert>(&material.bsdf);
  if (matt && std::holds_alternative<PlainTexture>(material.texture)) return matt->albedo;
  const Eigen::Vector3d back(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine);
  return std::numbers::pi *
         evaluate(bsdf_at(scene, hit.object, hit.triangle, hit.point), back, back);
}

}  // namespace

SampleAxis sample_axis(const PulsedLidar& s) {
  const double margin_s = window_margin_sigmas * s.pulse_sigma_s;
  const double length_s = 2 * (s.max_range_m - s.min_range_m) / speed_of_light_m_s + 2 * margin_s;
  // Enough that the last sample lies at or behind the window's end.
  return {.start_s = 2 * s.min_range_m / speed_of_light_m_s - margin_s,
          .interval_s = s.sample_interval_s,
          .samples = std::ceil(length_s / s.sample_interval_s) + 1};
}

SampleRange add_echo(const SampleAxis& axis, const Echo& echo, std::span<double> samples) {
  const double dt = axis.interval_s;
  const double reach = pulse_reach_sigmas * echo.sigma_s / dt + 0.5;
  const double middle = (echo.time_s - axis.start_s) / dt;  // in samples
  const auto end = static_cast<double>(samples.size());
  const double first = std::clamp(std::ceil(middle - reach), 0.0, end);
  const double behind = std::clamp(std::floor(middle + reach) + 1, first, end);
  const double scale = dt / (std::numbers::sqrt2 * echo.sigma_s);
  // Twice the pulse's share before an edge between samples, less one.
  double before = std::erf((first - 0.5 - middle) * scale);
  for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(behind); ++i) {
    const double after = std::erf((static_cast<double>(i) + 0.5 - middle) * scale);
    samples[i] += 0.5 * echo.electrons * (after - before);
    before = after;
  }
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(behind)};
}

std::optional<Echo> LidarBeam::echo_of(const Pose& world_from_scanner, const BeamRay& ray,
                                       const std::optional<Hit>& hit) const {
  if (!hit) return std::nullopt;
  const bool central = ray.origin.isZero(0);
  const double range_m =
      central ? hit->distance_m : (ray.origin + hit->distance_m * ray.direction).norm();
  const double cosine = std::abs(hit->normal.dot(world_from_scanner.linear() * ray.direction));
  const double falloff = reference_range_m * reference_range_m / (range_m * range_m);
  const double electrons =
      scanner.electrons_at_10m * white_share(caster.scene(), *hit, cosine) * cosine * falloff;
  return Echo{.time_s = 2 * range_m / speed_of_light_m_s,
              .electrons = std::min(most_electrons, electrons) * ray.share,
              .sigma_s = scanner.pulse_sigma_s};
}

void LidarBeam::trace(const Pose& world_from_scanner, std::span<const BeamRay> rays,
                      std::span<std::optional<Echo>> echoes) const {
  std::array<Ray, rays_at_once> views;
  std::array<std::optional<Hit>, rays_at_once> hits;
  for (std::size_t first = 0; first < rays.size(); first += rays_at_once) {
    const std::size_t count = std::min(rays_at_once, rays.size() - first);
    for (std::size_t i = 0; i < count; ++i)
      views[i] = view_along(world_from_scanner, rays[first + i]);
    caster.closest(std::span(views).first(count), std::span(hits).first(count));
    for (std::size_t i = 0; i < count; ++i)
      echoes[first + i] = echo_of(world_from_scanner, rays[first + i], hits[i]);
  }
}

void LidarBeam::sub_ray_echoes(const Pose& world_from_scanner, const Eigen::Vector3d& direction,
                               std::vector<Echo>& echoes) const {
  std::vector<BeamRay> rays;
  for (const Eigen::Vector2d& place : section.places) rays.push_back(section.ray(direction, place));
  std::vector<std::optional<Echo>> found(rays.size());
  trace(world_from_scanner, rays, found);
  for (const auto& echo : found)
    if (echo) echoes.push_back(*echo);
}

std::optional<Echo> LidarBeam::closed_form(const Pose& world_from_scanner,
                                           const Eigen::Vector3d& direction) const {
  std::array<BeamRay, 1 + 2 * pairs> pilots = {section.ray(direction, Eigen::Vector2d::Zero())};
  for (int k = 0; k < 2 * pairs; ++k)
    pilots[1 + k] = section.ray(direction, section.rim * (k % 2 ? -1 : 1) * pair_direction(k / 2));
  for (BeamRay& pilot : pilots) pilot.share = 1;
  std::array<std::optional<Echo>, 1 + 2 * pairs> found;
  trace(world_from_scanner, pilots, found);
  const auto& centre = found[0];
  if (!centre || !(centre->electrons > 0)) return std::nullopt;
  std::array<double, 2 * pairs> time_s, electrons;
  for (int k = 0; k < 2 * pairs; ++k) {
    const auto& rim = found[1 + k];
    if (!rim) return std::nullopt;
    time_s[k] = rim->time_s;
    electrons[k] = rim->electrons;
  }
  const Trend delay = trend(centre->time_s, time_s, section.rim);
  const Trend energy = trend(centre->electrons, electrons, section.rim);
  const double noise_share = share_of_noise / std::sqrt(std::max(centre->electrons, 1.0));
  const double limit_s = noise_share * scanner.pulse_sigma_s;
  const double limit_e = noise_share * centre->electrons;
  // A Gaussian beam has the variance D^2 / 4 along each axis; brighter sides pull the mean.
  const double pull_s = std::abs(delay.slope.dot(energy.slope)) / 4 / centre->electrons;
  if (std::max({delay.bend, delay.skew, pull_s}) > limit_s ||
      std::max(energy.bend, energy.skew) > limit_e)
    return std::nullopt;
  Echo echo = *centre;
  echo.sigma_s = std::hypot(scanner.pulse_sigma_s, delay.slope.norm() / 2);
  return echo;
}

void LidarBeam::echoes(const Pose& world_from_scanner, const Eigen::Vector3d& direction,
                       std::vector<Echo>& echoes) const {
  if (scanner.sub_rays < least_rings) return sub_ray_echoes(world_from_scanner, direction, echoes);
  if (const auto echo = closed_form(world_from_scanner, direction)) {
    echoes.push_back(*echo);
    return;
  }
  sub_ray_echoes(world_from_scanner, direction, echoes);
}

void LidarBeam::centre_echoes(std::span<const Pulse> pulses, PulseEchoes& found) const {
  std::array<Ray, rays_at_once> views;
  std::array<std::optional<Hit>, rays_at_once> hits;
  for (std::size_t first = 0; first < pulses.size(); first += rays_at_once) {
    const auto some = pulses.subspan(first, std::min(rays_at_once, pulses.size() - first));
    for (std::size_t i = 0; i < some.size(); ++i)
      views[i] = view_along(*some[i].world_from_scanner, centre_ray(some[i].direction));
    caster.closest(std::span(views).first(some.size()), std::span(hits).first(some.size()));
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (const auto echo =
              echo_of(*some[i].world_from_scanner, centre_ray(some[i].direction), hits[i]))
        found.echoes.push_back(*echo);
      found.ends.push_back(found.echoes.size());
    }
  }
}

void LidarBeam::echoes(std::span<const Pulse> pulses, PulseEchoes& found) const {
  found.echoes.clear();
  found.ends.clear();
  if (section.places.size() == 1) return centre_echoes(pulses, found);
  for (const Pulse& pulse : pulses) {
    echoes(*pulse.world_from_scanner, pulse.direction, found.echoes);
    found.ends.push_back(found.echoes.size());
  }
}

}  // namespace scan::synth
