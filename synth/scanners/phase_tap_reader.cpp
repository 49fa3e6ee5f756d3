// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_tap_reader.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {
namespace {

constexpr std::size_t per_block = 4;  // numbers of a stream
// Where a pixel's stream has the tap i that is read by itself: i times as many blocks later as a
// reading can need.
constexpr std::uint32_t alone_block = 1u << 31, blocks_alone = 256;

}  // namespace

struct TapReader::Memory {
  std::vector<BlockAddress> blocks;
  std::vector<double> expected_e;
  std::vector<float> normals;
  std::vector<std::uint16_t> readings;
};

double offset_m(const PhaseCamera& s, const RenderAddress& address, std::size_t pixel) {
  constexpr std::uint32_t no_scan = 0xffffffff;
  if (s.pixel_offset_m == 0) return s.range_offset_m;
  return s.range_offset_m + s.pixel_offset_m * RandomStream(address.seed, no_scan, pixel).normal();
}

std::uint64_t ray_address(const Readout& r, std::size_t pixel) {
  return r.index * r.frames.taps[0][0].pixels.size() + pixel;
}

TapReader::TapReader(const Readout& readout, std::span<const Tone> tones)
    : r_(readout), tones_(tones), detector_(readout.scanner.sensor, readout.reading) {
  const Exposure& exposed = readout.exposure;
  for (int f = 0; f < static_cast<int>(readout.frames.taps.size()); ++f)
    for (int k = 0; k < 4; ++k)
      if (all() || (f == exposed.frequency && k == exposed.tap))
        taps_.push_back(readout.frames.taps[f][k].pixels.data());
}

void TapReader::read(std::span<const std::size_t> pixels,
                     const std::function<LightSum(std::size_t)>& light_of) const {
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

void TapReader::expect(std::size_t pixel, const LightSum& light,
                       std::span<double> expected_e) const {
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

void TapReader::detect(Memory& memory) const {
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

void TapReader::deliver(const Memory& memory, std::size_t k, std::size_t pixel) const {
  const std::uint16_t* reading = &memory.readings[k * frequencies() * per_block];
  for (std::uint16_t* const tap : taps_) tap[pixel] = *reading++;
}

}  // namespace scan::synth
