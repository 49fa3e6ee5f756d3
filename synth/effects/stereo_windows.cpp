// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/stereo_windows.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {
namespace {

constexpr int side_px = StereoWindow::side_px;

template <class Term>
double sum_over(Term&& term) {
  double sum = 0;
  for (int row = 0; row < side_px; ++row)
    for (int column = 0; column < side_px; ++column) sum += term(row, column);
  return sum;
}

// Between a column and the next, as the decoder reads it: cubic convolution (Keys 1981).
double between_columns(const StereoWindow& w, int row, int column, double t) {
  const double a = w.at(row, column - 1), b = w.at(row, column), c = w.at(row, column + 1),
               d = w.at(row, column + 2);
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

}  // namespace

StereoWindow window_at(const StereoPair& s, const RayCaster& caster, const Pose& pose,
                       StereoSide side, int column, int row) {
  StereoWindow w;
  for (int j = 0; j < side_px; ++j)
    for (int i = -1; i < side_px + 2; ++i)
      w.electrons[j][i + 1] =
          expected_electrons(s, caster, pose, side, column + i - StereoWindow::half_px,
                             row + j - StereoWindow::half_px);
  return w;
}

double slope_energy(const StereoWindow& w) {
  return sum_over([&](int row, int column) { return std::pow(w.slope(row, column), 2); });
}

double varying_slope_energy(const StereoWindow& w) {
  const double sum = sum_over([&](int row, int column) { return w.slope(row, column); });
  return slope_energy(w) - sum * sum / StereoWindow::pixels;
}

double slope_ratio(const StereoWindow& w) {
  const double down = sum_over([&](int row, int column) {
    return row == 0 ? 0 : std::pow(w.at(row, column) - w.at(row - 1, column), 2);
  });
  return std::sqrt(down / std::max(slope_energy(w), 1e-300));
}

double change_px(const WindowPair& with, const WindowPair& without) {
  const auto change = [&](int row, int column) {
    const auto difference = [&](const WindowPair& pair) {
      return pair.left.at(row, column) - between_columns(pair.right, row, column, pair.between);
    };
    return difference(with) - difference(without);
  };
  const double sum = sum_over(change);
  const double squares =
      sum_over([&](int row, int column) { return std::pow(change(row, column), 2); });
  const double varying = std::max(0.0, squares - sum * sum / StereoWindow::pixels);
  return std::sqrt(varying / varying_slope_energy(with.left));
}

}  // namespace scan::synth
