// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/bsdf/directional_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace scan::synth {
namespace {

constexpr int order = 64;

struct QuadratureRule {
  std::array<double, order> x, weight;
};

// Nodes and weights on [0, 1]: Newton's method on Legendre's polynomial.
QuadratureRule gauss_legendre() {
  QuadratureRule rule;
  for (int i = 0; i < order; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (order + 0.5)), slope = 1;
    for (int step = 0; step < 8; ++step) {
      double last = 1, value = x;
      for (int n = 2; n <= order; ++n)
        last = std::exchange(value, ((2 * n - 1) * x * value - (n - 1) * last) / n);
      slope = order * (x * value - last) / (x * x - 1);
      x -= value / slope;
    }
    rule.x[i] = (1 - x) / 2;
    rule.weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

}  // namespace

DirectionalTable::DirectionalTable(const std::function<double(double)>& function_of_cosine) {
  for (int i = 0; i <= intervals; ++i) {
    // the plane itself is a limit; a cosine of 1e-9 is within 1e-9 of it
    const double t = static_cast<double>(i) / intervals;
    nodes_[i] = function_of_cosine(std::max(t * t, 1e-9));
  }
}

double DirectionalTable::operator()(double cosine) const {
  const double t = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * intervals;
  const int i = std::min(static_cast<int>(t), intervals - 1);
  const double s = t - i;
  const double before = nodes_[std::max(i - 1, 0)], left = nodes_[i], right = nodes_[i + 1];
  const double after = nodes_[std::min(i + 2, intervals)];
  const double slope_left = i > 0 ? (right - before) / 2 : right - left;
  const double slope_right = i + 2 <= intervals ? (after - left) / 2 : right - left;
  const double bend = slope_left + slope_right - 2 * (right - left);
  return left + s * (slope_left + s * (right - left - slope_left - bend + s * bend));
}

double integral_over_unit(const std::function<double(double)>& function) {
  static const QuadratureRule rule = gauss_legendre();
  double sum = 0;
  for (int i = 0; i < order; ++i) sum += rule.weight[i] * function(rule.x[i]);
  return sum;
}

}  // namespace scan::synth
