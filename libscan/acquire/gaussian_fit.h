// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The place of a Gaussian in noisy samples: maximum likelihood, centroid.
#pragma once

#include <optional>
#include <span>

namespace scan::decoding {

// Amplitude * exp(-(x - centre)^2 / (2 sigma^2)), x in samples.
struct Gaussian {
  double centre = 0;
  double sigma = 1;
  double amplitude = 0;
};

struct Location {
  Gaussian shape;
  double centre_sigma = 0;  // 1 sigma of shape.centre, samples
};

enum class Width { known, free };

// Signal above the background, electrons; sample i stands at x = first + i. Each has the variance
// background_variance_e2 plus its own expectation (shot noise).
struct Samples {
  std::span<const double> signal_e;
  double first = 0;
  double background_variance_e2 = 0;
};

// Maximum likelihood by Fisher scoring: weights are the inverse variances under the model itself,
// so that for pure shot noise the fixed point is Poisson's. The centre's sigma is the Cramer-Rao
// bound, sigma / sqrt(N) for N electrons without other noise. None if the iteration leaves the
// samples or does not settle. A free width stays within [0.4, 30] samples.
std::optional<Location> fit_gaussian(const Samples& samples, const Gaussian& start, Width width);

// Centre of mass over start.centre +- (3 start.sigma + 1), the window moved until it is centred on
// its own result (its end samples count by their covered share). None if the signal in it is not
// positive.
std::optional<Location> centroid(const Samples& samples, const Gaussian& start);

}  // namespace scan::decoding
