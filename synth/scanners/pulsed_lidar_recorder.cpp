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

bool has_table(const LidarScan& scan, const Echo& echo) {
  return scan.pulse.exists() && echo.sigma_s == scan.beam.scanner.pulse_sigma_s;
}

double middle_of(const LidarScan& scan, const Echo& echo) {
  return (echo.time_s - scan.axis.start_s) / scan.axis.interval_s;
}

SampleRange add_pulse(const LidarScan& scan, const Echo& echo, std::span<double> samples) {
  if (!has_table(scan, echo)) return add_echo(scan.axis, echo, samples);
  const auto place = scan.pulse.place(middle_of(scan, echo));
  const SampleRange range = scan.pulse.touched(place, samples.size());
  scan.pulse.add(place, echo.electrons, range, samples.data() + range.first);
  return range;
}

SampleRange joined(const SampleRange& a, const SampleRange& b) {
  if (b.first == b.behind) return a;
  if (a.first == a.behind) return b;
  return {std::min(a.first, b.first), std::max(a.behind, b.behind)};
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
    : scan_(scan), samples_(static_cast<std::size_t>(scan.axis.samples)) {}

void LidarRecorder::read(std::span<const Pulse> pulses, std::span<std::uint16_t* const> windows) {
  used_ = 0;
  lit_.clear();
  const bool straight = !scan_.paths || scan_.paths->straight_is_known();
  const bool alone = !scan_.fog && !scan_.paths && scan_.beam.scanner.range_walk.per_decade_s == 0;
  if (straight) scan_.beam.echoes(pulses, echoes_);
  for (std::size_t i = 0, begin = 0; i < pulses.size(); ++i) {
    const std::size_t end = straight ? echoes_.ends[i] : 0;
    const auto echoes = std::span(echoes_.echoes).subspan(begin, end - begin);
    if (alone && echoes.empty())
      open(pulses[i].ray, {});
    else if (alone && echoes.size() == 1 && has_table(scan_, echoes[0]))
      add_lone(pulses[i], echoes[0]);
    else
      add_light(pulses[i], echoes);
    begin = end;
  }
  detect();
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    const auto& [range, start] = lit_[i];
    std::copy_n(detected_.data() + start, range.behind - range.first, windows[i] + range.first);
  }
  read_dark(pulses, windows);
}

double* LidarRecorder::open(std::size_t ray, const SampleRange& range) {
  const std::size_t start = used_;
  const std::size_t blocks = (range.behind - range.first + per_block - 1) / per_block;
  used_ += per_block * blocks;
  if (expected_e_.size() < used_) {
    expected_e_.resize(2 * used_);
    blocks_.resize(expected_e_.size() / per_block);
    detected_.resize(expected_e_.size());
  }
  lit_.push_back({range, start});
  if (scan_.detector.needs_normals())  // else all are read in closed form
    for (std::size_t b = 0; b < blocks; ++b) blocks_[start / per_block + b] = {ray, b};
  double* const expected_e = expected_e_.data() + start;
  std::fill_n(expected_e, per_block * blocks, scan_.beam.scanner.ambient_electrons);
  return expected_e;
}

void LidarRecorder::detect() {
  const PulsedLidar& s = scan_.beam.scanner;
  const auto expected_e = std::span(expected_e_).first(used_);
  if (scan_.detector.needs_normals()) {
    if (normals_.size() < used_) normals_.resize(expected_e_.size());
    draw_normals(scan_.address.seed, scan_.address.scan,
                 std::span(blocks_).first(used_ / per_block), normals_);
  }
  const auto read_one = [&](std::size_t i) {
    const auto& [ray, block] = blocks_[i / per_block];
    const auto sample = static_cast<std::uint32_t>(per_block * block + i % per_block);
    RandomStream random(scan_.address.seed, scan_.address.scan, ray,
                        alone_block + blocks_alone * sample);
    const bool lit = expected_e[i] > s.ambient_electrons + least_signal_e;
    return lit ? read_pixel(s.sensor, scan_.reading, expected_e[i], random)
               : scan_.dark.draw(random);
  };
  scan_.detector.read(expected_e, normals_, std::span(detected_).first(used_), read_one);
}

void LidarRecorder::read_dark(std::span<const Pulse> pulses,
                              std::span<std::uint16_t* const> windows) {
  const auto words_of = [&](const SampleRange& lit) {
    return scan_.dark.words_for(lit.first) + scan_.dark.words_for(samples_ - lit.behind);
  };
  dark_blocks_.clear();
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    const std::size_t count = (words_of(lit_[i].range) + per_block - 1) / per_block;
    for (std::size_t b = 0; b < count; ++b) dark_blocks_.push_back({pulses[i].ray, dark_block + b});
  }
  words_.resize(per_block * dark_blocks_.size());
  draw_words(scan_.address.seed, scan_.address.scan, dark_blocks_, words_);
  std::size_t word = 0;
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    const SampleRange& lit = lit_[i].range;
    if (lit.behind - lit.first == samples_) continue;
    const auto window = std::span(windows[i], samples_);
    const std::size_t before = scan_.dark.words_for(lit.first), all = words_of(lit);
    const auto words = std::span<const std::uint32_t>(words_).subspan(word, all);
    RandomStream more(scan_.address.seed, scan_.address.scan, pulses[i].ray, dark_more_block);
    scan_.dark.draw(words.first(before), more, window.first(lit.first));
    scan_.dark.draw(words.subspan(before), more, window.subspan(lit.behind));
    word += (all + per_block - 1) / per_block * per_block;
  }
}

void LidarRecorder::add_lone(const Pulse& pulse, const Echo& echo) {
  const auto place = scan_.pulse.place(middle_of(scan_, echo));
  const SampleRange lit = scan_.pulse.touched(place, samples_);
  scan_.pulse.add(place, echo.electrons, lit, open(pulse.ray, lit));
}

void LidarRecorder::add_light(const Pulse& pulse, std::span<Echo> echoes) {
  const PulsedLidar& s = scan_.beam.scanner;
  const LidarPaths::Beam beam{*pulse.world_from_scanner, pulse.direction, scan_.address, pulse.ray};
  signal_e_.assign(samples_, 0.0);
  SampleRange lit;
  if (scan_.fog) lit = veil(pulse, echoes);
  walk_.clear();
  if (s.range_walk.per_decade_s != 0) {
    arrivals_.assign(echoes.begin(), echoes.end());
    if (scan_.paths) scan_.paths->find(beam, arrivals_, memory_);
    walk_ = delayed_pulses(s.range_walk, s.pulse_sigma_s, arrivals_);
  }
  for (Echo& echo : echoes) {
    echo.time_s += delay_s(walk_, echo.time_s);
    lit = joined(lit, add_pulse(scan_, echo, signal_e_));
  }
  if (scan_.paths) {
    quality_ += scan_.paths->add(beam, walk_, signal_e_, memory_);
    lit = {0, samples_};
  }
  double* const expected_e = open(pulse.ray, lit);
  for (std::size_t i = lit.first; i < lit.behind; ++i) expected_e[i - lit.first] += signal_e_[i];
}

SampleRange LidarRecorder::veil(const Pulse& pulse, std::span<Echo> echoes) {
  const auto end =
      first_surface(scan_.beam.caster, *pulse.world_from_scanner, {.direction = pulse.direction});
  const double far_m = end ? end->point.norm() : std::numeric_limits<double>::infinity();
  scan_.fog->dim(echoes);
  return scan_.fog->add(far_m, signal_e_);
}

}  // namespace scan::synth
