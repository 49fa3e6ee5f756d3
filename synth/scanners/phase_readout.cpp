// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_readout.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/core/random_blocks.h"
#include "synth/block_detector.h"

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

constexpr std::size_t pixels_at_once = 64;
constexpr std::size_t per_block = 4;  // numbers of a stream
// Where a pixel's stream has the tap i that is read by itself: i times as many blocks later as a
// reading can need.
constexpr std::uint32_t alone_block = 1u << 31, blocks_alone = 256;

// Reads the taps of some pixels by their light, each frequency by one block of its pixel's stream.
class TapReader {
 public:
  TapReader(const Readout& readout, std::span<const Tone> tones)
      : r_(readout), tones_(tones), detector_(readout.scanner.sensor, readout.reading) {
    const Exposure& exposed = readout.exposure;
    for (int f = 0; f < static_cast<int>(readout.frames.taps.size()); ++f)
      for (int k = 0; k < 4; ++k)
        if (all() || (f == exposed.frequency && k == exposed.tap))
          taps_.push_back(readout.frames.taps[f][k].pixels.data());
  }

  // light_of(k) of pixels[k].
  template <class LightOf>
  void read(std::span<const std::size_t> pixels, LightOf&& light_of) const {
    Memory memory;
    const std::size_t blocks = pixels.size() * frequencies();
    memory.expected_e.assign(blocks * per_block, 0.0);
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const std::size_t first = k * frequencies() * per_block;
      expect(pixels[k], light_of(k),
             std::span(memory.expected_e).subspan(first, frequencies() * per_block));
      for (std::size_t f = 0; f < frequencies(); ++f)
        memory.blocks.push_back({ray_address(r_, pixels[k]), f});
    }
    detect(memory);
    for (std::size_t k = 0; k < pixels.size(); ++k) deliver(memory, k, pixels[k]);
  }

 private:
  struct Memory {
    std::vector<BlockAddress> blocks;
    std::vector<double> expected_e, normals;
    std::vector<std::uint16_t> readings;
  };

  bool all() const { return r_.exposure.frequency < 0; }
  std::size_t frequencies() const { return all() ? r_.frames.taps.size() : 1; }

  void expect(std::size_t pixel, const LightSum& light, std::span<double> expected_e) const {
    const double moved_m = 2 * offset_m(r_.scanner, r_.address, pixel);
    for (double& e : expected_e) e = light.constant_e;
    for (std::size_t t = 0; t < tones_.size(); ++t) {
      const Tone& tone = tones_[t];
      std::complex<double> amplitude_e = light.amplitude_e[t];
      if (moved_m != 0) amplitude_e *= std::polar(1.0, tone.rad_per_m * moved_m);
      double* const taps_e = &expected_e[all() ? tone.frequency * per_block : 0];
      if (!all()) taps_e[0] += modulation(amplitude_e, tone.harmonic, r_.exposure.tap);
      for (int k = 0; all() && k < 4; ++k) taps_e[k] += modulation(amplitude_e, tone.harmonic, k);
    }
  }

  void detect(Memory& memory) const {
    memory.readings.resize(memory.expected_e.size());
    if (detector_.needs_normals()) {
      memory.normals.resize(memory.expected_e.size());
      draw_normals(r_.address.seed, r_.address.scan, memory.blocks, memory.normals);
    }
    detector_.read(memory.expected_e, memory.normals, memory.readings, [&](std::size_t i) {
      const auto& [ray, block] = memory.blocks[i / per_block];
      const auto tap = static_cast<std::uint32_t>(per_block * block + i % per_block);
      RandomStream random(r_.address.seed, r_.address.scan, ray, alone_block + blocks_alone * tap);
      return read_pixel(r_.scanner.sensor, r_.reading, std::max(0.0, memory.expected_e[i]), random);
    });
  }

  void deliver(const Memory& memory, std::size_t k, std::size_t pixel) const {
    const std::uint16_t* reading = &memory.readings[k * frequencies() * per_block];
    for (std::uint16_t* const tap : taps_) tap[pixel] = *reading++;
  }

  const Readout& r_;
  std::span<const Tone> tones_;
  BlockDetector detector_;
  std::vector<std::uint16_t*> taps_;  // that are exposed
};

// Reads the pixels that are wanted by their direct light.
template <class Wanted>
void read_by_direct_light(const Readout& r, std::span<const Tone> tones, Wanted&& wanted) {
  const Camera& camera = r.scanner.camera;
  const TapReader reader(r, tones);
  const int bands = (camera.height_px + band_rows - 1) / band_rows;
  parallel_for(
      static_cast<std::size_t>(bands),
      [&](std::size_t band) {
        const int begin = static_cast<int>(band) * band_rows;
        const int end = std::min(camera.height_px, begin + band_rows);
        LightImage light =
            direct_light(r.scanner, tones, r.caster, r.world_from_scanner, {begin, end});
        const std::size_t first = static_cast<std::size_t>(begin) * camera.width_px;
        parallel_chunks(
            light.constant_e.size(), pixels_at_once, [&](std::size_t from, std::size_t to) {
              std::vector<std::size_t> pixels;
              for (std::size_t i = from; i < to; ++i)
                if (wanted(first + i)) pixels.push_back(first + i);
              reader.read(pixels, [&](std::size_t k) { return light.at(pixels[k] - first); });
            });
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
  read_by_direct_light(r, tones, [](std::size_t) { return true; });
}

SamplingError read_by_paths(const Readout& r, const LightTransport& transport, PathNeed need) {
  const std::vector<Tone> tones = tones_of(r.scanner, r.exposure);
  const PathView view{r.scanner, transport, r.world_from_scanner, r.exposure, r.address};
  std::vector<char> by_paths(r.frames.taps[0][0].pixels.size(), 1);
  if (need == PathNeed::interreflection) {
    by_paths = surroundings_matter(view, tones);
    read_by_direct_light(r, tones, [&](std::size_t pixel) { return !by_paths[pixel]; });
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
