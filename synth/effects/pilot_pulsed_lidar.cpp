// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a pulsed lidar's pilot rays meet, and how far each effect moves the range there.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "libscan/core/units.h"
#include "synth/effects/convex.h"
#include "synth/effects/echo_light.h"
#include "synth/effects/pilot_rounds.h"
#include "synth/medium/diffusion.h"
#include "synth/scanners/first_surface.h"
#include "synth/scanners/pulsed_lidar_fog.h"
#include "synth/scanners/pulsed_lidar_noise.h"
#include "synth/scanners/pulsed_lidar_paths.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
constexpr double half_c = speed_of_light_m_s / 2;
constexpr double sigmas = 3;  // of noise that counts as its bound

double& left_out(PilotRay& ray, Effect effect) {
  return ray.left_out_m[static_cast<int>(effect)];
}

// What a pilot shares among its rays.
struct PilotScan {
  const PulsedLidar& scanner;
  const RayCaster& caster;
  // Without clear bodies, behind which there is something to measure, and translucent ones opaque.
  const RayCaster& solid;
  const Pose& world_from_scanner;
  BeamSection section;
  LightTransport transport;
  std::optional<LidarFog> fog;
  std::vector<double> endless_e;  // what fog without a surface sends back
};

PilotScan prepare(const PulsedLidar& s, const RayCaster& caster, const RayCaster& solid,
                  const Pose& world_from_scanner) {
  PilotScan scan{.scanner = s,
                 .caster = caster,
                 .solid = solid,
                 .world_from_scanner = world_from_scanner,
                 .section = beam_section(s),
                 .transport = LightTransport(caster, transport_options(EffectSet::all(), true)),
                 .fog = {},
                 .endless_e = {}};
  const SampleAxis axis = sample_axis(s);
  if (caster.scene().medium) {
    scan.fog.emplace(s, *caster.scene().medium, axis);
    scan.endless_e.assign(static_cast<std::size_t>(axis.samples), 0.0);
    scan.fog->add(std::numeric_limits<double>::infinity(), scan.endless_e);
  }
  return scan;
}

void weigh_paths(const PilotScan& scan, const Eigen::Vector3d& direction, std::size_t index,
                 double direct_e, PilotRay& ray) {
  const PulsedLidar& s = scan.scanner;
  const EchoNoise noise = echo_noise(s, direct_e);
  const EchoLight light = echo_light(s, scan.transport, scan.world_from_scanner, direction, index,
                                     ray.range_m, noise.half_window_m());
  if (light.indirect_e > 0) {
    ray.indirect_share = light.indirect_e / noise.total_e;
    ray.indirect_extra_m = light.extra_e_m / light.indirect_e;
    left_out(ray, Effect::interreflection) = light.late_e_m / (noise.total_e + light.indirect_e);
  }
  const double lamps_e = s.electrons_per_w_m2 * light.lamps_e;
  const double floor_e2 = floor_variance_e2(s);
  left_out(ray, Effect::scene_lights) =
      sigmas * (noise.all_m(floor_e2 + lamps_e) - noise.all_m(floor_e2));
}

// The decoder takes the first echo: what comes more than 5 pulse lengths behind the sub-rays before
// it is another one (strong equal echoes part at 3.5, see acquire/waveform.h), if those stand above
// twice the decoder's threshold.
void leave_first_echo(const PulsedLidar& s, std::vector<Echo>& echoes) {
  std::sort(echoes.begin(), echoes.end(),
            [](const Echo& a, const Echo& b) { return a.time_s < b.time_s; });
  double energy = 0;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const double threshold_e =
        6 * std::sqrt(echo_noise(s, energy).width * std::sqrt(pi) * floor_variance_e2(s));
    const bool is_behind = i > 0 && echoes[i].time_s - echoes[i - 1].time_s > 5 * s.pulse_sigma_s;
    if (is_behind && energy > 2 * threshold_e) return echoes.resize(i);
    energy += echoes[i].electrons;
  }
}

