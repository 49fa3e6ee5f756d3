// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/pilot_rounds.h"

#include <gtest/gtest.h>

#include <atomic>

namespace scan::synth {
namespace {

constexpr auto light = static_cast<std::size_t>(Effect::interreflection);
constexpr auto lamps = static_cast<std::size_t>(Effect::scene_lights);

struct Looked {
  std::vector<PilotRay> rays;
  int with_paths = 0;
};

// 1000 rays of 1 mm sigma of which ray `decisive` and those behind it err by so much where paths
// tell; every tenth sees nothing.
Looked looked(std::size_t decisive, double light_m, double lamps_m, const EffectSet& by_paths) {
  std::atomic<int> with_paths = 0;
  Looked result;
  result.rays =
      look_in_rounds(1000, by_paths, [&](std::size_t i, bool paths) -> std::optional<PilotRay> {
        with_paths += paths ? 1 : 0;
        if (i % 10 == 0) return std::nullopt;
        PilotRay ray{.range_m = static_cast<double>(i), .sigma_m = 1e-3};
        if (paths && i >= decisive) {
          ray.left_out_m[light] = light_m;
          ray.left_out_m[lamps] = lamps_m;
        }
        return ray;
      });
  result.with_paths = with_paths;
  return result;
}

TEST(PilotRounds, GiveTheRaysSeenInOrder) {
  const Looked all = looked(0, 0, 0, {Effect::interreflection});
  ASSERT_EQ(all.rays.size(), 900u);
  for (std::size_t i = 1; i < all.rays.size(); ++i)
    EXPECT_LT(all.rays[i - 1].range_m, all.rays[i].range_m);
}

// Below 0.02 sigma every ray is asked, from there on the first of 16 rounds decides.
TEST(PilotRounds, TracePathsUntilTheyDecide) {
  EXPECT_EQ(looked(0, 1.9e-5, 0, {Effect::interreflection}).with_paths, 1000);
  EXPECT_EQ(looked(0, 2.1e-5, 0, {Effect::interreflection}).with_paths, 63);
  // 999 = 62 * 16 + 7 is in the eighth round, and the first eight have 63 rays
  EXPECT_EQ(looked(999, 2.1e-5, 0, {Effect::interreflection}).with_paths, 8 * 63);
}

TEST(PilotRounds, WaitForEveryEffectThatPathsWeigh) {
  const EffectSet both = {Effect::interreflection, Effect::scene_lights};
  EXPECT_EQ(looked(0, 1, 0, both).with_paths, 1000);
  EXPECT_EQ(looked(0, 0, 1, both).with_paths, 1000);
  EXPECT_EQ(looked(0, 1, 1, both).with_paths, 63);
}

}  // namespace
}  // namespace scan::synth
