// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fits of waves of known period and phase, and where they fall below half.
#include "libscan/verify/structural_resolution.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

constexpr double least_transfer = 0.5, least_coverage = 0.9;

using Coefficients = Eigen::Matrix<double, 5, 1>;

// Height, tilts along and across the wave, the wave in phase and a quarter of a period off.
Coefficients terms(const WavePlate& plate, const Eigen::Vector3d& at) {
  const double phase_rad = 2 * std::numbers::pi * at.x() / plate.period_m;
  Coefficients value;
  value << 1, at.x() / plate.edge_m, at.y() / plate.edge_m, std::cos(phase_rad),
      std::sin(phase_rad);
  return value;
}

Coefficients fitted(const WavePlate& plate, const Points& points) {
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Coefficients right = Coefficients::Zero();
  for (const Eigen::Vector3d& x : points) {
    const Coefficients t = terms(plate, x);
    normal += t * t.transpose();
    right += t * x.z();
  }
  return normal.ldlt().solve(right);
}

Points on_face(const WavePlate& plate) {
  Points inner;
  for (const Eigen::Vector3d& x : plate.points)
    if (std::max(std::abs(x.x()), std::abs(x.y())) < plate.edge_m / 2) inner.push_back(x);
  return inner;
}

double transfer(const WavePlate& plate, const Points& points) {
  if (points.size() < 10) return 0;  // twice the unknowns
  const Coefficients first = fitted(plate, points);
  std::vector<double> residuals_m;
  for (const Eigen::Vector3d& x : points) residuals_m.push_back(x.z() - first.dot(terms(plate, x)));
  Points inner;
  for (const std::size_t i : without_outliers(residuals_m)) inner.push_back(points[i]);
  const double in_phase = fitted(plate, inner)[3] / plate.amplitude_m;
  return std::isfinite(in_phase) ? in_phase : 0;  // all points at one phase of the wave
}

// Of the fields that lie wholly on the face; along the wave each is a crest or a trough.
double coverage(const WavePlate& plate, const Points& points) {
  const double field_m = plate.period_m / 2;
  const auto half = static_cast<long>(std::floor(plate.edge_m / 2 / field_m - 0.5));
  if (half < 0) return 0;
  const long across = 2 * half + 1;
  std::vector<char> holds_point(static_cast<std::size_t>(across * across));
  for (const Eigen::Vector3d& x : points) {
    const long column = half + std::lround(x.x() / field_m),
               row = half + std::lround(x.y() / field_m);
    if (std::min(column, row) < 0 || std::max(column, row) >= across) continue;
    holds_point[static_cast<std::size_t>(row * across + column)] = 1;
  }
  const auto filled = std::count(holds_point.begin(), holds_point.end(), 1);
  return static_cast<double>(filled) / static_cast<double>(across * across);
}

// Where a value falls through the limit between two periods, linear in the period's logarithm.
double crossing_m(double longer_m, double shorter_m, double at_longer, double at_shorter,
                  double limit) {
  if (at_shorter >= limit) return shorter_m;
  const double share = (at_longer - limit) / (at_longer - at_shorter);
  return longer_m * std::pow(shorter_m / longer_m, share);
}

double resolution_m(const std::vector<WavePlate>& plates) {
  if (plates.empty()) throw Error(Trouble::input, "structural resolution: no plate was measured");
  WaveResponse longer = wave_response(plates.front());
  if (!is_resolved(longer))
    throw Error(Trouble::computation,
                "structural resolution: waves of " + std::to_string(plates.front().period_m) +
                    " m show " + std::to_string(longer.transfer) + " of their amplitude and " +
                    std::to_string(longer.coverage) + " of their fields, needs 0.5 and 0.9");
  for (std::size_t i = 1; i < plates.size(); ++i) {
    const WaveResponse here = wave_response(plates[i]);
    const double longer_m = plates[i - 1].period_m, here_m = plates[i].period_m;
    if (!is_resolved(here))
      return std::max(crossing_m(longer_m, here_m, longer.transfer, here.transfer, least_transfer),
                      crossing_m(longer_m, here_m, longer.coverage, here.coverage, least_coverage));
    longer = here;
  }
  return plates.back().period_m;
}

}  // namespace

WaveResponse wave_response(const WavePlate& plate) {
  const Points points = on_face(plate);
  return {transfer(plate, points), coverage(plate, points)};
}

bool is_resolved(const WaveResponse& response) {
  return response.transfer >= least_transfer && response.coverage >= least_coverage;
}

Measurement structural_resolution(std::span<const std::vector<WavePlate>> series) {
  if (series.empty()) throw Error(Trouble::input, "structural resolution: no plate was measured");
  Measurement figure{.name = "structural_resolution",
                     .unit = "m",
                     .over = "the worst of " + std::to_string(series.size()) + " directions"};
  for (const std::vector<WavePlate>& plates : series) {
    figure.value = std::max(figure.value, resolution_m(plates));
    for (const WavePlate& plate : plates) figure.count += plate.points.size();
  }
  return figure;
}

}  // namespace scan
