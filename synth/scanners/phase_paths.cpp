// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libscan/core/parallel.h"
#include "synth/sampling/warp.h"

namespace scan::synth {
namespace {

constexpr int tile_px = 8;
constexpr int pilot_paths = 64;
constexpr std::uint64_t pilot_address = std::uint64_t{1} << 40;  // beyond all pixels and exposures

// Turns the light of one path into readings of the exposure's taps.
struct TapReceiver {
  const PhaseCamera& scanner;
  std::span<const Tone> tones;
  const Exposure& exposure;
  double share;
  double extra_m;
  std::span<double> taps;

  void device_light(double electrons, double path_m, int /*scatterings*/) {
    add_to_all(share * electrons);
    for (const Tone& tone : tones) {
      const std::complex<double> phasor = std::polar(1.0, tone.rad_per_m * (path_m + extra_m)) *
                                          (share * tone.contrast * electrons);
      if (exposure.frequency >= 0)
        taps[0] += modulation(phasor, tone.harmonic, exposure.tap);
      else
        for (int k = 0; k < 4; ++k)
          taps[4 * tone.frequency + k] += modulation(phasor, tone.harmonic, k);
    }
  }
  void other_light(double w_m2) { add_to_all(share * scanner.electrons_per_w_m2 * w_m2); }
  void ambient(double part) { add_to_all(share * scanner.ambient_electrons * part); }
  void add_to_all(double electrons) {
    for (double& tap : taps) tap += electrons;
  }
};

// The paths of one pixel.
struct PixelPaths {
  const PathView& view;
  std::span<const Tone> tones;
  const PixelPlace& pixel;
  std::uint64_t ray;
  double offset_m;

  void add(int stream, int index, std::span<double> taps) const {
    const PhaseCamera& s = view.scanner;
    SampleSequence random(view.address.seed, view.address.scan, ray,
                          static_cast<std::uint32_t>(stream));
    random.start(static_cast<std::uint32_t>(index));
    const auto seen = draw_view(s, pixel, random);
    if (!seen) return;
    TapReceiver receiver{s, tones, view.exposure, seen->share, seen->extra_m + 2 * offset_m, taps};
    const Flash flash(s, view.world_from_scanner);
    trace_path(view.transport, in_world(view.world_from_scanner, seen->ray), flash, random,
               receiver);
  }
};

// A first look at a pixel's light.
struct Rough {
  double mean_e = 0;                            // of its taps
  std::vector<std::complex<double>> direction;  // of its phasors, length 1
};

std::complex<double> phasor(std::span<const double> taps, std::size_t f) {
  const double* tap = &taps[4 * f];
  return {(tap[0] - tap[2]) / 2, (tap[3] - tap[1]) / 2};
}

Rough rough_light(const PixelPaths& paths, std::size_t frequencies) {
  constexpr int looks = 16, stream = 4;  // none of those that are estimated by
  std::vector<double> taps(4 * frequencies);
  for (int i = 0; i < looks; ++i) paths.add(stream, i, taps);
  Rough rough;
  for (const double tap : taps)
    rough.mean_e += tap / (looks * 4.0 * static_cast<double>(frequencies));
  for (std::size_t f = 0; f < frequencies; ++f) {
    const std::complex<double> sum = phasor(taps, f);
    rough.direction.push_back(std::abs(sum) > 0 ? sum / std::abs(sum) : 1);
  }
  return rough;
}

// Range follows from a phasor's turn alone. All its light's brightness, which is most of the spread
// over paths, may be off by more: 2.5 times the share of noise. The noise of a phasor's component
// is a tap's over sqrt(2).
constexpr double brightness_slack = 2.5;

// Of the sum of a frequency's taps: the component across its rough direction, scaled so that its
// goal is that of the taps.
double turned(const Rough& rough, std::span<const double> taps, std::size_t f) {
  return brightness_slack * std::numbers::sqrt2 *
         (std::conj(rough.direction[f]) * phasor(taps, f)).imag();
}

// Sorts the device's light by whether it came straight.
struct PilotReceiver {
  double direct_path_m;
  double direct_e = 0, indirect_e = 0, extra_me = 0, other_w_m2 = 0;

