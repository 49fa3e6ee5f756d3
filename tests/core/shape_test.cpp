// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Truths of distance fields. A value is the exact distance if the field is 1-Lipschitz (so no
// surface is nearer) and the point at that distance against the gradient lies on the surface.
#include "libscan/core/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/random.h"

namespace scan {
namespace {

using Operation = CombinedShape::Operation;

Pose pose_of(double rx, double ry, double rz, double x, double y, double z) {
  Vector6 twist;
  twist << rx, ry, rz, 0, 0, 0;
  return make_pose(exp(twist).linear(), {x, y, z});
}

PlacedShape at(double x, double y, double z, Shape shape) {
  return {pose_of(0, 0, 0, x, y, z), std::move(shape)};
}

struct Case {
  std::string name;
  Shape shape;
  std::function<bool(const Eigen::Vector3d&)> inside;  // written without any distance
};

bool in_box(const Eigen::Vector3d& x, const Eigen::Vector3d& size) {
  return (x.cwiseAbs().array() < size.array() / 2).all();
}

std::vector<Case> simple_cases() {
  return {
      {"plane", PlaneShape{}, [](const auto& x) { return x.z() < 0; }},
      {"sphere", SphereShape{0.7}, [](const auto& x) { return x.squaredNorm() < 0.49; }},
      {"cylinder", CylinderShape{0.4, 1.2},
       [](const auto& x) {
         return x.x() * x.x() + x.y() * x.y() < 0.16 && std::abs(x.z()) < 0.6;
       }},
      {"box", BoxShape{{1, 0.8, 0.6}, 0}, [](const auto& x) { return in_box(x, {1, 0.8, 0.6}); }},
      {"rounded box", BoxShape{{1, 0.8, 0.6}, 0.1},
       [](const auto& x) {
         const Eigen::Vector3d core = x.cwiseMax(Eigen::Vector3d(-0.4, -0.3, -0.2))
                                          .cwiseMin(Eigen::Vector3d(0.4, 0.3, 0.2));
         return (x - core).squaredNorm() < 0.01;
       }},
      {"torus", TorusShape{0.6, 0.2},
       [](const auto& x) {  // the quartic
         const double k = x.squaredNorm() + 0.36 - 0.04;
         return k * k < 4 * 0.36 * (x.x() * x.x() + x.y() * x.y());
       }},
  };
}

std::vector<Case> combined_cases() {
  const auto combine = [](Operation operation, double blend, std::vector<PlacedShape> parts) {
    return CombinedShape{operation, blend, std::move(parts)};
  };
  const auto in_sphere = [](const Eigen::Vector3d& x, double cx, double r) {
    return (x - Eigen::Vector3d(cx, 0, 0)).norm() < r;
  };
  const PlacedShape tilted{pose_of(0.7, 0.2, 0, 0, 0, 0), BoxShape{{2, 2, 0.5}, 0}};
  const Pose from_tilted = tilted.parent_from_shape.inverse();
  return {
      {"two spheres",
       combine(Operation::unite, 0,
               {at(-0.3, 0, 0, SphereShape{0.5}), at(0.3, 0, 0, SphereShape{0.4})}),
       [=](const auto& x) { return in_sphere(x, -0.3, 0.5) || in_sphere(x, 0.3, 0.4); }},
      {"lens",
       combine(Operation::intersect, 0,
               {at(-0.3, 0, 0, SphereShape{0.5}), at(0.3, 0, 0, SphereShape{0.6})}),
       [=](const auto& x) { return in_sphere(x, -0.3, 0.5) && in_sphere(x, 0.3, 0.6); }},
      {"drilled box",
       combine(Operation::subtract, 0,
               {at(0, 0, 0, BoxShape{{1, 0.8, 0.6}, 0}), at(0.1, 0, 0, CylinderShape{0.2, 2})}),
       [](const auto& x) {
         return in_box(x, {1, 0.8, 0.6}) && !(std::hypot(x.x() - 0.1, x.y()) < 0.2);
       }},
      {"acute wedge",
       combine(Operation::intersect, 0, {at(0, 0, 0, BoxShape{{1.2, 1.2, 0.5}, 0}), tilted}),
       [=](const auto& x) {
         return in_box(x, {1.2, 1.2, 0.5}) && in_box(from_tilted * x, {2, 2, 0.5});
       }},
  };
}

// Blends have no closed form of their inside other than the field itself.
Shape filleted() {
  return CombinedShape{Operation::unite, 0.1,
                       {at(0, 0, 0, BoxShape{{1, 0.8, 0.3}, 0}),
                        at(0, 0, 0.2, CylinderShape{0.2, 0.6})}};
}

std::vector<Case> all_cases() {
  std::vector<Case> cases = simple_cases();
  for (Case& c : combined_cases()) cases.push_back(std::move(c));
  return cases;
}

Eigen::Vector3d point_in_cube(RandomStream& random, double half) {
  return half * Eigen::Vector3d(2 * random.uniform() - 1, 2 * random.uniform() - 1,
                                2 * random.uniform() - 1);
}

TEST(Shape, CasesCoverTheVariant) {
  std::vector<bool> covered(std::variant_size_v<Shape>, false);
  for (const Case& c : all_cases()) covered[c.shape.index()] = true;
  for (std::size_t i = 0; i < covered.size(); ++i)
    EXPECT_TRUE(covered[i]) << "no case for alternative " << i;
}

TEST(Field, IsNegativeExactlyInside) {
  for (const Case& c : all_cases())
    for (std::uint64_t i = 0; i < 5000; ++i) {
      RandomStream random(1, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1.2);
      ASSERT_EQ(field(c.shape, x).value_m < 0, c.inside(x)) << c.name << " " << x.transpose();
    }
}

// Rounding of coordinates of size 1: some 1e-16.
TEST(Field, IsLipschitz) {
  std::vector<Case> cases = all_cases();
  cases.push_back({"filleted", filleted(), {}});
  for (const Case& c : cases)
    for (std::uint64_t i = 0; i < 5000; ++i) {
      RandomStream random(2, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1.2);
      const double reach = std::pow(10, -4 * random.uniform());
      const Eigen::Vector3d y = x + point_in_cube(random, reach);
      const double change = std::abs(field(c.shape, x).value_m - field(c.shape, y).value_m);
      ASSERT_LE(change, (x - y).norm() + 1e-15) << c.name;
      ASSERT_LE(field(c.shape, x).gradient.norm(), 1 + 1e-15) << c.name;
    }
}

TEST(Field, OfASimpleShapeIsTheExactDistance) {
  for (const Case& c : simple_cases())
    for (std::uint64_t i = 0; i < 5000; ++i) {
      RandomStream random(3, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1.5);
      const DistanceField f = field(c.shape, x);
      ASSERT_NEAR(f.gradient.norm(), 1, 1e-15) << c.name;
      ASSERT_NEAR(field(c.shape, x - f.value_m * f.gradient).value_m, 0, 1e-15) << c.name;
    }
}

// Central differences with h = 1e-6 err by rounding, 2e-16 / 1e-6 = 2e-10, and by curvature; a
// point whose neighbours lie on both sides of a ridge of the field has no derivative, and at most
// a fraction of about h / size of all points has: so one in a thousand may fail.
TEST(Field, GradientIsTheDerivative) {
  std::vector<Case> cases = all_cases();
  cases.push_back({"filleted", filleted(), {}});
  for (const Case& c : cases) {
    int wrong = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      RandomStream random(4, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1.2);
      Eigen::Vector3d slope;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d h = 1e-6 * Eigen::Vector3d::Unit(k);
        slope(k) = (field(c.shape, x + h).value_m - field(c.shape, x - h).value_m) / 2e-6;
      }
      wrong += (slope - field(c.shape, x).gradient).norm() > 1e-8;
    }
    EXPECT_LE(wrong, 2) << c.name;
  }
}

