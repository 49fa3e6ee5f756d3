// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The inputs of the comparison are what they are called.
#include "tests/benchmarks/reconstruct_inputs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/verify/surface_error.h"
#include "tests/benchmarks/reconstruct_bodies.h"

namespace scan {
namespace {

const std::filesystem::path data = LIBSCAN_SOURCE_DIR "/../shared/data";

#define SKIP_WITHOUT_DATA() \
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "the data is not in " << data

double rms_distance(const ReconstructInput& input) {
  double sum = 0;
  for (const double d : deviations_m(input.cloud.points, input.truth)) sum += d * d;
  return std::sqrt(sum / static_cast<double>(input.cloud.size()));
}

TEST(ReconstructInputs, AreTheSameForAnyNumberOfThreads) {
  for (const std::string name : {"torus-0.5", "torus-holes", "sphere-cap"}) {
    const ReconstructInput two = make_reconstruct_input(name, data, 3000);
    const ThreadLimit one_thread(1);
    const ReconstructInput one = make_reconstruct_input(name, data, 3000);
    EXPECT_EQ(one.cloud.points, two.cloud.points) << name;
    EXPECT_EQ(one.cloud.normals, two.cloud.normals) << name;
  }
}

TEST(ReconstructInputs, ExactOnesLieOnTheSurface) {
  for (const std::string name : {"sphere", "torus", "csg", "plate"}) {
    const ReconstructInput input = make_reconstruct_input(name, data, 2000);
    EXPECT_EQ(input.cloud.size(), 2000u);
    // Floats of coordinates to 1.35: 2^-25 x 2 per axis at most.
    EXPECT_LT(rms_distance(input), 2e-7) << name;
  }
}

TEST(ReconstructInputs, NoiseIsAsStrongAsItsName) {
  const ReconstructInput input = make_reconstruct_input("torus-0.5", data, 20000);
  const double sigma = 0.005 * input.diagonal_m;
  // The variance over 20,000 samples is right to sqrt(2 / 20,000) = 1 %, its root to 0.5 %; 5 of
  // these. The tube bends: distances to it differ from offsets along the normal by
  // sigma^2 / (2 x 0.35), 2.7 % of sigma in the mean, 0.04 % in the rms.
  EXPECT_NEAR(rms_distance(input), sigma, 0.026 * sigma);
  const TrueDistance truth(input.truth);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < input.cloud.size(); ++i)
    wrong += truth.nearest(input.cloud.points[i]).normal.dot(input.cloud.normals[i]) < 0;
  EXPECT_LT(wrong, input.cloud.size() / 100);
}

// Each inner vertex goes half way to the mean of its neighbours, twice: what differs from this mean
// is halved at least where it was roughest, and rims and facets stay.
TEST(ReconstructInputs, SmoothBunnyIsSmoother) {
  SKIP_WITHOUT_DATA();
  const Mesh rough = closed_bunny(data), smooth = smooth_bunny(data);
  EXPECT_EQ(rough.triangles, smooth.triangles);
  const auto roughness = [](const Mesh& mesh) {
    std::vector<Eigen::Vector3d> sums(mesh.vertices.size(), Eigen::Vector3d::Zero());
    std::vector<double> counts(mesh.vertices.size(), 0);
    for (const Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        sums[t[k]] += mesh.vertices[t[(k + 1) % 3]] + mesh.vertices[t[(k + 2) % 3]];
        counts[t[k]] += 2;
      }
    double sum = 0;
    for (std::size_t v = 0; v < sums.size(); ++v)
      if (counts[v] > 0) sum += (sums[v] / counts[v] - mesh.vertices[v]).norm();
    return sum;
  };
  EXPECT_LT(roughness(smooth), 0.75 * roughness(rough));
  std::size_t still = 0;
  for (std::size_t v = 0; v < rough.vertices.size(); ++v)
    still += rough.vertices[v] == smooth.vertices[v];
  // The rims of the scan's five holes, and what no facet touches; not the inner vertices.
  EXPECT_GT(still, 100u);
  EXPECT_LT(still, rough.vertices.size() / 20);
}

TEST(ReconstructInputs, DensityFallsTwoHundredfold) {
  const ReconstructInput input = make_reconstruct_input("torus-density", data, 10000);
  double sum = 0, sum_x = 0;
  for (const auto& x : input.cloud.points)
    // Weighted back to uniform density, the torus is symmetric in x.
    sum += std::pow(200.0, (x[0] + 1.35) / 2.7),
        sum_x += x[0] * std::pow(200.0, (x[0] + 1.35) / 2.7);
  // The weights' second moment over their first squared is (199 / ln 200)^2 / 200 = 7.1 for a
  // uniform x; the mean has the deviation sqrt(7.1 x 0.6 / 10,000) = 0.021.
  EXPECT_NEAR(sum_x / sum, 0, 0.1);
}

TEST(ReconstructInputs, CapHasItsHeight) {
  const ReconstructInput input = make_reconstruct_input("sphere-cap", data, 7000);
  double lowest = 1;
  for (const auto& x : input.cloud.points) lowest = std::min(lowest, x[2]);
  EXPECT_NEAR(lowest, 0.3, 0.02);  // the noise is 0.0017
  EXPECT_NEAR(static_cast<double>(input.cloud.size()), 7000, 5 * std::sqrt(7000 * 0.65));
}

TEST(ReconstructInputs, BunnyIsClosed) {
  SKIP_WITHOUT_DATA();
  const EdgeCensus census = edge_census(closed_bunny(data));
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, 0);
}

TEST(ReconstructInputs, DamageIsAsGreatAsItsName) {
  SKIP_WITHOUT_DATA();
  const ReconstructInput clean = make_reconstruct_input("bunny-0.1", data, 5000);
  const ReconstructInput outliers = make_reconstruct_input("bunny-outliers-20", data, 5000);
  EXPECT_EQ(outliers.cloud.size(), 6000u);
  const ReconstructInput flipped = make_reconstruct_input("bunny-flipped-30", data, 5000);
  std::size_t turned = 0;
  for (std::size_t i = 0; i < clean.cloud.size(); ++i)
    turned += clean.cloud.normals[i].dot(flipped.cloud.normals[i]) < 0;
  EXPECT_NEAR(static_cast<double>(turned), 1500, 5 * std::sqrt(5000 * 0.3 * 0.7));
}

TEST(ReconstructInputs, ViewsFaceTheirScanners) {
  SKIP_WITHOUT_DATA();
  const ReconstructInput input = make_reconstruct_input("lordquas-views", data, 3000);
  ASSERT_EQ(input.viewpoints.size(), input.cloud.size());
  std::size_t away = 0;
  for (std::size_t i = 0; i < input.cloud.size(); ++i)
    away += (input.viewpoints[i] - input.cloud.points[i]).dot(input.cloud.normals[i]) < 0;
  EXPECT_LT(away, input.cloud.size() / 50);  // plane fits over 20 of 3,000 points round edges off
}

TEST(ReconstructInputs, UnknownNameIsHinted) {
  try {
    make_reconstruct_input("bunnny", data);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(error.hint().find("bunny"), std::string::npos);
  }
}

}  // namespace
}  // namespace scan
