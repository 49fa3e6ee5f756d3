// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The data sheet of each recipe's scanner keeps the limits that the recipe states for it, and a
// device that is not what its calibration says misses one.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace scan::test {
namespace {

using nlohmann::json;

constexpr int ok = 0, failed = 1;

json recipe(const std::string& name) {
  return json::parse(slurp(LIBSCAN_SOURCE_DIR "/datasets/recipes/" + name + ".json"));
}

struct Sheet {
  Outcome outcome;
  json measurements;
  const json& row(const std::string& name) const {
    for (const json& m : measurements)
      if (m.at("name") == name) return m;
    throw std::runtime_error(name + " is not in the sheet");
  }
};

Sheet sheet_of(const json& recipe) {
  const Folder folder;
  spill(folder / "recipe.json", recipe.dump());
  Sheet sheet{run_scan({"verify", "--artefacts", (folder / "recipe.json").string(), "--json"}), {}};
  if (sheet.outcome.exit_code <= failed)
    sheet.measurements = json::parse(sheet.outcome.out).at("measurements");
  return sheet;
}

class ArtefactLimits : public testing::TestWithParam<const char*> {};

TEST_P(ArtefactLimits, AreKept) {
  const Sheet sheet = sheet_of(recipe(GetParam()));
  ASSERT_EQ(sheet.outcome.exit_code, ok) << sheet.outcome.out << sheet.outcome.err;
  std::size_t limits = 0;
  for (const json& m : sheet.measurements) {
    if (m.at("limit").is_null()) continue;
    ++limits;
    EXPECT_TRUE(m.at("pass")) << m.dump(2);
    EXPECT_GT(m.at("reason").get<std::string>().size(), 40u) << m.at("name");
  }
  EXPECT_EQ(limits, 4u);
}

INSTANTIATE_TEST_SUITE_P(Recipes, ArtefactLimits,
                         testing::Values("bracket-laser", "bud-stereo", "vessel-phase",
                                         "pavilion-lidar"),
                         [](const auto& recipe) {
                           std::string name = recipe.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// The bracket's scanner with a stripe every 3.2 mm, in a fourth of the time, and what its device
// has that its calibration does not know.
json laser(const char* field, double value) {
  json changed = recipe("bracket-laser");
  json& device = changed.at("scanner").at("laser_line");
  device["steps"] = 38;
  device["step_mm"] = 3.2;
  device[field] = value;
  changed.at("effects").push_back("miscalibration");
  return changed;
}

// relative_range_error in um and whether it passed.
std::pair<double, bool> relative_range(const json& recipe) {
  const Sheet sheet = sheet_of(recipe);
  const json& m = sheet.row("relative_range_error");
  return {1e6 * m.at("value").get<double>(), m.at("pass")};
}

// With B the baseline, a the triangulation, z the range: a plane's offset B cos(a) that is a share
// larger than believed makes every range as much too short, and the 48 mm between the first and the
// last plate; a plane turned outwards by t takes t / (B cos^2(a)) from 1 / z, and so moves the
// plates at 367 and 319 mm apart by the difference of z^2 times that (1 % of it is left for second
// order, as z t / B is 4e-4 and tan(a) t 8e-5). The mean of a fourth of the 14800 points of 8.2 um
// is known to 0.13 um, the difference of two to 0.19; four of these, and of both sheets, 1.1 um.
TEST(ArtefactLimitsOfALaser, ATinyMiscalibrationMissesThem) {
  constexpr double baseline_mm = 160, a_rad = 25 * 0.017453292519943295, between_um = 48e3,
                   chance_um = 1.1;
  const double offset_mm = baseline_mm * std::cos(a_rad);
  const auto [is_um, is_kept] = relative_range(laser("plane_shift_mm", 0));
  EXPECT_TRUE(is_kept) << is_um;
  for (const double share : {1e-4, 1e-3}) {
    const auto [um, kept] = relative_range(laser("plane_shift_mm", share * offset_mm));
    EXPECT_FALSE(kept) << share;
    EXPECT_NEAR(um - is_um, -share * between_um, chance_um) << share;
  }
  const double turn_deg = 0.01, turn_rad = turn_deg * a_rad / 25;
  const double moved_um = 1e3 * (367.0 * 367 - 319.0 * 319) * turn_rad / baseline_mm /
                          (std::cos(a_rad) * std::cos(a_rad));
  const auto [um, kept] = relative_range(laser("plane_turn_deg", turn_deg));
  EXPECT_FALSE(kept) << um;
  EXPECT_NEAR(um - is_um, moved_um, chance_um + 0.01 * moved_um);
}

// Views that see a ball from several sides disagree where every range is too long by d: each moves
// its points inwards by d cos(incidence), which is 0.5 d to d, so that the ball gets smaller by d
// to 2 d if views from all sides tell of it, of which three see a part.
TEST(ArtefactLimitsOfAPhaseCamera, ARangeOffsetMissesThem) {
  json changed = recipe("vessel-phase");
  changed.at("scanner").at("phase_camera")["range_offset_mm"] = 5;
  changed.at("effects").push_back("miscalibration");
  const Sheet sheet = sheet_of(changed);
  EXPECT_EQ(sheet.outcome.exit_code, failed) << sheet.outcome.err;
  const json& row = sheet.row("merged_probing_size");
  EXPECT_FALSE(row.at("pass"));
  EXPECT_GT(-row.at("value").get<double>(), 5e-3);
  EXPECT_LT(-row.at("value").get<double>(), 10e-3);
}

// Echoes N times as strong come later by log10(N) / 10 ns: plates at 7 and 9 m return (9/7)^2 and
// stand 0.22 / 20 ns c = 3.3 mm too near together, 22 times the limit.
TEST(ArtefactLimitsOfALidar, ARangeWalkMissesThem) {
  json changed = recipe("pavilion-lidar");
  changed.at("scanner").at("pulsed_lidar")["range_walk"] = {{"per_decade_ns", 0.1},
                                                            {"at_electrons", 10000}};
  const Sheet sheet = sheet_of(changed);
  EXPECT_EQ(sheet.outcome.exit_code, failed) << sheet.outcome.err;
  EXPECT_FALSE(sheet.row("relative_range_error").at("pass"));
  const double predicted_m = -2 * std::log10(9.0 / 7) * 0.1e-9 * 299792458.0 / 2;
  EXPECT_NEAR(sheet.row("relative_range_error").at("value").get<double>(), predicted_m, 1.5e-4);
}

}  // namespace
}  // namespace scan::test
