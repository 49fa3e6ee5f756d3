// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_shared.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {
namespace {

constexpr double goal = 0.2 * 0.2;  // square of the error over the noise: see SamplingGoal
constexpr int least_paths = 1024, most_per_pixel = 4096;
constexpr int least_side_px = 8;
constexpr std::size_t least_pixels = 9;                          // for three functions
constexpr std::uint64_t patch_address = std::uint64_t{1} << 41;  // beyond all pixels and pilots

// A part of a patch that is fitted as a whole.
struct Part {
  std::size_t begin = 0, end = 0;
  int side_px = patch_tile_px;
  int per_stream = 0;  // paths of each pixel so far
  std::size_t size() const { return end - begin; }
};

// Adds the indirect light of a path to the signals of PatchReadings.
struct IndirectReceiver {
  std::span<const Tone> tones;
  double share;
  double extra_m;  // less the way from surface to lens
  std::span<double> signals;

  void device_light(double electrons, double path_m, int scatterings) {
    if (scatterings == 1) return;
    signals[0] += share * electrons;
    for (std::size_t t = 0; t < tones.size(); ++t) {
      const auto phasor = std::polar(share * electrons, tones[t].rad_per_m * (path_m + extra_m));
      signals[1 + 2 * t] += tones[t].contrast * phasor.real();
      signals[2 + 2 * t] += tones[t].contrast * phasor.imag();
    }
  }
  void other_light(double /*w_m2*/) {}
};

class SharedPaths {
 public:
  SharedPaths(const PathView& view, std::span<const Tone> tones, const Patch& patch,
              const RayOf& ray, const LightOf& light_of)
      : view_(view),
        tones_(tones),
        patch_(patch),
        ray_(ray),
        readings_(view, tones, light_of),
        signals_(readings_.signals()) {
    for (auto& sums : sums_) sums.assign(patch.size() * signals_, 0);
  }

  void solve(Part part);
  std::vector<SharedPixel> take() { return std::move(result_); }

 private:
  std::span<const PatchPixel> pixels_of(const Part& part) const {
    return std::span(patch_).subspan(part.begin, part.size());
  }
  void draw(const Part& part, std::uint64_t address, int from, int to);
  PatchFit fit(const Part& part, const PatchBasis& basis) const;
  void finish(const Part& part, const PatchFit& fit, Eigen::Index functions, const Misfit& misfit);
  void quarter(const Part& part);

