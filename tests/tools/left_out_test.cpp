// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which effects a verdict cannot know, and how that is said.
#include "tools/left_out.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace scan {
namespace {

using nlohmann::ordered_json;

ordered_json effect(const char* name, const char* decision, const ordered_json& bound_m,
                    const ordered_json& sigmas) {
  return {{"effect", name}, {"decision", decision}, {"bound_m", bound_m}, {"bound_sigma", sigmas}};
}

// 0.02 sigma is what the planner switches on, so as little as that counts.
const ordered_json effects = {
    effect("speckle", "off", 4e-6, 0.02),          effect("motion", "off", 3.9e-6, 0.0199),
    effect("interreflection", "off", 1.5e-3, 8.7), effect("shot noise", "on", 2e-4, 3),
    effect("fog", "off", nullptr, nullptr),        effect("medium", "off", 0, 0)};

TEST(LeftOut, IsWhatThePlannerWouldSwitchOn) {
  const ordered_json left_out = left_out_effects(effects, {{"effects", {"shot-noise"}}});
  ASSERT_EQ(left_out.size(), 3u);
  EXPECT_EQ(left_out[0].at("effect"), "fog");
  EXPECT_EQ(left_out[1].at("effect"), "interreflection");
  EXPECT_EQ(left_out[1].at("bound_m"), 1.5e-3);
  EXPECT_EQ(left_out[1].at("bound_sigma"), 8.7);
  EXPECT_EQ(left_out[2].at("effect"), "speckle");
  for (const auto& one : left_out) EXPECT_EQ(one.at("by"), "recipe");
}

TEST(LeftOut, SaysWhoseChoiceItWas) {
  EXPECT_EQ(left_out_effects(effects, {{"effects", "auto"}})[0].at("by"), "plan");
  EXPECT_EQ(left_out_effects(effects, {{"effects", "none"}})[0].at("by"), "recipe");
  EXPECT_EQ(left_out_effects(effects, nullptr)[0].at("by"), "recipe");
}

TEST(LeftOut, IsSaidWithItsBounds) {
  EXPECT_EQ(left_out_text(left_out_effects(effects, {{"effects", {"shot-noise"}}})),
            "the verdict does not know what the recipe left out: fog (bound unknown), "
            "interreflection (up to 1.5 mm, 8.7 sigma), speckle (up to 4 um, 0.02 sigma)");
}

TEST(LeftOut, SaysNothingOfNothing) {
  EXPECT_TRUE(left_out_effects({effects[1], effects[3], effects[5]}, nullptr).empty());
  EXPECT_TRUE(left_out_effects(nullptr, nullptr).empty());
  EXPECT_EQ(left_out_text(ordered_json::array()), "");
}

}  // namespace
}  // namespace scan
