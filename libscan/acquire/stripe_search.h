// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where in an image row the laser's stripe is, roughly, and whether there is just one.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "libscan/acquire/gaussian_fit.h"
#include "libscan/acquire/sensor_model.h"

namespace scan::decoding {

// The stripe of one row. `first` to `last` are the columns that are its own: the row's ends or the
// valleys to its neighbours. `miss` names why there is none (then the rest is void).
struct Stripe {
  std::string_view miss = {};
  Gaussian shape;  // first guess: from the width at half height
  int first = 0;
  int last = 0;
  Background background = {};
};

// Looks at the row through boxes of 1 to 33 pixels, so that stripes of sigma 0.6 to 10 px gather
// their light, and takes the finest box in which the stripe stands clear. A second peak at least
// half as high, with a valley between that noise does not explain, makes the row ambiguous.
Stripe find_stripe(std::span<const double> row_e, const Sensor& sensor, double threshold_sigmas);

}  // namespace scan::decoding
