// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/patch_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/random.h"

namespace scan::synth {
namespace {

using Streams = std::array<Eigen::MatrixXd, patch_streams>;

std::vector<PatchPlace> square(int side) {
  std::vector<PatchPlace> places;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      places.push_back({Eigen::Vector2d(100 + column, 7 + row), Eigen::Vector3d::UnitZ()});
  return places;
}

// One signal, alike in all streams but for normal noise of that deviation.
Streams values_of(const Eigen::VectorXd& value, double noise, std::uint64_t seed = 1) {
  Streams streams;
  for (int k = 0; k < patch_streams; ++k) {
    RandomStream random(seed, 0, static_cast<std::uint64_t>(k));
    streams[k] = value;
    for (Eigen::Index i = 0; i < value.size(); ++i) streams[k](i, 0) += noise * random.normal();
  }
  return streams;
}

TEST(PatchBasis, IsOrthonormal) {
  const PatchBasis basis = patch_basis(square(12));
  const Eigen::Index count = basis.functions.cols();
  EXPECT_EQ(basis.count, (std::vector<Eigen::Index>{1, 3, 6, 10, 15, 21, 28}));
  EXPECT_TRUE((basis.functions.transpose() * basis.functions)
                  .isApprox(Eigen::MatrixXd::Identity(count, count), 1e-12));
}

// x^3 y^3 is the last of 28 polynomials; x^7 is not among them.
TEST(PatchBasis, HoldsPolynomialsOfTheSixthDegree) {
  const std::vector<PatchPlace> places = square(12);
  const Eigen::MatrixXd q = patch_basis(places).functions;
  Eigen::VectorXd sixth(144), seventh(144);
  for (Eigen::Index i = 0; i < 144; ++i) {
    const double x = places[i].place_px.x() - 105, y = places[i].place_px.y() - 12;
    sixth[i] = std::pow(x * y, 3) - x + 2;
    seventh[i] = std::pow(x / 6, 7);
  }
  EXPECT_LT((sixth - q * (q.transpose() * sixth)).norm(), 1e-10 * sixth.norm());
  EXPECT_GT((seventh - q * (q.transpose() * seventh)).norm(), 1e-3 * seventh.norm());
}

TEST(PatchBasis, LeavesThreePixelsToAFunction) {
  EXPECT_EQ(patch_basis(square(3)).count, (std::vector<Eigen::Index>{1, 3}));
  EXPECT_EQ(patch_basis(square(5)).count, (std::vector<Eigen::Index>{1, 3, 6}));
  EXPECT_EQ(patch_basis(square(6)).count, (std::vector<Eigen::Index>{1, 3, 6, 10}));
}

// Two rows of pixels: of each degree from the second on, only x^n and x^(n-1) y are new.
TEST(PatchBasis, LeavesOutWhatAStripCannotTell) {
  std::vector<PatchPlace> places = square(32);
  places.resize(64);
  EXPECT_EQ(patch_basis(places).count, (std::vector<Eigen::Index>{1, 3, 5, 7, 9, 11, 13}));
}

// Facets lean at random by a tenth: what is linear in the normal is fitted to the second order of
// the lean, which is 1 - cos.
TEST(PatchBasis, FollowsTheNormal) {
  std::vector<PatchPlace> places = square(12);
  RandomStream random(1, 2, 3);
  Eigen::VectorXd value(144);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double x = 0.1 * random.normal();
    const double y = 0.1 * random.normal();
    places[i].normal = Eigen::Vector3d(x, y, 1).normalized();
    value[static_cast<Eigen::Index>(i)] = Eigen::Vector3d(2, -1, 0).dot(places[i].normal);
  }
  const PatchBasis basis = patch_basis(places);
  EXPECT_EQ(basis.count[2], 8);
  const Eigen::MatrixXd q = basis.functions;
  EXPECT_LT((value - q * (q.transpose() * value)).norm(), 0.02 * value.norm());
}

// Variance over four streams with a scatter of 2: 1 for their mean. The squares of 144 pixels
// scatter by sqrt(2 / (3 * 144)) = 0.07; four times that.
TEST(PatchFit, TellsChanceByTheStreams) {
  const PatchFit fit = fit_patch(patch_basis(square(12)), values_of(Eigen::VectorXd::Zero(144), 2));
  EXPECT_NEAR(fit.pixel_chance, 1, 0.28);
  EXPECT_EQ(fit.structure, 0);
}

// A bright spot of 2 x 2 pixels, which no polynomial follows: in the mean over 144 pixels its
// square is 4 * 25 / 144, less at most 28 / 144 of it; the chance of 0.1 is small beside.
TEST(PatchFit, NoticesWhatNoDegreeFollows) {
  Eigen::VectorXd value = Eigen::VectorXd::Zero(144);
  for (const Eigen::Index i : {65, 66, 77, 78}) value[i] = 5;
  const PatchFit fit = fit_patch(patch_basis(square(12)), values_of(value, 0.2));
  EXPECT_LT(fit.structure, 4 * 25.0 / 144);
  EXPECT_GT(fit.structure, 0.5 * 4 * 25.0 / 144);
}

}  // namespace
}  // namespace scan::synth
