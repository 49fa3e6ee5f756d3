// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/image_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>

#include "libscan/core/cost.h"
#include "libscan/io/image_codecs.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

template <class Pixel>
Image<Pixel> noise(int width, int height) {
  Image<Pixel> image(width, height);
  RandomStream random(2, 0, 0);
  for (Pixel& pixel : image.pixels) pixel = static_cast<Pixel>(random.bits32());
  return image;
}

TEST(Png, BringsBack8And16BitGrey) {
  const TemporaryFolder folder;
  write_png(folder / "a.png", noise<std::uint8_t>(7, 5));
  const auto narrow = read_grey8(folder / "a.png");
  EXPECT_EQ(narrow.width, 7);
  EXPECT_EQ(narrow.height, 5);
  EXPECT_EQ(narrow.pixels, noise<std::uint8_t>(7, 5).pixels);
  write_png(folder / "b.png", noise<std::uint16_t>(5, 9));
  EXPECT_EQ(read_grey16(folder / "b.png").pixels, noise<std::uint16_t>(5, 9).pixels);
  const auto widened = read_grey16(folder / "a.png");  // 8 bits, values as stored
  EXPECT_TRUE(std::equal(widened.pixels.begin(), widened.pixels.end(), narrow.pixels.begin()));
}

TEST(Png, TurnsColoursIntoGreyByTheStatedWeights) {
  const TemporaryFolder folder;
  Image<Colour> image(4, 1);
  image.pixels = {{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {10, 20, 30}}};
  write_png(folder / "c.png", image);
  // 76.245, 149.685, 29.07, 18.15
  EXPECT_EQ(read_grey8(folder / "c.png").pixels, (std::vector<std::uint8_t>{76, 150, 29, 18}));
  EXPECT_NE(error_of([&] { read_grey16(folder / "c.png"); }).find("one grey channel"),
            std::string::npos);
}

TEST(Png, ReadsOrRefusesAnyDamage) {
  const TemporaryFolder folder;
  write_png(folder / "a.png", noise<std::uint16_t>(16, 12));
  for (const auto& good :
       {read_file(folder / "a.png"), png_bytes(Image<Colour>(9, 9, {{1, 2, 3}}))})
    expect_read_or_refused(good, 3000, [](const std::string& bytes) {
      decode_png_grey8(bytes, "damaged.png");
      decode_png_grey16(bytes, "damaged.png");
    });
}

// IHDR with a right checksum that promises 10000 x 10000 16-bit pixels in a file of a hundred
// bytes.
TEST(Png, RefusesLyingSizesBeforeAllocating) {
  const TemporaryFolder folder;
  write_png(folder / "a.png", noise<std::uint16_t>(2, 2));
  std::string bytes = read_file(folder / "a.png");
  const auto promise = [&](std::uint32_t side) {
    for (const std::size_t at : {16u, 20u})
      for (int k = 0; k < 4; ++k) bytes[at + k] = static_cast<char>(side >> (24 - 8 * k));
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()) + 12, 17);
    for (int k = 0; k < 4; ++k) bytes[29 + k] = static_cast<char>(crc >> (24 - 8 * k));
    write_file(folder / "lie.png", bytes);
  };
  const double before_mib = peak_memory_mib();
  promise(10000);
  EXPECT_NE(error_of([&] { read_grey16(folder / "lie.png"); }).find("promises 200000000 bytes"),
            std::string::npos);
  promise(100000);
  EXPECT_NE(
      error_of([&] { read_grey16(folder / "lie.png"); }, Trouble::resource).find("over the limit"),
      std::string::npos);
  EXPECT_LT(peak_memory_mib() - before_mib, 16);  // 191 MiB if it were believed
}

TEST(Pfm, BringsBackFloatsAndTheUnknown) {
  const TemporaryFolder folder;
  Image<float> image(3, 2);
  image.pixels = {1.5f, -0.1f, 3e-30f, std::nanf(""), 5, 6};
  write_pfm(folder / "a.pfm", image);
  const Image<float> back = read_float_image(folder / "a.pfm");
  ASSERT_EQ(back.width, 3);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_TRUE(back.pixels[i] == image.pixels[i] || (i == 3 && std::isnan(back.pixels[i])));
  // the bottom row stands first on disk, and the unknown as infinity
  const std::string bytes = read_file(folder / "a.pfm");
  float first;
  std::memcpy(&first, bytes.data() + bytes.size() - 24, 4);
  EXPECT_TRUE(std::isinf(first));
}

