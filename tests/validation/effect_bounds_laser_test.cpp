// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The planner's bounds for the laser line against what leaving an effect out does, each on a scene
// built to meet it: the error is within the bound and not below a tenth of it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/validation/effect_bounds.h"
#include "tests/validation/laser_scans.h"

namespace scan::synth {
namespace {

LaserLine device() {
  LaserLine s = small_laser();
  s.steps = 30;
  s.step_m = 1e-3;
  s.stage_direction = {0, 1, 0};
  s.beam_radius_m = 2e-3;
  s.sensor = {.gain_e_per_dn = 0.2, .full_well_e = 1e9, .bits = 16};
  return s;
}

// How a row's place is read: by the decoder, or as the centroid of the whole row, where a window
// might choose between the parts of a stripe that an edge cuts in two.
enum class Reading { decoder, centroid };

struct Case {
  const char* name;
  Effect effect;
  void (*build)(LaserLine&, Scene&);
  Reading reading = Reading::decoder;
  EffectSet others = {};  // on in both renderings, besides what is free of noise
  int renderings = 1;     // with seeds of their own: more than one where paths are chance
  int pooled = 1;         // rows whose mean error counts as one ray's
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

// Means of so many neighbours each.
std::vector<double> pooled(const std::vector<double>& errors, int count) {
  std::vector<double> means;
  for (std::size_t first = 0; first + count <= errors.size(); first += count) {
    double sum = 0, found = 0;
    for (int i = 0; i < count; ++i)
      if (std::isfinite(errors[first + i])) sum += errors[first + i], ++found;
    means.push_back(found > 0 ? sum / found : NAN);
  }
  return means;
}

class LaserBound : public testing::TestWithParam<Case> {};

TEST_P(LaserBound, IsMetToATenth) {
  const Case& c = GetParam();
  LaserLine s = device();
  Scene scene;
  c.build(s, scene);
  EffectSet off = noise_free;
  for (const Effect effect : all_effects())
    if (c.others.has(effect)) off.set(effect);
  off.set(c.effect, false);
  const auto ranges_m = [&](const EffectSet& effects, std::uint64_t seed) {
    return c.reading == Reading::centroid ? centroid_ranges(s, scene, effects, seed)
                                          : decoded(s, scene, effects, seed).range_m;
  };
  const LargestError error = largest_error(c.renderings, [&](std::uint64_t seed) {
    return pooled(minus(ranges_m(EffectSet(off).set(c.effect), seed), ranges_m(off, seed)),
                  c.pooled);
  });
  expect_met(c.name, error, bound_m(s, scene, c.effect));
}

void few_rows(LaserLine& s, int rows) {
  s.steps = 1;
  s.camera.height_px = rows;
  s.camera.cy_px = (rows - 1) / 2.0;
}

// A plane that rises with the rows, so that the stripe takes all places within a pixel.
Object rising_plane(double z_m) {
  Object plane = plane_at(z_m);
  plane.world_from_object.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  return plane;
}

// Coarse steps of the converter.
void in_coarse_steps(LaserLine& s, Scene& scene) {
  s.sensor = {.gain_e_per_dn = 100, .bits = 8};
  scene = white_scene({rising_plane(focus_z(s))});
}

template <int tilt_percent>
void of_a_bent_and_shifted_plane(LaserLine& s, Scene& scene) {
  s.plane_bow_m = 1e-4;
  s.plane_shift_m = 5e-5;
  s.plane_turn_rad = 3e-4;
  scene = white_scene({plane_at(focus_z(s), tilt_percent / 100.0)});
}

// A step of reflectance of 50, swept through the beam, near the camera: what another width does.
void past_a_step(LaserLine& s, Scene& scene) {
  s.stage_direction = {1, 0, 0};
  s.step_m = 2e-4;
  s.steps = 41;
  s.sub_rays = 4;
  s.camera.height_px = 5;
  s.camera.cy_px = 2;
  s.beam_quality = 300;
  s.aperture_m = 4e-3;
  s.lens_focus_m = 0.3;
  const double z = 0.15;
  scene = reflectance_step({s.baseline_m - z * std::tan(theta), 0, z}, {0, 0, 1}, 50);
}

// The head runs along x past the same edge, its shutter open all the time.
void on_the_run(LaserLine& s, Scene& scene) {
  past_a_step(s, scene);
  s.beam_quality = s.aperture_m = 0;
  s.steps = 21;
  s.step_m = 2e-3;
  s.exposure_share = 1;
  scene = reflectance_step({0, 0, focus_z(s)}, {0, 0, 1}, 50);
}

// Ten times the full well, past the edge.
void overexposed(LaserLine& s, Scene& scene) {
  past_a_step(s, scene);
  s.beam_quality = s.aperture_m = 0;
  s.blooming_share = 1;
  s.sensor.full_well_e = 500;
}

// As bright as the dark side of the edge.
void under_even_light(LaserLine& s, Scene& scene) {
  past_a_step(s, scene);
  s.beam_quality = s.aperture_m = 0;
  s.ambient_electrons = 500;
}

// A stripe of a third of a pixel.
void of_a_thin_stripe(LaserLine& s, Scene& scene) {
  s.beam_radius_m = 2 * 0.33 * std::cos(theta) * focus_z(s) / 300;
  s.sub_rays = 5;
  scene = white_scene({rising_plane(focus_z(s))});
}

// A row whose lower half sees a wall, whose upper half one that stands 1.5 mm before it.
void across_a_ledge(LaserLine& s, Scene& scene) {
  s.beam_radius_m = 1e-3;
  s.sub_rays = 4;
  few_rows(s, 21);
  const double z = focus_z(s);
  Object ledge = plate(z - 1.5e-3, -1, 1);
  ledge.world_from_object.translation().y() = 1 + 0.05 / 300 * z;
  scene = white_scene({plane_at(z), ledge});
}

// They meet a pixel beside the stripe's middle, where the one that it lights lights the other most.
void before_two_walls(LaserLine& s, Scene& scene) {
  few_rows(s, 40);
  s.beam_radius_m = 1e-3;
  s.sensor.read_noise_e = 10;  // not drawn: how well paths need to be known
  scene = white_scene({plane_at(0.1844, 0.75), plane_at(0.1844, -0.75)});
}

// Satin metal sends little of the sheet to the camera, and much to polished metal, which shows a
// ghost of the stripe thirty times as bright.
void before_a_glossy_corner(LaserLine& s, Scene& scene) {
  before_two_walls(s, scene);
  scene = white_scene({plane_at(0.225, 0.565), plane_at(0.225, -1.1, 1)});
  scene.materials = {{.name = "polished", .bsdf = Conductor{.roughness = 0.02}},
                     {.name = "satin", .bsdf = Conductor{.roughness = 0.2}}};
}

// A square board of 2 `half_m` around a point with that normal.
Object board(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal, double half_m,
             int material) {
  const Eigen::Vector3d across = normal.unitOrthogonal() * half_m;
  const Eigen::Vector3d along = normal.normalized().cross(across);
  Mesh mesh;
  mesh.vertices = {centre - across - along, centre + across - along, centre + across + along,
                   centre - across + along};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return {.name = "board",
          .world_from_object = Pose::Identity(),
          .geometry = mesh,
          .material = material};
}

// A mirror in the view shows a white board above the view, where the sheet lights it; the wall's
// own stripe is dark.
void beside_a_mirror(LaserLine& s, Scene& scene) {
  few_rows(s, 40);
  s.sensor.read_noise_e = 10;
  const Eigen::Vector3d mirror(-0.03, 0, 0.15), lit(0.0126, 0.06, 0.16);
  const Eigen::Vector3d laser(s.baseline_m, 0, 0);
  const Eigen::Vector3d up = (lit - mirror).normalized();
  scene.materials = {plain(0.02), plain(1), {.name = "mirror", .bsdf = Conductor{.roughness = 0}}};
  scene.objects = {plane_at(focus_z(s)), board(lit, (laser - lit).normalized() - up, 0.02, 1),
                   board(mirror, up - mirror.normalized(), 0.01, 2)};
}

// Through a block of glass, 10 cm thick.
void behind_glass(LaserLine& s, Scene& scene) {
  few_rows(s, 20);
  s.sensor.read_noise_e = 10;
  scene = white_scene({plane_at(focus_z(s))});
  scene.materials.push_back({.name = "glass", .bsdf = Dielectric{1.5}});
  scene.objects.push_back({.name = "block",
                           .world_from_object = make_pose(Eigen::Matrix3d::Identity(), {0, 0, 0.1}),
                           .geometry = Shape(BoxShape{{0.3, 0.3, 0.1}}),
                           .material = 1});
}

// Light goes 1 mm into the body and some of it comes back.
void on_wax(LaserLine& s, Scene& scene) {
  few_rows(s, 12);
  s.peak_electrons = 50000;
  s.beam_radius_m = 1e-3;
  s.sensor.gain_e_per_dn = 1;
  s.sensor.read_noise_e = 10;
  scene = white_scene({plane_at(focus_z(s))});
  scene.materials[0] = {.name = "wax",
                        .bsdf = Dielectric{.index = 1},
                        .interior = Medium{.absorption_per_m = 100, .scattering_per_m = 900}};
}

// A dark wall, before which the sheet shines in the fog.
void in_fog(LaserLine& s, Scene& scene) {
  few_rows(s, 20);
  s.peak_electrons = 3e6;
  s.beam_radius_m = 1e-3;
  s.sensor.gain_e_per_dn = 4;
  s.sensor.read_noise_e = 10;
  scene = {.objects = {plane_at(focus_z(s))}, .materials = {plain(0.05)}};
  scene.medium = Medium{.scattering_per_m = 3};
}

INSTANTIATE_TEST_SUITE_P(
    All, LaserBound,
    testing::Values(
        Case{"quantisation", Effect::quantisation, in_coarse_steps},
        Case{"bow", Effect::plane_bow, of_a_bent_and_shifted_plane<0>},
        Case{"bow_on_a_slope", Effect::plane_bow, of_a_bent_and_shifted_plane<40>},
        Case{"bow_on_a_counterslope", Effect::plane_bow, of_a_bent_and_shifted_plane<-40>},
        Case{"miscalibration", Effect::miscalibration, of_a_bent_and_shifted_plane<0>},
        Case{"miscalibration_on_a_slope", Effect::miscalibration, of_a_bent_and_shifted_plane<40>},
        Case{"miscalibration_on_a_counterslope", Effect::miscalibration,
             of_a_bent_and_shifted_plane<-40>},
        Case{"beam_spread", Effect::beam_spread, past_a_step, Reading::centroid},
        Case{"defocus", Effect::defocus, past_a_step, Reading::centroid},
        Case{"motion", Effect::motion, on_the_run, Reading::centroid},
        Case{"blooming", Effect::blooming, overexposed, Reading::centroid},
        Case{"even_light_at_an_edge", Effect::scene_lights, under_even_light},
        Case{"footprint_of_a_thin_stripe", Effect::footprint, of_a_thin_stripe, Reading::centroid},
        Case{"footprint_at_a_ledge", Effect::footprint, across_a_ledge},
        Case{"interreflection",
             Effect::interreflection,
             before_two_walls,
             Reading::decoder,
             {},
             8,
             10},
        Case{"interreflection_ghost",
             Effect::interreflection,
             before_a_glossy_corner,
             Reading::decoder,
             {},
             8},
        Case{"mirror", Effect::mirror_reflection, beside_a_mirror, Reading::decoder, {}, 8},
        Case{"glass", Effect::refraction, behind_glass, Reading::decoder, {}, 8},
        Case{"subsurface", Effect::subsurface, on_wax, Reading::decoder, {}, 8, 4},
        Case{"fog", Effect::medium, in_fog, Reading::decoder, {}, 16, 20}),
    [](const auto& c) { return std::string(c.param.name); });

}  // namespace
}  // namespace scan::synth
