// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_patches.h"

#include <algorithm>

#include "tests/synth/phase_bench.h"

namespace scan::synth {
namespace {

std::vector<Patch> patches(const Scene& scene, const PixelPlace& first = {0, 0}) {
  PhaseCamera camera = small_camera();
  camera.sub_rays = 2;
  const RayCaster caster(scene);
  const LightTransport transport(caster, {});
  const PathView view{camera, transport, Pose::Identity(), {}, {}};
  return patches_of(view, first, [](const PixelPlace& place) { return place.row < 30; });
}

std::size_t pixels_in(const std::vector<Patch>& all) {
  std::size_t sum = 0;
  for (const Patch& patch : all) sum += patch.size();
  return sum;
}

// Pixels that are not wanted, and those beyond the frame of 48, are left out.
TEST(PhasePatches, TakeAPlaneAsOne) {
  const Scene plane{.objects = {plane_at(2, 0.4)}, .materials = {plain(0.7)}};
  ASSERT_EQ(patches(plane).size(), 1u);
  EXPECT_EQ(patches(plane)[0].size(), 32u * 30);
  ASSERT_EQ(patches(plane, {32, 0}).size(), 1u);
  EXPECT_EQ(patches(plane, {32, 0})[0].size(), 16u * 30);
}

// Each quarter of the tile is one run of the patch.
TEST(PhasePatches, FollowMortonsOrder) {
  const Scene plane{.objects = {plane_at(2)}, .materials = {plain(0.7)}};
  const Patch patch = patches(plane)[0];
  EXPECT_TRUE(std::is_sorted(patch.begin(), patch.end(),
                             [](const auto& a, const auto& b) { return a.code < b.code; }));
  for (const PatchPixel& pixel : patch) {
    const int quarter = (pixel.place.column >= 16 ? 1 : 0) + (pixel.place.row >= 16 ? 2 : 0);
    EXPECT_EQ(pixel.code / 256, quarter);
  }
}

// A crease in the middle of the tile's pixel column 16 (centre 23.5, so at tan = -7.5 / 60), where
// neither side has it: two patches of 16 and 15 columns.
TEST(PhasePatches, EndAtACrease) {
  Scene scene{.objects = {plane_at(1.5, 0.6), plane_at(1.5, -0.6)}, .materials = {plain(0.7)}};
  const double aside_m = -7.5 / 60 * 1.5;
  for (Object& wall : scene.objects) wall.world_from_object.translation().x() = aside_m;
  const std::vector<Patch> found = patches(scene);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].size(), 16u * 30);
  EXPECT_EQ(found[1].size(), 15u * 30);
}

// A plate 0.5 m before the wall is parallel to it and of the same object: only the step parts them.
TEST(PhasePatches, EndAtAStep) {
  Object both = plate(1.5, -10, -7.5 / 60 * 1.5);
  auto& mesh = std::get<Mesh>(both.geometry);
  for (const Eigen::Vector3d& corner : Mesh(mesh).vertices)
    mesh.vertices.emplace_back(10 * corner.x() + 50, 10 * corner.y(), 2);
  mesh.triangles.push_back({4, 6, 5});
  mesh.triangles.push_back({4, 7, 6});
  const std::vector<Patch> found = patches({.objects = {both}, .materials = {plain(0.7)}});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(pixels_in(found), 31u * 30);
}

TEST(PhasePatches, AreMattAndPlain) {
  Scene scene{.objects = {plane_at(2)}, .materials = {plain(0.7)}};
  scene.materials[0].bsdf = OrenNayar{};
  EXPECT_EQ(patches(scene).size(), 1u);
  scene.materials[0].texture = NoiseTexture{};
  EXPECT_TRUE(patches(scene).empty());
  scene.materials[0] = {.name = "metal", .bsdf = Conductor{.roughness = 0.3}, .texture = {}};
  EXPECT_TRUE(patches(scene).empty());
}

}  // namespace
}  // namespace scan::synth