// Sub-rays at ranges R_i with energies: the merged echo stands at their mean; from its third moment
// on (the spread against four pulse lengths) parts may be taken for the whole. It is not before the
// nearest or behind the farthest.
void weigh_footprint(const PilotScan& scan, const Eigen::Vector3d& direction, PilotRay& ray) {
  const PulsedLidar& s = scan.scanner;
  std::vector<Echo> echoes;
  LidarBeam{s, scan.solid, scan.section}.sub_ray_echoes(scan.world_from_scanner, direction, echoes);
  leave_first_echo(s, echoes);
  double nearest_m = ray.range_m, farthest_m = ray.range_m, energy = 0, moment = 0;
  for (const Echo& echo : echoes) {
    const double range_m = half_c * echo.time_s;
    nearest_m = std::min(nearest_m, range_m);
    farthest_m = std::max(farthest_m, range_m);
    energy += echo.electrons;
    moment += echo.electrons * (range_m - ray.range_m);
  }
  ray.range_spread_m = farthest_m - nearest_m;
  const double shift_m = energy > 0 ? std::abs(moment / energy) : ray.range_spread_m;
  const double pulse_m = half_c * s.pulse_sigma_s;
  left_out(ray, Effect::footprint) = std::min(
      shift_m + ray.range_spread_m * std::min(1.0, std::pow(ray.range_spread_m / (4 * pulse_m), 2)),
      std::max(farthest_m - ray.range_m, ray.range_m - nearest_m));
}

// Between the ray's true and its middle place: how far the point and its range move.
void weigh_motion(const PilotScan& scan, const Eigen::Vector3d& direction, std::size_t index,
                  PilotRay& ray) {
  if (!is_moving(scan.scanner)) return;
  const Pose pose = scan_from_scanner(scan.scanner, index);
  const auto seen =
      first_surface(scan.solid, scan.world_from_scanner * pose, {.direction = direction});
  const double range_m = seen ? seen->point.norm() : scan.scanner.max_range_m;
  const double moved_m = (pose * (range_m * direction) - ray.range_m * direction).norm();
  left_out(ray, Effect::motion) = std::max(moved_m, std::abs(range_m - ray.range_m));
}

// Fog before the surface adds B electrons to each sample of its near side: the fitted centre moves
// by sum(w m' r) / sum(w m'^2) to first order, with the model m, its weights w = 1 / (v + m) and r
// = B times the share of the pulse still to come. Half as much again for the higher orders.
double fog_pull_m(const EchoNoise& echo, double floor_e2, double near_e) {
  const int window = static_cast<int>(echo.half_window_m() / echo.m_per_sample);
  double pull = 0, information = 0;
  for (int i = -window; i <= window; ++i) {
    const double u = i / echo.width;
    const double model_e = echo.height_e * std::exp(-u * u / 2);
    const double slope_e = model_e * u / echo.width, weight = 1 / (floor_e2 + model_e);
    pull -= weight * slope_e * near_e * 0.5 * std::erfc(u / std::numbers::sqrt2);
    information += weight * slope_e * slope_e;
  }
  return 1.5 * echo.m_per_sample * pull / information;
}

// Electrons that an echo needs to stand out: six sigma of the floor under its own width.
double least_echo_e(const PulsedLidar& s, double width) {
  return 6 * std::sqrt(width * std::sqrt(pi) * floor_variance_e2(s));
}

// Besides, what is lost of the echo makes its noise larger; and fog that stands above the
// threshold, of which half is enough here, is an echo itself.
void weigh_fog(const PilotScan& scan, double electrons, PilotRay& ray) {
  if (!scan.fog) return;
  const PulsedLidar& s = scan.scanner;
  const SampleAxis axis = sample_axis(s);
  std::vector<Echo> echo = {{ray.range_m / half_c, electrons, s.pulse_sigma_s}};
  scan.fog->dim(echo);
  const EchoNoise dimmed = echo_noise(s, echo[0].electrons);
  const double floor_e2 = floor_variance_e2(s);
  const double window = dimmed.half_window_m() / dimmed.m_per_sample;
  const auto at =
      static_cast<std::ptrdiff_t>((ray.range_m / half_c - axis.start_s) / axis.interval_s - window);
  const auto count = static_cast<std::ptrdiff_t>(scan.endless_e.size());
  const double near_e = scan.endless_e[std::clamp<std::ptrdiff_t>(at, 0, count - 1)];
  const double pull_m = fog_pull_m(dimmed, floor_e2 + near_e, near_e);
  const double noise_m =
      sigmas * (dimmed.all_m(floor_e2 + near_e) - echo_noise(s, electrons).all_m(floor_e2));
  const double highest_e = *std::max_element(scan.endless_e.begin(), scan.endless_e.end());
  const bool is_echo =
      highest_e * dimmed.width * std::sqrt(2 * pi) > least_echo_e(s, dimmed.width) / 2;
  left_out(ray, Effect::medium) =
      is_echo ? ray.range_m : std::min(pull_m, dimmed.half_window_m()) + noise_m;
}

