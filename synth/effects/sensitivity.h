// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How noise of a pixel's reading becomes an error of range: closed forms for each scanner.
#pragma once

#include <string>
#include <vector>

#include "synth/scanner.h"

namespace scan::synth {

// At one working point of a scanner.
struct Sensitivity {
  double shot_m = 0;                // 1 sigma of range by shot noise
  double per_electron_m = 0;        // 1 sigma of range per electron of white noise in each reading
  double worst_per_electron_m = 0;  // range error at most if each reading is off by one electron
  Sensor sensor;
};

// Working points from the strongest to the weakest signal that the scanner is meant for: a white
// target near and a dark one (albedo 0.1) far.
std::vector<Sensitivity> sensitivities(const Scanner& scanner);

}  // namespace scan::synth
