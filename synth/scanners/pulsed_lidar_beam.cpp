// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar_beam.h"

#include <cmath>
#include <numbers>

#include "libscan/core/parallel.h"

namespace scan::synth {
namespace {

// Angles of columns and rows.
double azimuth(const RasterPattern& p, int column) {
  return p.width_rad * ((column + 0.5) / p.columns - 0.5);
}
double down(const RasterPattern& p, int row) {
  return p.height_rad * ((row + 0.5) / p.rows - 0.5);
}
double azimuth(const SpinningPattern& p, int column) {
  return 2 * std::numbers::pi * column / p.columns;
}
double down(const SpinningPattern& p, int row) {
  const double place = p.rows > 1 ? static_cast<double>(row) / (p.rows - 1) : 0.5;
  return -(p.highest_rad + place * (p.lowest_rad - p.highest_rad));
}

std::size_t pulse_number(const RasterPattern&, std::size_t ray) {
  return ray;
}

std::size_t pulse_number(const SpinningPattern& p, std::size_t ray) {
  return ray % p.columns * p.rows + ray / p.columns;
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

}  // namespace

RayGrid ray_grid(const PulsedLidar& scanner) {
  return std::visit(
      [](const auto& p) {
        return RayGrid{static_cast<std::uint32_t>(p.rows), static_cast<std::uint32_t>(p.columns)};
      },
      scanner.pattern);
}

std::vector<Eigen::Vector3d> ray_directions(const PulsedLidar& scanner) {
  const RayGrid grid = ray_grid(scanner);
  const std::size_t columns = grid.columns;
  std::vector<Eigen::Vector3d> directions(grid.rows * columns);
  std::visit(
      [&](const auto& pattern) {
        std::vector<Eigen::Vector2d> across(columns);  // sine and cosine
        for (std::size_t i = 0; i < columns; ++i) {
          const double angle = azimuth(pattern, static_cast<int>(i));
          across[i] = {std::sin(angle), std::cos(angle)};
        }
        parallel_chunks(directions.size(), columns, [&](std::size_t begin, std::size_t end) {
          const double angle = down(pattern, static_cast<int>(begin / columns));
          const double sine = std::sin(angle), cosine = std::cos(angle);
          for (std::size_t i = begin; i < end; ++i) {
            const Eigen::Vector2d& a = across[i - begin];
            directions[i] = Eigen::Vector3d(cosine * a.x(), sine, cosine * a.y()).normalized();
          }
        });
      },
      scanner.pattern);
  return directions;
}

bool is_moving(const PulsedLidar& s) {
  return s.motion.interval_s > 0 &&
         !(s.motion.velocity_m_s.isZero(0) && s.motion.angular_velocity_rad_s.isZero(0));
}

Pose scan_from_scanner(const PulsedLidar& s, std::size_t ray) {
  const RayGrid grid = ray_grid(s);
  const double middle = (static_cast<double>(grid.rows) * grid.columns - 1) / 2;
  const auto number = static_cast<double>(
      std::visit([&](const auto& pattern) { return pulse_number(pattern, ray); }, s.pattern));
  const double time_s = (number - middle) * s.motion.interval_s;
  Vector6 turn;
  turn << time_s * s.motion.angular_velocity_rad_s, Eigen::Vector3d::Zero();
  return make_pose(exp(turn).linear(), time_s * s.motion.velocity_m_s);
}

BeamSection beam_section(const PulsedLidar& s) {
  BeamSection section{.places = {},
                      .rim = 0,
                      .exit_radius_m = s.exit_radius_m,
                      .slope = std::tan(s.divergence_rad / 2)};
  const std::vector<double> squares = ring_radius_squares(s.sub_rays);
  section.rim = std::sqrt(squares.back() / 2);
  for (int ring = 0; ring < s.sub_rays; ++ring)
    for (int spoke = 0; spoke < 2 * ring + 1; ++spoke) {
      // Turned by 1 rad from ring to ring, so that no edge in the scene lines up with several.
      const double angle = 2 * std::numbers::pi * spoke / (2 * ring + 1) + ring;
      const double radius = std::sqrt(squares[ring] / 2);
      section.places.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
  return section;
}

BeamRay BeamSection::ray(const Eigen::Vector3d& axis, const Eigen::Vector2d& place) const {
  const Eigen::Vector3d across = axis.unitOrthogonal(), beside = axis.cross(across);
  const Eigen::Vector3d outward = place.x() * across + place.y() * beside;
  const Eigen::Vector3d askew = place.x() * beside - place.y() * across;
  return {.origin = exit_radius_m * outward,
          .direction = (axis + slope * askew).normalized(),
          .share = 1 / static_cast<double>(places.size())};
}

std::vector<BeamRay> beam_rays(const PulsedLidar& s, const Eigen::Vector3d& direction) {
  const BeamSection section = beam_section(s);
  std::vector<BeamRay> rays;
  for (const Eigen::Vector2d& place : section.places) rays.push_back(section.ray(direction, place));
  return rays;
}

}  // namespace scan::synth
