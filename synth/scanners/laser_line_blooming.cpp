// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_blooming.h"

namespace scan::synth {
namespace {

// Empties the run of full pixels around `over` onto its two neighbours. Returns the first pixel
// that may now be over full.
int spill_run(std::span<double> row_e, int over, double full_well_e) {
  const int count = static_cast<int>(row_e.size());
  int left = over, right = over;
  while (left >= 0 && row_e[left] >= full_well_e) --left;
  while (right < count && row_e[right] >= full_well_e) ++right;
  double excess_e = 0, moment_e = 0;  // about `left`
  for (int i = left + 1; i < right; ++i) {
    excess_e += row_e[i] - full_well_e;
    moment_e += (row_e[i] - full_well_e) * (i - left);
    row_e[i] = full_well_e;
  }
  const double to_right_e = moment_e / (right - left);
  if (right < count) row_e[right] += to_right_e;
  if (left >= 0) row_e[left] += excess_e - to_right_e;
  return left >= 0 ? left : over;
}

}  // namespace

void bloom(std::span<double> row_e, double full_well_e, double spilling) {
  for (double& charge_e : row_e)
    if (charge_e > full_well_e) charge_e = full_well_e + spilling * (charge_e - full_well_e);
  for (int i = 0; i < static_cast<int>(row_e.size());)
    if (row_e[i] > full_well_e)
      i = spill_run(row_e, i, full_well_e);
    else
      ++i;
}

}  // namespace scan::synth
