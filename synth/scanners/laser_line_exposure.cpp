// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_exposure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "libscan/core/parallel.h"

namespace scan::synth {
namespace {

constexpr int tile_px = 8;
constexpr double worthwhile_in_stripe = 0.1;     // of the noise at its top
constexpr double worthwhile_in_dark = 2;         // of the dark's noise; a decoder asks for several
constexpr std::uint64_t tile_rays = 1ull << 62;  // apart from the pixels' own sequences
// What paths leave of error adds a tenth to the noise's variance, but for rare bright paths.
constexpr SamplingGoal goal = {.share_of_noise = 0.3, .least_samples = 16, .most_samples = 128};

double dark_noise_e(const Sensor& sensor) {
  return std::hypot(sensor.read_noise_e, sensor.gain_e_per_dn / std::sqrt(12.0));
}

Image<double> tiles_for(const Camera& camera) {
  return {(camera.width_px + tile_px - 1) / tile_px, (camera.height_px + tile_px - 1) / tile_px};
}

// The largest of each tile and its eight neighbours.
Image<double> dilated(const Image<double>& tiles) {
  Image<double> result = tiles;
  for (int row = 0; row < tiles.height; ++row)
    for (int column = 0; column < tiles.width; ++column)
      for (int y = std::max(0, row - 1); y <= std::min(tiles.height - 1, row + 1); ++y)
        for (int x = std::max(0, column - 1); x <= std::min(tiles.width - 1, column + 1); ++x)
          result(column, row) = std::max(result(column, row), tiles(x, y));
  return result;
}

// The largest of the tiles within half a tile of a pixel.
double around(const Image<double>& tiles, int column, int row) {
  constexpr int half = tile_px / 2;
  double largest = 0;
  for (const int y : {row - half, row + half})
    for (const int x : {column - half, column + half})
      largest = std::max(largest, tiles(std::clamp(x / tile_px, 0, tiles.width - 1),
                                        std::clamp(y / tile_px, 0, tiles.height - 1)));
  return largest;
}

}  // namespace

PathTally& PathTally::operator+=(const PathTally& other) {
  paths += other.paths;
  squares += other.squares;
  largest = std::max(largest, other.largest);
  readings += other.readings;
  return *this;
}

RenderStatistics statistics_of(const PathTally& tally) {
  if (tally.readings == 0) return {.paths = tally.paths};
  return {.paths = tally.paths,
          .sampling_error_rms = std::sqrt(tally.squares / static_cast<double>(tally.readings)),
          .sampling_error_max = tally.largest};
}

LaserExposure::LaserExposure(const LaserSweep& sweep, const LaserView& view, int step)
    : sweep_(sweep), middle_(view), step_(step) {
  if (sweep.scanner.exposure_share == 0) {
    views_.push_back(view);
  } else {
    for (const CameraSample& sample : sweep.samples)
      views_.push_back(view.after(sample.time_steps));
  }
  for (const LaserView& each : views_) emitters_.emplace_back(each);
}

PixelLight LaserExposure::direct(int column, int row) const {
  PixelLight sum;
  for (std::size_t i = 0; i < sweep_.samples.size(); ++i) {
    const auto ray = camera_ray(sweep_.scanner, {column, row}, sweep_.samples[i]);
    if (!ray) continue;
    const PixelLight light = view_of(i).light(*ray);
    sum.laser_e += light.laser_e;
    sum.other_e += light.other_e;
  }
  const double count = static_cast<double>(sweep_.samples.size());
  return {sum.laser_e / count, sum.other_e / count};
}

PixelLight LaserExposure::path(int column, int row, std::size_t sample,
                               SampleSequence& random) const {
  const auto ray = camera_ray(sweep_.scanner, {column, row}, sweep_.samples[sample]);
  if (!ray) return {};
  return trace_light(*sweep_.paths, view_of(sample), emitters_[views_.size() > 1 ? sample : 0],
                     *ray, random);
}

PixelLight LaserExposure::by_paths(int column, int row, const PixelLight& direct,
                                   PathTally& tally) const {
  const Camera& camera = sweep_.scanner.camera;
  const std::uint64_t ray =
      (static_cast<std::uint64_t>(step_) * camera.height_px + row) * camera.width_px + column;
  std::array<SampleSequence, 4> random = {
      SampleSequence(sweep_.address.seed, sweep_.address.scan, ray, 0),
      SampleSequence(sweep_.address.seed, sweep_.address.scan, ray, 1),
      SampleSequence(sweep_.address.seed, sweep_.address.scan, ray, 2),
      SampleSequence(sweep_.address.seed, sweep_.address.scan, ray, 3)};
  const double dark_e = dark_noise_e(sweep_.scanner.sensor);
  const auto noise = [&](double mean_e) {
    return std::sqrt(std::max(0.0, mean_e + direct.laser_e + direct.other_e) + dark_e * dark_e);
  };
  const Estimate found =
      estimate(2, goal, noise, [&](int stream, int index, std::span<double> signals) {
        random[stream].start(static_cast<std::uint32_t>(index));
        const std::size_t sample =
            static_cast<std::size_t>(4 * index + stream) % sweep_.samples.size();
        const PixelLight light = path(column, row, sample, random[stream]);
        signals[0] += light.laser_e;
        signals[1] += light.other_e;
      });
  const double error = std::hypot(found.standard_error[0], found.standard_error[1]) /
                       noise(found.mean[0] + found.mean[1]);
  tally += {.paths = static_cast<std::uint64_t>(found.samples),
            .squares = error * error,
            .largest = error,
            .readings = 1};
  return {found.mean[0], found.mean[1]};
}

Image<std::uint8_t> LaserExposure::lit() const {
  const Camera& camera = sweep_.scanner.camera;
  // ambient light comes from everywhere
  if (sweep_.scanner.ambient_electrons == 0) return lit_band(middle_);
  Image<std::uint8_t> all(camera.width_px, camera.height_px);
  std::fill(all.pixels.begin(), all.pixels.end(), std::uint8_t{1});
  return all;
}

// Each round takes a path through each row and each column of the tile, and another pixel than the
// rounds before.
LaserExposure::TileLight LaserExposure::tile_light(int left, int top,
                                                   std::span<const double> limits_e) const {
  const Camera& camera = sweep_.scanner.camera;
  const std::uint64_t place = static_cast<std::uint64_t>(step_) * camera.height_px + top;
  SampleSequence random(sweep_.address.seed, sweep_.address.scan,
                        tile_rays + place * camera.width_px + left, 0);
  double sum = 0, squares = 0;
  TileLight light;
  for (int round = 0; round < tile_px; ++round) {
    for (int i = 0; i < tile_px; ++i) {
      const int column = left + i, row = top + (3 * i + left / tile_px + round) % tile_px;
      if (column >= camera.width_px || row >= camera.height_px) continue;
      const int index = round * tile_px + i;
      random.start(static_cast<std::uint32_t>(index));
      const PixelLight pixel = path(column, row, index % sweep_.samples.size(), random);
      sum += pixel.laser_e + pixel.other_e;
      squares += (pixel.laser_e + pixel.other_e) * (pixel.laser_e + pixel.other_e);
    }
    light.paths += tile_px;
    const auto n = static_cast<double>(light.paths);
    const double mean = sum / n;
    const double error = std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1));
    light.most_e = mean + 2 * error;
    if (std::none_of(limits_e.begin(), limits_e.end(),
                     [&](double limit_e) { return std::abs(mean - limit_e) < 2 * error; }))
      break;
  }
  return light;
}

