// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/semi_global.h"

#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

namespace scan::decoding {
namespace {

Image<std::uint8_t> mirrored(const Image<std::uint8_t>& image) {
  Image<std::uint8_t> result = image;
  for (int row = 0; row < image.height; ++row)
    std::reverse(
        result.pixels.begin() + static_cast<std::ptrdiff_t>(result.index(0, row)),
        result.pixels.begin() + static_cast<std::ptrdiff_t>(result.index(0, row)) + image.width);
  return result;
}

// The matcher gives no disparity to the columns whose search range leaves the right image, so both
// images get that many more columns on each side.
cv::Mat padded(const Image<std::uint8_t>& image, int before, int after) {
  const cv::Mat view(image.height, image.width, CV_8UC1,
                     const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat result;
  cv::copyMakeBorder(view, result, 0, 0, before, after, cv::BORDER_REPLICATE);
  return result;
}

}  // namespace

Image<float> semi_global(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                         const SemiGlobalOptions& options) {
  const int range = (options.disparities_px + 15) / 16 * 16;  // the matcher wants multiples of 16
  const int before = std::max(0, options.min_disparity_px + range);
  const int after = std::max(0, -options.min_disparity_px);
  // Penalties for steps of 1 and of more, per squared block, as the matcher's authors advise; a
  // match must beat the next best by 5 %; islands of fewer than 60 px within 2 px are speckles.
  const int block2 = options.block_px * options.block_px;
  const auto matcher = cv::StereoSGBM::create(
      options.min_disparity_px, range, options.block_px, 8 * block2, 32 * block2,
      /*disp12MaxDiff=*/-1, /*preFilterCap=*/31, options.reject ? 5 : 0, options.reject ? 60 : 0,
      /*speckleRange=*/2, cv::StereoSGBM::MODE_HH);
  cv::Mat sixteenths;
  matcher->compute(padded(left, before, after), padded(right, before, after), sixteenths);

  Image<float> disparity(left.width, left.height, std::numeric_limits<float>::quiet_NaN());
  for (int row = 0; row < left.height; ++row)
    for (int column = 0; column < left.width; ++column) {
      const int value = sixteenths.at<short>(row, column + before);
      if (value >= options.min_disparity_px * 16)
        disparity(column, row) = static_cast<float>(value) / 16;
    }
  return disparity;
}

Image<float> semi_global_of_right(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                                  const SemiGlobalOptions& options) {
  const Image<float> seen = semi_global(mirrored(right), mirrored(left), options);
  Image<float> disparity = seen;
  for (int row = 0; row < seen.height; ++row)
    for (int column = 0; column < seen.width; ++column)
      disparity(column, row) = seen(seen.width - 1 - column, row);
  return disparity;
}

}  // namespace scan::decoding
