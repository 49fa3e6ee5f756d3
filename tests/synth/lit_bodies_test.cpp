// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Ways over smooth surfaces that light of a narrow emitter cannot take are not looked for.
#include <gtest/gtest.h>

#include "libscan/core/random.h"
#include "synth/scanners/laser_line_paths.h"
#include "synth/scanners/pulsed_lidar_paths.h"
#include "tests/synth/laser_bench.h"
#include "tests/synth/smooth_scenes.h"

namespace scan::synth {
namespace {

// Shines at 1 within a cone, at 0 elsewhere.
struct Torch {
  Eigen::Vector3d place, axis;
  double least_cosine;

  Eigen::Vector3d position() const { return place; }
  double irradiance(const Eigen::Vector3d& direction, double /*length_m*/) const {
    return direction.dot(axis) > least_cosine ? 1 : 0;
  }
  EmittedRay sample(const Eigen::Vector2d& /*u*/) const { return {place, axis, 1}; }
  double flux() const { return 1; }
};

// Two mirrors at a right angle, of which the lamp lights the one or the other, and a silver ball.
Scene mirrors() {
  Scene scene;
  scene.materials = {mirror_material()};
  scene.objects = {placed(BoxShape{{2, 2, 0.1}}, 0, {0, 0, -0.05}),
                   placed(BoxShape{{0.1, 2, 2}}, 0, {-1.05, 0, 1}),
                   placed(SphereShape{0.2}, 0, {0.4, 0.3, 0.8})};
  return scene;
}

bool is_there(const std::vector<Connection>& ways, const Connection& way) {
  return std::any_of(ways.begin(), ways.end(), [&](const Connection& other) {
    return other.bounces == way.bounces && (other.emitted - way.emitted).norm() < 1e-9;
  });
}

TEST(LitBodies, LeaveOutNoWayThatIsLit) {
  const RayCaster caster(mirrors());
  const Connector connector(caster, 4);
  RandomStream random(3, 0, 0);
  const auto between = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  const auto point = [&] {
    const double x = between(-0.9, 0.9), y = between(-0.9, 0.9);
    return Eigen::Vector3d(x, y, between(0.2, 1.5));
  };
  int lit = 0, dark = 0;
  for (int i = 0; i < 300; ++i) {
    Torch torch{.place = point(), .axis = Eigen::Vector3d::Zero(), .least_cosine = 0.8};
    torch.axis = (point() - torch.place).normalized();
    const Eigen::Vector3d at = point();
    std::vector<Connection> all, some;
    connector.connect(at, torch.place, all);
    const AnyEmitter emitter = any_emitter(torch);
    Lamp lamp(torch.place);
    lamp.emitter = &emitter;
    lamp.lit = connector.lit_bodies(emitter);
    connector.connect(at, lamp, some);
    for (const Connection& way : all) {
      if (way.bounces == 0) continue;
      const bool is_lit = torch.irradiance(way.emitted, way.length_m) > 0;
      EXPECT_EQ(is_there(some, way), is_lit) << i;
      ++(is_lit ? lit : dark);
    }
  }
  EXPECT_GT(lit, 50);
  EXPECT_GT(dark, 50);
}

// A tilted pane of glass, seen from both sides by beams that are a fifth of a radian wide.
TEST(LitBodies, LeaveOutNoWayThroughGlassThatIsLit) {
  Scene scene;
  scene.materials = {{.name = "glass", .bsdf = Dielectric{.index = 1.5}}, mirror_material()};
  scene.objects = {placed(BoxShape{{2, 2, 0.05}}, 0, {0.1, 0, 0.4}),
                   placed(BoxShape{{2, 2, 0.1}}, 1, {0, 0, -0.05})};
  const RayCaster caster(scene);
  const Connector connector(caster, 4);
  RandomStream random(4, 0, 0);
  const auto point = [&](double low_z) {
    const double x = 1.6 * random.uniform() - 0.8, y = 1.6 * random.uniform() - 0.8;
    return Eigen::Vector3d(x, y, low_z + 0.3 * random.uniform());
  };
  int lit = 0, dark = 0;
  for (int i = 0; i < 300; ++i) {
    BeamLight beam{.origin = point(0.6), .axis = {}, .slope = 0.1, .electrons_at_1m = 1};
    beam.axis = (point(0.05) - beam.origin).normalized();
    const Eigen::Vector3d at = point(i % 2 == 0 ? 0.05 : 0.6);
    std::vector<Connection> all, some;
    connector.connect(at, beam.origin, all);
    const AnyEmitter emitter = any_emitter(beam);
    Lamp lamp(beam.origin);
    lamp.emitter = &emitter;
    lamp.lit = connector.lit_bodies(emitter);
    connector.connect(at, lamp, some);
    for (const Connection& way : all) {
      if (way.bounces == 0) continue;
      const double share = beam.irradiance(way.emitted, 1) / 2;
      EXPECT_TRUE(!(share > 1e-15) || is_there(some, way)) << i;
      ++(share > 1e-15 ? lit : dark);
    }
  }
  EXPECT_GT(lit, 100);
  EXPECT_GT(dark, 100);
}

TEST(LitBodies, AreThoseThatTheEmitterReaches) {
  const RayCaster caster(mirrors());
  const Connector connector(caster, 4);
  const auto lit_by = [&](const Eigen::Vector3d& direction) {
    const BeamLight beam{
        .origin = {0.4, 0.3, 1.5}, .axis = direction, .slope = 1e-3, .electrons_at_1m = 1};
    return connector.lit_bodies(any_emitter(beam));
  };
  const std::uint64_t ball = Lamp::bit(2);
  EXPECT_NE(lit_by(-Eigen::Vector3d::UnitZ()) & ball, 0u);
  EXPECT_EQ(lit_by(Eigen::Vector3d::UnitZ()), 0u);  // away from everything
  EXPECT_EQ(lit_by(-Eigen::Vector3d::UnitX()) & ball, 0u);
}

// A half-space of glass has no centre and no size to reach: whatever way the beam looks, it may
// light it, and through it everything.
TEST(LitBodies, HoldUnboundedGlassWhereverTheBeamGoes) {
  Scene scene;
  scene.materials = {glass_material()};
  scene.objects = {placed(PlaneShape{}, 0, {0, 0, -4})};
  const RayCaster caster(scene);
  const BeamLight beam{
      .origin = {0, 0, 0}, .axis = {0.6, 0, -0.8}, .slope = 1e-3, .electrons_at_1m = 1};
  EXPECT_EQ(Connector(caster, 4).lit_bodies(any_emitter(beam)), Lamp::all_bodies);
}

// A ball that a lit point touches from within is reached, from whatever side; most others are not.
template <class Emitter>
void expect_reaches_what_it_lights(const Emitter& emitter, double brightest_at_1m, double size_m) {
  RandomStream random(7, 0, 0);
  const auto direction = [&]() -> Eigen::Vector3d {
    const double x = random.normal(), y = random.normal();
    return Eigen::Vector3d(x, y, random.normal()).normalized();
  };
  int lit = 0, missed = 0;
  for (int i = 0; i < 50'000; ++i) {
    const double u = random.uniform();
    const EmittedRay ray = emitter.sample({u, random.uniform()});
    const double range_m = size_m * random.uniform(), aside_m = 0.02 * range_m * random.uniform();
    const Eigen::Vector3d point = ray.origin + range_m * ray.direction + aside_m * direction();
    const Eigen::Vector3d away = point - emitter.position();
    const double radius_m = 0.1 * size_m * random.uniform();
    const Eigen::Vector3d centre = point + 0.999 * radius_m * direction();
    const double electrons = emitter.irradiance(away.normalized(), away.norm());
    if (electrons * away.squaredNorm() > 1e-15 * brightest_at_1m) {
      ++lit;
      ASSERT_TRUE(emitter.reaches(centre, radius_m)) << centre.transpose() << ' ' << radius_m;
    }
    missed += emitter.reaches(emitter.position() + size_m * direction(), radius_m) ? 0 : 1;
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(missed, 10'000);
}

TEST(BeamLight, ReachesWhatItLights) {
  const BeamLight beam{.origin = {1, 2, 3},
                       .axis = Eigen::Vector3d(1, -2, 2) / 3,
                       .slope = 0.02,
                       .electrons_at_1m = 1};
  expect_reaches_what_it_lights(beam, 1, 4);
}

TEST(SheetEmitter, ReachesWhatItLights) {
  LaserLine s = small_laser();
  s.plane_bow_m = 2e-3;
  s.beam_quality = 3;
  const LaserSheet sheet = laser_sheet(s);
  const RayCaster caster(white_scene({plane_at(1)}));
  const Pose pose = make_pose(
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {3, 1, 2});
  const LaserView view{s, sheet, caster, pose};
  expect_reaches_what_it_lights(SheetEmitter(view), s.peak_electrons, 0.5);
}

}  // namespace
}  // namespace scan::synth
