// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_readout.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"

namespace scan::synth {
namespace {

constexpr int band_rows = 32;  // whose light is kept at a time, near the processor

// What miscalibration adds to the distance of a pixel. The fixed pattern belongs to the device: it
// is the same for all scans.
double offset_m(const PhaseCamera& s, const RenderAddress& address, std::size_t pixel) {
  constexpr std::uint32_t no_scan = 0xffffffff;
  if (s.pixel_offset_m == 0) return s.range_offset_m;
  return s.range_offset_m + s.pixel_offset_m * RandomStream(address.seed, no_scan, pixel).normal();
}

std::uint64_t ray_address(const Readout& r, std::size_t pixel) {
  return r.index * r.frames.taps[0][0].pixels.size() + pixel;
}

// mean_e(frequency, tap): expected electrons.
template <class Mean>
void read_pixel_taps(const Readout& r, std::size_t pixel, Mean&& mean_e) {
  RandomStream random(r.address.seed, r.address.scan, ray_address(r, pixel));
  const auto read = [&](int f, int k) {
    r.frames.taps[f][k].pixels[pixel] =
        read_pixel(r.scanner.sensor, r.reading, std::max(0.0, mean_e(f, k)), random);
  };
  if (r.exposure.frequency >= 0) return read(r.exposure.frequency, r.exposure.tap);
  for (int f = 0; f < static_cast<int>(r.frames.taps.size()); ++f)
    for (int k = 0; k < 4; ++k) read(f, k);
}

void read_light(const Readout& r, std::span<const Tone> tones, std::size_t pixel,
                const LightSum& light) {
  const double moved_m = 2 * offset_m(r.scanner, r.address, pixel);
  if (moved_m != 0)
    for (std::size_t t = 0; t < tones.size(); ++t)
      light.amplitude_e[t] *= std::polar(1.0, tones[t].rad_per_m * moved_m);
  read_pixel_taps(r, pixel, [&](int frequency, int tap) {
    double mean = light.constant_e;
    for (std::size_t t = 0; t < tones.size(); ++t)
      if (tones[t].frequency == frequency)
        mean += modulation(light.amplitude_e[t], tones[t].harmonic, tap);
    return mean;
  });
}

// Calls read(pixel, light) for every pixel with its direct light.
template <class Read>
void for_direct_light(const Readout& r, std::span<const Tone> tones, Read&& read) {
  const Camera& camera = r.scanner.camera;
  const int bands = (camera.height_px + band_rows - 1) / band_rows;
  parallel_for(
      static_cast<std::size_t>(bands),
      [&](std::size_t band) {
        const int begin = static_cast<int>(band) * band_rows;
        const int end = std::min(camera.height_px, begin + band_rows);
        LightImage light =
            direct_light(r.scanner, tones, r.caster, r.world_from_scanner, {begin, end});
        const std::size_t first = static_cast<std::size_t>(begin) * camera.width_px;
        parallel_for(light.constant_e.size(), [&](std::size_t i) { read(first + i, light.at(i)); });
      },
      1);
}

}  // namespace

void SamplingError::add(const Sensor& sensor, const Estimate& estimate) {
  paths += static_cast<std::uint64_t>(estimate.samples);
  for (std::size_t i = 0; i < estimate.mean.size(); ++i) {
    if (!(estimate.mean[i] > 0)) continue;
    const double share =
        estimate.standard_error[i] / std::sqrt(tap_variance_e2(sensor, estimate.mean[i]));
    squares += share * share;
    largest = std::max(largest, share);
    ++taps;
  }
}

SamplingError& SamplingError::operator+=(const SamplingError& other) {
  paths += other.paths;
  squares += other.squares;
  largest = std::max(largest, other.largest);
  taps += other.taps;
  return *this;
}

RenderStatistics SamplingError::statistics() const {
  return {.paths = paths,
          .sampling_error_rms = taps > 0 ? std::sqrt(squares / static_cast<double>(taps)) : 0,
          .sampling_error_max = largest};
}

void read_direct_light(const Readout& r) {
  const std::vector<Tone> tones = tones_of(r.scanner, r.exposure);
  for_direct_light(r, tones, [&](std::size_t pixel, const LightSum& light) {
    read_light(r, tones, pixel, light);
  });
}

SamplingError read_by_paths(const Readout& r, const LightTransport& transport, PathNeed need) {
  const std::vector<Tone> tones = tones_of(r.scanner, r.exposure);
  const PathView view{r.scanner, transport, r.world_from_scanner, r.exposure, r.address};
  std::vector<char> by_paths(r.frames.taps[0][0].pixels.size(), 1);
  if (need == PathNeed::interreflection) {
    by_paths = surroundings_matter(view, tones);
    for_direct_light(r, tones, [&](std::size_t pixel, const LightSum& light) {
      if (!by_paths[pixel]) read_light(r, tones, pixel, light);
    });
  }
  // enough for each stream to meet its share of bright paths before it may stop
  const SamplingGoal goal{.least_samples = 64};
  return ordered_sum(by_paths.size(), 64, SamplingError{}, [&](std::size_t begin, std::size_t end) {
    SamplingError sum;
    EstimateMemory memory;
    Estimate taps;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (!by_paths[pixel]) continue;
      estimate_taps(view, tones, place_of(pixel, r.scanner.camera.width_px), ray_address(r, pixel),
                    offset_m(r.scanner, r.address, pixel), goal, memory, taps);
      sum.add(r.scanner.sensor, taps);
      const bool all = r.exposure.frequency < 0;
      read_pixel_taps(r, pixel, [&](int f, int k) { return taps.mean[all ? 4 * f + k : 0]; });
    }
    return sum;
  });
}

}  // namespace scan::synth
