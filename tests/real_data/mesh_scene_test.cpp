// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A model that others made (Spot, by Keenan Crane) before a simulated phase camera: the whole road
// through `scan run`, the mesh is the truth.
#include "tests/real_data/real_data.h"

namespace scan::test {
namespace {

const fs::path model = data_folder("spot") / "spot_triangulated.obj";

// The cow is 1.7 m long.
nlohmann::json recipe() {
  return {{"libscan", 1},
          {"name", "spot"},
          {"seed", 3},
          {"scene",
           {{"objects", {{{"mesh", model.string()}, {"unit", "m"}, {"material", "plaster"}}}},
            {"materials", {{"plaster", {{"diffuse", 0.8}}}}}}},
          {"scanner",
           {{"phase_camera",
             {{"camera", {{"width_px", 240}, {"height_px", 180}, {"focal_px", 255}}},
              {"frequencies_mhz", {60, 100}},
              {"electrons_at_1m", 300000},
              {"contrast", 0.6},
              {"ambient_electrons", 2000},
              {"sensor",
               {{"gain_e_per_dn", 2}, {"read_noise_e", 20}, {"full_well_e", 120000}, {"bits", 16}}},
              {"max_range_m", 7}}}}},
          {"viewpoints",
           {{"dome",
             {{"count", 10},
              {"radius_m", 3},
              {"lowest_deg", -60},
              {"pose_noise", {{"rotation_deg", 0.5}, {"translation_mm", 10}}}}}}},
          {"effects", {"shot-noise", "read-noise", "quantisation", "footprint"}},
          {"reconstruct", {{"method", "ssd"}, {"depth", 7}}},
          {"verify", {{"seen_distance_mm", 20}}},
          {"limits", nlohmann::json::array()}};
}

TEST(MeshScene, ComesBackBetterThanSingleReadings) {
  SKIP_WITHOUT(model);
  const Folder out;
  spill(out / "spot.json", recipe().dump());
  const Answer run = ask_scan({"run", (out / "spot.json").string(), (out / "run").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  print_seconds(run);
  const double reading_m = measured(run, "range_error_rms");
  // Each cell of the surface rests on many readings from several places: it, and the poses, must be
  // better than one reading.
  EXPECT_LT(measured(run, "accuracy_rms"), reading_m);
  EXPECT_LT(measured(run, "completeness_rms"), reading_m);
  EXPECT_LT(measured(run, "pose_error_rms"), reading_m);
  // The readings' own sigma: over 10^5 of them the ratio is known to 1 %; effects that no sigma can
  // tell (edges in a pixel) add to it.
  EXPECT_NEAR(measured(run, "normalised_range_error_rms"), 1, 0.1);
  EXPECT_EQ(measured(run, "components"), 1);
  EXPECT_EQ(measured(run, "boundary_edges"), 0);
  EXPECT_EQ(measured(run, "genus"), 0);
  for (const char* name :
       {"accuracy_mean", "accuracy_p95", "accuracy_max", "completeness_mean", "normal_error_mean"})
    measured(run, name);
}

}  // namespace
}  // namespace scan::test
