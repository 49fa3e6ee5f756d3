// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Surfaces from the simulated scans of the surface reconstruction benchmark (Berger et al. 2013):
// 3,000 noisy points with estimated normals each, against the closed reference meshes.
#include <cmath>

#include "libscan/core/mesh.h"
#include "libscan/io/scan_file.h"
#include "tests/real_data/real_data.h"

namespace scan::test {
namespace {

const fs::path folder = data_folder("reconbench");

struct Case {
  std::string name;
  double genus = 0;
};

void PrintTo(const Case& shape, std::ostream* out) {
  *out << shape.name;
}

class Reconbench : public testing::TestWithParam<Case> {
 protected:
  std::string points() const {
    return (folder / "derived" / (GetParam().name + "_mvs_full.ply")).string();
  }
  std::string truth() const { return (folder / "mesh" / (GetParam().name + ".off")).string(); }
};

// The shapes have no unit; it is taken as metres.
TEST_P(Reconbench, SurfaceIsAsGoodAsTheSampling) {
  SKIP_WITHOUT(folder);
  const Folder out;
  const std::string surface = (out / "surface.ply").string();
  const Answer made = ask_scan({"reconstruct", points(), surface, "--depth", "7"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  print_seconds(made);
  const Answer scanned = ask_scan({"verify", points(), "--truth", truth()});
  const Answer verdict = ask_scan({"verify", surface, "--truth", truth()});

  // A chord of one sample spacing across a right-angled edge is 1 / (4 sqrt 2) = 0.177 of its
  // length from the faces on average: a surface that were all edges would not be worse, noise
  // aside.
  const double spacing_m = std::sqrt(area_m2(read_mesh(truth())) / 3000);
  std::cout << "  samples (spacing " << spacing_m << " m):\n";
  const double noise_m = measured(scanned, "accuracy_mean");
  const double gap_m = measured(scanned, "completeness_mean");
  std::cout << "  surface:\n";
  EXPECT_LE(measured(verdict, "accuracy_mean"), noise_m + 0.177 * spacing_m);
  // Between the samples the surface must know more than that a sample is near.
  EXPECT_LE(measured(verdict, "completeness_mean"), 0.5 * gap_m);
  EXPECT_EQ(measured(verdict, "components"), 1);
  EXPECT_EQ(measured(verdict, "boundary_edges"), 0);
  EXPECT_EQ(measured(verdict, "genus"), GetParam().genus);
  for (const char* name : {"accuracy_rms", "accuracy_p95", "accuracy_max", "completeness_rms",
                           "completeness_p95", "f_score", "normal_error_mean"})
    measured(verdict, name);
}

INSTANTIATE_TEST_SUITE_P(All, Reconbench, testing::Values(Case{"anchor", 4}, Case{"lordquas", 0}),
                         [](const auto& shape) { return shape.param.name; });

}  // namespace
}  // namespace scan::test
