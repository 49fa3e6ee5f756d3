// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// PNG by libpng. It reports errors by longjmp, which must not cross a C++ object with a destructor:
// each function that calls setjmp holds plain data only; the objects live in its callers.
#include <png.h>

#include <csetjmp>
#include <cstring>
#include <new>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/image_codecs.h"

namespace scan {
namespace {

constexpr std::uint64_t deflate_limit = 1032;  // unpacked over packed bytes, at most (zlib)

struct Trap {
  std::jmp_buf back;
  char message[160] = "";
};

void on_error(png_structp png, png_const_charp message) {
  auto* trap = static_cast<Trap*>(png_get_error_ptr(png));
  std::strncpy(trap->message, message, sizeof trap->message - 1);
  std::longjmp(trap->back, 1);
}

void on_warning(png_structp, png_const_charp) {}

struct Source {
  const char* bytes;
  std::size_t left;
};

void on_read(png_structp png, png_bytep to, std::size_t count) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (count > source->left) png_error(png, "the file ends early");
  std::memcpy(to, source->bytes, count);
  source->bytes += count;
  source->left -= count;
}

struct Reader {
  explicit Reader(std::string_view bytes) : source{bytes.data(), bytes.size()} {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &trap, on_error, on_warning);
    info = png ? png_create_info_struct(png) : nullptr;
    if (!info) {
      png_destroy_read_struct(&png, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png, &source, on_read);
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  Trap trap;
  Source source;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

bool read_header(Reader& reader) {
  if (setjmp(reader.trap.back)) return false;
  png_set_user_limits(reader.png, 0x7fffffff, 0x7fffffff);
  png_read_info(reader.png, reader.info);
  return true;
}

// How pixels shall come out of libpng.
enum class Wanted { rgb_or_grey_8, stored_grey_16 };

bool set_transforms(Reader& reader, Wanted wanted) {
  if (setjmp(reader.trap.back)) return false;
  png_structp png = reader.png;
  const int depth = png_get_bit_depth(png, reader.info);
  const int colour = png_get_color_type(png, reader.info);
  if (wanted == Wanted::stored_grey_16) {
    if (depth < 8) png_set_packing(png);
    if (depth == 16) png_set_swap(png);
  } else {
    if (colour == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
    if (colour == PNG_COLOR_TYPE_GRAY && depth < 8) png_set_expand_gray_1_2_4_to_8(png);
    if (depth == 16) png_set_scale_16(png);
    png_set_strip_alpha(png);
  }
  png_set_interlace_handling(png);
  png_read_update_info(png, reader.info);
  return true;
}

bool read_rows(Reader& reader, png_bytep* rows) {
  if (setjmp(reader.trap.back)) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

struct Decoded {
  int width = 0;
  int height = 0;
  std::size_t row_bytes = 0;
  std::string bytes;  // row by row
};

void check_packed_size(std::uint64_t unpacked, std::size_t packed, const std::string& name) {
  if (unpacked > deflate_limit * packed)
    throw Error(Trouble::input, name + ": promises " + std::to_string(unpacked) +
                                    " bytes of pixels, more than its " + std::to_string(packed) +
                                    " bytes can hold");
}

Decoded decode(std::string_view file, Wanted wanted, const std::string& name) {
  Reader reader(file);
  const auto fail = [&](const std::string& what) {
    throw Error(Trouble::input, name + ": broken PNG: " + what);
  };
  if (!read_header(reader)) fail(reader.trap.message);
  Decoded image;
  const auto width = png_get_image_width(reader.png, reader.info);
  const auto height = png_get_image_height(reader.png, reader.info);
  check_image_size(width, height, name);
  // stored bytes, before any transform enlarges them
  check_packed_size(std::uint64_t{png_get_rowbytes(reader.png, reader.info)} * height, file.size(),
                    name);
  const int colour = png_get_color_type(reader.png, reader.info);
  if (wanted == Wanted::stored_grey_16 && colour != PNG_COLOR_TYPE_GRAY)
    throw Error(Trouble::input, name + ": has colours or transparency, one grey channel is needed");
  if (!set_transforms(reader, wanted)) fail(reader.trap.message);
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.row_bytes = png_get_rowbytes(reader.png, reader.info);
  image.bytes.resize(image.row_bytes * height);
  std::vector<png_bytep> rows(height);
  for (std::size_t row = 0; row < height; ++row)
    rows[row] = reinterpret_cast<png_bytep>(image.bytes.data()) + row * image.row_bytes;
  if (!read_rows(reader, rows.data())) fail(reader.trap.message);
  return image;
}

struct Writer {
  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &trap, on_error, on_warning);
    info = png ? png_create_info_struct(png) : nullptr;
    if (!info) {
      png_destroy_write_struct(&png, nullptr);
      throw std::bad_alloc();
    }
  }
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  Trap trap;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string bytes;
};

void on_write(png_structp png, png_bytep from, std::size_t count) {
  auto* writer = static_cast<Writer*>(png_get_io_ptr(png));
  bool stored = true;
  try {
    writer->bytes.append(reinterpret_cast<const char*>(from), count);
  } catch (const std::exception&) {
    stored = false;
  }
  if (!stored) png_error(png, "out of memory");
}

bool write_rows(Writer& writer, png_uint_32 width, png_uint_32 height, int depth, int colour,
                png_bytep* rows) {
  if (setjmp(writer.trap.back)) return false;
  png_set_write_fn(writer.png, &writer, on_write, nullptr);
  png_set_IHDR(writer.png, writer.info, width, height, depth, colour, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  if (depth == 16) png_set_swap(writer.png);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, nullptr);
  return true;
}

template <class Pixel>
std::string encode(const Image<Pixel>& image, int depth, int colour) {
  if (image.empty()) throw Error(Trouble::output, "an image without pixels cannot be a PNG");
  Writer writer;
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.height));
  for (int row = 0; row < image.height; ++row)  // libpng does not write to them
    rows[static_cast<std::size_t>(row)] =
        reinterpret_cast<png_bytep>(const_cast<Pixel*>(&image(0, row)));
  if (!write_rows(writer, static_cast<png_uint_32>(image.width),
                  static_cast<png_uint_32>(image.height), depth, colour, rows.data()))
    throw Error(Trouble::output, std::string("PNG: ") + writer.trap.message);
  return std::move(writer.bytes);
}

}  // namespace

