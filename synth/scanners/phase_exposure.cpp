// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_exposure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libscan/core/parallel.h"

namespace scan::synth {
namespace {

constexpr int rim_px = 2;

// The central rays' light of some rows with a rim around them.
struct CentralLight {
  int width;  // with the rim
  LightImage light;
  std::vector<char> textured;

  // Of a pixel whose row is counted from the first of the rows.
  std::size_t index(const PixelPlace& pixel) const {
    return static_cast<std::size_t>(pixel.row + rim_px) * width + pixel.column + rim_px;
  }
};

bool is_textured(const Scene& scene, const Hit& hit) {
  return !std::holds_alternative<PlainTexture>(
      scene.materials[scene.objects[hit.object].material].texture);
}

CentralLight central_light(const DirectLight& light, const RayCaster& caster,
                           const Pose& world_from_scanner, const Rows& rows) {
  const PhaseCamera& s = light.scanner;
  const int width = s.camera.width_px + 2 * rim_px;
  const int height = rows.end - rows.begin + 2 * rim_px;
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  CentralLight central{width, LightImage(pixels, light.tones.size()), std::vector<char>(pixels)};
  const bool pinhole = is_pinhole(s);
  parallel_chunks(pixels, ViewBatch::most, [&](std::size_t begin, std::size_t end) {
    ViewBatch batch;
    TileWalk walk(begin, width, height);
    for (std::size_t i = begin; i < end; ++i, walk.next()) {
      const auto [column, row] = walk.place();
      const Eigen::Vector2d place(column - rim_px, rows.begin + row - rim_px);
      const std::size_t owner = index_of(walk.place(), width);
      if (pinhole)
        batch.add(place, owner);
      else if (const auto view = lens_ray(s, place, {0, 0}))
        batch.add(world_from_scanner, *view, owner);
    }
    if (pinhole) batch.aim(s, world_from_scanner);
    batch.trace(s, caster, world_from_scanner);
    light.add(batch, [&](std::size_t owner) { return central.light.at(owner); });
    for (std::size_t i = 0; i < batch.size(); ++i)
      central.textured[batch.owner(i)] = batch.hit(i) && is_textured(light.scene, *batch.hit(i));
  });
  return central;
}

// At most how much a signal's mean over a pixel differs from the value at its centre, by the second
// differences of five values in a row of which it is the middle: at its neighbours and `here`. A
// step within the pixel moves the mean by at most half of its height, which is what the second
// difference shows of it; a kink moves it by 1/8. A step or kink also shows as a change of the
// second difference from pixel to pixel, of twice the step. Where that is small the surface is
// smooth, and the mean is off by 1/24 of the second difference along each axis.
double unevenness(double before, double here, double after) {
  const double change = std::max(std::abs(after - here), std::abs(here - before));
  return std::min(std::abs(here) / 2, change / 4 + std::abs(here) / 12);
}

// Of the constant part, which shows brightness, over one row of pixels `step` apart.
double brightness_e(const LightImage& light, std::size_t pixel, std::size_t step) {
  const auto second = [&](std::size_t i) {
    return light.constant_e[i - step] - 2 * light.constant_e[i] + light.constant_e[i + step];
  };
  return unevenness(second(pixel - step), second(pixel), second(pixel + step));
}

// Of a phasor's component across the phasor in the middle, times that one's length, over one row.
double turning_e2(const LightImage& light, std::size_t phasor, std::size_t stride) {
  const std::complex<double> middle = light.amplitude_e[phasor];
  const auto across = [&](std::size_t i) {
    const std::complex<double> second =
        light.amplitude_e[i - stride] - 2.0 * light.amplitude_e[i] + light.amplitude_e[i + stride];
    return middle.real() * second.imag() - middle.imag() * second.real();
  };
  return unevenness(across(phasor - stride), across(phasor), across(phasor + stride));
}

bool is_even(const PhaseCamera& s, const CentralLight& central, std::size_t pixel) {
  if (central.textured[pixel]) return false;
  const LightImage& light = central.light;
  const double variance_e2 = tap_variance_e2(s.sensor, light.constant_e[pixel]);
  const double noise_e = std::sqrt(variance_e2);
  const auto width = static_cast<std::size_t>(central.width);
  const std::array<std::size_t, 4> steps = {1, width - 1, width, width + 1};
  for (const std::size_t step : steps)
    if (brightness_e(light, pixel, step) > brightness_share * noise_e) return false;
  for (std::size_t t = 0; t < light.tones; ++t) {
    const std::size_t phasor = pixel * light.tones + t;
    const double limit_e4 =
        turning_share * turning_share * variance_e2 * std::norm(light.amplitude_e[phasor]);
    for (const std::size_t step : steps) {
      const double turning = turning_e2(light, phasor, step * light.tones);
      if (turning * turning > limit_e4) return false;
    }
  }
  return true;
}

// All sub-rays of those pixels among [begin, end), counted in tiles from the first row, that are
// wanted.
template <class Wanted>
void add_sub_rays(const DirectLight& light, const RayCaster& caster, const Pose& world_from_scanner,
                  const Rows& rows, std::size_t begin, std::size_t end, Wanted&& wanted,
                  LightImage& image) {
  const PhaseCamera& s = light.scanner;
  const bool pinhole = is_pinhole(s);
  ViewBatch batch;
  const auto flush = [&] {
    if (pinhole) batch.aim(s, world_from_scanner);
    batch.trace(s, caster, world_from_scanner);
    light.add(batch, [&](std::size_t owner) { return image.at(owner); });
    batch.clear();
  };
  TileWalk walk(begin, s.camera.width_px, rows.end - rows.begin);
  for (std::size_t i = begin; i < end; ++i, walk.next()) {
    PixelPlace place = walk.place();
    const std::size_t pixel = index_of(place, s.camera.width_px);
    if (!wanted(pixel)) continue;
    place.row += rows.begin;
    for (int ray = 0; ray < s.sub_rays * s.sub_rays; ++ray) {
      const Eigen::Vector2d seen(place.column, place.row);
      if (pinhole)
        batch.add(s.sub_rays == 1 ? seen : sub_pixel(place, ray, s.sub_rays), pixel);
      else if (const auto view = sub_ray(s, place, ray))
        batch.add(world_from_scanner, *view, pixel);
      if (batch.full()) flush();
    }
  }
  flush();
}

void copy(const LightSum& from, const LightSum& to) {
  to.constant_e = from.constant_e;
  std::copy(from.amplitude_e.begin(), from.amplitude_e.end(), to.amplitude_e.begin());
}

}  // namespace

std::vector<Exposure> exposures_of(const PhaseCamera& s) {
  const bool still = s.velocity_m_s.isZero(0) && s.angular_velocity_rad_s.isZero(0);
  if (s.tap_interval_s == 0 || still) return {Exposure{}};
  const int taps = 4 * static_cast<int>(s.frequencies_hz.size());
  std::vector<Exposure> exposures;
  for (int i = 0; i < taps; ++i)
    exposures.push_back({(i - (taps - 1) / 2.0) * s.tap_interval_s, i / 4, i % 4});
  return exposures;
}

Pose moved(const Pose& world_from_scanner, const PhaseCamera& s, double time_s) {
  Vector6 twist;
  twist << s.angular_velocity_rad_s, s.velocity_m_s;
  return world_from_scanner * exp(time_s * twist);
}

std::vector<Tone> tones_of(const PhaseCamera& s, const Exposure& exposure) {
  std::vector<Tone> tones = tones_of(s);
  if (exposure.frequency >= 0)
    std::erase_if(tones, [&](const Tone& tone) { return tone.frequency != exposure.frequency; });
  return tones;
}

double tap_variance_e2(const Sensor& sensor, double mean_e) {
  return std::max(mean_e, 1.0) + sensor.read_noise_e * sensor.read_noise_e +
         sensor.gain_e_per_dn * sensor.gain_e_per_dn / 12;
}

LightImage direct_light(const PhaseCamera& s, std::span<const Tone> tones, const RayCaster& caster,
                        const Pose& world_from_scanner, const Rows& rows) {
  const int width = s.camera.width_px;
  const std::size_t pixels = static_cast<std::size_t>(width) * (rows.end - rows.begin);
  LightImage image(pixels, tones.size());
  DirectLight light{s, caster.scene(), tones, world_from_scanner.linear().transpose()};
  const DirectLight sub_light{s, caster.scene(), tones, light.scanner_from_world,
                              1.0 / (s.sub_rays * s.sub_rays)};
  const auto add = [&](std::size_t begin, std::size_t end, auto&& wanted) {
    add_sub_rays(sub_light, caster, world_from_scanner, rows, begin, end, wanted, image);
  };
  if (s.sub_rays == 1 || s.aperture_m != 0) {  // blur may reach further than the next pixels
    parallel_chunks(pixels, ViewBatch::most, [&](std::size_t begin, std::size_t end) {
      add(begin, end, [](std::size_t) { return true; });
    });
    return image;
  }
  CentralLight central = central_light(light, caster, world_from_scanner, rows);
  std::vector<char> refined(pixels);
  parallel_chunks(pixels, ViewBatch::most, [&](std::size_t begin, std::size_t end) {
    TileWalk walk(begin, width, rows.end - rows.begin);
    for (std::size_t i = begin; i < end; ++i, walk.next()) {
      const std::size_t pixel = index_of(walk.place(), width);
      const std::size_t centre = central.index(walk.place());
      refined[pixel] = !is_even(s, central, centre);
      if (!refined[pixel]) copy(central.light.at(centre), image.at(pixel));
    }
    add(begin, end, [&](std::size_t i) { return refined[i] != 0; });
  });
  image.refined_pixels = static_cast<std::size_t>(std::count(refined.begin(), refined.end(), 1));
  return image;
}

}  // namespace scan::synth