TEST(Field, KeepsItsValueUnderMotion) {
  const Pose world_from_shape = pose_of(1, -2, 0.5, 3, 4, 5);
  for (const Case& c : all_cases()) {
    RandomStream random(5, 0, 0);
    const Eigen::Vector3d x = point_in_cube(random, 1);
    const DistanceField local = field(c.shape, x);
    const DistanceField world = field(PlacedShape{world_from_shape, c.shape}, world_from_shape * x);
    EXPECT_NEAR(world.value_m, local.value_m, 1e-14) << c.name;
    EXPECT_LT((world.gradient - world_from_shape.linear() * local.gradient).norm(), 1e-14) << c.name;
  }
}

// Points of the zero set found by marching along random lines: dense, not tied to closest_point.
std::vector<Eigen::Vector3d> surface_points(const Shape& shape, std::uint64_t lines) {
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < lines; ++i) {
    RandomStream random(6, 0, i);
    const Eigen::Vector3d from = point_in_cube(random, 1.2), to = point_in_cube(random, 1.2);
    double last = field(shape, from).value_m;
    for (int step = 1; step <= 60; ++step) {
      double low = (step - 1) / 60.0, high = step / 60.0;
      const double value = field(shape, from + high * (to - from)).value_m;
      if ((value > 0) != (last > 0)) {
        for (int k = 0; k < 50; ++k) {
          const double middle = (low + high) / 2;
          const bool same = (field(shape, from + middle * (to - from)).value_m > 0) == (last > 0);
          (same ? low : high) = middle;
        }
        points.push_back(from + low * (to - from));
      }
      last = value;
    }
  }
  return points;
}

