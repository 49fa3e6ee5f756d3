// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_readout.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "synth/scanners/phase_shared.h"
#include "synth/scanners/phase_tap_reader.h"

namespace scan::synth {
namespace {

constexpr int band_rows = patch_tile_px;  // whose light is kept at a time, near the processor
constexpr std::size_t pixels_at_once = 64;

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

// The bands of rows whose light is kept at a time.
int band_count(const Readout& r) {
  return (r.scanner.camera.height_px + band_rows - 1) / band_rows;
}

// Calls read(band, first_pixel, light) for every band of rows with its direct light.
template <class Read>
void for_direct_light(const Readout& r, std::span<const Tone> tones, Read&& read) {
  const Camera& camera = r.scanner.camera;
  parallel_for(
      static_cast<std::size_t>(band_count(r)),
      [&](std::size_t band) {
        const int begin = static_cast<int>(band) * band_rows;
        const int end = std::min(camera.height_px, begin + band_rows);
        LightImage light =
            direct_light(r.scanner, tones, r.caster, r.world_from_scanner, {begin, end});
        read(band, static_cast<std::size_t>(begin) * camera.width_px, light);
      },
      1);
}

// Reads those pixels of a band that are wanted by its light.
template <class Wanted>
void read_band(const TapReader& reader, std::size_t first, LightImage& light, Wanted&& wanted) {
  parallel_chunks(light.constant_e.size(), pixels_at_once, [&](std::size_t from, std::size_t to) {
    std::vector<std::size_t> pixels;
    for (std::size_t i = from; i < to; ++i)
      if (wanted(first + i)) pixels.push_back(first + i);
    reader.read(pixels, [&](std::size_t k) { return light.at(pixels[k] - first); });
  });
}

// The patches of a band of rows, among pixels that are wanted.
std::vector<Patch> patches_of_band(const PathView& view, int band,
                                   const std::vector<char>& wanted) {
  const int width = view.scanner.camera.width_px;
  const int tiles = (width + patch_tile_px - 1) / patch_tile_px;
  std::vector<std::vector<Patch>> of_tile(static_cast<std::size_t>(tiles));
  parallel_for(
      of_tile.size(),
      [&](std::size_t tile) {
        const PixelPlace first{static_cast<int>(tile) * patch_tile_px, band * band_rows};
        of_tile[tile] = patches_of(view, first, [&](const PixelPlace& place) {
          return wanted[index_of(place, width)] != 0;
        });
      },
      1);
  std::vector<Patch> all;
  for (auto& patches : of_tile) std::move(patches.begin(), patches.end(), std::back_inserter(all));
  return all;
}

// Adds the indirect light that neighbours share to a band's direct light. `wanted` keeps the pixels
// that it leaves out.
SamplingError add_shared_light(const Readout& r, const PathView& view, std::span<const Tone> tones,
                               int band, LightImage& light, std::vector<char>& wanted) {
  const int width = r.scanner.camera.width_px;
  const std::size_t first = static_cast<std::size_t>(band) * band_rows * width;
  const std::vector<Patch> patches = patches_of_band(view, band, wanted);
  std::vector<std::vector<SharedPixel>> shared(patches.size());
  const auto ray = [&](const PixelPlace& place) { return ray_address(r, index_of(place, width)); };
  const auto light_of = [&](const PixelPlace& place) {
    return light.at(index_of(place, width) - first);
  };
  parallel_for(
      patches.size(),
      [&](std::size_t i) { shared[i] = add_shared_light(view, tones, patches[i], ray, light_of); },
      1);
  SamplingError sum;
  for (const auto& pixels : shared)
    for (const auto& [place, taps] : pixels) {
      wanted[index_of(place, width)] = 0;
      sum.add(r.scanner.sensor, taps);
    }
  return sum;
}

// Reads all pixels but those that want paths of their own, which are left in `wanted`.
SamplingError read_shared_light(const Readout& r, const PathView& view, std::span<const Tone> tones,
                                std::vector<char>& wanted) {
  const TapReader reader(r, tones);
  std::vector<SamplingError> errors(static_cast<std::size_t>(band_count(r)));
  for_direct_light(r, tones, [&](std::size_t band, std::size_t first, LightImage& light) {
    if (r.scanner.aperture_m == 0)  // else blur mixes surfaces
      errors[band] = add_shared_light(r, view, tones, static_cast<int>(band), light, wanted);
    read_band(reader, first, light, [&](std::size_t pixel) { return !wanted[pixel]; });
  });
  SamplingError sum;
  for (const SamplingError& error : errors) sum += error;
  return sum;
}

SamplingError read_own_paths(const Readout& r, const PathView& view, std::span<const Tone> tones,
                             const std::vector<char>& wanted) {
  // enough for each stream to meet its share of bright paths before it may stop
  const SamplingGoal goal{.least_samples = 64};
  return ordered_sum(wanted.size(), 64, SamplingError{}, [&](std::size_t begin, std::size_t end) {
    SamplingError sum;
    EstimateMemory memory;
    Estimate taps;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (!wanted[pixel]) continue;
      estimate_taps(view, tones, place_of(pixel, r.scanner.camera.width_px), ray_address(r, pixel),
                    offset_m(r.scanner, r.address, pixel), goal, memory, taps);
      sum.add(r.scanner.sensor, taps);
      const bool all = r.exposure.frequency < 0;
      read_pixel_taps(r, pixel, [&](int f, int k) { return taps.mean[all ? 4 * f + k : 0]; });
    }
    return sum;
  });
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
  const TapReader reader(r, tones);
  for_direct_light(r, tones, [&](std::size_t, std::size_t first, LightImage& light) {
    read_band(reader, first, light, [](std::size_t) { return true; });
  });
}

SamplingError read_by_paths(const Readout& r, const LightTransport& transport, PathNeed need) {
  const std::vector<Tone> tones = tones_of(r.scanner, r.exposure);
  const PathView view{r.scanner, transport, r.world_from_scanner, r.exposure, r.address};
  std::vector<char> by_own_paths(r.frames.taps[0][0].pixels.size(), 1);
  SamplingError error;
  if (need == PathNeed::interreflection) {
    by_own_paths = surroundings_matter(view, tones);
    error = read_shared_light(r, view, tones, by_own_paths);
  }
  error += read_own_paths(r, view, tones, by_own_paths);
  return error;
}

}  // namespace scan::synth
