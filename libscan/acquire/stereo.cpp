// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stereo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "libscan/acquire/depth_edges.h"
#include "libscan/acquire/disparity_refinement.h"
#include "libscan/acquire/ray_outcome.h"
#include "libscan/acquire/reason.h"
#include "libscan/acquire/semi_global.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

using decoding::missed;
using decoding::RayOutcome;

void require(bool holds, const char* field, double value, const char* limit) {
  if (holds) return;
  throw Error(Trouble::input,
              std::string("stereo/") + field + ": " + std::to_string(value) + ", must be " + limit);
}

void check(const StereoCalibration& c) {
  require(c.width_px > 0, "width_px", c.width_px, "positive");
  require(c.height_px > 0, "height_px", c.height_px, "positive");
  require(c.focal_px > 0 && std::isfinite(c.focal_px), "focal_px", c.focal_px, "positive");
  require(c.baseline_m > 0 && std::isfinite(c.baseline_m), "baseline_m", c.baseline_m, "positive");
  require(std::isfinite(c.cx_px), "cx_px", c.cx_px, "finite");
  require(std::isfinite(c.cy_px), "cy_px", c.cy_px, "finite");
  require(std::isfinite(c.doffs_px), "doffs_px", c.doffs_px, "finite");
}

void check(const ImagePair& pair, const StereoOptions& options) {
  const StereoCalibration& c = pair.calibration;
  check(c);
  // The matcher keeps sixteenths of a pixel in 16 bits.
  require(c.disparities_px > 0 && c.disparities_px < 2000, "disparities_px", c.disparities_px,
          "1 to 1999");
  require(std::abs(c.min_disparity_px) + c.disparities_px < 2000, "min_disparity_px",
          c.min_disparity_px, "within 2000 px of 0 with the search range");
  for (const Image<std::uint8_t>* image : {&pair.left, &pair.right})
    if (image->width != c.width_px || image->height != c.height_px)
      throw Error(Trouble::input, "stereo/image: " + std::to_string(image->width) + " x " +
                                      std::to_string(image->height) + " px, the calibration has " +
                                      std::to_string(c.width_px) + " x " +
                                      std::to_string(c.height_px));
  check(options);
}

// Whether the block about a pixel changes along the row by more than rounding does: the variance of
// a difference of two rounded readings is 1/6, so their mean square must exceed 1/2.
bool has_texture(const Image<std::uint8_t>& image, int column, int row, int block_px) {
  const int half = std::max(1, block_px / 2);
  int count = 0, sum2 = 0;
  for (int y = std::max(0, row - half); y <= std::min(image.height - 1, row + half); ++y)
    for (int x = std::max(1, column - half); x <= std::min(image.width - 1, column + half); ++x) {
      const int difference = image(x, y) - image(x - 1, y);
      ++count;
      sum2 += difference * difference;
    }
  return 2 * sum2 > count;
}

// Why a pixel has no disparity; empty if it has one. The left-right check asks the pixels of the
// right image on both sides of the match; one that agrees is enough.
std::string_view fault(const ImagePair& pair, const StereoOptions& options,
                       const Image<float>& of_left, const Image<float>& of_right, int column,
                       int row) {
  if (!has_texture(pair.left, column, row, options.block_px)) return reason::no_signal;
  const float disparity = of_left(column, row);
  if (std::isnan(disparity)) return reason::ambiguous;
  const double match = column - static_cast<double>(disparity);
  if (match < 0 || match > pair.right.width - 1) return reason::border;
  for (const double candidate : {std::floor(match), std::ceil(match)}) {
    const double back = of_right(static_cast<int>(candidate), row);
    if (std::abs(back - disparity) <= options.max_left_right_px) return {};
  }
  return reason::inconsistent;
}

void reject(decoding::RefinedDisparity& refined, std::size_t pixel, std::string_view why,
            std::map<std::string, std::size_t>& misses) {
  refined.disparity_px.pixels[pixel] = std::numeric_limits<float>::quiet_NaN();
  refined.sigma_px.pixels[pixel] = std::numeric_limits<float>::quiet_NaN();
  ++misses[std::string(why)];
}

// The matcher's smoothness also finds agreement in noise. The best of a hundred windows of 7 x 7
// unrelated pixels correlates by about 2.5 / 7.
void reject_uncorrelated(decoding::RefinedDisparity& refined,
                         std::map<std::string, std::size_t>& misses) {
  constexpr float least_correlation = 0.4f;
  for (std::size_t i = 0; i < refined.correlation.pixels.size(); ++i) {
    if (!(refined.correlation.pixels[i] < least_correlation)) continue;
    reject(refined, i, reason::inconsistent, misses);
  }
}

void reject_depth_edges(int margin_px, decoding::RefinedDisparity& refined,
                        std::map<std::string, std::size_t>& misses) {
  const std::vector<char> near = decoding::near_depth_edge(refined.disparity_px, margin_px);
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i]) reject(refined, i, reason::border, misses);
}

}  // namespace

