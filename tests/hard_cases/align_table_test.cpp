// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Every hard case by every method and every search: the outcome is one of those wanted, a pose that
// is called converged is right, and no search changes a bit. Prints the table of outcomes.
#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include "libscan/search/kd_tree.h"
#include "tests/align/icp_methods.h"
#include "tests/hard_cases/align_cases.h"

namespace scan {
namespace {

using Eigen::Vector3d;

// Planes are off by their curvature times the square of their reach, 3 / m (0.16 m)^2 / 8 = 1 cm at
// a spacing of 0.07 m. Point-to-point's partners are off by up to a spacing; half of the points lie
// sqrt(2) farther apart.
constexpr double plane_tolerance_m = 0.02, spacing_tolerance_m = 0.1;

double largest_error_m(const test::HardCase& hard, const IcpResult& result) {
  double largest_m = 0;
  for (const Vector3d& x : hard.source.points)
    if (x.allFinite())
      largest_m = std::max(largest_m, (result.target_from_source * x - hard.truth * x).norm());
  return largest_m;
}

// Point-to-point's partners lie beside the true places by a part l of the spacing, to any side.
// That pulls along the surface with a variance of var(l) sum J^T (1 - n n^T) J, while only the
// normals hold the pose, with A = sum J^T n n^T J: its covariance is var(l) A^-1 sum J^T (1 - n
// n^T) J A^-1. Three sigma of the point that this moves most. Copies of a point pull alike and
// count once.
double slide_m(const test::HardCase& hard) {
  const PointCloud target = subset(hard.target, finite_points(hard.target));
  const KdTree tree(target.points);
  const auto less = [](const Vector3d& a, const Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::set<Vector3d, decltype(less)> places(less);
  for (const Vector3d& x : hard.source.points)
    if (x.allFinite()) places.insert(hard.truth * x);
  const Bounds box = bounds_of(target.points);
  const double unit_m = box.diagonal().norm();
  const auto row = [&](const Vector3d& x) {
    Eigen::Matrix<double, 3, 6> j;
    j << -cross_matrix((x - box.center()) / unit_m), Eigen::Matrix3d::Identity();
    return j;
  };
  Matrix6 held = Matrix6::Zero(), slid = Matrix6::Zero();
  double squares_m2 = 0, count = 0;
  const double reach_m = 2 * unit_m / std::sqrt(static_cast<double>(places.size()));
  for (const Vector3d& x : places) {
    const auto found = tree.nearest(x, reach_m);
    if (!found) continue;
    const Vector3d n = target.normals[found->index], off = x - target.points[found->index];
    const Eigen::Matrix3d along = Eigen::Matrix3d::Identity() - n * n.transpose();
    held += row(x).transpose() * n * n.transpose() * row(x);
    slid += row(x).transpose() * along * row(x);
    squares_m2 += (along * off).squaredNorm() / 2;
    ++count;
  }
  const Matrix6 inverse = held.inverse();
  const Matrix6 covariance = squares_m2 / count * inverse * slid * inverse;
  double largest_m2 = 0;
  for (const Vector3d& x : places)
    largest_m2 = std::max(largest_m2, (row(x) * covariance * row(x).transpose()).trace());
  return 3 * std::sqrt(largest_m2);
}

void run(const test::HardCase& hard) {
  std::string wanted;
  for (const Stop stop : hard.wanted)
    wanted += (wanted.empty() ? "" : " or ") + std::string(name_of(stop));
  std::printf("| %-28s | %-32s |", hard.name.c_str(), wanted.c_str());
  for (const IcpMethod method : test::icp_methods) {
    IcpOptions options = hard.options;
    options.method = method;
    const IcpResult result = icp(hard.source, hard.target, hard.guess, options);
    const std::string what = hard.name + ", " + std::string(name_of(method));
    std::printf(" %-18s |", std::string(name_of(result.stop)).c_str());
    EXPECT_TRUE(hard.wanted.contains(result.stop)) << what << ": " << name_of(result.stop);
    EXPECT_TRUE(result.target_from_source.matrix().allFinite()) << what;
    EXPECT_TRUE(result.information.allFinite()) << what;
    EXPECT_TRUE(result.stop != Stop::degenerate || !result.weak_directions.empty()) << what;
    if (result.stop == Stop::converged) {
      EXPECT_TRUE(result.weak_directions.empty()) << what;
      const double tolerance_m = method == IcpMethod::point_to_point
                                     ? std::min(hard.scale * spacing_tolerance_m, slide_m(hard))
                                     : hard.scale * plane_tolerance_m;
      EXPECT_LT(largest_error_m(hard, result), tolerance_m) << what;
    }
    if (hard.source.size() > 4000) continue;  // the tenfold cloud: once is long enough
    for (const SearchMethod search : {SearchMethod::octree, SearchMethod::flann,
                                      SearchMethod::pcl_octree, SearchMethod::brute_force}) {
      options.search = search;
      const IcpResult other = icp(hard.source, hard.target, hard.guess, options);
      EXPECT_EQ(other.stop, result.stop) << what << ", " << name_of(search);
      EXPECT_EQ(other.target_from_source.matrix(), result.target_from_source.matrix())
          << what << ", " << name_of(search);
    }
  }
  std::printf("\n");
}

void run_all(const std::vector<test::HardCase>& cases) {
  std::printf(
      "| case                         | wanted                           | point-to-point    "
      " "
      "| point-to-plane     | symmetric          | plane-to-plane     |\n");
  for (const test::HardCase& hard : cases) run(hard);
}

TEST(HardTable, OfBrokenInput) {
  run_all(test::input_cases());
}

TEST(HardTable, OfFramesAndUnits) {
  run_all(test::frame_cases());
}

TEST(HardTable, OfScenes) {
  run_all(test::scene_cases());
}

}  // namespace
}  // namespace scan
