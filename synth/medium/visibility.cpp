// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/visibility.h"

#include <cmath>

namespace scan::synth {
namespace {

double exponent_by_kruse(double km) {
  if (km > 50) return 1.6;
  return km >= 6 ? 1.3 : 0.585 * std::cbrt(km);
}

double exponent_by_kim(double km) {
  if (km >= 6) return exponent_by_kruse(km);
  if (km >= 1) return 0.16 * km + 0.34;
  return km >= 0.5 ? km - 0.5 : 0;
}

double carried_over(double visibility_m, double wavelength_m, double exponent) {
  return 3.91 / visibility_m * std::pow(wavelength_m / 550e-9, -exponent);
}

}  // namespace

double extinction_by_optical_range(double optical_range_m) {
  return std::log(20.0) / optical_range_m;
}

double extinction_by_kruse(double visibility_m, double wavelength_m) {
  return carried_over(visibility_m, wavelength_m, exponent_by_kruse(visibility_m / 1000));
}

double extinction_by_kim(double visibility_m, double wavelength_m) {
  return carried_over(visibility_m, wavelength_m, exponent_by_kim(visibility_m / 1000));
}

}  // namespace scan::synth
