// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The effect planner's proof: over the scenes of datasets/recipes/effects it switches on what the
// scene was built for, and what it leaves out stays within its bounds (simulate --check).
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/tools/program.h"

namespace scan::test {
namespace {

using nlohmann::json;

// What each scene calls for besides noise and rounding; nothing else may be on in the first two.
const std::map<std::string, std::set<std::string>> called_for = {
    {"plane-laser", {}},
    {"ball-phase", {}},
    {"print-stereo", {"footprint"}},
    {"checker-laser", {}},
    {"corner-matt-phase", {"interreflection"}},
    {"corner-glossy-laser", {"interreflection"}},
    {"pane-lidar", {"refraction"}},
    {"mirror-phase", {"mirror reflection"}},
    {"wax-laser", {"subsurface"}},
    {"fog-lidar", {"medium"}},
    {"wires-lidar", {"footprint"}},
    {"platform-lidar", {"motion"}},
    {"far-phase", {}},
    {"desk-stereo", {"scene lights", "defocus"}},
    {"shelf-phase", {"interreflection", "wiggling"}},
    {"street-lidar", {"medium", "refraction"}},
    {"bracket-laser-glossy", {"speckle"}}};

std::vector<std::string> scenes() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(LIBSCAN_SOURCE_DIR "/datasets/recipes/effects"))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

// Scenes whose points differ from scan to scan by the paths of light, drawn anew or shared among
// other pixels: hundreds of scans would resolve 0.1 sigma of each point. There the points together
// are held to it, and each to what the repeats resolve.
bool is_noisy(const std::string& scene) {
  return scene.ends_with("stereo") || scene == "corner-glossy-laser" ||
         scene == "corner-matt-phase" || scene == "shelf-phase";
}

// Within the bounds, unbiased beyond doubt, and decided for 95 % of the points of quiet scenes.
void expect_proven(const json& check, bool noisy) {
  EXPECT_TRUE(check.at("pass").get<bool>()) << check.dump();
  const auto number = [&](const char* key) { return check.at(key).get<double>(); };
  EXPECT_GT(number("points"), 100);
  EXPECT_EQ(number("beyond"), 0) << check.dump();
  EXPECT_GE(number("bias_low_sigma"), -0.1) << check.dump();
  EXPECT_LE(number("bias_high_sigma"), 0.1) << check.dump();
  const double open = number("undecided") + number("unsteady") + number("at_edges");
  const double open_share = open / (number("points") + number("unsteady") + number("at_edges"));
  EXPECT_TRUE(noisy || open_share <= 0.05) << check.dump();
}

// All scans' rays over the seconds of their simulation.
void expect_rate(const json& result) {
  double rays = 0;
  for (const json& scan : result.at("scans")) rays += scan.at("rays").get<double>();
  EXPECT_GT(rays, 0);
  const double expected = rays / result.at("seconds").at("simulate").get<double>();
  EXPECT_NEAR(result.at("rays_per_second").get<double>(), expected, 1e-9 * expected);
}

class PlannerScenes : public testing::TestWithParam<std::string> {};

TEST_P(PlannerScenes, ArePlannedWithinTheirBounds) {
  const Folder folder;
  const std::string recipe = LIBSCAN_SOURCE_DIR "/datasets/recipes/effects/" + GetParam() + ".json";
  const Outcome outcome =
      run_scan({"simulate", recipe, (folder / "run").string(), "--check", "--json"});
  ASSERT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 1) << outcome.err;
  const json result = json::parse(outcome.out);
  expect_rate(result);
  std::set<std::string> on;
  for (const json& effect : result.at("effects")) {
    EXPECT_GT(effect.at("reason").get<std::string>().size(), 20u);
    if (effect.at("decision") == "on") on.insert(effect.at("effect"));
  }
  ASSERT_TRUE(called_for.contains(GetParam())) << "state what the new scene calls for";
  for (const std::string& effect : called_for.at(GetParam()))
    EXPECT_TRUE(on.contains(effect)) << effect;
  if (called_for.at(GetParam()).empty()) {
    for (const char* effect : {"mirror reflection", "refraction", "subsurface", "medium", "motion"})
      EXPECT_FALSE(on.contains(effect)) << effect;
  }
  for (const json& check : result.at("check")) expect_proven(check, is_noisy(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(All, PlannerScenes, testing::ValuesIn(scenes()), [](const auto& scene) {
  std::string name = scene.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(PlannerScenes, AreAllThere) {
  EXPECT_GE(scenes().size(), 16u);
  for (const auto& [name, effects] : called_for)
    EXPECT_TRUE(
        std::filesystem::exists(LIBSCAN_SOURCE_DIR "/datasets/recipes/effects/" + name + ".json"))
        << name;
}

}  // namespace
}  // namespace scan::test
