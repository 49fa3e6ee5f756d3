// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Comparison of disparity images, as the Middlebury benchmark counts (Scharstein et al. 2014).
#include "libscan/verify/disparity_error.h"

#include <cmath>
#include <limits>
#include <string>

#include "libscan/core/error.h"
#include "libscan/verify/statistics.h"

namespace scan {
namespace {

constexpr double bad_px = 2;

// Z ~ 1 / (d + doffs), so |Z - Z*| / Z* = |(d* + doffs) / (d + doffs) - 1|. A disparity that puts
// the point at infinity or behind the cameras has an infinite error.
double relative_depth_error(double measured_px, double true_px, double doffs_px) {
  const double shift_px = measured_px + doffs_px;
  if (!(shift_px > 0)) return std::numeric_limits<double>::infinity();
  return std::abs((true_px + doffs_px) / shift_px - 1);
}

}  // namespace

std::vector<Measurement> disparity_error(const Image<float>& measured, const Image<float>& truth,
                                         double doffs_px) {
  if (measured.width != truth.width || measured.height != truth.height)
    throw Error(Trouble::input, "disparity: measured image is " + std::to_string(measured.width) +
                                    " x " + std::to_string(measured.height) + " px, the true one " +
                                    std::to_string(truth.width) + " x " +
                                    std::to_string(truth.height) + " px");
  std::vector<double> errors_px, depth_errors;
  std::size_t known = 0, bad = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const double d_true = truth.pixels[i], d = measured.pixels[i];
    if (!std::isfinite(d_true)) continue;
    ++known;
    if (!std::isfinite(d)) continue;
    errors_px.push_back(std::abs(d - d_true));
    bad += errors_px.back() > bad_px;
    depth_errors.push_back(relative_depth_error(d, d_true, doffs_px));
  }
  if (known == 0) throw Error(Trouble::input, "disparity: the true image has no known pixel");

  const std::size_t matched = errors_px.size();
  const auto share = [](std::size_t part, std::size_t whole) {  // NaN over nothing
    return static_cast<double>(part) / static_cast<double>(whole);
  };
  const char* of_matched = "matched pixels with known truth";
  const char* of_known = "pixels with known truth";
  return {{"disparity_bad_2px", share(bad, matched), "1", of_matched, matched},
          {"disparity_bad_2px_all", share(bad + known - matched, known), "1",
           std::string(of_known) + ", unmatched ones bad", known},
          {"disparity_density", share(matched, known), "1", of_known, known},
          {"disparity_error_median", quantile(errors_px, 0.5), "px", of_matched, matched},
          {"relative_depth_error_median", quantile(depth_errors, 0.5), "1", of_matched, matched}};
}

}  // namespace scan
