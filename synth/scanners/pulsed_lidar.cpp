// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/core/units.h"
#include "synth/scanners/first_surface.h"
#include "synth/scanners/limits.h"

namespace scan::synth {
namespace {

constexpr double reference_range_m = 10;  // of electrons_at_10m
constexpr double window_margin_sigmas = 4;
// A surface at the lens would send back more than any sensor holds; this many still count as
// Poisson.
constexpr double most_electrons = 1e15;
constexpr double pulse_reach_sigmas = 9;  // a share of 2e-19 of the pulse lies beyond

struct Echo {
  double time_s;
  double electrons;
};

double window_start_s(const PulsedLidar& s) {
  return 2 * s.min_range_m / speed_of_light_m_s - window_margin_sigmas * s.pulse_sigma_s;
}

// Of the pulse as recorded: the variance of the sampling interval, h^2 / 12, adds to the pulse's
// own.
double recorded_sigma_s(const PulsedLidar& s) {
  return std::sqrt(s.pulse_sigma_s * s.pulse_sigma_s +
                   s.sample_interval_s * s.sample_interval_s / 12);
}

// Enough that the last sample lies at or behind the window's end. May exceed what an integer holds.
double samples_in_window(const PulsedLidar& s) {
  const double length_s = 2 * (s.max_range_m - s.min_range_m) / speed_of_light_m_s +
                          2 * window_margin_sigmas * s.pulse_sigma_s;
  return std::ceil(length_s / s.sample_interval_s) + 1;
}

Eigen::Vector3d direction_at(const RasterPattern& p, int row, int column) {
  const double azimuth = p.width_rad * ((column + 0.5) / p.columns - 0.5);
  const double down = p.height_rad * ((row + 0.5) / p.rows - 0.5);
  return {std::cos(down) * std::sin(azimuth), std::sin(down), std::cos(down) * std::cos(azimuth)};
}

Eigen::Vector3d direction_at(const SpinningPattern& p, int row, int column) {
  const double azimuth = 2 * std::numbers::pi * column / p.columns;
  const double place = p.rows > 1 ? static_cast<double>(row) / (p.rows - 1) : 0.5;
  const double up = p.highest_rad + place * (p.lowest_rad - p.highest_rad);
  return {std::cos(up) * std::sin(azimuth), -std::sin(up), std::cos(up) * std::cos(azimuth)};
}

RayGrid grid_of(const PulsedLidar& scanner) {
  return std::visit(
      [](const auto& p) {
        return RayGrid{static_cast<std::uint32_t>(p.rows), static_cast<std::uint32_t>(p.columns)};
      },
      scanner.pattern);
}

// Integral of -ln(1 - u): with u the share of energy inside a radius, -ln(1 - u) = 2 r^2 / D^2.
double integrated_radius_square(double u) {
  return u < 1 ? (1 - u) * std::log(1 - u) + u : 1;
}

// Squared radii of the rings, in units of D^2 / 2. Each ring stands at the mean square of its share
// of the Gaussian; ring 0 must stand on the axis, what it lacks goes to the others in proportion.
std::vector<double> ring_radius_squares(int rings) {
  std::vector<double> squares(rings, 0.0);
  double outside = 0;  // share of the mean square beyond ring 0
  for (int k = 1; k < rings; ++k) {
    const double inner = static_cast<double>(k * k) / (rings * rings);
    const double outer = static_cast<double>((k + 1) * (k + 1)) / (rings * rings);
    const double moment = integrated_radius_square(outer) - integrated_radius_square(inner);
    squares[k] = moment / (outer - inner);
    outside += moment;
  }
  for (double& square : squares)
    if (outside > 0) square /= outside;
  return squares;
}

// The echo of one sub-ray; none from the void.
std::optional<Echo> echo_of(const PulsedLidar& s, const RayCaster& caster,
                            const Pose& world_from_scanner, const BeamRay& ray) {
  const auto seen = first_surface(caster, world_from_scanner, {ray.origin, ray.direction});
  if (!seen) return std::nullopt;
  const double range_m = seen->point.norm();
  const double albedo = albedo_at(caster.scene(), seen->hit.object, seen->hit.point);
  const double cosine = std::abs(seen->normal.dot(ray.direction));
  const double falloff = reference_range_m * reference_range_m / (range_m * range_m);
  return Echo{
      .time_s = 2 * range_m / speed_of_light_m_s,
      .electrons =
          std::min(most_electrons, s.electrons_at_10m * albedo * cosine * falloff) * ray.share};
}

// Adds the echo's Gaussian, integrated over each sample's interval.
void add_echo(const PulsedLidar& s, const Echo& echo, std::vector<double>& samples) {
  const double dt = s.sample_interval_s;
  const double reach = pulse_reach_sigmas * s.pulse_sigma_s / dt + 0.5;
  const double middle = (echo.time_s - window_start_s(s)) / dt;  // in samples
  const auto end = static_cast<double>(samples.size());
  const double first = std::clamp(std::ceil(middle - reach), 0.0, end);
  const double behind = std::clamp(std::floor(middle + reach) + 1, first, end);
  const auto share_before = [&](double edge) {  // of the pulse, before an edge between samples
    return 0.5 * (1 + std::erf((edge - middle) * dt / (std::numbers::sqrt2 * s.pulse_sigma_s)));
  };
  double before = share_before(first - 0.5);
  for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(behind); ++i) {
    const double after = share_before(static_cast<double>(i) + 0.5);
    samples[i] += echo.electrons * (after - before);
    before = after;
  }
}

}  // namespace

