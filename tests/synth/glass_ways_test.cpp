// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Ways through clear bodies against closed forms.
#include <gtest/gtest.h>

#include "synth/bsdf/fresnel.h"
#include "tests/synth/smooth_scenes.h"

namespace scan::synth {
namespace {

constexpr double index_of_glass = 1.5;
constexpr double thickness_m = 0.006;

// A pane of 1 m in z = 0 and a wall behind the light's side.
Scene pane_scene() {
  Scene scene;
  scene.materials = {glass_material(), plain(0.5)};
  scene.objects = {placed(BoxShape{{1, 1, thickness_m}}, 0, {0, 0, 0})};
  return scene;
}

// Distance along a pane's normal in air `open_m`, angle of incidence: how far light gets sideways,
// its derivative by the angle, and the length of the way.
struct PaneWay {
  PaneWay(double open_m, double angle, double passes = 1) {
    const double inner = std::asin(std::sin(angle) / index_of_glass);
    const double d = passes * thickness_m;
    sideways_m = open_m * std::tan(angle) + d * std::tan(inner);
    slope_m = open_m / std::pow(std::cos(angle), 2) +
              d * std::cos(angle) / (index_of_glass * std::pow(std::cos(inner), 3));
    length_m = open_m / std::cos(angle) + d / std::cos(inner);
    optical_m = open_m / std::cos(angle) + index_of_glass * d / std::cos(inner);
    // area across per solid angle: cos(angle) dh in the plane of incidence, h / sin(angle) across
    spread = length_m * length_m / (std::cos(angle) * slope_m * sideways_m / std::sin(angle));
  }
  double sideways_m, slope_m, length_m, optical_m, spread;
};

// The extra optical length d (n - 1), and rays that diverge from a point nearer by d (1 - 1 / n).
TEST(Pane, AtNormalIncidence) {
  const RayCaster caster(pane_scene());
  const Connector connector(caster, 8);
  EXPECT_FALSE(connector.straight_only());
  std::vector<Connection> ways;
  const Eigen::Vector3d at(0.1, 0.2, 0.7), light(0.1, 0.2, -0.4);
  connector.connect(at, light, ways);
  ASSERT_FALSE(ways.empty());
  const Connection& way = ways[0];
  const double length_m = 1.1, r = 0.04, d = thickness_m;
  EXPECT_EQ(way.bounces, 2);
  EXPECT_NEAR(way.length_m, length_m, 1e-14);
  EXPECT_NEAR(way.optical_m - way.length_m, d * (index_of_glass - 1), 1e-14);
  EXPECT_NEAR(way.open_m, length_m - d, 1e-14);
  EXPECT_NEAR(way.throughput, (1 - r) * (1 - r), 1e-14);
  EXPECT_NEAR(way.spread, std::pow(length_m / (length_m - d + d / index_of_glass), 2), 1e-12);
  EXPECT_EQ(way.point_index, 1);
}

// Both ends' directions are parallel, shifted by d sin(a) (1 - cos(a) / (n cos(b))).
TEST(Pane, Tilted) {
  const Scene scene = pane_scene();
  const RayCaster caster(scene);
  const Connector connector(caster, 8);
  std::vector<Connection> ways;
  for (const double angle : {0.2, 0.7, 1.2}) {
    const PaneWay truth(0.06, angle);
    const Eigen::Vector3d light(0, -truth.sideways_m / 2, -0.03 - thickness_m / 2),
        at(0, truth.sideways_m / 2, 0.03 + thickness_m / 2);
    connector.connect(at, light, ways);
    const auto direct = with_bounces(ways, 2);
    ASSERT_EQ(direct.size(), 1u);
    const Connection& way = direct[0];
    const Eigen::Vector3d travel(0, std::sin(angle), std::cos(angle));
    EXPECT_LT((way.arriving + travel).norm(), 1e-11);
    EXPECT_LT((way.emitted - travel).norm(), 1e-11);
    const double inner = std::asin(std::sin(angle) / index_of_glass);
    const double shift_m =
        thickness_m * std::sin(angle) * (1 - std::cos(angle) / (index_of_glass * std::cos(inner)));
    const Eigen::Vector3d line = at - light;
    EXPECT_NEAR((line - line.dot(way.emitted) * way.emitted).norm(), shift_m, 1e-12);
    EXPECT_NEAR(way.length_m, truth.length_m, 1e-12);
    EXPECT_NEAR(way.optical_m, truth.optical_m, 1e-12);
    EXPECT_NEAR(way.spread / truth.spread, 1, 1e-10);
    EXPECT_NEAR(way.throughput,
                std::pow(1 - fresnel_dielectric(std::cos(angle), index_of_glass), 2), 1e-12);
    expect_stationary(scene, {0, 0}, at, light, way, {1, index_of_glass, 1});
  }
}

// Direct transmission and the double inner reflection: (1 - r)^2 (1 + r^2) = 0.92308 of the full
// (1 - r) / (1 + r) = 0.92308; what is left out is of order r^4 = 2.6e-6. With the lengths of each
// pass.
TEST(Pane, TransmissionIncludesInnerReflections) {
  const RayCaster caster(pane_scene());
  const Connector connector(caster, 8);
  std::vector<Connection> ways;
  const Eigen::Vector3d at(0.1, 0.2, 0.7), light(0.1, 0.2, -0.4);
  connector.connect(at, light, ways);
  double sum = 0;
  for (const Connection& way : ways) {
    if (way.bounces != 2 && way.bounces != 4) continue;
    sum += way.throughput;
    const double glass_m = (way.bounces - 1) * thickness_m;
    EXPECT_NEAR(way.optical_m, 1.1 - thickness_m + index_of_glass * glass_m, 1e-13);
  }
  EXPECT_NEAR(sum, 0.96 / 1.04, 3e-6);
}

// Light on the point's own side: from the front face, and from the back face through the front.
TEST(Pane, ReflectsFromBothFaces) {
  const Scene scene = pane_scene();
  const RayCaster caster(scene);
  const Connector connector(caster, 8);
  std::vector<Connection> ways;
  const Eigen::Vector3d at(0.1, 0, 0.3), light(-0.1, 0.05, 0.4);
  connector.connect(at, light, ways);
  ASSERT_GE(ways.size(), 3u);
  EXPECT_EQ(ways[0].bounces, 0);
  const auto front = with_bounces(ways, 1), back = with_bounces(ways, 3);
  ASSERT_EQ(front.size(), 1u);
  ASSERT_EQ(back.size(), 1u);
  expect_stationary(scene, {0}, at, light, front[0], {1, 1});
  expect_stationary(scene, {0, 0, 0}, at, light, back[0], {1, 1.5, 1.5, 1});
  const Eigen::Vector3d image(light.x(), light.y(), thickness_m - light.z());
  EXPECT_NEAR(front[0].length_m, (image - at).norm(), 1e-13);
  EXPECT_NEAR(front[0].spread, 1, 1e-12);
  const double cosine = (at - image).normalized().z();
  EXPECT_NEAR(front[0].throughput, fresnel_dielectric(cosine, 1.5), 1e-13);
}

// A smooth face of glass or metal lights what is opaque only from the front.
TEST(Pane, WallBehindItBlocks) {
  Scene scene = pane_scene();
  scene.objects.push_back(placed(BoxShape{{1, 1, 0.01}}, 1, {0, 0, -0.2}));
  const RayCaster caster(scene);
  const Connector connector(caster, 8);
  std::vector<Connection> ways;
  connector.connect(Eigen::Vector3d(0.1, 0.2, 0.7), Eigen::Vector3d(0.1, 0.2, -0.4), ways);
  EXPECT_TRUE(ways.empty());
  scene.materials[0].bsdf = Dielectric{.index = 1.5, .roughness = 0.1};
  scene.objects.pop_back();
  const RayCaster frosted_caster(scene);
  const Connector frosted(frosted_caster, 8);
  frosted.connect(Eigen::Vector3d(0.1, 0.2, 0.7), Eigen::Vector3d(0.1, 0.2, -0.4), ways);
  EXPECT_TRUE(ways.empty());
}

// The pane as a mesh of twelve triangles gives the same ways.
TEST(Pane, OfTrianglesIsTheSame) {
  const Eigen::Vector3d h(0.5, 0.5, thickness_m / 2);
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        {i & 1 ? h.x() : -h.x(), i & 2 ? h.y() : -h.y(), i & 4 ? h.z() : -h.z()});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  Scene scene = pane_scene();
  const RayCaster box_caster(scene);
  scene.objects[0].geometry = mesh;
  const RayCaster mesh_caster(scene);
  const Connector of_box(box_caster, 8), of_mesh(mesh_caster, 8);
  std::vector<Connection> box_ways, mesh_ways;
  for (std::uint64_t i = 0; i < 50; ++i) {
    RandomStream random(5, 0, i);
    Eigen::Vector3d at, light;
    for (int axis = 0; axis < 3; ++axis) at(axis) = 0.4 * (2 * random.uniform() - 1);
    for (int axis = 0; axis < 3; ++axis) light(axis) = 0.4 * (2 * random.uniform() - 1);
    of_box.connect(at, light, box_ways);
    of_mesh.connect(at, light, mesh_ways);
    ASSERT_EQ(box_ways.size(), mesh_ways.size()) << i;
    for (std::size_t k = 0; k < box_ways.size(); ++k) {
      EXPECT_NEAR(box_ways[k].optical_m, mesh_ways[k].optical_m, 1e-12);
      EXPECT_NEAR(box_ways[k].spread / mesh_ways[k].spread, 1, 1e-9);
      EXPECT_NEAR(box_ways[k].throughput, mesh_ways[k].throughput, 1e-12);
    }
  }
}

// A cube's side reflects totally from inside: only the entry and the exit cost light.
TEST(GlassCube, ReflectsTotallyInside) {
  Scene scene;
  scene.materials = {glass_material()};
  scene.objects = {placed(BoxShape{{0.1, 0.1, 0.1}}, 0, {0, 0, 0})};
  const RayCaster caster(scene);
  const Connector connector(caster, 8);
  const Eigen::Vector3d at(0.03, 0, -0.1), light(0.03, 0, 0.1);
  std::vector<Connection> ways;
  connector.connect(at, light, ways);
  // two entries' worth of light: over the side at x = 0.05
  bool found = false;
  for (const Connection& way : with_bounces(ways, 3)) {
    if (std::abs(way.bends[1].x() - 0.05) > 1e-12) continue;
    found = true;
    expect_stationary(scene, {0, 0, 0}, at, light, way, {1, 1.5, 1.5, 1});
    const double r = fresnel_dielectric(std::abs(way.arriving.z()), 1.5);
    EXPECT_NEAR(way.throughput, (1 - r) * (1 - r), 1e-12);
  }
  EXPECT_TRUE(found);
}

// A point under water, a light above: Snell's law by bisection, absorption in the water, and the
// solid angle seen from the light, which the water's index squared makes denser.
TEST(Water, LightsWhatLiesBelow) {
  Scene scene;
  const double index = 1.33, depth_m = 0.5, height_m = 0.8, side_m = 0.6;
  scene.materials = {glass_material(index), plain(0.5)};
  scene.materials[0].interior = Medium{.absorption_per_m = 0.3};
  scene.objects = {placed(PlaneShape{}, 0, {0, 0, 0})};
  const RayCaster caster(scene);
  const Connector connector(caster, 4);
  const Eigen::Vector3d at(0, 0, -depth_m), light(side_m, 0, height_m);
  std::vector<Connection> ways;
  connector.connect(at, light, ways);
  ASSERT_EQ(ways.size(), 1u);
  const Connection& way = ways[0];
  const auto inner = [&](double angle) { return std::asin(std::sin(angle) / index); };
  const double angle = bisect(0, 1.5, [&](double a) {
    return height_m * std::tan(a) + depth_m * std::tan(inner(a)) - side_m;
  });
  expect_stationary(scene, {0}, at, light, way, {index, 1});
  EXPECT_NEAR(std::acos(-way.emitted.z()), angle, 1e-11);
  EXPECT_NEAR(std::acos(way.arriving.z()), inner(angle), 1e-11);
  const double wet_m = depth_m / std::cos(inner(angle)), dry_m = height_m / std::cos(angle);
  EXPECT_NEAR(way.open_m, dry_m, 1e-12);
  EXPECT_NEAR(way.throughput,
              (1 - fresnel_dielectric(std::cos(angle), index)) * std::exp(-0.3 * wet_m), 1e-11);
  EXPECT_EQ(way.point_index, index);
  // area across the way at the point, under water, per solid angle at the light
  const double slope_m = height_m / std::pow(std::cos(angle), 2) +
                         depth_m * std::cos(angle) / (index * std::pow(std::cos(inner(angle)), 3));
  const double area_m2 = std::cos(inner(angle)) * slope_m * side_m / std::sin(angle);
  EXPECT_NEAR(way.spread, std::pow(wet_m + dry_m, 2) / area_m2, 1e-9);
}

// Paraxial matrices: a ball of radius r and index n between distances a and b from its centre has
// B = a + b - a b / f with f = n r / (2 (n - 1)) from the centre; light spreads over B^2.
TEST(BallLens, SpreadsOnItsAxisAsItsMatrixSays) {
  const double r = 0.02, n = 1.5, a = 0.11, f = n * r / (2 * (n - 1));
  Scene scene;
  scene.materials = {glass_material(n)};
  scene.objects = {placed(SphereShape{r}, 0, {0.3, -0.2, 0.4})};
  const RayCaster caster(scene);
  const Connector connector(caster, 4);
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 2) / 3, centre(0.3, -0.2, 0.4);
  for (const double b : {0.025, 0.031, 0.06, 0.2}) {
    std::vector<Connection> ways;
    connector.connect(centre + b * axis, Eigen::Vector3d(centre - a * axis), ways);
    const Connection* axial = nullptr;
    for (const Connection& way : ways)
      if (way.bounces == 2 && (way.arriving + axis).norm() < 1e-9) axial = &way;
    ASSERT_TRUE(axial);
    EXPECT_NEAR(axial->spread / std::pow((a + b) / (a + b - a * b / f), 2), 1, 1e-9) << b;
    EXPECT_NEAR(axial->optical_m, a + b + 2 * r * (n - 1), 1e-13);
    EXPECT_NEAR(axial->throughput, 0.96 * 0.96, 1e-12);
  }
}

