// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far the averages of bilateral_samples.h reach.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/reconstruct/bilateral_cases.h"

namespace scan {
namespace {

using namespace bilateral;

// Where the fit smooths over four spacings averages reach over 12.8 and count as 5 pi R^2 / 9 = 286
// samples: 0.8 x 0.25 / sqrt(286) leaves a mean distance of 0.012 spacings, six spacings 0.025. The
// fit stands half a spacing below the plane, so that any average is better. Of samples farther from
// the plane's end than that some 30 share no neighbours: chance moves that by a seventh.
TEST(BilateralSamples, AverageAsFarAsTheFitSmooths) {
  Case plane = roof(0, 0);
  for (Eigen::Vector3d& foot : plane.fit.feet) foot[2] -= spacing / 2;
  plane.fit.length.assign(plane.fit.length.size(), 4 * spacing);
  const auto moved = bilateral_samples(plane.samples, plane.fit);
  ASSERT_TRUE(moved);
  double sum = 0, count = 0;
  for (const Eigen::Vector3d& p : moved->points) {
    if ((p - Eigen::Vector3d(0.5, 0.5, p[2])).cwiseAbs().maxCoeff() > (side / 2 - 13) * spacing)
      continue;
    sum += std::abs(p[2] - 0.5);
    count += 1;
  }
  EXPECT_LT(sum / count, 0.018 * spacing);
}

// Heights off the waves, in the mean over the samples from x to x + 20 spacings and away from the
// sides.
double mean_off_waves(const std::vector<Eigen::Vector3d>& points, double h, double k, double x) {
  double sum = 0, count = 0;
  for (const Eigen::Vector3d& p : points) {
    const double along = (p[0] - x) / spacing;
    if (along < 0 || along > 20 || std::abs(p[1] - 0.5) > (side / 2 - 7) * spacing) continue;
    sum += std::abs(p[2] - 0.5 - height_of_waves(p[0], h, k));
    count += 1;
  }
  return sum / count;
}

// What averages of reach R take from waves of height h, in the mean over their sines. A biweight
// passes a = 48 J_3(x) / x^3 of waves of k R = x, two rounds a^2 of their slopes; the mean of (n_i
// + n_j) / 2 . (p_j - p_i) then leaves a - a^2 x a' / 2 of their height, a' = -48 J_4(x) / x^3.
double taken(double h, double x) {
  const double a = 48 * std::cyl_bessel_j(3, x) / std::pow(x, 3);
  const double left = a + a * a * 24 * std::cyl_bessel_j(4, x) / (x * x);
  return h * (1 - left) * 2 / std::numbers::pi;
}

// The full reach takes 0.16 spacings, of which weights by normals, 30 degrees apart here, give half
// back; half of it takes 0.02 and leaves 0.05 of noise: below 0.4 of what the full one takes. On
// the plane that leaves 0.025 of noise, 1/sqrt(2) of it 0.035: there 1300 samples are some 20
// averages, so that chance moves the mean by an eighth of it.
TEST(BilateralSamples, ReachLessFarWhereTheSurfaceCurves) {
  const double k = 3.5 / (6 * spacing), h = 0.5 * spacing;
  const Case c = waves(h, k, fitted_length);
  const auto moved = bilateral_samples(c.samples, c.fit);
  ASSERT_TRUE(moved);
  EXPECT_LT(mean_off_waves(moved->points, h, k, 0.5 + 15 * spacing), 0.4 * taken(h, 3.5));
  EXPECT_LT(mean_off_waves(moved->points, h, k, 0.5 - 35 * spacing), 0.03 * spacing);
}

// Lengths of 4 spacings reach over 12.8. Where scatter is said to be above a spacing all of it
// stays.
TEST(BilateralSamples, ReachAsFarAsEverWhereScatterHidesWhoIsNextToWhom) {
  const double k = 3.5 / (12.8 * spacing), h = 1.2 * spacing;
  Case c = waves(h, k, 4 * spacing);
  for (Eigen::Vector3d& foot : c.fit.feet) foot[2] -= 2 * spacing;
  for (const auto& [spacings, is_shorter] : {std::pair(0.99, true), {1.01, false}}) {
    c.samples.sigma.assign(c.samples.sigma.size(), spacings * spacing);
    const auto moved = bilateral_samples(c.samples, c.fit);
    ASSERT_TRUE(moved);
    EXPECT_EQ(mean_off_waves(moved->points, h, k, 0.5 + 15 * spacing) < 0.4 * taken(h, 3.5),
              is_shorter)
        << spacings;
  }
}

// The mean risk is sigma^2 and the squared distance from the truth (local_smoothing.h): what
// averages take, in the mean square over the sines that lie on half of all samples, and the noise
// that they leave, 1 / 63 of sigma^2 for the full reach and twice that for 1/sqrt(2) of it. To
// lower it by 1 % takes (1 + 1 / 63) / 100 + 1 / 63 = 0.026 sigma^2 of what curvature costs; chance
// moves the sums by 0.2 / sqrt(6400) = 0.0025. Full averages are those that scatter said to be
// above a spacing leaves: only that, and the risk, are told by sigma.
TEST(BilateralSamples, ReachLessFarOnlyForAHundredthOfTheRisk) {
  const double k = 3.5 / (6 * spacing), root = std::sqrt(0.5);
  const auto amplitude = [](double x) { return taken(1, x) * std::numbers::pi / 2; };
  const double cost = (std::pow(amplitude(3.5), 2) - std::pow(amplitude(3.5 * root), 2)) / 4;
  for (const auto& [in_variances, is_full] :
       {std::pair(0.0, true), {0.021, true}, {0.036, false}}) {
    Case c = waves(std::sqrt(in_variances / cost) * sigma, k, fitted_length);
    const auto moved = bilateral_samples(c.samples, c.fit);
    c.samples.sigma.assign(c.samples.sigma.size(), 1.01 * spacing);
    const auto full = bilateral_samples(c.samples, c.fit);
    ASSERT_TRUE(moved && full);
    EXPECT_EQ(moved->points == full->points, is_full) << in_variances;
  }
}

// No neighbour's normal agrees with these samples', which are their own averages: they go to the
// fit among waves, where averages are short, and stay on the plane.
TEST(BilateralSamples, GoToTheFitWhereShortAveragesAreTheirOwn) {
  const double k = 3.5 / (6 * spacing), h = 0.5 * spacing;
  Case c = waves(h, k, fitted_length);
  std::size_t on_plane = 0, on_waves = 0;
  for (std::size_t i = 0; i < c.samples.points.size(); ++i) {
    const Eigen::Vector3d off = (c.samples.points[i] - Eigen::Vector3d(0.5, 0.5, 0.5)) / spacing;
    if (std::abs(off[1]) > 20) continue;
    if (std::abs(off[0] + 25) < 5) on_plane = i;
    if (std::abs(off[0] - 25) < 5) on_waves = i;
  }
  for (const std::size_t i : {on_plane, on_waves}) c.fit.normals[i] = Eigen::Vector3d::UnitY();
  const auto moved = bilateral_samples(c.samples, c.fit);
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->points[on_waves], c.fit.feet[on_waves]);
  EXPECT_EQ(moved->points[on_plane], c.samples.points[on_plane]);
}

}  // namespace
}  // namespace scan