Image<std::uint8_t> decode_png_grey8(std::string_view bytes, const std::string& name) {
  const Decoded decoded = decode(bytes, Wanted::rgb_or_grey_8, name);
  Image<std::uint8_t> image(decoded.width, decoded.height);
  const std::size_t channels = decoded.row_bytes / static_cast<std::size_t>(decoded.width);
  const auto* at = reinterpret_cast<const std::uint8_t*>(decoded.bytes.data());
  for (std::uint8_t& pixel : image.pixels) {
    // ITU-R BT.601 weights in thousandths, rounded to nearest
    pixel = channels == 1
                ? at[0]
                : static_cast<std::uint8_t>((299 * at[0] + 587 * at[1] + 114 * at[2] + 500) / 1000);
    at += channels;
  }
  return image;
}

Image<std::uint16_t> decode_png_grey16(std::string_view bytes, const std::string& name) {
  const Decoded decoded = decode(bytes, Wanted::stored_grey_16, name);
  Image<std::uint16_t> image(decoded.width, decoded.height);
  if (decoded.row_bytes == 2 * static_cast<std::size_t>(decoded.width)) {
    std::memcpy(image.pixels.data(), decoded.bytes.data(), decoded.bytes.size());
  } else {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] = static_cast<std::uint8_t>(decoded.bytes[i]);
  }
  return image;
}

void write_png(const std::filesystem::path& path, const Image<std::uint8_t>& image) {
  write_file(path, encode(image, 8, PNG_COLOR_TYPE_GRAY));
}

void write_png(const std::filesystem::path& path, const Image<std::uint16_t>& image) {
  write_file(path, encode(image, 16, PNG_COLOR_TYPE_GRAY));
}

void write_png(const std::filesystem::path& path, const Image<Colour>& image) {
  write_file(path, png_bytes(image));
}

std::string png_bytes(const Image<Colour>& image) {
  return encode(image, 8, PNG_COLOR_TYPE_RGB);
}

}  // namespace scan
