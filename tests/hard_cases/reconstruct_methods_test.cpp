// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Hard input through every method: a right surface or a clear error, never a crash, never a NaN.
#include <gtest/gtest.h>

#include <optional>

#include "libscan/core/error.h"
#include "libscan/reconstruct/reconstruct.h"
#include "tests/hard_cases/reconstruct_cases.h"
#include "tests/reconstruct/method_names.h"

namespace scan {
namespace {

#ifdef LIBSCAN_WITH_CGAL
constexpr bool with_cgal = true;
#else
constexpr bool with_cgal = false;
#endif

std::optional<SurfaceResult> answer_of(const HardCase& hard, ReconstructMethod method) {
  const std::vector<Eigen::Vector3d> scanners = scanners_of(hard.cloud);
  try {
    return reconstruct(hard.cloud, scanners, {.method = method, .ssd = {.depth = 6}});
  } catch (const Error& error) {
    EXPECT_GT(std::string(error.what()).size(), 10u);
    EXPECT_TRUE(error.trouble() == Trouble::input || error.trouble() == Trouble::computation)
        << error.what();
    return std::nullopt;
  }
}

class HardCases : public testing::TestWithParam<std::size_t> {};

TEST_P(HardCases, EndInARightSurfaceOrAClearError) {
  const auto method = static_cast<ReconstructMethod>(GetParam());
  if (!with_cgal &&
      (method == ReconstructMethod::poisson || method == ReconstructMethod::delaunay ||
       method == ReconstructMethod::scale_space || method == ReconstructMethod::power_crust))
    GTEST_SKIP() << "built with LIBSCAN_WITH_CGAL=OFF";
  for (const HardCase& hard : hard_cases()) {
    SCOPED_TRACE(hard.name);
    const std::optional<SurfaceResult> result = answer_of(hard, method);
    if (hard.answer != Answer::either) {
      EXPECT_EQ(result.has_value(), hard.answer == Answer::surface);
    }
    if (!result) continue;
    EXPECT_FALSE(result->surface.empty());
    std::size_t off = 0, supported = 0;
    for (std::size_t v = 0; v < result->surface.vertices.size(); ++v) {
      const Eigen::Vector3d& x = result->surface.vertices[v];
      ASSERT_TRUE(x.allFinite());
      if (result->support_m[v] > 2 * hard.tolerance_m) continue;
      ++supported;
      off += hard.distance_m(x) > hard.tolerance_m;
    }
    EXPECT_GT(supported, 0u);
    EXPECT_LE(off, supported / 100);
  }
}

INSTANTIATE_TEST_SUITE_P(All, HardCases, test::each_method(), test::method_name);

}  // namespace
}  // namespace scan
