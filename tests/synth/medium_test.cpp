// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/medium.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "libscan/core/error.h"
#include "tests/synth/density_grids.h"
#include "tests/synth/stream_mean.h"

namespace scan::synth {
namespace {

const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
const Eigen::Vector3d ahead = Eigen::Vector3d(2, -1, 2) / 3;

Medium with_grid(const DensityGrid& grid, double absorption_per_m, double scattering_per_m) {
  return {
      .absorption_per_m = absorption_per_m, .scattering_per_m = scattering_per_m, .density = grid};
}

// Beer and Lambert.
TEST(HomogeneousMedium, TransmitsByTheExponentialLaw) {
  const Medium medium{.absorption_per_m = 0.2, .scattering_per_m = 0.5};
  SampleSequence random(1, 0, 0, 0);
  random.start(0);
  SampleSequence untouched = random;
  EXPECT_DOUBLE_EQ(transmittance(medium, origin, 3 * ahead, random), std::exp(-2.1));
  EXPECT_EQ(transmittance(medium, origin, origin, random), 1);
  EXPECT_EQ(transmittance(Medium{}, origin, 3 * ahead, random), 1);
  EXPECT_EQ(random.next(), untouched.next()) << "needs no chance";
}

// Chi-square of the free paths in 20 bins of equal probability; one number per independent ray.
TEST(HomogeneousMedium, FliesByTheExponentialLaw) {
  const Medium medium{.absorption_per_m = 0.5, .scattering_per_m = 1.5};
  const int count = 40000, bins = 20;
  const double end_m = 0.7;
  std::vector<int> found(bins + 1, 0);
  for (int i = 0; i < count; ++i) {
    SampleSequence random(2, 0, i, 0);
    random.start(0);
    const Flight flight = sample_flight(medium, origin, ahead, end_m, random);
    EXPECT_EQ(flight.weight, flight.scattered_m ? 0.75 : 1);
    const double share =
        flight.scattered_m ? std::expm1(-2 * *flight.scattered_m) / std::expm1(-2 * end_m) : 1;
    ++found[flight.scattered_m ? static_cast<int>(share * bins) : bins];
  }
  double chi2 = 0;
  for (int i = 0; i <= bins; ++i) {
    const double expected = count * (i < bins ? -std::expm1(-2 * end_m) / bins : std::exp(-1.4));
    chi2 += std::pow(found[i] - expected, 2) / expected;
  }
  EXPECT_LT(chi2, 45.3);  // 0.1 % quantile of chi-square, 20 degrees of freedom
}

TEST(HomogeneousMedium, LetsAllLightArriveThatItDoesNotScatter) {
  SampleSequence random(3, 0, 0, 0);
  random.start(0);
  const Flight glass = sample_flight({.absorption_per_m = 4}, origin, ahead, 0.5, random);
  EXPECT_FALSE(glass.scattered_m);
  EXPECT_DOUBLE_EQ(glass.weight, std::exp(-2.0));
  const double far = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sample_flight({.absorption_per_m = 4}, origin, ahead, far, random).weight, 0);
  EXPECT_EQ(sample_flight({}, origin, ahead, far, random).weight, 1);
  EXPECT_TRUE(sample_flight({.scattering_per_m = 4}, origin, ahead, far, random).scattered_m);
}

// Against exp of the exact integral of the trilinear density.
TEST(DensityGridMedium, TransmitsWithoutBias) {
  DensityGrid grid = cloud_with_holes();
  for (const bool majorants : {false, true}) {
    if (majorants) set_majorants(grid);
    const Medium medium = with_grid(grid, 1, 2);
    for (const Line& line : lines_through_the_cloud()) {
      const double optical_depth = 3 * line_integral(grid, line.from, line.to);
      const StreamMean found = stream_mean(256, [&](SampleSequence& random) {
        return transmittance(medium, line.from, line.to, random);
      });
      EXPECT_NEAR(found.mean, std::exp(-optical_depth), 4.5 * found.error + 1e-14);
      EXPECT_LT(found.error, 0.01) << "or the test tells nothing";
    }
  }
}

// Where flights end: the distribution function 1 - exp(-tau), in 16 bins of distance.
TEST(DensityGridMedium, FliesByTheTrueOpticalDepth) {
  DensityGrid grid = cloud_with_holes();
  set_majorants(grid);
  const Medium medium = with_grid(grid, 1, 3);
  const int count = 40000, bins = 16;
  for (const Line& line : lines_through_the_cloud()) {
    const double length_m = (line.to - line.from).norm();
    const Eigen::Vector3d direction = (line.to - line.from) / length_m;
    std::vector<double> found(bins + 1, 0);
    for (int i = 0; i < count; ++i) {
      SampleSequence random(4, 0, i, 0);
      random.start(0);
      const Flight flight = sample_flight(medium, line.from, direction, length_m, random);
      EXPECT_EQ(flight.weight, flight.scattered_m ? 0.75 : 1);
      ++found[flight.scattered_m ? std::min(bins - 1, int(*flight.scattered_m / length_m * bins))
                                 : bins];
    }
    double chi2 = 0, left = 1;
    for (int i = 0; i <= bins; ++i) {
      const double behind =
          i < bins
              ? std::exp(-4 * line_integral(grid, line.from,
                                            line.from + (line.to - line.from) * ((i + 1.0) / bins)))
              : 0;
      const double expected = count * (left - behind);
      left = behind;
      if (expected < 5)
        EXPECT_LE(found[i], 25) << "a chance of 1e-10";
      else
        chi2 += std::pow(found[i] - expected, 2) / expected;
    }
    EXPECT_LT(chi2, 39.3);  // 0.1 % quantile of chi-square, 16 degrees of freedom
  }
}

// What arrives, what is scattered and what is absorbed is all there is; a pure absorber's arrivals
// carry the same energy.
TEST(DensityGridMedium, LosesNoEnergy) {
  DensityGrid grid = cloud_with_holes();
  set_majorants(grid);
  const Line line = lines_through_the_cloud().front();
  const double length_m = (line.to - line.from).norm();
  const Eigen::Vector3d direction = (line.to - line.from) / length_m;
  const double left = std::exp(-4 * line_integral(grid, line.from, line.to));
  const auto energy = [&](const Medium& medium, bool scattered) {
    return stream_mean(256, [&](SampleSequence& random) {
      const Flight flight = sample_flight(medium, line.from, direction, length_m, random);
      return flight.scattered_m.has_value() == scattered ? flight.weight : 0;
    });
  };
  const StreamMean arrived = energy(with_grid(grid, 1, 3), false);
  const StreamMean scattered = energy(with_grid(grid, 1, 3), true);
  const StreamMean absorber = energy(with_grid(grid, 4, 0), false);
  EXPECT_NEAR(arrived.mean, left, 4.5 * arrived.error);
  EXPECT_NEAR(scattered.mean, 0.75 * (1 - left), 4.5 * scattered.error);
  EXPECT_NEAR(absorber.mean, left, 4.5 * absorber.error);
}

TEST(DensityGridMedium, CostsNothingWhereItIsEmpty) {
  DensityGrid grid = cloud_with_holes();
  std::fill(grid.density.begin(), grid.density.end(), 0.0f);
  grid.density.back() = 1;
  set_majorants(grid);
  const Medium medium = with_grid(grid, 1e6, 1e6);
  SampleSequence random(5, 0, 0, 0);
  random.start(0);
  SampleSequence untouched = random;
  const Eigen::Vector3d low = grid.box_m.min(), size = grid.box_m.sizes();
  const Eigen::Vector3d from = low + 0.1 * size;
  EXPECT_EQ(transmittance(medium, from, from + 0.8 * size.x() * Eigen::Vector3d::UnitX(), random),
            1);
  EXPECT_EQ(transmittance(medium, grid.box_m.max(), grid.box_m.max(), random), 1) << "no way";
  EXPECT_EQ(random.next(), untouched.next());
}

// Two-way transmission over 50 m of fog.
TEST(Fog, HasTheGoldenValuesOfTheOpticalRange) {
  const std::array<std::array<double, 2>, 4> golden = {
      {{50, 0.0025}, {100, 0.0500}, {200, 0.2236}, {500, 0.549}}};
  SampleSequence random(6, 0, 0, 0);
  random.start(0);
  for (const auto& [range_m, share] : golden) {
    const Medium medium = fog(range_m, 0.8, 0.9);
    const double there = transmittance(medium, origin, 50 * ahead, random);
    EXPECT_NEAR(there * there, share, range_m < 500 ? 5e-5 : 5e-4);  // as many digits as given
    EXPECT_NEAR(medium.scattering_per_m / extinction_per_m(medium), 0.9, 1e-15);
    EXPECT_EQ(mean_cosine(medium.phase), 0.8);
  }
}

TEST(Haze, HasItsVisibility) {
  // 3.91 is ln 50 in three digits
  SampleSequence random(6, 0, 0, 0);
  random.start(0);
  EXPECT_NEAR(transmittance(haze(2000, 550e-9, 0.7, 0.9), origin, 2000 * ahead, random), 0.02,
              0.02 * 0.005);
  EXPECT_NEAR(extinction_per_m(haze(2000, 1550e-9, 0.7, 0.9)) / (3.91 / 2000),
              std::pow(1550.0 / 550, -0.66), 1e-14);
  EXPECT_DOUBLE_EQ(haze(200, 905e-9, 0.7, 0.9).scattering_per_m, 0.9 * 3.91 / 200);
}

std::string complaint_of(const Medium& medium) {
  try {
    check(medium, "scene/medium");
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::input);
    return error.what();
  }
  return {};
}

TEST(Medium, NamesWhatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint_of({.absorption_per_m = 1, .scattering_per_m = 2}), "");
  EXPECT_EQ(complaint_of({.absorption_per_m = -1}),
            "scene/medium/absorption_per_m: -1, must be finite and at least 0");
  EXPECT_EQ(complaint_of({.scattering_per_m = nan}),
            "scene/medium/scattering_per_m: nan, must be finite and at least 0");
  EXPECT_EQ(complaint_of({.phase = HenyeyGreenstein{1}}),
            "scene/medium/phase/mean_cosine: 1, must be between -1 and 1");
  EXPECT_NE(complaint_of(fog(0, 0.5, 0.5)), "");
  EXPECT_NE(complaint_of(fog(-3, 0.5, 0.5)), "");
  EXPECT_NE(complaint_of(fog(100, 0.5, 1.5)), "");
  EXPECT_NE(complaint_of({.density = DensityGrid{}}), "") << "the grid is looked at as well";
}

}  // namespace
}  // namespace scan::synth
