// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Windows, grids and noise resolve what their closed forms say.
#include "libscan/verify/structural_resolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/random.h"

namespace scan {
namespace {

using Transfer = std::function<double(double period_m)>;

// A grid of points on a face of 1 m whose waves are seen with that share of their amplitude. The
// grid's origin is at no special place of the fields.
WavePlate plate_of(double period_m, double pitch_m, const Transfer& seen) {
  WavePlate plate{.points = {}, .edge_m = 1, .period_m = period_m, .amplitude_m = 0.05 * period_m};
  for (double x = -0.52 + 0.123 * pitch_m; x < 0.52; x += pitch_m)
    for (double y = -0.52 + 0.321 * pitch_m; y < 0.52; y += pitch_m)
      plate.points.push_back(
          {x, y,
           seen(period_m) * plate.amplitude_m * std::cos(2 * std::numbers::pi * x / period_m)});
  return plate;
}

// Periods from a quarter metre down by the root of two, as on the data sheet.
std::vector<WavePlate> falling(double longest_m, int count, double pitch_m, const Transfer& seen) {
  std::vector<WavePlate> plates;
  for (int i = 0; i < count; ++i)
    plates.push_back(plate_of(longest_m * std::pow(2, -i / 2.0), pitch_m, seen));
  return plates;
}

double resolution_m(std::vector<WavePlate> plates) {
  return structural_resolution(std::vector<std::vector<WavePlate>>{std::move(plates)}).value;
}

double whole(double) {
  return 1;
}

// A reading that is the mean over a width w keeps sin(v) / v of the amplitude, v = pi w / P: half
// at P = w / 0.6034. Per unit of ln P this S has the slope S - cos v and the second derivative S -
// cos v - v sin v, at most 0.99 in size where a step h = ln(2) / 2 may lie about the limit (v =
// 1.34 to 2.68). So the chord is off by at most h^2 / 8 0.99 = 0.0149 and falls by at least 0.653
// (v = 1.34 to 1.90) per unit of ln P, which makes 0.023 of P.
TEST(StructuralResolution, OfAWindowIsThatOfItsSinc) {
  for (const double width_m : {0.04, 0.047, 0.055}) {
    const auto sinc = [&](double period_m) {
      const double v = std::numbers::pi * width_m / period_m;
      return std::sin(v) / v;
    };
    EXPECT_NEAR(resolution_m(falling(0.25, 6, 0.0055, sinc)) * 0.6034 / width_m, 1, 0.023);
  }
}

// Points that show all of it resolve what their pitch p lets them: below P = 2 p the share of the
// fields that hold a point is (P / 2 p)^2, 0.9 at 1.897 p. Of two periods about this limit, a root
// of two apart, the longer r = P / 2 p lies in (0.949, 1.342). The chord between min(1, r^2) and
// r^2 / 2 in ln P meets 0.9 at r 2^(-s / 2), s = (min(1, r^2) - 0.9) / (min(1, r^2) - r^2 / 2):
// from 0.933 (r = 1) to 1.068 (r = 1.24). The share is known to one row of 30 fields, 1/30, at its
// slope of 2 in ln P: 0.02.
TEST(StructuralResolution, OfAnIdealGridIsTwoPoints) {
  for (const double pitch_m : {0.015, 0.0163, 0.0175, 0.019, 0.0207}) {
    const double points = resolution_m(falling(0.25, 9, pitch_m, whole)) / pitch_m;
    EXPECT_GT(points, 2 * (0.933 - 0.02));
    EXPECT_LT(points, 2 * (1.068 + 0.02));
  }
}

// Noise of sigma leaves the amplitude in phase without bias, with sigma sqrt(2 / n); the two-sided
// chance of 5 of these is 6e-7. The amplitude of any phase would be sqrt(pi / 4) 2 sigma / sqrt(n)
// too large where there is no wave.
TEST(WaveResponse, IsWithoutBiasInNoise) {
  RandomStream random(1, 0, 0);
  for (const double share : {0.0, 1.0}) {
    const double sigma_of_mean = 5 * std::sqrt(2 / 2500.0 / 50);  // 50 x 50 points on the face
    double mean = 0;
    for (int repeat = 0; repeat < 50; ++repeat) {
      WavePlate plate = plate_of(0.1, 0.02, [&](double) { return share; });
      const double sigma_m = 5 * plate.amplitude_m;
      for (Eigen::Vector3d& x : plate.points) x.z() += sigma_m * random.normal();
      mean += wave_response(plate).transfer / 50;
    }
    EXPECT_NEAR(mean, share, 5 * sigma_of_mean);
  }
}

TEST(WaveResponse, IsBlindToTiltHeightAndOutliers) {
  WavePlate plate = plate_of(0.1, 0.01, [](double) { return 0.7; });
  for (Eigen::Vector3d& x : plate.points) x.z() += 3 + 0.1 * x.x() - 0.2 * x.y();
  for (std::size_t i = 0; i < plate.points.size() / 500; ++i) plate.points[487 * i].z() += 1;
  EXPECT_NEAR(wave_response(plate).transfer, 0.7, 1e-10);
  EXPECT_EQ(wave_response(plate).coverage, 1);
}

// A window longer than the period turns crests into troughs: detail of that size, and wrong.
TEST(WaveResponse, IsNegativeForTurnedPhase) {
  const WaveResponse response = wave_response(plate_of(0.1, 0.01, [](double) { return -1; }));
  EXPECT_NEAR(response.transfer, -1, 1e-10);
  EXPECT_FALSE(is_resolved(response));
}

// Rows 20 mm apart of points 2 mm apart are no better than their rows: the share of the fields that
// hold a point is r = P / 2 p, and the chord meets 0.9 between 0.888 (r = 1) and 0.957 (r = 1.18),
// by one row of 30 fields more or less, 1/30 at the slope of 1 in ln P.
TEST(StructuralResolution, OfRowsIsThatAcrossThem) {
  std::vector<WavePlate> plates = falling(0.25, 9, 0.002, whole);
  for (WavePlate& plate : plates)
    std::erase_if(plate.points, [](const Eigen::Vector3d& x) {
      return std::lround((x.y() + 0.52) / 0.002) % 10 != 0;
    });
  EXPECT_GT(resolution_m(plates), 2 * 0.02 * (0.888 - 0.033));
  EXPECT_LT(resolution_m(plates), 2 * 0.02 * (0.957 + 0.033));
}

TEST(StructuralResolution, IsTheWorstDirections) {
  const std::vector series = {falling(0.25, 9, 0.01, whole), falling(0.25, 9, 0.02, whole)};
  EXPECT_DOUBLE_EQ(structural_resolution(series).value, resolution_m(series[1]));
}

TEST(StructuralResolution, RefusesWhatShowsNoWave) {
  const auto flat = [](double) { return 0.0; };
  EXPECT_THROW(resolution_m({}), Error);
  EXPECT_THROW(structural_resolution({}), Error);
  EXPECT_THROW(resolution_m(falling(0.25, 2, 0.01, flat)), Error);
  EXPECT_THROW(resolution_m(falling(0.25, 2, 0.4, whole)), Error);
}

// Fields are half a period wide; the fifth on either side is half beyond the face of 1 m and does
// not count: points on the inner nine tenths cover all that do.
TEST(WaveResponse, CountsFieldsThatLieWhollyOnTheFace) {
  WavePlate plate = plate_of(0.2, 0.02, whole);
  std::erase_if(plate.points, [](const Eigen::Vector3d& x) {
    return std::max(std::abs(x.x()), std::abs(x.y())) > 0.449;
  });
  EXPECT_EQ(wave_response(plate).coverage, 1);
}

// Five unknowns: from fewer than twice as many points nothing is told.
TEST(WaveResponse, OfAFewPointsIsNothing) {
  WavePlate plate = plate_of(0.25, 0.05, whole);
  plate.points.resize(10);
  for (std::size_t i = 0; i < 10; ++i) {  // on the face, at many phases
    Eigen::Vector3d& x = plate.points[i];
    x.x() = -0.4 + 0.083 * static_cast<double>(i);
    x.y() = i % 3 == 0 ? 0.2 : -0.1;
    x.z() = plate.amplitude_m * std::cos(2 * std::numbers::pi * x.x() / plate.period_m);
  }
  EXPECT_NEAR(wave_response(plate).transfer, 1, 1e-9);
  plate.points.pop_back();
  EXPECT_EQ(wave_response(plate).transfer, 0);
}

}  // namespace
}  // namespace scan
