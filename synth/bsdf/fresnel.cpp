// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/bsdf/fresnel.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {
namespace {

double square(double x) {
  return x * x;
}

}  // namespace

double fresnel_boundary(double cosine, double cosine_behind, double index) {
  const double s = (cosine - index * cosine_behind) / (cosine + index * cosine_behind);
  const double p = (index * cosine - cosine_behind) / (index * cosine + cosine_behind);
  return (s * s + p * p) / 2;
}

double fresnel_dielectric(double cosine, double index) {
  const double cosine2_behind = 1 - (1 - cosine * cosine) / (index * index);
  if (!(cosine2_behind > 0)) return index < 1 ? 1 : 0;  // 0: no boundary, along it
  return fresnel_boundary(cosine, std::sqrt(cosine2_behind), index);
}

double fresnel_conductor(double cosine, double eta, double k) {
  const double cosine2 = cosine * cosine, sine2 = 1 - cosine2;
  // a + i b is the root of (eta + i k)^2 - sin^2; sum2 = a^2 + b^2, a^2 free of cancellation
  const double real = eta * eta - k * k - sine2, imaginary = 2 * eta * k;
  const double sum2 = std::hypot(real, imaginary);
  const double a2 = real >= 0 ? (sum2 + real) / 2 : square(imaginary) / (2 * (sum2 - real));
  const double a = std::sqrt(a2);
  const double s = (sum2 + cosine2 - 2 * a * cosine) / (sum2 + cosine2 + 2 * a * cosine);
  if (sine2 <= 0) return s;
  // Born and Wolf, section 14.2: the ratio of p to s from the same root
  const double even = cosine2 * sum2 + sine2 * sine2, odd = 2 * a * cosine * sine2;
  return s * (1 + (even - odd) / (even + odd)) / 2;
}

std::optional<Eigen::Vector3d> refract(const Eigen::Vector3d& in, const Eigen::Vector3d& normal,
                                       double index) {
  const double cosine = in.dot(normal);
  const double cosine2_behind = 1 - (1 - cosine * cosine) / (index * index);
  if (!(cosine2_behind > 0)) return std::nullopt;
  return Eigen::Vector3d(normal * (cosine / index - std::sqrt(cosine2_behind)) - in / index)
      .normalized();
}

double fresnel_dielectric_mean(double index) {
  // etendue is kept: the light that gets through is the same from both sides, times index^2
  if (index < 1) return 1 - square(index) * (1 - fresnel_dielectric_mean(1 / index));
  const double n = index, n2 = n * n;
  // the closed form cancels to 1e-16 / (n - 1); there the first term of its series is exact enough
  if (n < 1 + 1e-6) return (n - 1) / 3;
  const double n4 = n2 * n2;
  // Walsh 1926, in Duntley 1942, eq. 23: the integral of both polarisations in closed form
  return 0.5 + (n - 1) * (3 * n + 1) / (6 * square(n + 1)) +
         n2 * square(n2 - 1) / (square(n2 + 1) * (n2 + 1)) * std::log((n - 1) / (n + 1)) -
         2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
         8 * n4 * (n4 + 1) / ((n2 + 1) * square(n4 - 1)) * std::log(n);
}

}  // namespace scan::synth
