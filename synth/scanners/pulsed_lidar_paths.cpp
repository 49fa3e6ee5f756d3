// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "libscan/core/units.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
// An error that all readings of an echo share changes its energy and not its place: few paths do.
constexpr SamplingGoal goal{.most_samples = 512};
constexpr double least_slope = 1e-5;      // of a beam without an extent
constexpr double reference_range_m = 10;  // of electrons_at_10m
constexpr double same_length = 1e-9;      // relative, of the straight way computed twice
constexpr double sharp = 1e-3;            // of a sampling interval: within one sample
constexpr double least_electrons = 0.01;  // less is no part of a pulse

// Puts arrivals of one view at their times.
struct Arrivals {
  const SampleAxis& axis;
  double pulse_sigma_s;
  double known_m;  // the straight way there and back is not longer; 0: nothing is known
  double lamp_e;   // electrons per sample and 1 W / m^2
  std::span<double> samples;
  double& lamps;
  std::span<const DelayedPulse> walk;

  void device_light(double electrons, double path_m, int scatterings) {
    if (scatterings == 1 && path_m <= known_m) return;
    const double time_s = path_m / speed_of_light_m_s;
    add_echo(axis, {time_s + delay_s(walk, time_s), electrons, pulse_sigma_s}, samples);
  }
  void other_light(double electrons) { lamps += lamp_e * electrons; }
};

bool has_uneven_medium(const Scene& scene, const EffectSet& effects) {
  return effects.has(Effect::medium) && scene.medium &&
         !std::holds_alternative<Homogeneous>(scene.medium->density);
}

}  // namespace

// Radius by its distribution, 1 - exp(-t^2 / slope^2).
Eigen::Vector3d BeamLight::view(const Eigen::Vector2d& u) const {
  const Eigen::Vector3d across = axis.unitOrthogonal(), beside = axis.cross(across);
  const double t = slope * std::sqrt(-std::log1p(-u.x()));
  const double angle = 2 * pi * u.y();
  return (axis + t * std::cos(angle) * across + t * std::sin(angle) * beside).normalized();
}

// The mean of 2 exp(-t^2 / slope^2) over views is 1. Per steradian: cos^3 of it are a square of
// tangents.
double BeamLight::irradiance(const Eigen::Vector3d& direction, double length_m) const {
  const double cosine = direction.dot(axis);
  if (!(cosine > 0)) return 0;
  const double t2 = (direction - cosine * axis).squaredNorm() / (cosine * cosine * slope * slope);
  return 2 * electrons_at_1m / (length_m * length_m) * std::exp(-t2) / (cosine * cosine * cosine);
}

EmittedRay BeamLight::sample(const Eigen::Vector2d& u) const {
  return {.origin = origin, .direction = view(u), .flux = flux()};
}

double BeamLight::flux() const {
  return 2 * pi * slope * slope * electrons_at_1m;
}

BeamLight beam_light(const PulsedLidar& s, const RayCaster& caster, const Pose& world_from_scanner,
                     const Eigen::Vector3d& direction) {
  BeamLight light{.origin = world_from_scanner.translation(),
                  .axis = world_from_scanner.linear() * direction,
                  .slope = least_slope,
                  .electrons_at_1m = s.electrons_at_10m * reference_range_m * reference_range_m};
  if (s.sub_rays == 1) return light;
  const auto hit = caster.closest(light.origin, light.axis);
  const double range_m = hit ? hit->distance_m : reference_range_m;
  const double slope = std::hypot(std::tan(s.divergence_rad / 2), s.exit_radius_m / range_m);
  light.slope = std::max(light.slope, slope);
  return light;
}

double straight_way_m(const RayCaster& caster, const Ray& view) {
  const auto hit = caster.closest(view.origin, view.direction);
  return hit ? 2 * hit->distance_m * (1 + same_length) : std::numeric_limits<double>::infinity();
}

// exp(-t^2 / slope^2) is below 1e-21 beyond 7 slopes; the ball meets the cone if its centre is no
// farther off than its radius over the cone's cosine.
bool BeamLight::reaches(const Eigen::Vector3d& centre, double radius_m) const {
  const Eigen::Vector3d away = centre - origin;
  const double ahead_m = away.dot(axis), aside_m = (away - ahead_m * axis).norm();
  const double edge = 7 * slope;
  return ahead_m >= -radius_m &&
         aside_m <= edge * std::max(ahead_m, 0.0) + radius_m * std::hypot(1, edge);
}

