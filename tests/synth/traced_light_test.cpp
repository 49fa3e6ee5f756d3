// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Irradiance behind glass by brute force: many rays from the light, counted on a screen. Knows
// nothing of connections, and so holds spread, throughput and the number of ways to account.
#include <gtest/gtest.h>

#include "synth/bsdf/fresnel.h"
#include "tests/synth/smooth_scenes.h"

namespace scan::synth {
namespace {

// A square on the plane z = z_m.
struct Patch {
  Eigen::Vector2d centre;
  double half_m;
  double z_m;
};

// Rays of even density in a cone from the light.
struct Cone {
  Eigen::Vector3d apex, axis;
  double half_angle_rad;
  double solid_angle_sr() const { return 2 * std::numbers::pi * (1 - std::cos(half_angle_rad)); }
  Eigen::Vector3d draw(RandomStream& random) const {
    const double cosine = 1 - random.uniform() * (1 - std::cos(half_angle_rad));
    const double azimuth = 2 * std::numbers::pi * random.uniform();
    const double sine = std::sqrt(1 - cosine * cosine);
    return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis) *
           Eigen::Vector3d(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
  }
};

struct Power {
  double mean = 0;
  double standard_error = 0;
};

// Power on the patch of a light of 1 W/sr by rays that are refracted at each surface of index 1.5.
Power traced_power(const RayCaster& caster, const Cone& cone, const Patch& patch) {
  const std::size_t rays = 300000;
  const Eigen::Vector2d sums =
      ordered_sum(rays, 5000, Eigen::Vector2d(0, 0), [&](std::size_t begin, std::size_t end) {
        Eigen::Vector2d part(0, 0);
        for (std::size_t i = begin; i < end; ++i) {
          RandomStream random(21, 0, i);
          Eigen::Vector3d point = cone.apex, direction = cone.draw(random);
          double share = 1;
          int surfaces = 0;
          while (const auto hit = caster.closest(point, direction)) {
            const double cosine = hit->normal.dot(direction);
            const double index = cosine < 0 ? 1.5 : 1 / 1.5;
            share *= 1 - fresnel_dielectric(std::abs(cosine), index);
            const auto inside = refract(-direction, cosine < 0 ? hit->normal : -hit->normal, index);
            if (!inside) share = 0;
            if (share == 0) break;
            direction = *inside;
            point = caster.leave(*hit, direction);
            ++surfaces;
          }
          if (surfaces == 0 || !(direction.z() > 0)) continue;
          const Eigen::Vector3d end_point =
              point + (patch.z_m - point.z()) / direction.z() * direction;
          const Eigen::Vector2d across = end_point.head<2>() - patch.centre;
          if (across.cwiseAbs().maxCoeff() < patch.half_m)
            part += Eigen::Vector2d(share, share * share);
        }
        return part;
      });
  const double mean = sums.x() / rays;
  const double variance = sums.y() / rays - mean * mean;
  return {mean * cone.solid_angle_sr(), std::sqrt(variance / rays) * cone.solid_angle_sr()};
}

// The same by connections from a grid of points, those over two surfaces.
double connected_power(const Connector& connector, const Eigen::Vector3d& light,
                       const Patch& patch) {
  const int side = 24;
  double sum = 0;
  std::vector<Connection> ways;
  for (int i = 0; i < side * side; ++i) {
    const Eigen::Vector2d u((i % side + 0.5) / side * 2 - 1, (i / side + 0.5) / side * 2 - 1);
    const Eigen::Vector2d across = patch.centre + patch.half_m * u;
    connector.connect(Eigen::Vector3d(across.x(), across.y(), patch.z_m), light, ways);
    for (const Connection& way : with_bounces(ways, 2))
      sum += way.throughput * way.spread / (way.length_m * way.length_m) * -way.arriving.z();
  }
  return sum * std::pow(2 * patch.half_m / side, 2);
}

// 4.5 standard errors are passed by chance once in 150 000 seeds; the midpoint rule over 24 x 24
// points adds at most 1e-3 where irradiance changes by half across the patch.
void expect_same_power(const Object& glass, const Cone& cone, const Patch& patch) {
  Scene scene;
  scene.materials = {glass_material()};
  scene.objects = {glass};
  const RayCaster caster(scene);
  const Connector connector(caster, 2);
  const Power traced = traced_power(caster, cone, patch);
  const double connected = connected_power(connector, cone.apex, patch);
  ASSERT_LT(traced.standard_error, 0.02 * traced.mean);
  EXPECT_NEAR(connected / traced.mean, 1, 4.5 * traced.standard_error / traced.mean + 1e-3);
}

TEST(TracedLight, BehindATiltedPane) {
  expect_same_power(placed(BoxShape{{2, 2, 0.05}}, 0, {0, 0, 0.2}, turn_about_y(0.9)),
                    {Eigen::Vector3d::Zero(), Eigen::Vector3d(0.3, 0, 1).normalized(), 0.35},
                    {{0.15, 0.05}, 0.05, 0.5});
}

// Beyond the focus, which lies at 1.5 r from the centre for parallel light: one way, upside down.
TEST(TracedLight, BehindTheFocusOfABall) {
  expect_same_power(placed(SphereShape{0.02}, 0, {0, 0, 0.1}),
                    {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0.202},
                    {{0.012, 0.003}, 0.006, 0.19});
}

// Before it, between the caustic on the axis and the one around it: several ways meet.
TEST(TracedLight, BeforeTheFocusOfABall) {
  expect_same_power(placed(SphereShape{0.02}, 0, {0, 0, 0.1}),
                    {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0.202},
                    {{0.0022, 0}, 0.0005, 0.127});
}

// A rod focuses one way only.
TEST(TracedLight, BehindARod) {
  const Eigen::Matrix3d lying = Eigen::AngleAxisd(1.4, Eigen::Vector3d::UnitX()).toRotationMatrix();
  expect_same_power(placed(CylinderShape{0.02, 0.4}, 0, {0, 0, 0.1}, lying),
                    {Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0.1, 1).normalized(), 0.205},
                    {{0.01, 0.015}, 0.007, 0.18});
}

// A lens of two spheres, which the shapes describe as an intersection.
TEST(TracedLight, BehindALens) {
  CombinedShape lens{.operation = CombinedShape::Operation::intersect};
  lens.parts = {{make_pose(Eigen::Matrix3d::Identity(), {0, 0, -0.09}), SphereShape{0.1}},
                {make_pose(Eigen::Matrix3d::Identity(), {0, 0, 0.09}), SphereShape{0.1}}};
  expect_same_power(placed(lens, 0, {0, 0, 0.1}, turn_about_y(0.2)),
                    {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0.42},
                    {{0.004, 0.006}, 0.012, 0.2});
}

}  // namespace
}  // namespace scan::synth
