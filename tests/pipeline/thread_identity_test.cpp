// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The same seed gives the same bytes of every file in the run folder, for any number of threads.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace scan::test {
namespace {

// One small run per scanner, as text: scanner and viewing distance.
struct Device {
  std::string name, scanner, radius;
};

// How GoogleTest names a case in its messages.
void PrintTo(const Device& device, std::ostream* out) {
  *out << device.name;
}

std::vector<Device> devices() {
  return {
      {"laser_line",
       R"("laser_line": { "camera": { "width_px": 120, "height_px": 90, "focal_px": 260 },
             "baseline_mm": 120, "triangulation_deg": 20, "beam_radius_mm": 1.5, "steps": 60, "step_mm": 1.5,
             "sensor": { "gain_e_per_dn": 4, "read_noise_e": 8, "offset_dn": 16, "bits": 12 } })",
       "330"},
      {"stereo_pair",
       R"("stereo_pair": { "width_px": 160, "height_px": 120, "focal_px": 320, "baseline_mm": 60,
             "min_disparity_px": 32, "disparities_px": 48, "ambient_electrons": 8000, "sub_rays": 2 })",
       "400"},
      {"phase_camera",
       R"("phase_camera": { "camera": { "width_px": 80, "height_px": 60, "focal_px": 160 },
             "frequencies_mhz": [60, 100], "electrons_at_1m": 20000, "max_range_m": 3 })",
       "400"},
      {"pulsed_lidar",
       R"("pulsed_lidar": { "raster": { "rows": 50, "columns": 50, "height_deg": 20, "width_deg": 20 },
             "electrons_at_10m": 20, "sensor": { "gain_e_per_dn": 4, "offset_dn": 20, "read_noise_e": 8 },
             "min_range_m": 0.1, "max_range_m": 2 })",
       "400"}};
}

std::string recipe_for(const Device& device) {
  return R"({ "libscan": 1, "name": ")" + device.name + R"(", "seed": 5,
    "scene": { "objects": [ { "shape": "bud", "material": "paint" } ],
      "materials": { "paint": { "diffuse": 0.8, "texture": { "noise": { "period_mm": 6 } } } } },
    "scanner": { )" +
         device.scanner + R"( },
    "viewpoints": { "ring": { "count": 6, "radius_mm": )" +
         device.radius + R"(,
      "pose_noise": { "rotation_deg": 0.5, "translation_mm": 0.5 } } },
    "effects": [ "shot-noise", "read-noise", "quantisation", "footprint" ],
    "reconstruct": { "depth": 5 }, "verify": { "samples": 2000 } })";
}

// Timings and the machine stand in one file, in one element of the report, and under one key of
// its twin.
std::string without_timings(const std::string& name, std::string content) {
  if (name == "report.json") {
    auto twin = nlohmann::ordered_json::parse(content);
    EXPECT_EQ(twin.erase("cost"), 1u);
    return twin.dump();
  }
  if (name != "report.html") return content;
  const auto begin = content.find("<table id=\"seconds\">");
  const auto end = content.find("</table>", begin);
  EXPECT_NE(begin, std::string::npos);
  return content.erase(begin, end - begin);
}

class ThreadIdentity : public testing::TestWithParam<Device> {};

TEST_P(ThreadIdentity, EveryFileOfARunIsTheSame) {
  const Folder folder;
  spill(folder / "recipe.json", recipe_for(GetParam()));
  std::vector<std::string> names;
  for (const std::string threads : {"1", "2", "7"}) {
    const Outcome outcome =
        run_scan({"run", (folder / "recipe.json").string(), (folder / threads).string(),
                  "--threads", threads, "--keep-raw"});
    ASSERT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 1) << outcome.err;
    if (threads == "1") names = files_below(folder / "1");
    ASSERT_EQ(files_below(folder / threads), names);
  }
  EXPECT_GT(names.size(), 30u);
  for (const std::string& name : names) {
    if (name.starts_with("timings")) continue;
    const std::string one = without_timings(name, slurp((folder / "1") / name));
    for (const std::string threads : {"2", "7"})
      EXPECT_EQ(one, without_timings(name, slurp((folder / threads) / name)))
          << name << " differs with " << threads << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, ThreadIdentity, testing::ValuesIn(devices()),
                         [](const auto& device) { return device.param.name; });

}  // namespace
}  // namespace scan::test
