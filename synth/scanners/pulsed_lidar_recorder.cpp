// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar_recorder.h"

#include <algorithm>
#include <limits>

#include "synth/scanners/first_surface.h"

namespace scan::synth {
namespace {

// Less light than this changes a reading in one of a million samples, by one electron.
constexpr double least_signal_e = 1e-6;

constexpr std::size_t per_block = 4;  // numbers of a stream
// Where a ray's stream has the words of its dark samples, and those of sample i that is read by
// itself: i times as many blocks later as a reading can need.
constexpr std::uint32_t dark_block = 1u << 29, dark_more_block = 1u << 30, alone_block = 1u << 31;
constexpr std::uint32_t blocks_alone = 256;

SampleRange add_pulse(const LidarScan& scan, const Echo& echo, std::span<double> samples) {
  if (!scan.pulse.exists() || echo.sigma_s != scan.beam.scanner.pulse_sigma_s)
    return add_echo(scan.axis, echo, samples);
  return scan.pulse.add((echo.time_s - scan.axis.start_s) / scan.axis.interval_s, echo.electrons,
                        samples);
}

}  // namespace

LidarScan prepare_scan(const LidarBeam& beam, const RenderAddress& address,
                       const EffectSet& effects) {
  const PulsedLidar& s = beam.scanner;
  const Scene& scene = beam.caster.scene();
  const DetectorEffects reading = detector_effects(effects);
  LidarScan scan{.beam = beam,
                 .axis = sample_axis(s),
                 .reading = reading,
                 .address = address,
                 .pulse = PulseTable(s.pulse_sigma_s / s.sample_interval_s),
                 .detector = BlockDetector(s.sensor, reading),
                 .dark = ReadingTable(s.sensor, reading, s.ambient_electrons),
                 .fog = {},
                 .paths = {}};
  if (LidarPaths::needed(s, scene, effects)) scan.paths.emplace(s, beam.caster, effects, scan.axis);
  const bool known = !scan.paths || scan.paths->straight_is_known();
  if (known && effects.has(Effect::medium) && scene.medium)
    scan.fog.emplace(s, *scene.medium, scan.axis);
  return scan;
}

LidarRecorder::LidarRecorder(const LidarScan& scan)
    : scan_(scan), signal_e_(static_cast<std::size_t>(scan.axis.samples), 0.0) {}

std::span<const std::uint16_t> LidarRecorder::read(std::span<const Pulse> pulses) {
  expected_e_.clear();
  lit_.clear();
  starts_.clear();
  blocks_.clear();
  const bool straight = !scan_.paths || scan_.paths->straight_is_known();
  if (straight) scan_.beam.echoes(pulses, echoes_);
  for (std::size_t i = 0, begin = 0; i < pulses.size(); ++i) {
    const std::size_t end = straight ? echoes_.ends[i] : 0;
    const auto echoes = std::span(echoes_.echoes).subspan(begin, end - begin);
    collect(pulses[i].ray, light(pulses[i], echoes));
    begin = end;
  }
  readings_.resize(pulses.size() * samples());
  detect();
  read_dark(pulses);
  for (std::size_t i = 0; i < pulses.size(); ++i)
    std::copy_n(detected_.begin() + static_cast<std::ptrdiff_t>(starts_[i]),
                lit_[i].behind - lit_[i].first,
                readings_.begin() + static_cast<std::ptrdiff_t>(i * samples() + lit_[i].first));
  return readings_;
}

void LidarRecorder::collect(std::size_t ray, const SampleRange& lit) {
  const std::size_t count = lit.behind - lit.first, start = expected_e_.size();
  const std::size_t blocks = (count + per_block - 1) / per_block;
  lit_.push_back(lit);
  starts_.push_back(start);
  for (std::size_t b = 0; b < blocks; ++b) blocks_.push_back({ray, b});
  const double ambient_e = scan_.beam.scanner.ambient_electrons;
  expected_e_.resize(start + per_block * blocks, ambient_e);
  double* const expected_e = expected_e_.data() + start;
  double* const signal_e = signal_e_.data() + lit.first;
  for (std::size_t i = 0; i < count; ++i) expected_e[i] = ambient_e + signal_e[i];
  std::fill_n(signal_e, count, 0.0);
}

void LidarRecorder::detect() {
  const PulsedLidar& s = scan_.beam.scanner;
  detected_.resize(expected_e_.size());
  if (scan_.detector.needs_normals()) {
    normals_.resize(expected_e_.size());
    draw_normals(scan_.address.seed, scan_.address.scan, blocks_, normals_);
  }
  scan_.detector.read(expected_e_, normals_, detected_, [&](std::size_t i) {
    const auto& [ray, block] = blocks_[i / per_block];
    const auto sample = static_cast<std::uint32_t>(per_block * block + i % per_block);
    RandomStream random(scan_.address.seed, scan_.address.scan, ray,
                        alone_block + blocks_alone * sample);
    const bool lit = expected_e_[i] > s.ambient_electrons + least_signal_e;
    return lit ? read_pixel(s.sensor, scan_.reading, expected_e_[i], random)
               : scan_.dark.draw(random);
  });
}

void LidarRecorder::read_dark(std::span<const Pulse> pulses) {
  const auto words_of = [&](const SampleRange& lit) {
    return scan_.dark.words_for(lit.first) + scan_.dark.words_for(samples() - lit.behind);
  };
  blocks_.clear();
  for (std::size_t i = 0; i < pulses.size(); ++i)
    for (std::size_t b = 0; b < (words_of(lit_[i]) + per_block - 1) / per_block; ++b)
      blocks_.push_back({pulses[i].ray, dark_block + b});
  words_.resize(per_block * blocks_.size());
  draw_words(scan_.address.seed, scan_.address.scan, blocks_, words_);
  std::size_t word = 0;
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    const auto window = std::span(readings_).subspan(i * samples(), samples());
    const std::size_t before = scan_.dark.words_for(lit_[i].first), all = words_of(lit_[i]);
    const auto words = std::span<const std::uint32_t>(words_).subspan(word, all);
    RandomStream more(scan_.address.seed, scan_.address.scan, pulses[i].ray, dark_more_block);
    scan_.dark.draw(words.first(before), more, window.first(lit_[i].first));
    scan_.dark.draw(words.subspan(before), more, window.subspan(lit_[i].behind));
    word += (all + per_block - 1) / per_block * per_block;
  }
}

