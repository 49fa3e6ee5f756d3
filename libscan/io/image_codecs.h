// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The image formats one by one, from and to memory; `name` is how errors call the file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "libscan/core/image.h"
#include "libscan/io/image_file.h"

namespace scan {

// Throws scan::Error: input for sizes that are not positive, resource above max_image_px.
void check_image_size(std::uint64_t width, std::uint64_t height, const std::string& name);

Image<std::uint8_t> decode_png_grey8(std::string_view bytes, const std::string& name);
Image<std::uint16_t> decode_png_grey16(std::string_view bytes, const std::string& name);
Image<std::uint8_t> decode_jpeg_grey8(std::string_view bytes, const std::string& name);
Image<float> decode_pfm(std::string_view bytes, const std::string& name);
NumberArray decode_npy(std::string_view bytes, const std::string& name);

// The first member of a zip archive whose name ends in `ending`, unpacked and checked against its
// CRC.
std::string first_zip_member(std::string_view bytes, std::string_view ending,
                             const std::string& name);

}  // namespace scan
