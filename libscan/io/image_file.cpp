// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/image_file.h"

#include <algorithm>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/image_codecs.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

bool is_png(std::string_view bytes) {
  return bytes.substr(0, 4) == "\x89PNG";
}
bool is_jpeg(std::string_view bytes) {
  return bytes.substr(0, 2) == "\xff\xd8";
}

}  // namespace

void check_image_size(std::uint64_t width, std::uint64_t height, const std::string& name) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " px";
  constexpr std::uint64_t largest_side = std::numeric_limits<int>::max();
  if (width == 0 || height == 0 || width > largest_side || height > largest_side)
    throw Error(Trouble::input, name + ": is " + size);
  if (width * height > max_image_px)
    throw Error(Trouble::resource,
                name + ": is " + size + ", over the limit of " + std::to_string(max_image_px));
}

Image<std::uint8_t> read_grey8(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  if (is_png(bytes)) return decode_png_grey8(bytes, path.string());
  if (is_jpeg(bytes)) return decode_jpeg_grey8(bytes, path.string());
  throw Error(Trouble::input, path.string() + ": is neither PNG nor JPEG");
}

Image<std::uint16_t> read_grey16(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  if (!is_png(bytes)) throw Error(Trouble::input, path.string() + ": is not a PNG image");
  return decode_png_grey16(bytes, path.string());
}

Image<float> read_float_image(const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string());
  if (ending == ".pfm") return decode_pfm(read_file(path), path.string());
  const NumberArray array = read_npy(path);
  if (array.shape.size() != 2)
    throw Error(Trouble::input, path.string() +
                                    ": an image needs an array of two dimensions, it has " +
                                    std::to_string(array.shape.size()));
  check_image_size(array.shape[1], array.shape[0], path.string());
  Image<float> image(static_cast<int>(array.shape[1]), static_cast<int>(array.shape[0]));
  std::transform(array.values.begin(), array.values.end(), image.pixels.begin(), [](double value) {
    return std::isfinite(value) ? static_cast<float>(value)
                                : std::numeric_limits<float>::quiet_NaN();
  });
  return image;
}

}  // namespace scan