  const PathView& view_;
  std::span<const Tone> tones_;
  const Patch& patch_;
  const RayOf& ray_;
  PatchReadings readings_;
  std::size_t signals_;
  std::array<std::vector<double>, patch_streams> sums_;  // [pixel * signals + signal]
  std::vector<SharedPixel> result_;
};

// Each size of part has sequences of its own.
std::uint64_t address_of(const Part& part, std::uint64_t first_ray) {
  return patch_address * static_cast<std::uint64_t>(part.side_px) + first_ray;
}

// A pixel's paths follow one another: indices a power of two apart would give it the same
// directions again and again, while an aligned block of pixels, and of paths, has all of them.
void SharedPaths::draw(const Part& part, std::uint64_t address, int from, int to) {
  const PhaseCamera& s = view_.scanner;
  const Flash flash(s, view_.world_from_scanner);
  for (int k = 0; k < patch_streams; ++k) {
    SampleSequence random(view_.address.seed, view_.address.scan, address,
                          static_cast<std::uint32_t>(k));
    auto index = static_cast<std::uint32_t>(from * part.size());
    for (std::size_t i = part.begin; i < part.end; ++i)
      for (int path = from; path < to; ++path) {
        random.start(index++);
        const auto seen = draw_view(s, patch_[i].place, random);
        if (!seen) continue;
        IndirectReceiver receiver{tones_, seen->share, seen->extra_m - patch_[i].distance_m,
                                  std::span(sums_[k]).subspan(i * signals_, signals_)};
        trace_path(view_.transport, in_world(view_.world_from_scanner, seen->ray), flash, random,
                   receiver);
      }
  }
}

PatchFit SharedPaths::fit(const Part& part, const PatchBasis& basis) const {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::array<Eigen::MatrixXd, patch_streams> means;
  for (int k = 0; k < patch_streams; ++k)
    means[k] = Eigen::Map<const Rows>(&sums_[k][part.begin * signals_],
                                      static_cast<Eigen::Index>(part.size()),
                                      static_cast<Eigen::Index>(signals_)) /
               part.per_stream;
  return fit_patch(basis, means);
}

// Adds what the first functions fit to the light of the part's pixels.
void SharedPaths::finish(const Part& part, const PatchFit& fit, Eigen::Index functions,
                         const Misfit& misfit) {
  for (std::size_t i = part.begin; i < part.end; ++i) {
    const PatchPixel& pixel = patch_[i];
    const LightSum light = readings_.direct(pixel);
    const Eigen::RowVectorXd row =
        fit.basis.functions.row(static_cast<Eigen::Index>(i - part.begin)).head(functions);
    std::array<Eigen::ArrayXd, patch_streams> reading;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(signals_));
    for (int k = 0; k < patch_streams; ++k) {
      const Eigen::VectorXd signal = (row * fit.coefficients[k].topRows(functions)).transpose();
      reading[k] = readings_.readings(pixel, signal);
      mean += signal / patch_streams;
    }
    light.constant_e += mean[0];
    for (std::size_t t = 0; t < tones_.size(); ++t)
      light.amplitude_e[t] += readings_.phasor_of(pixel, mean, t);
    const Eigen::ArrayXd square =
        error_e2(spread_of(reading), misfit, readings_.unit_e2(light.constant_e));
    Estimate taps{.samples = patch_streams * part.per_stream};
    for (Eigen::Index j = 0; j < readings_.tap_count(); ++j) {
      taps.mean.push_back(light.constant_e);
      taps.standard_error.push_back(std::sqrt(square[j]));
    }
    result_.push_back({pixel.place, std::move(taps)});
  }
}

void SharedPaths::quarter(const Part& part) {
  const int half = part.side_px / 2, codes = half * half;
  for (std::size_t begin = part.begin, end = begin; begin < part.end; begin = end) {
    while (end < part.end && patch_[end].code / codes == patch_[begin].code / codes) ++end;
    solve({begin, end, half, part.per_stream});
  }
}

PatchBasis basis_of(std::span<const PatchPixel> pixels) {
  std::vector<PatchPlace> places;
  for (const PatchPixel& pixel : pixels)
    places.push_back({Eigen::Vector2d(pixel.place.column, pixel.place.row), pixel.normal});
  return patch_basis(places);
}

void SharedPaths::solve(Part part) {
  if (part.size() < least_pixels) return;
  const PatchBasis basis = basis_of(pixels_of(part));
  const std::uint64_t address = address_of(part, ray_(patch_[part.begin].place));
  const int inherited = part.per_stream;
  int wanted = std::max(inherited, 1);
  while (wanted * static_cast<int>(part.size()) < least_paths / patch_streams) wanted *= 2;
  for (;; wanted *= 2) {
    draw(part, address, part.per_stream - inherited, wanted - inherited);
    part.per_stream = wanted;
    const PatchFit fitted = fit(part, basis);
    const std::vector<Misfit> misfits = misfits_of(readings_, pixels_of(part), fitted);
    const auto best =
        std::min_element(misfits.begin(), misfits.end(),
                         [](const Misfit& a, const Misfit& b) { return a.square() < b.square(); });
    const bool is_smallest = part.side_px <= least_side_px;
    if (!is_smallest && misfits.back().is_stiff(goal)) return quarter(part);
    if (is_smallest && misfits.back().is_stiff(goal)) return;
    if (best->square() <= goal || 2 * patch_streams * wanted > most_per_pixel)
      return finish(part, fitted, basis.count[static_cast<std::size_t>(best - misfits.begin()) + 1],
                    *best);
  }
}

}  // namespace

std::vector<SharedPixel> add_shared_light(const PathView& view, std::span<const Tone> tones,
                                          const Patch& patch, const RayOf& ray,
                                          const LightOf& light_of) {
  SharedPaths paths(view, tones, patch, ray, light_of);
  paths.solve({.begin = 0, .end = patch.size()});
  return paths.take();
}

}  // namespace scan::synth