void check(const PulsedLidar& s) {
  const RayGrid grid = grid_of(s);
  require_within("pulsed_lidar/pattern.rows", static_cast<int>(grid.rows), 1, 1e6);
  require_within("pulsed_lidar/pattern.columns", static_cast<int>(grid.columns), 1, 1e6);
  if (const auto* raster = std::get_if<RasterPattern>(&s.pattern)) {
    require_within("pulsed_lidar/pattern.height_rad", raster->height_rad, 0, std::numbers::pi);
    require_within("pulsed_lidar/pattern.width_rad", raster->width_rad, 0, 2 * std::numbers::pi);
  } else {
    const auto& spinning = std::get<SpinningPattern>(s.pattern);
    const double right_angle = std::numbers::pi / 2;
    require_within("pulsed_lidar/pattern.lowest_rad", spinning.lowest_rad, -right_angle,
                   right_angle);
    require_within("pulsed_lidar/pattern.highest_rad", spinning.highest_rad, spinning.lowest_rad,
                   right_angle);
  }
  require_positive("pulsed_lidar/pulse_sigma_s", s.pulse_sigma_s);
  require_positive("pulsed_lidar/sample_interval_s", s.sample_interval_s);
  require_within("pulsed_lidar/electrons_at_10m", s.electrons_at_10m, 0, 1e12);
  require_within("pulsed_lidar/ambient_electrons", s.ambient_electrons, 0, 1e9);
  require_within("pulsed_lidar/divergence_rad", s.divergence_rad, 0, 1);
  require_within("pulsed_lidar/exit_radius_m", s.exit_radius_m, 0, 1);
  require_within("pulsed_lidar/sub_rays", s.sub_rays, 1, 64);
  require_sensor("pulsed_lidar", s.sensor, 16);
  require_within("pulsed_lidar/min_range_m", s.min_range_m, 0, 1e9);
  require_within("pulsed_lidar/max_range_m", s.max_range_m, s.min_range_m, 1e9);
  require_size("pulsed_lidar/rows * columns * samples",
               samples_in_window(s) * grid.rows * grid.columns);
}

std::vector<Eigen::Vector3d> ray_directions(const PulsedLidar& scanner) {
  std::vector<Eigen::Vector3d> directions;
  std::visit(
      [&](const auto& pattern) {
        for (int row = 0; row < pattern.rows; ++row)
          for (int column = 0; column < pattern.columns; ++column)
            directions.push_back(direction_at(pattern, row, column).normalized());
      },
      scanner.pattern);
  return directions;
}

std::vector<BeamRay> beam_rays(const PulsedLidar& s, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d across = direction.unitOrthogonal(), beside = direction.cross(across);
  const std::vector<double> squares = ring_radius_squares(s.sub_rays);
  std::vector<BeamRay> rays;
  for (int ring = 0; ring < s.sub_rays; ++ring)
    for (int spoke = 0; spoke < 2 * ring + 1; ++spoke) {
      // Turned by 1 rad from ring to ring, so that no edge in the scene lines up with several.
      const double angle = 2 * std::numbers::pi * spoke / (2 * ring + 1) + ring;
      const double radius = std::sqrt(squares[ring] / 2);  // in units of D
      const Eigen::Vector3d outward = std::cos(angle) * across + std::sin(angle) * beside;
      const Eigen::Vector3d askew = std::cos(angle) * beside - std::sin(angle) * across;
      rays.push_back(
          {.origin = radius * s.exit_radius_m * outward,
           .direction = (direction + radius * std::tan(s.divergence_rad / 2) * askew).normalized(),
           .share = 1.0 / (s.sub_rays * s.sub_rays)});
    }
  return rays;
}

std::vector<double> expected_waveform(const PulsedLidar& s, const RayCaster& caster,
                                      const Pose& world_from_scanner,
                                      const Eigen::Vector3d& direction) {
  std::vector<double> samples(static_cast<std::size_t>(samples_in_window(s)), s.ambient_electrons);
  for (const BeamRay& ray : beam_rays(s, direction))
    if (const auto echo = echo_of(s, caster, world_from_scanner, ray)) add_echo(s, *echo, samples);
  return samples;
}

Rendering render(const PulsedLidar& device, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects) {
  check(device);
  PulsedLidar s = device;
  if (!effects.has(Effect::footprint)) s.sub_rays = 1;
  const DetectorEffects reading = detector_effects(effects);
  Waveforms frames{.calibration = {.sample_interval_s = s.sample_interval_s,
                                   .window_start_s = window_start_s(s),
                                   .pulse_sigma_s = recorded_sigma_s(s),
                                   .sensor = delivered_sensor(s.sensor, reading)},
                   .grid = grid_of(s),
                   .directions = ray_directions(s),
                   .samples_per_ray = static_cast<std::uint32_t>(samples_in_window(s)),
                   .samples = {}};
  frames.samples.resize(frames.directions.size() * frames.samples_per_ray);
  parallel_for(frames.directions.size(), [&](std::size_t ray) {
    const auto mean = expected_waveform(s, caster, world_from_scanner, frames.directions[ray]);
    const std::size_t first = ray * frames.samples_per_ray;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      RandomStream random(address.seed, address.scan, first + i);
      frames.samples[first + i] = read_pixel(s.sensor, reading, mean[i], random);
    }
  });
  return {.frames = std::move(frames), .statistics = {}};
}

std::vector<RayTruth> true_rays(const PulsedLidar& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner) {
  const std::vector<Eigen::Vector3d> directions = ray_directions(scanner);
  std::vector<RayTruth> rays(directions.size());
  parallel_for(rays.size(), [&](std::size_t i) {
    rays[i] = true_ray(caster, world_from_scanner, {.direction = directions[i]});
  });
  return rays;
}

}  // namespace scan::synth
