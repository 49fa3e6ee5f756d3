// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the planner asks of the lidar's pilot; the bounds themselves: effect_bounds_lidar_test.cpp.
#include <gtest/gtest.h>

#include "synth/effects/weight.h"
#include "tests/synth/lidar_waveforms.h"

namespace scan::synth {
namespace {

Weighed weighed(const PulsedLidar& lidar, const Scene& scene, Effect effect) {
  const RayCaster caster(scene);
  return weigh(lidar, scene, effect, pilot(lidar, caster, Pose::Identity(), 2000));
}

// Behind a pane stands what is measured.
TEST(WeighPulsedLidar, LooksThroughClearBodies) {
  Scene scene = scene_of(plane_at(12), 0.5);
  const auto bare = pilot(quiet_lidar(), RayCaster(scene), Pose::Identity(), 50);
  scene.materials.push_back({.name = "glass", .bsdf = Dielectric{1.5}});
  scene.objects.push_back({.name = "pane",
                           .world_from_object = make_pose(Eigen::Matrix3d::Identity(), {0, 0, 6}),
                           .geometry = Shape(BoxShape{{9, 9, 0.01}}),
                           .material = 1});
  const auto behind = pilot(quiet_lidar(), RayCaster(scene), Pose::Identity(), 50);
  ASSERT_EQ(bare.size(), behind.size());
  for (std::size_t i = 0; i < bare.size(); ++i) {
    EXPECT_EQ(bare[i].range_m, behind[i].range_m);
    EXPECT_EQ(bare[i].sigma_m, behind[i].sigma_m);
    EXPECT_FALSE(bare[i].met_smooth);
    EXPECT_TRUE(behind[i].met_smooth);
  }
}

TEST(WeighPulsedLidar, SaysWhatIsNotThere) {
  const PulsedLidar lidar = quiet_lidar();
  const Scene scene = scene_of(plane_at(12), 0.5);
  for (const Effect effect : all_effects()) {
    const Weighed weight = weighed(lidar, scene, effect);
    EXPECT_NE(weight.weight.has_value(), !weight.why_absent.empty()) << name(effect);
  }
  EXPECT_EQ(weighed(lidar, scene, Effect::footprint).why_absent, "the beam is a line");
  EXPECT_EQ(weighed(lidar, scene, Effect::medium).why_absent, "the air is clear");
  Scene mirror = scene;
  mirror.materials[0].bsdf = Conductor{.roughness = 0};
  // the wall stands at 12 m or more, the window ends at 40 m
  EXPECT_NEAR(weighed(lidar, mirror, Effect::mirror_reflection).weight->bound_m, 28, 0.01);
}

}  // namespace
}  // namespace scan::synth
