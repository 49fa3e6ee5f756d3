// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tests/synth/laser_bench.h"

namespace scan::synth {
namespace {

std::vector<RayTruth> truth_of(const LaserLine& s, const Scene& scene) {
  return true_rays(s, RayCaster(scene), Pose::Identity());
}

TEST(LaserTruth, LiesOnSurfaceLightPlaneAndRow) {
  LaserLine s = small_laser();
  s.camera.k1 = -0.2;
  s.camera.p1 = 0.01;
  s.steps = 9;
  s.step_m = 5e-3;
  const Eigen::Vector3d centre(0, 0, 0.18);
  const double radius = 0.03;
  const auto rays = truth_of(s, white_scene({sphere_at(centre, radius)}));
  const auto poses = scanner_from_camera(s);
  const LaserSheet sheet = laser_sheet(s);
  int hits = 0;
  for (int step = 0; step < s.steps; ++step)
    for (int row = 0; row < 120; ++row) {
      const RayTruth& ray = rays[step * 120 + row];
      if (ray.object < 0) continue;
      ++hits;
      const Eigen::Vector3d x = poses[step].inverse() * ray.point_in_scanner;
      EXPECT_NEAR(sheet.normal.dot(x) - sheet.offset_m, 0, 1e-15);
      EXPECT_NEAR((ray.point_in_scanner - centre).norm(), radius, 1e-14);
      EXPECT_NEAR((ray.normal_in_scanner - (ray.point_in_scanner - centre) / radius).norm(), 0,
                  1e-12);
      // on_row's own limit, and its looser one where the surface turns away from the light
      EXPECT_NEAR(project(s.camera, x)->y(), row, 1e-8);
      EXPECT_LT((ray.point_in_scanner - centre).dot(x), 0.01 * radius) << "it faces the camera";
    }
  EXPECT_GT(hits, 300);
}

// The nearest lit point of an image row by a search along it: views whose points change sides of
// the light plane within a tenth of a pixel.
std::optional<Eigen::Vector3d> search_row(const Bench& bench, int row) {
  std::optional<Eigen::Vector3d> nearest;
  Hit seen;
  const auto offset_at = [&](double column) {
    const Eigen::Vector3d view =
        ray_through(bench.scanner.camera, {column, double(row)})->normalized();
    seen = facing(*bench.caster.closest({0, 0, 0}, view), view);
    return bench.sheet.normal.dot(seen.point) - bench.sheet.offset_m;
  };
  double before_m = offset_at(-0.5);
  for (double column = -0.4; column <= 159.5; column += 0.1) {
    const double after_m = offset_at(column);
    if ((before_m < 0) != (after_m < 0)) {
      double low = column - 0.1, high = column;
      for (int i = 0; i < 60; ++i) {
        const double half = (low + high) / 2;
        ((offset_at(half) < 0) == (before_m < 0) ? low : high) = half;
      }
      const bool is_crossing = std::abs(offset_at(low)) < 1e-9;  // no jump between surfaces
      if (is_crossing && !bench.caster.occluded(seen, bench.sheet.origin) &&
          (!nearest || seen.point.norm() < nearest->norm()))
        nearest = seen.point;
    }
    before_m = after_m;
  }
  return nearest;
}

// From the middle of a ball to the sheet that grazes it, and on a blend: no row is lost, up to the
// limbs, and of two points in a row the nearer is taken.
TEST(LaserTruth, LosesNoRowThatASearchFinds) {
  LaserLine s = small_laser();
  s.camera.k1 = -0.3;  // only distortion brings two points of the sheet into one row
  s.camera.p2 = 0.05;
  const Eigen::Vector3d focus(0, 0, focus_z(s)), across = laser_sheet(s).normal;
  std::vector<Object> bodies = {
      {"bud", exp((Vector6() << 0.5, 0.4, 0.3, 0, 0, 0.2).finished()), bud(), 0}};
  for (const double share : {0.0, 0.3, -0.5, 0.8, 0.95, 0.99})
    bodies.push_back(sphere_at(focus + share * 0.025 * across, 0.025));
  // a plate that ends at a height: the light steps from it to the plane behind, a row or so back
  for (const double end_m : {0.0151, 0.0173}) {
    Object half = plate(0.15, -0.1, 0.1);
    for (Eigen::Vector3d& vertex : std::get<Mesh>(half.geometry).vertices)
      vertex.y() = std::min(vertex.y(), end_m);
    bodies.push_back(half);
  }
  int found = 0, lost = 0;
  for (const Object& body : bodies) {
    const Bench bench(s, white_scene({body, plane_at(0.25)}));
    const auto rays = true_rays(s, bench.caster, Pose::Identity());
    for (int row = 0; row < 120; ++row) {
      const auto nearest = search_row(bench, row);
      if (!nearest) continue;
      ++found;
      // bisection ends at 1e-17 px; a point of grazing light moves by 1e5 times more than its view
      lost += rays[row].object < 0 || (*nearest - rays[row].point_in_scanner).norm() > 1e-9;
    }
  }
  EXPECT_GT(found, 500);
  EXPECT_EQ(lost, 0);
}

// Of a ball of radius r around the focus, z before the camera, the lit points are turned by beta
// from the laser's middle ray; the camera sees them as long as cos(beta) z cos(theta) > r, where
// their normal turns away from it.
TEST(LaserTruth, EndsWhereTheCameraSeesTheBallNoMore) {
  const LaserLine s = small_laser();
  const double z = focus_z(s);
  int checked = 0;
  for (double radius = 0.02; radius < 0.03; radius += 1e-4) {
    const Bench bench(s, white_scene({sphere_at({0, 0, z}, radius)}));
    const auto rays = true_rays(s, bench.caster, Pose::Identity());
    const double cosine = radius / (z * std::cos(theta)), sine = std::sqrt(1 - cosine * cosine);
    const double end_px = 300 * radius * sine / (z - radius * cosine * std::cos(theta));
    const int last = static_cast<int>(std::floor(59.5 + end_px));
    if (59.5 + end_px - last < 1e-6) continue;  // the very end: either answer is right
    ++checked;
    EXPECT_EQ(rays[last].object, 0) << radius;
    EXPECT_EQ(rays[119 - last].object, 0) << radius;
    EXPECT_EQ(rays[last + 1].object, -1) << radius;
  }
  EXPECT_GT(checked, 80);
}

// The brightest place of each rendered row is where the truth says.
TEST(LaserTruth, StandsInTheMiddleOfTheRenderedStripe) {
  LaserLine s = small_laser();
  s.beam_radius_m = 2e-5;
  const Bench bench(s, white_scene({sphere_at({0, 0, 0.18}, 0.03)}));
  const auto rays = true_rays(s, bench.caster, Pose::Identity());
  int hits = 0;
  for (int row = 0; row < 120; ++row) {
    if (rays[row].object < 0) continue;
    ++hits;
    const Eigen::Vector2d pixel = *project(s.camera, rays[row].point_in_scanner);
    const double middle = bench.electrons(pixel.x(), row);
    EXPECT_GT(middle, 0) << row;
    EXPECT_GT(middle, bench.electrons(pixel.x() - 0.05, row)) << row;
    EXPECT_GT(middle, bench.electrons(pixel.x() + 0.05, row)) << row;
  }
  EXPECT_GT(hits, 60);
}

}  // namespace
}  // namespace scan::synth