TEST(Pfm, ReadsBothByteOrders) {
  const std::string big =
      std::string("Pf\n2 1\n1.0\n") + std::string("\x3f\x80\x00\x00\x40\x00\x00\x00", 8);
  EXPECT_EQ(decode_pfm(big, "big.pfm").pixels, (std::vector<float>{1, 2}));
  const std::string little =
      std::string("Pf 2 1 -0.5 ") + std::string("\x00\x00\x80\x3f\x00\x00\x00\x40", 8);
  EXPECT_EQ(decode_pfm(little, "little.pfm").pixels, (std::vector<float>{1, 2}));
}

TEST(Pfm, ReadsOrRefusesAnyDamage) {
  const std::string good = std::string("Pf\n2 1\n-1.0\n") + std::string(8, '\x3f');
  expect_read_or_refused(good, 3000,
                         [](const std::string& bytes) { decode_pfm(bytes, "damaged.pfm"); });
  EXPECT_NE(
      error_of([&] { decode_pfm("Pf\n60000 2000\n-1\n1234", "lie.pfm"); }).find("has 4 bytes"),
      std::string::npos);
  error_of([&] { decode_pfm("Pf\n4000000000 4000000000\n-1\n1234", "lie.pfm"); });
}

TEST(Npy, BringsBackShapeAndNumbers) {
  const TemporaryFolder folder;
  write_npy(folder / "a.npy", {2, 3}, std::vector<double>{1, -0.1, 1e300, 4, 5, 6});
  const NumberArray doubles = read_npy(folder / "a.npy");
  EXPECT_EQ(doubles.shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(doubles.values, (std::vector<double>{1, -0.1, 1e300, 4, 5, 6}));
  write_npy(folder / "b.npy", {3}, std::vector<std::uint16_t>{0, 1, 65535});
  const NumberArray whole = read_npy(folder / "b.npy");
  EXPECT_EQ(whole.shape, std::vector<std::size_t>{3});
  EXPECT_EQ(whole.values, (std::vector<double>{0, 1, 65535}));
  EXPECT_EQ(read_file(folder / "b.npy").size() % 64, 6u);  // the data begins at a multiple of 64
  EXPECT_NE(read_file(folder / "b.npy").find("'shape': (3,), }"), std::string::npos);
}

std::string npy_by_hand(const std::string& type, const std::string& shape,
                        const std::string& data) {
  const std::string text =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(text.size()) + '\0' + text + data;
}

TEST(Npy, ReadsEachType) {
  const auto first = [](const std::string& type, const std::string& data) {
    return decode_npy(npy_by_hand(type, "(1,)", data), "a.npy").values.at(0);
  };
  EXPECT_EQ(first("<f2", std::string("\x00\xc1", 2)), -2.5);  // 1 10000 0100000000
  EXPECT_EQ(first("<f2", std::string("\x01\x00", 2)), std::ldexp(1, -24));
  EXPECT_EQ(first("<f4", std::string("\x00\x00\x80\x3f", 4)), 1);
  EXPECT_EQ(first(">f4", std::string("\x3f\x80\x00\x00", 4)), 1);
  EXPECT_EQ(first("|i1", "\xff"), -1);
  EXPECT_EQ(first("|u1", "\xff"), 255);
  EXPECT_EQ(first("|b1", "\x01"), 1);
  EXPECT_EQ(first(">i2", std::string("\xff\xfe", 2)), -2);
  EXPECT_EQ(first("<u4", "\xff\xff\xff\xff"), 4294967295.0);
  EXPECT_EQ(first("<i8", "\xff\xff\xff\xff\xff\xff\xff\xff"), -1);
}

TEST(Npy, RefusesShapesThatDoNotFitAndForeignTypes) {
  EXPECT_NE(error_of([] {
              decode_npy(npy_by_hand("<f8", "(4000000000, 4000000000)", "12345678"), "l.npy");
            }).find("its shape needs another number"),
            std::string::npos);
  error_of([] { decode_npy(npy_by_hand("<f8", "(2,)", "12345678"), "l.npy"); });
  EXPECT_NE(
      error_of([] { decode_npy(npy_by_hand("<c8", "(1,)", "12345678"), "l.npy"); }).find("'<c8'"),
      std::string::npos);
  expect_read_or_refused(npy_by_hand("<f4", "(2, 1)", "12345678"), 5000,
                         [](const std::string& bytes) { decode_npy(bytes, "damaged.npy"); });
}

// What a broken file holds is quoted, and must not break the message's one line.
TEST(Npy, SaysInOneLineWhatIsBroken) {
  const std::string said =
      error_of([] { decode_npy(npy_by_hand("<f4", "(2\n, 1\x1b)", "12345678"), "a.npy"); });
  EXPECT_EQ(said.find_first_of("\n\x1b"), std::string::npos) << said;
}

TEST(RealData, MotorcycleDisparityEqualsItsPfm) {
  const auto folder = outside_data() / "middlebury-motorcycle";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the stereo pair is not in " << folder;
  const Image<float> packed = read_float_image(folder / "motorcycle_disp.npz");
  const Image<float> plain = read_float_image(folder / "derived" / "motorcycle_disp.pfm");
  ASSERT_EQ(packed.width, 741);
  ASSERT_EQ(packed.height, 500);
  ASSERT_EQ(plain.pixels.size(), packed.pixels.size());
  std::size_t known = 0;
  for (std::size_t i = 0; i < packed.pixels.size(); ++i) {
    ASSERT_TRUE(packed.pixels[i] == plain.pixels[i] ||
                (std::isnan(packed.pixels[i]) && std::isnan(plain.pixels[i])));
    known += !std::isnan(packed.pixels[i]);
  }
  EXPECT_NEAR(static_cast<double>(known) / static_cast<double>(packed.pixels.size()), 0.927, 5e-4);
  EXPECT_EQ(read_grey8(folder / "motorcycle_left.png").width, 741);
}

TEST(RealData, DamagedArchivesAreReadOrRefused) {
  const auto file = outside_data() / "reconbench" / "scan" / "anchor_mvs.npz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the archive is not at " << file;
  const std::string good = read_file(file);
  for (int flip = 0; flip < 300; ++flip) {
    RandomStream random(4, 0, static_cast<std::uint64_t>(flip));
    std::string bytes = good;
    // half of the damage in the directory at the end
    const std::size_t room = flip % 2 == 0 ? bytes.size() : 400;
    bytes[bytes.size() - 1 - random.bits32() % room] = static_cast<char>(random.bits32());
    try {
      decode_npy(first_zip_member(bytes, ".npy", "a.npz"), "a.npz");
    } catch (const Error&) {
    }
  }
  for (std::size_t size = 0; size < good.size(); size += 997)
    error_of([&] { first_zip_member(good.substr(0, size), ".npy", "a.npz"); });
}

TEST(RealData, DepthAndColourImagesRead) {
  const auto data = outside_data();
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "the outside data is not in " << data;
  const auto depth = read_grey16(data / "redwood-rgbd" / "depth" / "00000.png");
  ASSERT_EQ(depth.width, 640);
  std::uint16_t nearest = 65535, farthest = 0;
  for (const std::uint16_t mm : depth.pixels)
    if (mm > 0) nearest = std::min(nearest, mm), farthest = std::max(farthest, mm);
  EXPECT_GE(nearest, 955);  // 0.96 to 2.70 m over all frames, rounded to centimetres
  EXPECT_LE(farthest, 2705);
  EXPECT_EQ(read_grey8(data / "middlebury-aloe" / "aloeL.jpg").width, 1282);
  EXPECT_EQ(read_grey8(data / "opencv-stereo-calibration" / "left01.jpg").height, 480);
  EXPECT_EQ(read_grey8(data / "laser-stripe-photos" / "cube.jpg").width, 480);
  const auto truth = read_grey16(data / "middlebury-aloe" / "aloeGT.png");
  EXPECT_EQ(*std::max_element(truth.pixels.begin(), truth.pixels.end()), 211);
  const auto range = read_npy(data / "tofsim-cornell" / "cbox_rgb_nr-240_nc-320.npy");
  EXPECT_EQ(range.shape, (std::vector<std::size_t>{240, 320, 3}));
}

TEST(RealData, DamagedJpegsAreReadOrRefused) {
  const auto file = outside_data() / "opencv-stereo-calibration" / "left01.jpg";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the photograph is not at " << file;
  const std::string good = read_file(file);
  for (int flip = 0; flip < 200; ++flip) {
    RandomStream random(6, 0, static_cast<std::uint64_t>(flip));
    std::string bytes =
        good.substr(0, flip % 3 == 0 ? random.bits32() % good.size() + 1 : good.size());
    bytes[random.bits32() % std::min<std::size_t>(bytes.size(), 1000)] =
        static_cast<char>(random.bits32());
    try {
      decode_jpeg_grey8(bytes, "damaged.jpg");
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace scan