  void device_light(double electrons, double path_m, int scatterings) {
    if (scatterings == 1 && std::abs(path_m - direct_path_m) <= 1e-9 * direct_path_m) {
      direct_e += electrons;
    } else {
      indirect_e += electrons;
      extra_me += electrons * std::abs(path_m - direct_path_m) / 2;
    }
  }
  void other_light(double w_m2) { other_w_m2 += w_m2; }
  void ambient(double /*part*/) {}
};

// Of light straight from the device to the first surface and back; 0 if there is none.
double direct_path_m(const PathView& view, const ScannerRay& ray) {
  const auto seen = first_surface(view.transport.caster(), view.world_from_scanner, ray);
  if (!seen) return 0;
  const Eigen::Vector3d emitter(view.scanner.emitter_offset_m, 0, 0);
  return seen->hit.distance_m + (emitter - seen->point).norm();
}

bool matters(const PhaseCamera& s, std::span<const Tone> tones, const IndirectLight& light) {
  const double indirect_e = light.indirect_e + 3 * light.indirect_error_e;
  const double ambient_e = s.ambient_electrons * light.direct_e / std::max(1.0, s.electrons_at_1m);
  const double noise_e = std::sqrt(tap_variance_e2(s.sensor, light.direct_e + ambient_e));
  double steepest = 0;
  for (const Tone& tone : tones) steepest = std::max(steepest, tone.rad_per_m);
  const double turned = std::min(1.0, 2 * steepest * light.extra_m);
  return indirect_e * s.contrast * turned > turning_share * noise_e ||
         indirect_e > brightness_share * noise_e;
}

}  // namespace

PathNeed path_need(const PhaseCamera& s, const Scene& scene, const EffectSet& effects) {
  const auto any = [&](auto&& is) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [&](const Material& m) { return is(m.bsdf); });
  };
  const bool all =
      effects.everywhere() || (effects.has(Effect::mirror_reflection) && any(has_delta)) ||
      (effects.has(Effect::refraction) && any(is_transmissive)) ||
      (effects.has(Effect::subsurface) && any(is_transmissive)) ||
      (effects.has(Effect::medium) && scene.medium) ||
      (effects.has(Effect::scene_lights) && !scene.lights.empty() && s.electrons_per_w_m2 > 0);
  if (all) return PathNeed::all;
  return effects.has(Effect::interreflection) ? PathNeed::interreflection : PathNeed::none;
}

Ray in_world(const Pose& world_from_scanner, const ScannerRay& ray) {
  return {.origin = world_from_scanner * ray.origin,
          .direction = world_from_scanner.linear() * ray.direction};
}

std::optional<LensRay> draw_view(const PhaseCamera& s, const PixelPlace& pixel,
                                 SampleSequence& random) {
  const Eigen::Vector2d in_pixel = random.next_2d();
  const Eigen::Vector2d lens = to_disk(random.next_2d());
  const Eigen::Vector2d centre(pixel.column, pixel.row);
  const Eigen::Vector2d half(0.5, 0.5);
  return lens_ray(s, s.sub_rays > 1 ? Eigen::Vector2d(centre + in_pixel - half) : centre, lens);
}

EmittedRay Flash::sample(const Eigen::Vector2d& u) const {
  return {.origin = position_, .direction = to_sphere(u), .flux = flux()};
}

double Flash::flux() const {
  return 4 * std::numbers::pi * electrons_at_1m_;
}

