// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/shape_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "libscan/core/random.h"

namespace scan::synth {
namespace {

Eigen::Vector3d random_vector(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

// From a point three units away towards a point near the unit shape.
Ray random_ray(RandomStream& random) {
  const Eigen::Vector3d origin = 3 * random_vector(random).normalized();
  return {origin, (0.6 * random_vector(random) - origin).normalized()};
}

TEST(RayOnSphere, MeetsItWhereTheQuadraticSays) {
  const double radius = 0.7;
  int hits = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    RandomStream random(1, 0, i);
    const Ray ray = random_ray(random);
    const auto hit = intersect(SphereShape{radius}, ray);
    // in long double the textbook formula loses no digit that matters here
    const Eigen::Matrix<long double, 3, 1> o = ray.origin.cast<long double>();
    const Eigen::Matrix<long double, 3, 1> d = ray.direction.cast<long double>();
    const long double a = d.dot(d), b = o.dot(d), c = o.dot(o) - 0.7L * 0.7L;
    const long double discriminant = b * b - a * c;
    if (std::abs(discriminant) < 1e-12L) continue;  // tangent to rounding: either answer is right
    ASSERT_EQ(hit.has_value(), discriminant > 0);
    if (!hit) continue;
    ++hits;
    const auto exact = static_cast<double>((-b - std::sqrt(discriminant)) / a);
    // radius and ray are rounded: d t = r d r / (half chord), half chord > 1e-6
    EXPECT_NEAR(hit->distance_m, exact, 4e-16 * (4 + 4 / std::sqrt(double(discriminant))));
    EXPECT_NEAR((hit->normal - (ray.origin + exact * ray.direction) / radius).norm(), 0, 1e-9);
  }
  EXPECT_GT(hits, 5000);
}

TEST(RayOnSphere, KeepsItsAccuracyForASmallSphereFarAway) {
  const double radius = 1e-3;
  const Ray ray{{0.25 * radius, 0, -1e4}, {0, 0, 1}};
  const auto hit = intersect(SphereShape{radius}, ray);
  ASSERT_TRUE(hit);
  // one rounding of a distance of 1e4 m is 1.8e-12 m
  EXPECT_NEAR(hit->distance_m, 1e4 - radius * std::sqrt(1 - 0.0625), 4e-12);
}

TEST(RayOnSphere, KeepsItsAccuracyJustAboveALargeSphere) {
  const double radius = 1e6;
  const Ray ray{{0, 0, radius + 1}, {std::sin(0.5), 0, -std::cos(0.5)}};
  const auto hit = intersect(SphereShape{radius}, ray);
  ASSERT_TRUE(hit);
  const long double d = std::cos(0.5), b = (1e6L + 1) * d, c = 2e6L + 1;  // t^2 - 2 b t + c = 0
  const long double exact = c / (b + std::sqrt(b * b - c));
  EXPECT_NEAR(hit->distance_m, static_cast<double>(exact), 1e-15);  // four roundings
}

TEST(RayOnPlane, IsExactAtGrazingIncidence) {
  for (const double degrees : {0.0, 60.0, 89.9, 89.99, 89.999}) {
    const double angle = degrees * M_PI / 180;
    const Ray ray{{0, 0, 2}, {std::sin(angle), 0, -std::cos(angle)}};
    const auto hit = intersect(PlaneShape{}, ray);
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit->distance_m, 2 / std::cos(angle));
    EXPECT_EQ(hit->normal, Eigen::Vector3d::UnitZ());
  }
  EXPECT_FALSE(intersect(PlaneShape{}, Ray{{0, 0, 2}, {1, 0, 0}}));
  EXPECT_FALSE(intersect(PlaneShape{}, Ray{{0, 0, 2}, {0, 0, 1}}));
  EXPECT_FALSE(intersect(PlaneShape{}, Ray{{0, 0, 0}, {1, 0, 0}}));
}

TEST(RayOnBox, MeetsTheFacesAtKnownPlaces) {
  const BoxShape box{{2, 4, 6}};
  const auto from_x = intersect(box, Ray{{-5, 1, 1}, {1, 0, 0}});
  ASSERT_TRUE(from_x);
  EXPECT_EQ(from_x->distance_m, 4);
  EXPECT_EQ(from_x->normal, Eigen::Vector3d(-1, 0, 0));
  const auto from_inside = intersect(box, Ray{{0, 0, 0}, {0, -1, 0}});
  ASSERT_TRUE(from_inside);
  EXPECT_EQ(from_inside->distance_m, 2);
  EXPECT_EQ(from_inside->normal, Eigen::Vector3d(0, -1, 0));
  EXPECT_FALSE(intersect(box, Ray{{-5, 2.001, 0}, {1, 0, 0}}));
}

TEST(RayOnCylinder, MeetsWallAndEndsAtKnownPlaces) {
  const CylinderShape cylinder{2, 6};
  const auto wall = intersect(cylinder, Ray{{-5, 0, 1}, {1, 0, 0}});
  ASSERT_TRUE(wall);
  EXPECT_EQ(wall->distance_m, 3);
  EXPECT_EQ(wall->normal, Eigen::Vector3d(-1, 0, 0));
  const auto end = intersect(cylinder, Ray{{1, 1, 9}, {0, 0, -1}});
  ASSERT_TRUE(end);
  EXPECT_EQ(end->distance_m, 6);
  EXPECT_EQ(end->normal, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(intersect(cylinder, Ray{{1.5, 1.5, 9}, {0, 0, -1}}));
  const double r = std::sqrt(0.5);
  const auto slanted = intersect(cylinder, Ray{{-4, 0, 4}, {r, 0, -r}});
  ASSERT_TRUE(slanted);  // the wall x = -2 at z = 2
  EXPECT_NEAR(slanted->distance_m, 2 / r, 1e-15);
}

// Two independent ways, one shape: the closed forms and the march along the distance field.
void expect_closed_form_equals_march(const Shape& shape) {
  const Bounds bounds = bounds_of(PlacedShape{Pose::Identity(), shape});
  int hits = 0, undecided = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    RandomStream random(2, 0, i);
    const Ray ray = random_ray(random);
    const auto closed = intersect(shape, ray);
    const auto marched = trace_field(shape, bounds, ray);
    undecided += closed.has_value() != marched.has_value();
    if (!closed || !marched) continue;
    ++hits;
    const double incidence = std::abs(closed->normal.dot(ray.direction));
    // both place the point within a few roundings (1e-15) of the surface
    ASSERT_NEAR(closed->distance_m, marched->distance_m, 1e-14 / std::max(incidence, 1e-6));
  }
  EXPECT_GT(hits, 5000);
  EXPECT_EQ(undecided, 0);
}

TEST(RayOnSphere, MeetsItWhereTheFieldChangesSign) {
  expect_closed_form_equals_march(SphereShape{0.7});
}
TEST(RayOnBox, MeetsItWhereTheFieldChangesSign) {
  expect_closed_form_equals_march(BoxShape{{0.9, 1.1, 0.4}});
}
TEST(RayOnCylinder, MeetsItWhereTheFieldChangesSign) {
  expect_closed_form_equals_march(CylinderShape{0.5, 1.2});
}

// The torus as the quartic (|x|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2), negative inside.
long double torus_quartic(const Ray& ray, long double t) {
  const Eigen::Matrix<long double, 3, 1> x =
      ray.origin.cast<long double>() + t * ray.direction.cast<long double>();
  const long double R = 0.8L, r = 0.25L, s = x.dot(x) + R * R - r * r;
  return s * s - 4 * R * R * (x.x() * x.x() + x.y() * x.y());
}

// Its first root by a walk in steps of 1e-3 and bisection; none if it has none longer than a step.
std::optional<double> first_root(const Ray& ray) {
  for (long double t = 1.5L; t < 6; t += 1e-3L)
    if (torus_quartic(ray, t) < 0) {
      long double outside = t - 1e-3L, inside = t;
      for (int i = 0; i < 80; ++i) {
        const long double half = (outside + inside) / 2;
        (torus_quartic(ray, half) < 0 ? inside : outside) = half;
      }
      return static_cast<double>(inside);
    }
  return std::nullopt;
}

TEST(RayOnTorus, MeetsItAtTheQuarticsFirstRoot) {
  const TorusShape torus{0.8, 0.25};
  int hits = 0, brief = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    RandomStream random(3, 0, i);
    const Ray ray = random_ray(random);
    const auto hit = intersect(torus, ray);
    const auto root = first_root(ray);
    if (!root || !hit) {
      ASSERT_FALSE(root && !hit) << "ray " << i;
      brief += hit && !root;  // a chord shorter than the walk's step
      continue;
    }
    if (hit->distance_m < *root - 1e-3) {  // a brief chord before the long one
      ++brief;
      continue;
    }
    ++hits;
    const double incidence = std::abs(hit->normal.dot(ray.direction));
    ASSERT_NEAR(hit->distance_m, *root, 2e-15 / std::max(incidence, 1e-6)) << "ray " << i;
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(brief, 10);  // about 1e-3 of the rays graze so closely
}

TEST(RayOnTorus, PassesThroughItsHole) {
  EXPECT_FALSE(intersect(TorusShape{0.8, 0.25}, Ray{{0.1, 0.2, 5}, {0, 0, -1}}));
}

TEST(TracedRay, FindsGrazingChordsOfABoxBothWays) {
  // a ray that cuts the edge of a box at 45 degrees in a chord of 2e-6: a march must not step over
  // it
  const double depth = 1e-6, r = std::sqrt(0.5);
  const BoxShape box{{2, 2, 2}};
  const Eigen::Vector3d corner(1, 0, 1), inward = Eigen::Vector3d(-1, 0, -1) * r;
  const Eigen::Vector3d direction(r, 0, -r);
  const Ray ray{corner + depth * inward - 3 * direction, direction};
  const auto hit = trace_field(box, Bounds(-box.size_m / 2, box.size_m / 2), ray);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 3 - depth, 1e-14);
  const Ray beside{corner - depth * inward - 3 * direction, direction};
  EXPECT_FALSE(trace_field(box, Bounds(-box.size_m / 2, box.size_m / 2), beside));
}

