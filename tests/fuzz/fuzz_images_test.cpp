// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Broken copies of images and arrays.
#include <gtest/gtest.h>
#include <turbojpeg.h>
#include <zlib.h>

#include <bit>

#include "libscan/io/byte_order.h"
#include "libscan/io/image_file.h"
#include "tests/fuzz/fuzz.h"

namespace scan::test {
namespace {

constexpr int width = 24, height = 16;

template <class Pixel>
Image<Pixel> ramp() {
  Image<Pixel> image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<Pixel>(i * 7 % 200);
  return image;
}

template <class Pixel>
void expect_whole(const Image<Pixel>& image) {
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * image.height)
    throw std::logic_error("the pixels do not fill the image");
}

// A thousandth of the pixels may be in the file: deflate and Huffman codes are that dense.
constexpr Allowance packed{.fixed_bytes = std::size_t{1} << 22, .per_byte = 1 << 16};

TEST(Fuzz, Png) {
  const TemporaryFolder folder;
  write_png(folder / "a.png", ramp<std::uint8_t>());
  fuzz(
      folder / "a.png", [](const auto& path) { expect_whole(read_grey8(path)); }, packed);
  write_png(folder / "b.png", ramp<std::uint16_t>());
  fuzz(
      folder / "b.png", [](const auto& path) { expect_whole(read_grey16(path)); }, packed);
  write_png(folder / "c.png", Image<Colour>(width, height, {10, 20, 30}));
  fuzz(
      folder / "c.png", [](const auto& path) { expect_whole(read_grey8(path)); }, packed);
}

TEST(Fuzz, Jpeg) {
  const TemporaryFolder folder;
  const Image<std::uint8_t> image = ramp<std::uint8_t>();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const tjhandle encoder = tjInitCompress();
  ASSERT_EQ(tjCompress2(encoder, image.pixels.data(), width, 0, height, TJPF_GRAY, &bytes, &size,
                        TJSAMP_GRAY, 90, 0),
            0);
  write_file(folder / "a.jpg", {reinterpret_cast<const char*>(bytes), size});
  tjFree(bytes);
  tjDestroy(encoder);
  fuzz(
      folder / "a.jpg", [](const auto& path) { expect_whole(read_grey8(path)); }, packed);
}

TEST(Fuzz, Pfm) {
  const TemporaryFolder folder;
  write_pfm(folder / "a.pfm", ramp<float>());
  fuzz(folder / "a.pfm", [](const auto& path) { expect_whole(read_float_image(path)); });
}

// One deflated member called a.npy (PKWARE's APPNOTE, sections 4.3.7, 4.3.12, 4.3.16).
std::string zipped(const std::string& content) {
  std::string data(content.size() + 64, '\0');
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(data.data());
  stream.avail_out = static_cast<uInt>(data.size());
  deflate(&stream, Z_FINISH);
  data.resize(stream.total_out);
  deflateEnd(&stream);
  const auto crc =
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  const auto put = [](std::string& bytes, int size, std::uint64_t number) {
    for (int i = 0; i < size; ++i) bytes += static_cast<char>(number >> 8 * i & 255);
  };
  std::string shared;
  put(shared, 2, 20), put(shared, 2, 0), put(shared, 2, 8), put(shared, 4, 0);
  put(shared, 4, crc), put(shared, 4, data.size()), put(shared, 4, content.size());
  put(shared, 2, 5), put(shared, 2, 0);
  const std::string local = "PK\3\4" + shared + "a.npy" + data;
  std::string central = "PK\1\2";
  put(central, 2, 20);
  central += shared;
  put(central, 2, 0), put(central, 2, 0), put(central, 2, 0), put(central, 4, 0);
  put(central, 4, 0);
  central += "a.npy";
  std::string end = "PK\5\6";
  put(end, 4, 0), put(end, 2, 1), put(end, 2, 1), put(end, 4, central.size());
  put(end, 4, local.size()), put(end, 2, 0);
  return local + central + end;
}

TEST(Fuzz, NpyAndNpz) {
  const TemporaryFolder folder;
  const Reader read = [](const auto& path) {
    const NumberArray array = read_npy(path);
    std::size_t count = 1;
    for (const std::size_t side : array.shape) count *= side;
    if (count != array.values.size()) throw std::logic_error("numbers do not fill the shape");
  };
  write_npy(folder / "a.npy", {4, 3}, std::vector<double>(12, 1.0 / 3));
  fuzz(folder / "a.npy", read);
  write_npy(folder / "b.npy", {5}, std::vector<std::uint16_t>{1, 2, 3, 4, 65535});
  fuzz(folder / "b.npy", read);
  write_file(folder / "a.npz", zipped(read_file(folder / "a.npy")));
  fuzz(folder / "a.npz", read, packed);
}

}  // namespace
}  // namespace scan::test