// The light's image over a mirror behind a pane: through the pane, off the mirror, back through it.
TEST(Connector, SeesAMirrorThroughGlass) {
  Scene scene = pane_scene();
  scene.materials.push_back(mirror_material());
  scene.objects.push_back(placed(PlaneShape{}, 2, {0, 0, -0.2}));
  const RayCaster caster(scene);
  const Connector connector(caster, 8);
  const Eigen::Vector3d at(0.1, 0.05, 0.3), light(-0.1, 0, 0.2);
  std::vector<Connection> ways;
  connector.connect(at, light, ways);
  int found = 0;
  for (const Connection& way : with_bounces(ways, 5)) {
    if (std::abs(way.bends[2].z() + 0.2) > 1e-12) continue;
    ++found;
    expect_stationary(scene, {0, 0, 1, 0, 0}, at, light, way, {1, 1.5, 1, 1, 1.5, 1});
    const double angle = std::acos(-way.arriving.z());
    // 0.9 m of way along the normal, of which two passes of glass
    const PaneWay truth(0.9 - 2 * thickness_m, angle, 2);
    EXPECT_NEAR(way.length_m, truth.length_m, 1e-12);
    EXPECT_NEAR(way.spread / truth.spread, 1, 1e-10);
    const double r = fresnel_dielectric(std::cos(angle), 1.5);
    EXPECT_NEAR(way.throughput, std::pow(1 - r, 4) * fresnel_conductor(std::cos(angle), 0.2, 6),
                1e-12);
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace scan::synth