TEST(TracedRay, EndsSoonAlongAFlatFace) {
  // one part's face is a plane of the ray: the worst case of sphere tracing must still end
  const Shape slab = CombinedShape{
      CombinedShape::Operation::unite, 0, {PlacedShape{Pose::Identity(), BoxShape{{2, 2, 2}}}}};
  for (const double above : {0.0, 1e-15, 1e-12, 1e-6})
    EXPECT_FALSE(intersect(slab, Ray{{-5, 0, 1 + above}, {1, 0, 0}}) && above > 1e-14);
}

TEST(RayFromASurface, DoesNotHitItAtZero) {
  RandomStream random(4, 0, 0);
  const std::vector<Shape> shapes = {SphereShape{0.7}, CylinderShape{0.5, 1.2},
                                     BoxShape{{0.9, 1.1, 0.4}}, TorusShape{0.8, 0.25}};
  for (const Shape& shape : shapes)
    for (int i = 0; i < 2000; ++i) {
      const Ray ray = random_ray(random);
      const auto hit = intersect(shape, ray);
      if (!hit || std::abs(hit->normal.dot(ray.direction)) < 0.1) continue;
      const Eigen::Vector3d point = ray.origin + hit->distance_m * ray.direction;
      const auto back = intersect(shape, Ray{point, -ray.direction});
      EXPECT_FALSE(back) << "leaving";
      const auto through = intersect(shape, Ray{point, ray.direction});
      ASSERT_TRUE(through) << "entering: it must leave the solid again";
      EXPECT_GT(through->distance_m, 1e-9);
    }
}

