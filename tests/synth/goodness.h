// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Chi-square tests and quadrature over the sphere, for samplers and their densities.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace scan::synth {

// Probability that chi-square of so many degrees of freedom is larger: the regularised incomplete
// gamma function Q(k / 2, x / 2) by its series or its continued fraction (Lentz).
inline double chi_square_tail(double statistic, double degrees) {
  const double a = degrees / 2, x = statistic / 2;
  if (x <= 0) return 1;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 2000; ++n) sum += term *= x / (a + n);
    return 1 - scale * sum;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 2000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
  }
  return scale * h;
}

// The tail probability of counts under expected counts; cells that expect fewer than 10 are pooled.
inline double goodness_of_fit(const std::vector<double>& counts,
                              const std::vector<double>& expected) {
  double statistic = 0, pooled_count = 0, pooled_expected = 0;
  int cells = 0;
  const auto add = [&](double count, double mean) {
    statistic += (count - mean) * (count - mean) / mean;
    ++cells;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= 10) {
      add(counts[i], expected[i]);
      continue;
    }
    pooled_count += counts[i];
    pooled_expected += expected[i];
  }
  if (pooled_expected >= 10) add(pooled_count, pooled_expected);
  // what must not happen at all: fewer than 10 expected, Poisson's tail beyond 60 is below 1e-20
  else if (pooled_count > 60)
    return 0;
  return cells > 1 ? chi_square_tail(statistic, cells - 1) : 1;
}

struct Node {
  double x, weight;
};

// Gauss and Legendre's rule on [0, 1] by Newton's method.
inline std::vector<Node> gauss_nodes(int order) {
  std::vector<Node> nodes;
  for (int i = 0; i < order; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (order + 0.5)), slope = 1;
    for (int step = 0; step < 10; ++step) {
      double before = 0, now = 1;
      for (int n = 1; n <= order; ++n) {
        const double next = ((2 * n - 1) * x * now - (n - 1) * before) / n;
        before = now;
        now = next;
      }
      slope = order * (x * now - before) / (x * x - 1);
      x -= now / slope;
    }
    nodes.push_back({(1 + x) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

inline Eigen::Vector3d direction_at(double cosine, double angle) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

// Rows of polar angle, columns of azimuth.
struct SphereCells {
  int rows = 12, columns = 16;

  std::size_t count() const { return static_cast<std::size_t>(rows) * columns; }
  std::size_t index(const Eigen::Vector3d& v) const {
    const double turn = std::atan2(v.y(), v.x()) / (2 * std::numbers::pi);
    const double tilt = std::atan2(std::hypot(v.x(), v.y()), v.z()) / std::numbers::pi;
    const int row = std::min(static_cast<int>(tilt * rows), rows - 1);
    const int column = static_cast<int>((turn < 0 ? turn + 1 : turn) * columns) % columns;
    return static_cast<std::size_t>(row) * columns + column;
  }
  // Integral of a function over each cell.
  template <class Function>
  std::vector<double> integrals(Function&& function, int order = 24) const {
    const std::vector<Node> nodes = gauss_nodes(order);
    std::vector<double> sums(count(), 0.0);
    const double area = 2 * std::numbers::pi * std::numbers::pi / static_cast<double>(count());
    for (std::size_t cell = 0; cell < count(); ++cell)
      for (const Node& a : nodes)
        for (const Node& b : nodes) {
          const double tilt = std::numbers::pi * (static_cast<double>(cell / columns) + a.x) / rows;
          const double turn = (static_cast<double>(cell % columns) + b.x) / columns;
          sums[cell] += area * std::sin(tilt) * a.weight * b.weight *
                        function(direction_at(std::cos(tilt), 2 * std::numbers::pi * turn));
        }
    return sums;
  }
};

inline double total(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

}  // namespace scan::synth