// The stripe's top in each tile and those around it, 0 outside its window.
Image<double> LaserExposure::tops(const Image<double>& direct_e) const {
  Image<double> top_e = tiles_for(sweep_.scanner.camera);
  for (int row = 0; row < direct_e.height; ++row)
    for (int column = 0; column < direct_e.width; ++column) {
      double& top = top_e(column / tile_px, row / tile_px);
      top = std::max(top, direct_e(column, row));
    }
  return dilated(top_e);
}

Image<std::uint8_t> LaserExposure::brightened(const Image<std::uint8_t>& lit,
                                              const Image<double>& direct_e,
                                              PathTally& tally) const {
  const Image<double> top_e = tops(direct_e);
  const double dark_e = dark_noise_e(sweep_.scanner.sensor);
  const auto worthwhile_e = [&](double top) {
    return top > 0 ? worthwhile_in_stripe * std::sqrt(top + dark_e * dark_e)
                   : worthwhile_in_dark * dark_e;
  };
  Image<double> light_e(top_e.width, top_e.height);
  std::vector<std::uint64_t> paths(top_e.height, 0);
  parallel_for(
      static_cast<std::size_t>(light_e.height),
      [&](std::size_t y) {
        const int row = static_cast<int>(y);
        for (int x = 0; x < light_e.width; ++x) {
          const std::array limits_e = {worthwhile_e(0), worthwhile_e(top_e(x, row))};
          const TileLight light = tile_light(x * tile_px, row * tile_px, limits_e);
          light_e(x, row) = light.most_e;
          paths[y] += light.paths;
        }
      },
      4);
  tally.paths += std::accumulate(paths.begin(), paths.end(), std::uint64_t{0});
  Image<std::uint8_t> pixels(lit.width, lit.height);
  for (int row = 0; row < lit.height; ++row)
    for (int column = 0; column < lit.width; ++column) {
      const double found_e = around(light_e, column, row);
      const double top = top_e(column / tile_px, row / tile_px);
      pixels(column, row) =
          found_e > worthwhile_e(0) ||
          (lit(column, row) && (sweep_.paths->everywhere || found_e > worthwhile_e(top)));
    }
  return pixels;
}

}  // namespace scan::synth
