// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/stereo_paths.h"

#include <cmath>

#include "tests/synth/stereo_images.h"

namespace scan::synth {
namespace {

StereoPair lit_pair() {
  StereoPair pair = small_pair();
  pair.ambient_electrons = 1500;
  pair.projector_electrons = 3000;
  pair.projector_dots = 32;
  pair.vignetting = 0.5;
  return pair;
}

// Two routes to one number: sub-rays on a grid with direct light, and paths. A convex scene has no
// light over two surfaces. The path mean is known to its standard error with 3 degrees of freedom:
// beyond 22 of them once in 5000 (Student's t), for 24 pixels once in 200; the grid of 144 rays
// errs by less than 1 % of the brightest light.
TEST(StereoPaths, MeetDirectLightOnAConvexScene) {
  StereoPair pair = lit_pair();
  pair.sub_rays = 12;
  const Scene scene{.objects = {sphere_at({0.05, -0.02, 1}, 0.2)}, .materials = {noisy(0.1, 2)}};
  const RayCaster caster(scene);
  const LightTransport transport(caster, transport_options({Effect::interreflection}, false));
  for (int i = 0; i < 24; ++i) {
    const StereoSide side = i % 2 ? StereoSide::left : StereoSide::right;
    const int column = 28 + i % 12, row = 8 + i / 2;
    const PixelEstimate paths =
        path_electrons(pair, transport, Pose::Identity(), {3, 1}, side, column, row);
    const double grid = expected_electrons(pair, caster, Pose::Identity(), side, column, row);
    EXPECT_NEAR(paths.electrons, grid, 22 * paths.standard_error + 0.01 * 4500);
    EXPECT_GT(grid, 100);
  }
}

// A wall seen in a mirror at 45 degrees is as bright as the same wall seen straight, under ambient
// light; without mirrors the mirror is black.
TEST(StereoPaths, SeeAWallInAMirror) {
  StereoPair pair = small_pair();
  pair.ambient_electrons = 2000;
  const Scene scene{
      .objects = {plane_at(1, std::numbers::pi / 4),
                  {.name = "wall",
                   .world_from_object =
                       make_pose(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY())
                                     .toRotationMatrix(),
                                 {-3, 0, 0}),
                   .geometry = Shape{PlaneShape{}},
                   .material = 1}},
      .materials = {{.name = "mirror", .bsdf = Conductor{1, 100, 0}}, plain(0.5)}};
  const RayCaster caster(scene);
  const LightTransport with(
      caster, transport_options({Effect::mirror_reflection, Effect::interreflection}, false));
  const auto mean = [&](const LightTransport& transport) {
    return path_electrons(pair, transport, Pose::Identity(), {}, StereoSide::left, 40, 16)
        .electrons;
  };
  const bool faces_the_wall =
      caster.closest(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()).has_value();
  ASSERT_TRUE(faces_the_wall);
  EXPECT_NEAR(mean(with), 1000, 1);  // 4 / k^2 of the light is absorbed
  const LightTransport without(caster, transport_options({Effect::interreflection}, false));
  EXPECT_EQ(mean(without), 0);
}

}  // namespace
}  // namespace scan::synth
