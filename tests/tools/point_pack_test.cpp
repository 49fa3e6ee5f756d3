// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/point_pack.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "libscan/core/random.h"

namespace scan {
namespace {

std::string bytes_of_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<unsigned>(digits.find(c));
    bits += 6;
    if (bits >= 8) bytes += static_cast<char>(word >> (bits -= 8) & 0xff);
  }
  return bytes;
}

// The way back, as the page's script goes it.
std::map<std::string, std::vector<double>> unpacked(const nlohmann::ordered_json& packed) {
  const auto count = packed.at("count").get<std::size_t>();
  const std::string deflation = bytes_of_base64(packed.at("data").get<std::string>());
  uLongf size = 2 * count * packed.at("channels").size();
  std::string bytes(size, '\0');
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                       reinterpret_cast<const Bytef*>(deflation.data()), deflation.size()),
            Z_OK);
  EXPECT_EQ(size, bytes.size());
  std::map<std::string, std::vector<double>> channels;
  std::size_t start = 0;
  for (const auto& channel : packed.at("channels")) {
    int steps = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const int coded = static_cast<unsigned char>(bytes[start + i]) |
                        static_cast<unsigned char>(bytes[start + count + i]) << 8;
      steps = (steps + (coded >> 1 ^ -(coded & 1))) & 0xffff;
      channels[channel.at("name")].push_back(channel.at("low").get<double>() +
                                             channel.at("step").get<double>() * steps);
    }
    start += 2 * count;
  }
  return channels;
}

PagePoints ball(std::size_t count) {
  PagePoints points;
  RandomStream random(1, 0, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    points.normals.push_back(Eigen::Vector3d(x, y, z).normalized());
    points.points.push_back(Eigen::Vector3d(1, 2, 3) + 0.1 * points.normals.back());
    points.deviations_m.push_back(1e-3 * x);
  }
  return points;
}

TEST(PackedPoints, ComeBackWithinHalfAStep) {
  const PagePoints points = ball(3000);
  const auto channels = unpacked(packed_points(points));
  ASSERT_EQ(channels.size(), 6u);
  // Half a step of 0.2 m / 65535 along each axis, so no two of 3,000 points are confused.
  const double tolerance_m = 0.51 * 0.2 / 65535;
  for (std::size_t k = 0; k < points.points.size(); ++k) {
    const Eigen::Vector3d at(channels.at("x")[k], channels.at("y")[k], channels.at("z")[k]);
    const auto source = std::find_if(
        points.points.begin(), points.points.end(),
        [&](const auto& point) { return (point - at).cwiseAbs().maxCoeff() <= tolerance_m; });
    ASSERT_NE(source, points.points.end());
    const auto i = static_cast<std::size_t>(source - points.points.begin());
    const double range_m =
        *std::max_element(points.deviations_m.begin(), points.deviations_m.end()) -
        *std::min_element(points.deviations_m.begin(), points.deviations_m.end());
    EXPECT_NEAR(channels.at("deviation")[k], points.deviations_m[i], 0.51 * range_m / 65535);
    // The octahedral map stretches lengths by sqrt(3) to 3 on its way back; half a step of 2 / 255
    // along either axis turns a normal by no more than 3 sqrt(2) / 255.
    const double u = channels.at("normal_u")[k], v = channels.at("normal_v")[k];
    const double z = 1 - std::abs(u) - std::abs(v), fold = std::max(-z, 0.0);
    const Eigen::Vector3d normal(u - std::copysign(fold, u), v - std::copysign(fold, v), z);
    EXPECT_LT(std::acos(std::min(1.0, normal.normalized().dot(points.normals[i]))),
              3 * std::sqrt(2) / 255);
  }
}

TEST(PackedPoints, TakeLessThanTheirRawBytes) {
  const nlohmann::ordered_json packed = packed_points(ball(20000));
  // 10 bytes a point are 13.3 characters. Neighbours lie 2.5 mm apart, 800 of the steps of 3 um: of
  // the 48 bits of a place some 33 tell something, of a normal's 16 some 8: under 11 characters.
  EXPECT_LT(packed.at("data").get<std::string>().size(), 20000 * 11);
}

TEST(PackedPoints, OfOnePointAreThatPoint) {
  PagePoints one;
  one.points = {{1, 2, 3}};
  const auto channels = unpacked(packed_points(one));
  EXPECT_EQ(channels.at("x").at(0), 1);
  EXPECT_EQ(channels.at("z").at(0), 3);
}

TEST(Thinned, KeepsTheWorstAndAnEvenChoice) {
  std::vector<double> weights(1000, 0.0);
  weights[17] = -5;
  weights[501] = 7;
  weights[800] = std::numeric_limits<double>::quiet_NaN();
  const auto chosen = thinned(weights.size(), weights, 100, 2);
  ASSERT_EQ(chosen.size(), 100u);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_EQ(std::adjacent_find(chosen.begin(), chosen.end()), chosen.end());
  EXPECT_TRUE(std::binary_search(chosen.begin(), chosen.end(), 17u));
  EXPECT_TRUE(std::binary_search(chosen.begin(), chosen.end(), 501u));
  for (std::size_t k = 1; k < chosen.size(); ++k) EXPECT_LE(chosen[k] - chosen[k - 1], 12u);
}

TEST(Thinned, KeepsNoMoreOfTheWorstThanAreAskedForInAll) {
  const std::vector<double> weights{1, 5, 2, 4, 3};
  EXPECT_EQ(thinned(5, weights, 2, 4), (std::vector<std::uint32_t>{1, 3}));
}

TEST(Thinned, LeavesFewAsTheyAre) {
  EXPECT_EQ(thinned(4, {}, 10, 2), (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(Quantised, WhatIsNotFiniteIsTheLowEnd) {
  const Quantised q = quantised(std::vector<double>{1, std::numeric_limits<double>::infinity(), 3});
  EXPECT_EQ(q.low, 1);
  EXPECT_EQ(q.steps, (std::vector<std::uint16_t>{0, 0, 65535}));
}

}  // namespace
}  // namespace scan
