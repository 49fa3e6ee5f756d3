// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Image files: PNG (8 and 16 bit), JPEG (reading), PFM and NumPy arrays (npy, npz).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "libscan/core/image.h"

namespace scan {

// Readers throw scan::Error: input for what is broken or of another kind, resource above
// max_image_px; both before anything is allocated. Writers: output.
inline constexpr std::size_t max_image_px = std::size_t{1} << 27;

using Colour = std::array<std::uint8_t, 3>;

// .png, .jpg. Colours become grey by 0.299 R + 0.587 G + 0.114 B.
Image<std::uint8_t> read_grey8(const std::filesystem::path& path);
// .png with one channel of 16 (or 8) bits, values as stored.
Image<std::uint16_t> read_grey16(const std::filesystem::path& path);
void write_png(const std::filesystem::path& path, const Image<std::uint8_t>& image);
void write_png(const std::filesystem::path& path, const Image<std::uint16_t>& image);
void write_png(const std::filesystem::path& path, const Image<Colour>& image);
std::string png_bytes(const Image<Colour>& image);  // for pages that carry their pictures

// .pfm (bottom row first on disk, unknown = infinity) or a two-dimensional .npy/.npz array (unknown
// = NaN). Unknown becomes NaN.
Image<float> read_float_image(const std::filesystem::path& path);
void write_pfm(const std::filesystem::path& path, const Image<float>& image);

// NumPy arrays of any shape in C order, of floats (16, 32, 64 bits), integers or booleans, either
// byte order; npz (stored or deflated): the first array.
struct NumberArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};
NumberArray read_npy(const std::filesystem::path& path);
void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
               const std::vector<std::uint16_t>& values);
void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
               const std::vector<double>& values);

}  // namespace scan