void estimate_taps(const PathView& view, std::span<const Tone> tones, const PixelPlace& pixel,
                   std::uint64_t ray, double offset_m, const SamplingGoal& goal,
                   EstimateMemory& memory, Estimate& result) {
  const PixelPaths paths{view, tones, pixel, ray, offset_m};
  const Sensor& sensor = view.scanner.sensor;
  if (view.exposure.frequency >= 0) {
    const auto noise = [&](double mean_e) { return std::sqrt(tap_variance_e2(sensor, mean_e)); };
    const auto draw = [&](int stream, int index, std::span<double> tap) {
      paths.add(stream, index, tap);
    };
    return estimate(1, goal, noise, draw, memory, result);
  }
  const std::size_t frequencies = view.scanner.frequencies_hz.size();
  const Rough rough = rough_light(paths, frequencies);
  const double noise_e = std::sqrt(tap_variance_e2(sensor, rough.mean_e));
  const auto draw = [&](int stream, int index, std::span<double> signals) {
    const auto taps = signals.first(4 * frequencies);
    for (std::size_t f = 0; f < frequencies; ++f)
      signals[taps.size() + f] -= turned(rough, taps, f);
    paths.add(stream, index, taps);
    for (std::size_t f = 0; f < frequencies; ++f)
      signals[taps.size() + f] += turned(rough, taps, f);
  };
  SamplingGoal with_brightness = goal;
  with_brightness.share_of_noise *= brightness_slack;
  estimate(
      5 * frequencies, with_brightness, [&](double) { return noise_e; }, draw, memory, result);
  result.mean.resize(4 * frequencies);
  result.standard_error.resize(4 * frequencies);
}

IndirectLight indirect_light(const PathView& view, const PixelPlace& pixel, std::uint64_t ray,
                             int paths) {
  const int streams = std::min(4, paths);
  const PhaseCamera& s = view.scanner;
  const auto seen = lens_ray(s, Eigen::Vector2d(pixel.column, pixel.row), {0, 0});
  if (!seen) return {};
  const Flash flash(s, view.world_from_scanner);
  const double direct_m = direct_path_m(view, seen->ray);
  PilotReceiver all{direct_m};
  double squares = 0;
  for (int stream = 0; stream < streams; ++stream) {
    PilotReceiver part{direct_m};
    SampleSequence random(view.address.seed, view.address.scan, ray,
                          static_cast<std::uint32_t>(stream));
    for (int i = 0; i < paths / streams; ++i) {
      random.start(static_cast<std::uint32_t>(i));
      trace_path(view.transport, in_world(view.world_from_scanner, seen->ray), flash, random, part);
    }
    all.direct_e += part.direct_e;
    all.indirect_e += part.indirect_e;
    all.extra_me += part.extra_me;
    all.other_w_m2 += part.other_w_m2;
    squares += part.indirect_e * part.indirect_e;
  }
  const double scale = seen->share / (paths / streams * streams);
  const double scatter = std::max(0.0, squares - all.indirect_e * all.indirect_e / streams);
  return {.direct_e = scale * all.direct_e,
          .indirect_e = scale * all.indirect_e,
          .indirect_error_e = scale * std::sqrt(scatter * streams / std::max(streams - 1, 1)),
          .extra_m = all.indirect_e > 0 ? all.extra_me / all.indirect_e : 0,
          .other_e = scale * s.electrons_per_w_m2 * all.other_w_m2};
}

std::vector<char> surroundings_matter(const PathView& view, std::span<const Tone> tones) {
  const Camera& camera = view.scanner.camera;
  const int across = (camera.width_px + tile_px - 1) / tile_px;
  const int down = (camera.height_px + tile_px - 1) / tile_px;
  Image<char> tiles(across, down);
  parallel_for(
      tiles.pixels.size(),
      [&](std::size_t i) {
        const auto [column, row] = place_of(i, across);
        const PixelPlace middle{std::min(column * tile_px + tile_px / 2, camera.width_px - 1),
                                std::min(row * tile_px + tile_px / 2, camera.height_px - 1)};
        tiles.pixels[i] = matters(view.scanner, tones,
                                  indirect_light(view, middle, pilot_address + i, pilot_paths));
      },
      8);
  Image<char> pixels(camera.width_px, camera.height_px);
  for (int row = 0; row < camera.height_px; ++row)
    for (int column = 0; column < camera.width_px; ++column)
      for (int j = std::max(0, row / tile_px - 1); j <= std::min(down - 1, row / tile_px + 1); ++j)
        for (int i = std::max(0, column / tile_px - 1);
             i <= std::min(across - 1, column / tile_px + 1); ++i)
          pixels(column, row) |= tiles(i, j);
  return std::move(pixels.pixels);
}

}  // namespace scan::synth