// What is calibrated is known but for the noise of log10(N); else a tenth for sampling and the fit.
// Behind glass or in a mirror the echo may be as weak as any that is found.
void weigh_walk(const PulsedLidar& s, const EchoNoise& echo, PilotRay& ray) {
  const double decade_m = half_c * std::abs(s.range_walk.per_decade_s);
  const double least_e = ray.met_smooth ? least_echo_e(s, echo.width) : echo.total_e;
  const auto decades = [&](double electrons) {
    return std::abs(std::log10(electrons / s.range_walk.at_electrons));
  };
  left_out(ray, Effect::range_walk) =
      s.range_walk.is_calibrated
          ? sigmas * decade_m / std::numbers::ln10 / std::sqrt(std::min(least_e, echo.total_e))
          : 1.1 * decade_m * std::max(decades(echo.total_e), decades(least_e));
}

// Light stays in a body for its mean path there; what comes after the window is another echo.
void weigh_stay(const Material& material, const EchoNoise& echo, PilotRay& ray) {
  const auto* boundary = std::get_if<Dielectric>(&material.bsdf);
  if (!boundary || !material.interior) return;
  const double path_m = penetration_path_m(*material.interior, std::max(boundary->index, 1.0));
  left_out(ray, Effect::subsurface) = std::min(path_m / 2, echo.half_window_m());
}

bool any_transmissive(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    return is_transmissive(scene.materials[object.material].bsdf);
  });
}

std::optional<PilotRay> look(const PilotScan& scan, const Eigen::Vector3d& direction,
                             std::size_t index, bool with_paths) {
  const PulsedLidar& s = scan.scanner;
  const auto seen = first_surface(scan.solid, scan.world_from_scanner, {.direction = direction});
  if (!seen) return std::nullopt;
  PilotRay ray{.range_m = seen->point.norm()};
  if (ray.range_m < s.min_range_m || ray.range_m > s.max_range_m) return std::nullopt;
  const auto first = scan.caster.closest(scan.world_from_scanner.translation(),
                                         scan.world_from_scanner.linear() * direction);
  const Scene& scene = scan.caster.scene();
  ray.met_smooth = first && has_delta(scene.materials[scene.objects[first->object].material].bsdf);
  ray.incidence_rad = std::acos(std::clamp(-seen->normal.dot(direction), 0.0, 1.0));
  PulsedLidar line = s;
  line.sub_rays = 1;
  const BeamSection centre = beam_section(line);
  std::vector<Echo> echoes;
  LidarBeam{line, scan.solid, centre}.sub_ray_echoes(scan.world_from_scanner, direction, echoes);
  const double electrons = echoes.empty() ? 0 : echoes[0].electrons;
  const EchoNoise noise = echo_noise(s, electrons);
  ray.sigma_m = noise.all_m(floor_variance_e2(s));
  ray.signal_e = noise.height_e;
  weigh_footprint(scan, direction, ray);
  weigh_motion(scan, direction, index, ray);
  weigh_fog(scan, electrons, ray);
  weigh_walk(s, noise, ray);
  const auto& object = scan.solid.scene().objects[seen->hit.object];
  weigh_stay(scene.materials[object.material], noise, ray);
  if (with_paths && !light_meets_once(scene, scan.world_from_scanner.translation()))
    weigh_paths(scan, direction, index, electrons, ray);
  return ray;
}

}  // namespace

std::vector<PilotRay> pilot(const PulsedLidar& scanner, const RayCaster& caster,
                            const Pose& world_from_scanner, int rays) {
  check(scanner);
  const Scene& scene = caster.scene();
  std::optional<RayCaster> solid;  // where it differs from the scene
  if (any_transmissive(scene))
    solid.emplace(
        simplified(without_clear_objects(scene), EffectSet::all().without(Effect::subsurface)));
  const PilotScan scan = prepare(scanner, caster, solid ? *solid : caster, world_from_scanner);
  const std::vector<Eigen::Vector3d> directions = ray_directions(scanner);
  const RayGrid grid = ray_grid(scanner);
  const auto count = std::min(directions.size(), static_cast<std::size_t>(std::max(rays, 1)));
  EffectSet by_paths = {Effect::interreflection};
  by_paths.set(Effect::scene_lights, scanner.electrons_per_w_m2 > 0 && !scene.lights.empty());
  return look_in_rounds(count, by_paths, [&](std::size_t i, bool with_paths) {
    // Spread evenly over rows and columns (Roberts' sequence, by the plastic number).
    const double row = std::fmod(0.5 + 0.7548776662466927 * static_cast<double>(i), 1);
    const double column = std::fmod(0.5 + 0.5698402909980532 * static_cast<double>(i), 1);
    const std::size_t index = static_cast<std::size_t>(row * grid.rows) * grid.columns +
                              static_cast<std::size_t>(column * grid.columns);
    return look(scan, directions[index], index, with_paths);
  });
}

}  // namespace scan::synth