// Where the ray comes nearest to the beam's axis; a ray along the beam: to the origin.
Brightest BeamLight::brightest(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const {
  const Eigen::Vector3d off = from - origin;
  const double cosine = along.dot(axis), sine2 = 1 - cosine * cosine;
  const double to_axis =
      sine2 > slope * slope ? (cosine * off.dot(axis) - off.dot(along)) / sine2 : -off.dot(along);
  const Eigen::Vector3d nearest = off + std::max(to_axis, 0.0) * along;
  const double down_m = std::max(nearest.dot(axis), 0.0);
  const double width_m = std::hypot(slope * down_m, (nearest - down_m * axis).norm());
  return {.distance_m = std::max(to_axis, 0.0),
          .half_width_m = std::max(width_m / std::sqrt(std::max(sine2, slope * slope)), 1e-3)};
}

LidarPaths::Quality& LidarPaths::Quality::operator+=(const Quality& other) {
  paths += other.paths;
  readings += other.readings;
  square += other.square;
  largest = std::max(largest, other.largest);
  return *this;
}

LidarPaths::LidarPaths(const PulsedLidar& scanner, const RayCaster& caster,
                       const EffectSet& effects, const SampleAxis& axis)
    : scanner_(scanner),
      axis_(axis),
      transport_(caster, transport_options(effects, true)),
      straight_is_known_(!has_uneven_medium(caster.scene(), effects)),
      floor_e2_(scanner.ambient_electrons +
                scanner.sensor.read_noise_e * scanner.sensor.read_noise_e +
                scanner.sensor.gain_e_per_dn * scanner.sensor.gain_e_per_dn / 12) {}

bool LidarPaths::needed(const PulsedLidar& scanner, const Scene& scene, const EffectSet& effects) {
  const bool lets_light_in =
      std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
        const Bsdf& bsdf = scene.materials[object.material].bsdf;
        return has_delta(bsdf) || is_transmissive(bsdf);
      });
  const bool bends = effects.has(Effect::mirror_reflection) || effects.has(Effect::refraction) ||
                     effects.has(Effect::subsurface);
  const bool lamps =
      effects.has(Effect::scene_lights) && !scene.lights.empty() && scanner.electrons_per_w_m2 > 0;
  return effects.has(Effect::interreflection) || (bends && lets_light_in) || lamps ||
         has_uneven_medium(scene, effects);
}

double LidarPaths::noise_e(double mean_e) const {
  return std::sqrt(floor_e2_ + std::max(mean_e, 0.0));
}

void LidarPaths::trace(const Beam& beam, double sigma_s, std::span<const DelayedPulse> walk,
                       Memory& memory) const {
  const BeamLight light =
      beam_light(scanner_, transport_.caster(), beam.world_from_scanner, beam.direction);
  const auto sequence = [&](std::uint32_t stream) {
    return SampleSequence(beam.address.seed, beam.address.scan, beam.ray, stream);
  };
  std::array<SampleSequence, 4> sequences = {sequence(0), sequence(1), sequence(2), sequence(3)};
  const auto samples = static_cast<std::size_t>(axis_.samples);
  const auto draw = [&](int stream, int index, std::span<double> signals) {
    SampleSequence& random = sequences[stream];
    random.start(index);
    const Ray view{.origin = light.origin, .direction = light.view(random.next_2d())};
    Arrivals arrivals{.axis = axis_,
                      .pulse_sigma_s = sigma_s,
                      .known_m = straight_is_known_ ? straight_way_m(transport_.caster(), view) : 0,
                      .lamp_e = scanner_.electrons_per_w_m2,
                      .samples = signals.first(samples),
                      .lamps = signals.back(),
                      .walk = walk};
    trace_path(transport_, view, light, random, arrivals);
  };
  estimate(
      samples + 1, goal, [this](double mean_e) { return noise_e(mean_e); }, draw, memory.sums,
      memory.estimate);
}

LidarPaths::Quality LidarPaths::add(const Beam& beam, std::span<const DelayedPulse> walk,
                                    std::span<double> samples, Memory& memory) const {
  trace(beam, scanner_.pulse_sigma_s, walk, memory);
  const Estimate& estimated = memory.estimate;
  Quality quality{.paths = static_cast<double>(estimated.samples)};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double mean_e = estimated.mean[i] + estimated.mean.back();
    if (!(mean_e > 0)) continue;
    samples[i] += mean_e;
    const double share =
        std::hypot(estimated.standard_error[i], estimated.standard_error.back()) / noise_e(mean_e);
    ++quality.readings;
    quality.square += share * share;
    quality.largest = std::max(quality.largest, share);
  }
  return quality;
}

void LidarPaths::find(const Beam& beam, std::vector<Echo>& arrivals, Memory& memory) const {
  trace(beam, sharp * axis_.interval_s, {}, memory);
  for (std::size_t i = 0; i + 1 < memory.estimate.mean.size(); ++i)
    if (memory.estimate.mean[i] >= least_electrons)
      arrivals.push_back({.time_s = axis_.start_s + static_cast<double>(i) * axis_.interval_s,
                          .electrons = memory.estimate.mean[i]});
}

}  // namespace scan::synth