SampleRange LidarRecorder::light(const Pulse& pulse, std::span<Echo> echoes) {
  const PulsedLidar& s = scan_.beam.scanner;
  const LidarPaths::Beam beam{*pulse.world_from_scanner, pulse.direction, scan_.address, pulse.ray};
  SampleRange lit{signal_e_.size(), 0};
  if (scan_.fog) lit = veil(pulse, echoes);
  walk_.clear();
  if (s.range_walk.per_decade_s != 0) {
    arrivals_.assign(echoes.begin(), echoes.end());
    if (scan_.paths) scan_.paths->find(beam, arrivals_, memory_);
    walk_ = delayed_pulses(s.range_walk, s.pulse_sigma_s, arrivals_);
  }
  for (Echo& echo : echoes) {
    echo.time_s += delay_s(walk_, echo.time_s);
    const SampleRange touched = add_pulse(scan_, echo, signal_e_);
    if (touched.first == touched.behind) continue;
    lit = {std::min(lit.first, touched.first), std::max(lit.behind, touched.behind)};
  }
  if (scan_.paths) {
    quality_ += scan_.paths->add(beam, walk_, signal_e_, memory_);
    lit = {0, signal_e_.size()};
  }
  return {std::min(lit.first, lit.behind), lit.behind};
}

SampleRange LidarRecorder::veil(const Pulse& pulse, std::span<Echo> echoes) {
  const auto end =
      first_surface(scan_.beam.caster, *pulse.world_from_scanner, {.direction = pulse.direction});
  const double far_m = end ? end->point.norm() : std::numeric_limits<double>::infinity();
  scan_.fog->dim(echoes);
  return scan_.fog->add(far_m, signal_e_);
}

}  // namespace scan::synth
