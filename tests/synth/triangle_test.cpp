// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// On a grid of 2^-18, where a long double of 64 bits holds all triple products without rounding.
#include "synth/triangle.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "synth/solid.h"
#include "tests/synth/ray_scenes.h"

namespace scan::synth {
namespace {

using Exact = Eigen::Matrix<long double, 3, 1>;

Eigen::Vector3d to_grid(const Eigen::Vector3d& x) {
  return (x * 0x1p18).array().round() * 0x1p-18;
}

Eigen::Vector3d in_cube(RandomStream& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return {x - 0.5, y - 0.5, z - 0.5};
}

struct Shot {
  Eigen::Vector3d a, b, c, origin, direction;  // the direction is not unit: distances are in its
};

// Triangles down to one grid step wide, needles and caps; rays at their insides, edges and corners.
Shot draw(std::uint64_t i) {
  RandomStream random(31, 0, i);
  Shot s;
  s.a = to_grid(0.4 * in_cube(random));
  const Eigen::Vector3d along = 0.4 * in_cube(random);
  s.b = to_grid(s.a + along);
  const double share = random.uniform() < 0.3 ? 0 : random.uniform();
  const double width = std::pow(10, -6 * random.uniform());
  s.c = to_grid(s.a + share * along + width * in_cube(random));
  const double v = i % 3 == 0 ? 0 : random.uniform();
  const double w = i % 3 < 2 ? 0 : random.uniform() * (1 - v);
  const Eigen::Vector3d target = to_grid(s.a + v * (s.b - s.a) + w * (s.c - s.a));
  const Eigen::Vector3d flat = (random.uniform() - 0.5) * (s.b - s.a) + 0.3 * (s.c - s.a);
  const double tilt = i % 2 ? 1 : std::pow(10, -5 * random.uniform());
  s.direction = to_grid(flat + tilt * in_cube(random));
  s.origin = target - s.direction;
  return s;
}

// Edge functions along the ray without rounding, and the distance as a quotient of exact numbers.
struct Truth {
  std::array<long double, 3> edge;   // positive inside, all together negative from behind
  std::array<long double, 3> reach;  // of the line from the edge, m: |edge function| over this
  long double area_along = 0;
  long double distance = 0;
  double cosine = 0;
};

Truth truth_of(const Shot& s) {
  const Exact o = s.origin.cast<long double>(), d = s.direction.cast<long double>();
  const Exact p[3] = {s.a.cast<long double>() - o, s.b.cast<long double>() - o,
                      s.c.cast<long double>() - o};
  Truth truth;
  for (int i = 0; i < 3; ++i) {
    const Exact &q = p[(i + 1) % 3], &r = p[(i + 2) % 3];
    truth.edge[i] = d.dot(q.cross(r));
    truth.reach[i] = (r - q).cross(d).norm();
  }
  const Exact n = (p[1] - p[0]).cross(p[2] - p[0]);
  truth.area_along = n.dot(d);
  truth.distance = n.dot(p[0]) / truth.area_along;
  truth.cosine = static_cast<double>(std::abs(truth.area_along) / (n.norm() * d.norm()));
  return truth;
}

double size_of(const Shot& s) {
  return std::max({(s.b - s.a).norm(), (s.c - s.a).norm(), (s.c - s.b).norm()});
}

TEST(LineDistance, IsWithinItsBoundHoweverThinTheTriangle) {
  int thin = 0, grazing = 0, hits = 0;
  for (std::uint64_t i = 0; i < 300000; ++i) {
    const Shot s = draw(i);
    const Truth truth = truth_of(s);
    if (truth.area_along == 0 || s.direction.norm() < 1e-3) continue;
    ShearedRay ray;
    shear(s.origin, s.direction, ray);
    const auto distance = line_distance(ray, s.a, s.b, s.c);
    if (!distance) continue;
    ++hits;
    const double width = (s.b - s.a).cross(s.c - s.a).norm() / size_of(s);
    thin += width < 1e-4 * size_of(s);
    grazing += truth.cosine < 1e-3;
    const double length_m = s.direction.norm();
    // The bound that a hit carries (Hit::error_m): 64 roundings of distance and size.
    const double bound_m =
        rounding_m(static_cast<double>(std::abs(truth.distance)) * length_m, size_of(s)) /
        truth.cosine;
    ASSERT_LE(std::abs(*distance - truth.distance) * length_m, bound_m)
        << i << " width " << width << " cosine " << truth.cosine;
  }
  EXPECT_GT(hits, 100000);
  EXPECT_GT(thin, 10000);
  EXPECT_GT(grazing, 10000);
}

// Inside by more than the rounding is a hit, outside by more is none.
TEST(LineDistance, HitsWhatTheLineCrosses) {
  int inside = 0, outside = 0;
  for (std::uint64_t i = 0; i < 300000; ++i) {
    Shot s = draw(i);
    if (s.direction.norm() < 1e-3) continue;
    RandomStream random(32, 0, i);
    if (i % 4 == 3) s.origin = to_grid(s.origin + 1e-4 * in_cube(random));
    const Truth truth = truth_of(s);
    // Corners in the ray's frame are off by less than 16 roundings of their distance.
    const double off_m =
        16 * std::numeric_limits<double>::epsilon() * (s.direction.norm() + size_of(s) + 1e-4);
    bool surely_in = truth.area_along != 0, surely_out = false;
    for (int k = 0; k < 3; ++k) {
      const long double room = truth.edge[k] * (truth.area_along < 0 ? -1 : 1);
      surely_in &= room > off_m * truth.reach[k];
      surely_out |= truth.area_along != 0 && room < -off_m * truth.reach[k];
    }
    ShearedRay ray;
    shear(s.origin, s.direction, ray);
    const bool hit = line_distance(ray, s.a, s.b, s.c).has_value();
    inside += surely_in;
    outside += surely_out;
    ASSERT_TRUE(hit || !surely_in) << i;
    ASSERT_FALSE(hit && surely_out) << i;
  }
  EXPECT_GT(inside, 50000);
  EXPECT_GT(outside, 50000);
}

}  // namespace
}  // namespace scan::synth