void check(const StereoOptions& options) {
  require(options.block_px >= 1 && options.block_px % 2 == 1 && options.block_px <= 31, "block_px",
          options.block_px, "odd, 1 to 31");
  require(options.edge_margin_px >= 0 && options.edge_margin_px <= 100, "edge_margin_px",
          options.edge_margin_px, "0 to 100");
  require(options.max_left_right_px > 0, "max_left_right_px", options.max_left_right_px,
          "positive");
  require(options.disparity_sigma_px >= 0, "disparity_sigma_px", options.disparity_sigma_px,
          "0 or more");
}

DisparityMap match(const ImagePair& pair, const StereoOptions& options) {
  check(pair, options);
  decoding::SemiGlobalOptions search{pair.calibration.min_disparity_px,
                                     pair.calibration.disparities_px, options.block_px, true};
  Image<float> disparity = decoding::semi_global(pair.left, pair.right, search);
  search.reject = false;  // the check needs an opinion of every right pixel
  const Image<float> of_right = decoding::semi_global_of_right(pair.left, pair.right, search);

  std::vector<std::string_view> faults(disparity.pixels.size());
  parallel_for(faults.size(), [&](std::size_t i) {
    faults[i] = fault(pair, options, disparity, of_right, static_cast<int>(i % disparity.width),
                      static_cast<int>(i / disparity.width));
  });
  DisparityMap map;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (faults[i].empty()) continue;
    disparity.pixels[i] = std::numeric_limits<float>::quiet_NaN();
    ++map.misses[std::string(faults[i])];
  }
  // What passed the left-right check lies, at three sigma, within its limit.
  decoding::RefinedDisparity refined = decoding::refine(
      pair.left, pair.right, disparity, options.block_px, options.max_left_right_px / 3);
  reject_uncorrelated(refined, map.misses);
  if (options.edge_margin_px > 0) reject_depth_edges(options.edge_margin_px, refined, map.misses);
  map.disparity_px = std::move(refined.disparity_px);
  map.sigma_px = std::move(refined.sigma_px);
  if (options.disparity_sigma_px > 0)
    for (float& sigma : map.sigma_px.pixels)
      if (!std::isnan(sigma)) sigma = static_cast<float>(options.disparity_sigma_px);
  return map;
}

Scan points_from(const DisparityMap& map, const StereoCalibration& calibration) {
  check(calibration);
  const Image<float>& disparity = map.disparity_px;
  if (disparity.width != calibration.width_px || disparity.height != calibration.height_px)
    throw Error(Trouble::input, "stereo/disparity: " + std::to_string(disparity.width) + " x " +
                                    std::to_string(disparity.height) +
                                    " px, the calibration has another size");
  constexpr std::string_view counted_before = "counted before";
  std::vector<RayOutcome> outcomes(disparity.pixels.size());
  parallel_for(outcomes.size(), [&](std::size_t i) {
    if (std::isnan(disparity.pixels[i])) {
      outcomes[i] = missed(counted_before);
      return;
    }
    const double parallax = disparity.pixels[i] + calibration.doffs_px;
    const double sigma_px = map.sigma_px.pixels[i];
    // Infinity within three sigma: no depth.
    if (!(parallax > 3 * sigma_px) || !(parallax > 0)) {
      outcomes[i] = missed(reason::undetermined);
      return;
    }
    const double depth_m = calibration.focal_px * calibration.baseline_m / parallax;
    const std::size_t row = i / disparity.width, column = i % disparity.width;
    const Eigen::Vector3d ray(
        (static_cast<double>(column) - calibration.cx_px) / calibration.focal_px,
        (static_cast<double>(row) - calibration.cy_px) / calibration.focal_px, 1);
    // dZ/dd = -Z / (d + doffs); the point moves along its ray, all of it by the same share.
    const double range_m = depth_m * ray.norm();
    outcomes[i] =
        decoding::point_on_ray(ray.normalized(), range_m, range_m * sigma_px / parallax, 0);
  });
  Scan scan = decoding::collect(outcomes, {static_cast<std::uint32_t>(disparity.height),
                                           static_cast<std::uint32_t>(disparity.width)});
  scan.misses.erase(std::string(counted_before));
  for (const auto& [reason, count] : map.misses) scan.misses[reason] += count;
  return scan;
}

Scan acquire_stereo(const ImagePair& pair, const StereoOptions& options) {
  Scan scan = points_from(match(pair, options), pair.calibration);
  for (std::size_t i = 0; i < scan.ray.size(); ++i)
    scan.cloud.intensity[i] = pair.left.pixels[scan.ray[i]];
  const auto window = static_cast<std::uint32_t>(decoding::refinement_window_px(options.block_px));
  scan.noise_window = {window, window};
  return scan;
}

}  // namespace scan