TEST(RayInsideAShape, HitsItFromInsideWithTheOutwardNormal) {
  for (const Shape& shape : std::vector<Shape>{SphereShape{1}, CylinderShape{1, 2},
                                               BoxShape{{2, 2, 2}}, BoxShape{{2, 2, 2}, 0.1}}) {
    const auto hit = intersect(shape, Ray{{0, 0, 0}, {0, 0, 1}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance_m, 1, 1e-15);
    EXPECT_NEAR((hit->normal - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-15);
  }
}

TEST(PlacedRay, EqualsTheRayInTheShapesFrame) {
  RandomStream random(5, 0, 0);
  const Pose pose = exp((Vector6() << 0.3, -0.5, 0.9, 0.1, 0.2, -0.3).finished());
  for (int i = 0; i < 1000; ++i) {
    const Ray local = random_ray(random);
    const Ray moved{pose * local.origin, pose.linear() * local.direction};
    const auto a = intersect(TorusShape{0.8, 0.25}, local);
    const auto b = intersect(PlacedShape{pose, TorusShape{0.8, 0.25}}, moved);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a && std::abs(a->normal.dot(local.direction)) > 0.01) {
      EXPECT_NEAR(a->distance_m, b->distance_m, 1e-12);
    }
  }
}

}  // namespace
}  // namespace scan::synth
