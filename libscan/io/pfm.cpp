// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Portable float maps: "Pf", width, height, a scale whose sign tells the byte order, rows from
// below.
#include <bit>
#include <cmath>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/byte_order.h"
#include "libscan/io/image_codecs.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

// The next word of the header and the one blank behind it.
std::string_view header_word(std::string_view& rest) {
  const std::size_t begin = rest.find_first_not_of(" \t\r\n");
  const std::size_t end =
      begin == std::string_view::npos ? begin : rest.find_first_of(" \t\r\n", begin);
  if (end == std::string_view::npos) return {};
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end + 1);
  return word;
}

}  // namespace

Image<float> decode_pfm(std::string_view bytes, const std::string& name) {
  const auto fail = [&](const std::string& what) {
    throw Error(Trouble::input, name + ": " + what);
  };
  const std::string_view kind = header_word(bytes);
  if (kind == "PF") fail("is a colour PFM, one channel ('Pf') is needed");
  if (kind != "Pf") fail("is not a PFM image (its first word is not 'Pf')");
  const auto width = number_from<std::uint32_t>(header_word(bytes));
  const auto height = number_from<std::uint32_t>(header_word(bytes));
  const auto scale = number_from<double>(header_word(bytes));
  if (!width || !height) fail("width and height must be whole numbers");
  if (!scale || *scale == 0 || !std::isfinite(*scale)) fail("the scale must be a number but 0");
  check_image_size(*width, *height, name);
  if (bytes.size() != std::size_t{*width} * *height * sizeof(float))
    fail("has " + std::to_string(bytes.size()) + " bytes for " + std::to_string(*width) + " x " +
         std::to_string(*height) + " floats");
  const auto order = *scale < 0 ? std::endian::little : std::endian::big;
  Image<float> image(static_cast<int>(*width), static_cast<int>(*height));
  for (int row = image.height - 1; row >= 0; --row)
    for (int column = 0; column < image.width; ++column) {
      const float value = load<float>(bytes.data(), order);
      bytes.remove_prefix(sizeof(float));
      image(column, row) = std::isfinite(value) ? value : std::numeric_limits<float>::quiet_NaN();
    }
  return image;
}

void write_pfm(const std::filesystem::path& path, const Image<float>& image) {
  if (image.empty()) throw Error(Trouble::output, path.string() + ": an image without pixels");
  std::string bytes =
      "Pf\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1\n";
  for (int row = image.height - 1; row >= 0; --row)
    for (int column = 0; column < image.width; ++column) {
      const float value = image(column, row);
      store(bytes, std::isnan(value) ? std::numeric_limits<float>::infinity() : value,
            std::endian::little);
    }
  write_file(path, bytes);
}

}  // namespace scan