// The closest point lies on the surface, and none of many other surface points is nearer.
void expect_closest(const std::string& name, const Shape& shape, double reach_m) {
  const PlacedShape placed{Pose::Identity(), shape};
  const auto brute = surface_points(shape, 4000);
  ASSERT_GT(brute.size(), 500u) << name;
  int farther = 0, tried = 0;
  double worst = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    RandomStream random(7, 0, i);
    const Eigen::Vector3d x = point_in_cube(random, 1);
    if (std::abs(field(shape, x).value_m) > reach_m) continue;
    ++tried;
    const Eigen::Vector3d p = closest_point(placed, x);
    EXPECT_LT(std::abs(field(shape, p).value_m), 1e-12) << name;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& q : brute) nearest = std::min(nearest, (q - x).norm());
    const double excess = (p - x).norm() - nearest;
    farther += excess > 1e-9;
    worst = std::max(worst, excess);
  }
  EXPECT_GT(tried, 50) << name;
  EXPECT_EQ(farther, 0) << name << " of " << tried << ", worst by " << worst << " m";
}

TEST(ClosestPoint, IsAsNearAsAnySurfacePoint) {
  for (const Case& c : all_cases())
    expect_closest(c.name, c.shape, 0.1);
  expect_closest("filleted", filleted(), 0.1);
}

// Two unit spheres whose seam is the circle x = 0 of radius 0.8. On the axis through both centres
// every gradient is parallel; the nearest surface of the union is the seam (or, beyond the centres,
// the far side of a sphere).
TEST(ClosestPoint, OfAUnionIsNotBuriedOnItsAxis) {
  const PlacedShape both{Pose::Identity(),
                         CombinedShape{Operation::unite, 0, {at(-0.6, 0, 0, SphereShape{1}),
                                                             at(0.6, 0, 0, SphereShape{1})}}};
  for (const double x : {-0.4, -0.1, 0.0, 0.3, 0.4})
    EXPECT_NEAR((closest_point(both, {x, 0, 0}) - Eigen::Vector3d(x, 0, 0)).norm(),
                std::min(std::hypot(x, 0.8), 1.6 - std::abs(x)), 1e-9)
        << x;
}

// Two half-spaces meet in an edge; the foot is on a face or on the edge.
TEST(ClosestPoint, FindsTheEdgeOfAWedge) {
  for (const double half_angle : {0.2, 0.5, 1.0, 1.4}) {
    // the solid |x| < z tan(half_angle), edge along y, opening towards +z
    const auto half_space = [&](double side) {
      return PlacedShape{pose_of(0, side * (std::numbers::pi / 2 + half_angle), 0, 0, 0, 0),
                         PlaneShape{}};
    };
    const PlacedShape wedge{Pose::Identity(),
                            CombinedShape{Operation::intersect, 0, {half_space(1), half_space(-1)}}};
    for (std::uint64_t i = 0; i < 300; ++i) {
      RandomStream random(8, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1);
      // nearest on the face of the same side, whose direction from the edge is (sin, cos)
      const double along = std::max(
          0.0, std::abs(x.x()) * std::sin(half_angle) + x.z() * std::cos(half_angle));
      const double expected =
          std::hypot(std::abs(x.x()) - along * std::sin(half_angle), x.z() - along * std::cos(half_angle));
      const double found = (closest_point(wedge, x) - x).norm();
      EXPECT_NEAR(found, expected, 1e-9 * expected + 1e-15) << half_angle << " " << x.transpose();
    }
  }
}

TEST(Bounds, HoldEverySurfacePoint) {
  std::vector<Case> cases = all_cases();
  cases.push_back({"filleted", filleted(), {}});
  const Pose world_from_shape = pose_of(0.4, 0.8, -1, 1, 2, 3);
  for (const Case& c : cases) {
    if (std::holds_alternative<PlaneShape>(c.shape)) continue;
    Bounds box = bounds_of(PlacedShape{world_from_shape, c.shape});
    box = Bounds(box.min() - Eigen::Vector3d::Constant(1e-12),
                 box.max() + Eigen::Vector3d::Constant(1e-12));
    for (const auto& point : surface_points(c.shape, 500))
      EXPECT_TRUE(box.contains(world_from_shape * point)) << c.name;
  }
  EXPECT_FALSE(bounds_of(PlacedShape{Pose::Identity(), PlaneShape{}}).sizes().allFinite());
}

TEST(Check, NamesShapeAndField) {
  for (const Case& c : all_cases()) EXPECT_NO_THROW(check(c.shape)) << c.name;
  const std::vector<std::pair<Shape, std::string>> broken = {
      {SphereShape{0}, "radius"},
      {SphereShape{std::nan("")}, "radius"},
      {CylinderShape{1, -1}, "height"},
      {BoxShape{{1, 1, 0}, 0}, "size"},
      {BoxShape{{1, 1, 1}, 0.6}, "rounding"},
      {TorusShape{1, 0}, "minor radius"},
      {TorusShape{1, 1.5}, "minor radius"},
      {CombinedShape{}, "no parts"},
      {CombinedShape{Operation::unite, -1, {at(0, 0, 0, SphereShape{1})}}, "blend"},
      {CombinedShape{Operation::unite, 0, {at(0, 0, 0, SphereShape{-1})}}, "radius"}};
  for (const auto& [shape, word] : broken) try {
      check(shape);
      FAIL() << word;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace scan
