// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libscan/core/units.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
constexpr double dark_albedo = 0.1;

// Place of a sampled Gaussian peak of height A (electrons) and width s (samples), found by least
// squares with its slope A'; errors in samples. White noise v per sample gives the variance v / sum
// A'^2 (the Cramer-Rao bound), with sum A'^2 = sqrt(pi) A^2 / (2 s) and sum |A'| = 2 A.
struct PeakError {
  double shot;          // s / sqrt(total electrons)
  double per_electron;  // sqrt(2 s / sqrt(pi)) / A
  double
      worst_per_electron;  // 4 s / (sqrt(pi) A): every reading wrong by one electron the worst way
};

PeakError peak_error(double width, double height_e, double background_e) {
  const double total_e = height_e * width * std::sqrt(2 * pi);
  const double white = std::sqrt(2 * width / std::sqrt(pi)) / height_e;
  return {std::hypot(width / std::sqrt(total_e), white * std::sqrt(background_e)), white,
          4 * width / (std::sqrt(pi) * height_e)};
}

Sensitivity scaled(const PeakError& error, double m_per_sample, const Sensor& sensor) {
  return {error.shot * m_per_sample, error.per_electron * m_per_sample,
          error.worst_per_electron * m_per_sample, sensor};
}

double visible(double electrons) {
  return std::max(electrons, 1.0);
}

// At the focus; dz/du = z^2 / (baseline f) there, by the derivative of plane and ray's
// intersection.
std::vector<Sensitivity> at_points(const LaserLine& s) {
  const double z = s.baseline_m / std::tan(s.triangulation_rad);
  const double m_per_px = z * z / (s.baseline_m * s.camera.fx_px);
  const double stripe_px = s.beam_radius_m / 2 / std::cos(s.triangulation_rad) * s.camera.fx_px / z;
  const double width_px = std::sqrt(stripe_px * stripe_px + 1.0 / 12);  // and the pixel's own box
  std::vector<Sensitivity> points;
  for (const double albedo : {1.0, dark_albedo})
    points.push_back(
        scaled(peak_error(width_px, visible(albedo * s.peak_electrons), 0), m_per_px, s.sensor));
  return points;
}

// Matching of 9 x 9 pixels whose gradient is 10 % of their brightness per pixel, in two images, at
// focus_m; sigma_Z = Z^2 / (f B) sigma_d.
std::vector<Sensitivity> at_points(const StereoPair& s) {
  constexpr double pixels = 81, gradient = 0.1;
  const double m_per_px =
      s.focus_m * s.focus_m / (s.calibration.focal_px * s.calibration.baseline_m);
  std::vector<Sensitivity> points;
  for (const double albedo : {1.0, dark_albedo}) {
    const double bright_e = visible(albedo * (s.ambient_electrons + s.projector_electrons));
    const double white_px = std::sqrt(2 / pixels) / (gradient * bright_e);
    points.push_back({m_per_px * white_px * std::sqrt(bright_e), m_per_px * white_px,
                      m_per_px * 2 / (gradient * bright_e), s.sensor});
  }
  return points;
}

// Four taps: var(phi) = var(tap) / (2 A^2) (Lange 2000); taps off by one electron each move
// (C0 - C2, C3 - C1) of length 2A by sqrt(8) at most.
std::vector<Sensitivity> at_points(const PhaseCamera& s) {
  const double frequency = *std::max_element(s.frequencies_hz.begin(), s.frequencies_hz.end());
  const double m_per_rad = speed_of_light_m_s / (4 * pi * frequency);
  std::vector<Sensitivity> points;
  for (const auto& [albedo, range_m] : {std::pair(1.0, 1.0), {dark_albedo, s.max_range_m}}) {
    const double own_e = visible(albedo * s.electrons_at_1m / (range_m * range_m));
    const double amplitude_e = s.contrast * own_e;
    const double white_rad = 1 / (std::numbers::sqrt2 * amplitude_e);
    const double tap_e = own_e + albedo * s.ambient_electrons;
    points.push_back({m_per_rad * white_rad * std::sqrt(tap_e), m_per_rad * white_rad,
                      m_per_rad * std::numbers::sqrt2 / amplitude_e, s.sensor});
  }
  return points;
}

std::vector<Sensitivity> at_points(const PulsedLidar& s) {
  const double width = s.pulse_sigma_s / s.sample_interval_s;
  const double m_per_sample = speed_of_light_m_s / 2 * s.sample_interval_s;
  std::vector<Sensitivity> points;
  for (const auto& [albedo, range_m] : {std::pair(1.0, 10.0), {dark_albedo, s.max_range_m}}) {
    const double total_e = visible(albedo * s.electrons_at_10m * 100 / (range_m * range_m));
    const double height_e = total_e / (width * std::sqrt(2 * pi));
    points.push_back(
        scaled(peak_error(width, height_e, s.ambient_electrons), m_per_sample, s.sensor));
  }
  return points;
}

}  // namespace

std::vector<Sensitivity> sensitivities(const Scanner& scanner) {
  return std::visit([](const auto& s) { return at_points(s); }, scanner);
}

}  // namespace scan::synth
