// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Areas and volumes of scaled and rounded solids against closed forms and against each other.
#include "libscan/verify/size_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/core/random.h"
#include "tests/core/meshes.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

Mesh scaled(Mesh mesh, double factor) {
  for (auto& vertex : mesh.vertices) vertex *= factor;
  return mesh;
}

// Sums of 12 triangles round at a few 1e-16.
TEST(SizeError, OfAScaledMeshIsThePowerOfTheScale) {
  const Mesh one = cube(1);
  const auto errors = size_error(scaled(one, 1.01), {{}, {one}});
  EXPECT_NEAR(figure(errors, "area_error"), 1.01 * 1.01 - 1, 1e-14);
  EXPECT_NEAR(figure(errors, "volume_error"), 1.01 * 1.01 * 1.01 - 1, 1e-14);
}

// A box against the unit cube's mesh, and a rounded one against what its rounding takes away: along
// the 12 edges a square less a quarter disc, at the 8 corners a cube less an eighth of a ball, with
// the edges' parts cut back to 1 - 2 r.
TEST(SizeError, OfBoxes) {
  const auto error = [](double rounding, const char* name) {
    const TrueSurface box{{{Pose::Identity(), BoxShape{Eigen::Vector3d::Ones(), rounding}}}, {}};
    return figure(size_error(cube(1), box), name);
  };
  EXPECT_NEAR(error(0, "area_error"), 0, 1e-14);
  EXPECT_NEAR(error(0, "volume_error"), 0, 1e-14);
  const double r = 0.1, pi = std::numbers::pi;
  const double volume =
      1 - 12 * (1 - 2 * r) * (r * r - pi / 4 * r * r) - 8 * (r * r * r - pi / 6 * r * r * r);
  EXPECT_NEAR(error(r, "volume_error"), 1 / volume - 1, 1e-14);
  const double area =
      6 * (1 - 2 * r) * (1 - 2 * r) + 12 * (1 - 2 * r) * (pi / 2 * r) + 8 * (pi / 2 * r * r);
  EXPECT_NEAR(error(r, "area_error"), 6 / area - 1, 1e-14);
}

// The volume is that of the inside of the field: of 200,000 places drawn in a box around the solid
// a share p = V / V_box falls inside, +- 5 sqrt(p (1 - p) / n).
TEST(SizeError, VolumesAreThoseOfTheFields) {
  const std::vector<PlacedShape> solids = {{Pose::Identity(), SphereShape{0.8}},
                                           {Pose::Identity(), CylinderShape{0.5, 1.2}},
                                           {Pose::Identity(), BoxShape{{1, 0.8, 1.4}, 0.2}},
                                           {Pose::Identity(), TorusShape{0.6, 0.25}}};
  for (const PlacedShape& solid : solids) {
    constexpr std::size_t n = 200'000;
    const Bounds box = bounds_of(solid);
    std::size_t inside = 0;
    for (std::uint64_t i = 0; i < n; ++i) {
      RandomStream random(1, 0, i);
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      inside +=
          field(solid, box.min() + box.sizes().cwiseProduct(Eigen::Vector3d(x, y, z))).value_m < 0;
    }
    const double p = static_cast<double>(inside) / n, spread = 5 * std::sqrt(p * (1 - p) / n);
    const double true_volume = 1 / (1 + figure(size_error(cube(1), {{solid}, {}}), "volume_error"));
    EXPECT_NEAR(true_volume / box.volume(), p, spread);
  }
}

PlacedShape at(double x, double y, double z, Shape shape) {
  return {make_pose(Eigen::Matrix3d::Identity(), {x, y, z}), std::move(shape)};
}

CombinedShape combined(CombinedShape::Operation operation, std::vector<PlacedShape> parts) {
  return {operation, 0, std::move(parts)};
}

// Closed forms: two balls as far apart as their radius r share two caps of height h = r / 2, each
// of the area 2 pi r h and the volume pi h^2 (r - h / 3); a cube less a bore of radius r has two
// discs less and a wall of height 1 more. The intervals hold 95 %, so that of each six one may miss
// with a chance of a quarter: three half-widths from the middle are 1 in 50 of Student's t with 7.
// They are narrow enough to tell a surface's error: 1e-3.
TEST(SizeError, OfCombinationsIsThatOfTheirClosedForms) {
  using enum CombinedShape::Operation;
  const double pi = std::numbers::pi, r = 0.3, h = r / 2;
  const double cap_area = 2 * pi * r * h, cap = pi * h * h * (r - h / 3);
  const Shape ball = SphereShape{r};
  const std::vector<PlacedShape> balls = {at(0, 0, 0, ball), at(0, 0, r, ball)};
  struct Case {
    Shape shape;
    double area_m2, volume_m3;
  };
  const std::vector<Case> cases = {
      {combined(unite, balls), 2 * (4 * pi * r * r - cap_area), 2 * (4 * pi / 3 * r * r * r - cap)},
      {combined(intersect, balls), 2 * cap_area, 2 * cap},
      {combined(subtract, {at(0, 0, 0, BoxShape{Eigen::Vector3d::Ones(), 0}),
                           at(0, 0, 0, CylinderShape{r, 2})}),
       6 - 2 * pi * r * r + 2 * pi * r, 1 - pi * r * r}};
  const Mesh one = cube(1);
  for (const Case& c : cases) {
    const auto errors = size_error(one, {{at(0.4, -2, 7, c.shape)}, {}});
    ASSERT_EQ(errors.size(), 2u);
    for (const auto& [m, is] :
         {std::pair(errors[0], 6 / c.area_m2), {errors[1], 1 / c.volume_m3}}) {
      const double width = m.interval->high - m.interval->low;
      EXPECT_NEAR(m.value, is - 1, 1.5 * width) << m.name;
      EXPECT_LT(width, 1e-3 * is) << m.name;
      EXPECT_GT(width, 0) << m.name;
    }
  }
}

TEST(SizeError, LeavesOutWhatIsNotDefined) {
  Mesh open = cube(1);
  open.triangles.pop_back();
  EXPECT_EQ(size_error(open, {{}, {cube(1)}}).size(), 1u);
  EXPECT_EQ(size_error(cube(1), {{}, {open}}).size(), 1u);
  EXPECT_TRUE(size_error(cube(1), {{}, {open, open}}).empty());
  EXPECT_TRUE(size_error(cube(1), {{{Pose::Identity(), PlaneShape{}}}, {}}).empty());
  const Shape endless = combined(CombinedShape::Operation::unite, {at(0, 0, 0, PlaneShape{})});
  EXPECT_TRUE(size_error(cube(1), {{at(0, 0, 0, endless)}, {}}).empty());
  Mesh touching = cube(1);  // two cubes that share the corner at the origin: closed, no manifold
  for (const Triangle& t : cube(1).triangles) {
    const auto other = [](std::uint32_t v) { return v == 0 ? 0 : v + 7; };
    touching.triangles.push_back({other(t[0]), other(t[2]), other(t[1])});
  }
  ASSERT_TRUE(cube(1).vertices[0].isZero());
  for (std::size_t v = 1; v < 8; ++v) touching.vertices.push_back(-cube(1).vertices[v]);
  EXPECT_EQ(size_error(touching, {{}, {cube(1)}}).size(), 1u);
}

}  // namespace
}  // namespace scan
