// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/raw_files.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/calibration_json.h"
#include "libscan/io/image_file.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

using Paths = std::vector<std::filesystem::path>;

std::string tap_name(std::size_t frequency, std::size_t tap) {
  return "frequency_" + std::to_string(frequency) + "_tap_" + std::to_string(tap) + ".png";
}

template <class Pixel>
void check_size(const Image<Pixel>& image, int width, int height,
                const std::filesystem::path& path) {
  if (image.width == width && image.height == height) return;
  throw Error(Trouble::input, path.string() + ": is " + std::to_string(image.width) + " x " +
                                  std::to_string(image.height) + " px, the calibration says " +
                                  std::to_string(width) + " x " + std::to_string(height));
}

void check_bits(const std::vector<std::uint16_t>& numbers, const Sensor& sensor,
                const std::filesystem::path& path) {
  const auto largest = std::max_element(numbers.begin(), numbers.end());
  if (largest == numbers.end() || *largest < 1u << sensor.bits) return;
  throw Error(Trouble::input, path.string() + ": holds " + std::to_string(*largest) +
                                  ", a sensor of " + std::to_string(sensor.bits) +
                                  " bits ends at " + std::to_string((1u << sensor.bits) - 1));
}

Image<std::uint16_t> read_frame(const std::filesystem::path& path, const Camera& camera,
                                const Sensor& sensor) {
  Image<std::uint16_t> image = read_grey16(path);
  check_size(image, camera.width_px, camera.height_px, path);
  check_bits(image.pixels, sensor, path);
  return image;
}

// The inputs as given, or the files called `names` if one folder was given.
Paths files_of(const Paths& inputs, const std::vector<std::string>& names) {
  Paths paths = inputs;
  if (inputs.size() == 1 && std::filesystem::is_directory(inputs.front())) {
    paths.clear();
    for (const std::string& name : names) paths.push_back(inputs.front() / name);
  }
  if (paths.size() != names.size())
    throw Error(Trouble::input, "raw frames: " + std::to_string(paths.size()) +
                                    " files are given, the calibration needs " +
                                    std::to_string(names.size()));
  return paths;
}

StripeImages read_stripes(const Paths& inputs, const std::filesystem::path& calibration) {
  LaserLineSetup setup = read_laser_line_calibration(calibration);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < setup.scanner_from_camera.size(); ++i)
    names.push_back(numbered(i, ".png"));
  StripeImages frames{setup.calibration, {}, std::move(setup.scanner_from_camera)};
  for (const auto& path : files_of(inputs, names))
    frames.images.push_back(read_frame(path, frames.calibration.camera, frames.calibration.sensor));
  return frames;
}

ImagePair read_pair(const Paths& inputs, const std::filesystem::path& calibration) {
  const StereoSetup setup = read_stereo_calibration(calibration);
  ImagePair pair{setup.calibration, {}, {}};
  const Paths paths = files_of(inputs, {"left.png", "right.png"});
  pair.left = read_grey8(paths[0]);
  pair.right = read_grey8(paths[1]);
  check_size(pair.left, pair.calibration.width_px, pair.calibration.height_px, paths[0]);
  check_size(pair.right, pair.calibration.width_px, pair.calibration.height_px, paths[1]);
  return setup.rectification ? rectify(*setup.rectification, pair.left, pair.right) : pair;
}

PhaseTaps read_taps(const Paths& inputs, const std::filesystem::path& calibration) {
  PhaseTaps frames{read_phase_calibration(calibration), {}};
  const std::size_t frequencies = frames.calibration.frequencies_hz.size();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < 4 * frequencies; ++i) names.push_back(tap_name(i / 4, i % 4));
  const Paths paths = files_of(inputs, names);
  frames.taps.resize(frequencies);
  for (std::size_t i = 0; i < paths.size(); ++i)
    frames.taps[i / 4][i % 4] =
        read_frame(paths[i], frames.calibration.camera, frames.calibration.sensor);
  return frames;
}

NumberArray read_table(const std::filesystem::path& path) {
  NumberArray table = read_npy(path);
  if (table.shape.size() != 2)
    throw Error(Trouble::input, path.string() + ": must be an array of two dimensions, has " +
                                    std::to_string(table.shape.size()));
  return table;
}

void read_samples(const std::filesystem::path& path, Waveforms& frames) {
  const NumberArray table = read_table(path);
  if (table.shape[1] == 0 || table.shape[1] > std::size_t{1} << 24)
    throw Error(Trouble::input, path.string() + ": has " + std::to_string(table.shape[1]) +
                                    " samples a ray, must be 1 to 2^24");
  frames.samples_per_ray = static_cast<std::uint32_t>(table.shape[1]);
  frames.samples.reserve(table.values.size());
  for (const double value : table.values) {
    if (!(value >= 0 && value <= 65535) || value != std::floor(value))
      throw Error(Trouble::input, path.string() + ": holds " + shortest(value) +
                                      ", samples are whole numbers from 0 to 65535");
    frames.samples.push_back(static_cast<std::uint16_t>(value));
  }
  check_bits(frames.samples, frames.calibration.sensor, path);
}

void read_directions(const std::filesystem::path& path, Waveforms& frames) {
  const NumberArray table = read_table(path);
  if (table.shape[1] != 3)
    throw Error(Trouble::input, path.string() + ": a direction has three numbers, not " +
                                    std::to_string(table.shape[1]));
  for (std::size_t i = 0; i < table.shape[0]; ++i) {
    const Eigen::Vector3d direction = Eigen::Map<const Eigen::Vector3d>(&table.values[3 * i]);
    if (!(std::abs(direction.norm() - 1) < 1e-6))
      throw Error(Trouble::input, path.string() + ": direction " + std::to_string(i) +
                                      " has length " + shortest(direction.norm()) + ", must be 1");
    frames.directions.push_back(direction);
  }
}

void check_rays(const std::filesystem::path& path, std::size_t count, std::size_t rays) {
  if (count == rays) return;
  throw Error(Trouble::input, path.string() + ": has " + std::to_string(count) +
                                  " rays, directions.npy has " + std::to_string(rays));
}

void read_first_samples(const std::filesystem::path& path, Waveforms& frames) {
  const NumberArray list = read_npy(path);
  check_rays(path, list.values.size(), frames.directions.size());
  for (const double value : list.values) {
    if (!(value >= 0 && value <= 1 << 30) || value != std::floor(value))
      throw Error(Trouble::input, path.string() + ": holds " + shortest(value) +
                                      ", must be whole numbers from 0 to 2^30");
    frames.first_sample.push_back(static_cast<std::uint32_t>(value));
  }
}

// Each row holds the upper three rows of a rigid motion's matrix.
void read_ray_poses(const std::filesystem::path& path, Waveforms& frames) {
  const NumberArray table = read_table(path);
  if (table.shape[1] != 12)
    throw Error(Trouble::input, path.string() + ": a pose has twelve numbers, not " +
                                    std::to_string(table.shape[1]));
  check_rays(path, table.shape[0], frames.directions.size());
  for (std::size_t i = 0; i < table.shape[0]; ++i) {
    using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
    Pose pose = Pose::Identity();
    pose.affine() = Eigen::Map<const Rows>(&table.values[12 * i]);
    const Eigen::Matrix3d& turn = pose.linear();
    const double error =
        (turn.transpose() * turn - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(error < 1e-6) || !(turn.determinant() > 0) || !pose.translation().allFinite())
      throw Error(Trouble::input,
                  path.string() + ": pose " + std::to_string(i) + " is no rigid motion");
    frames.scanner_from_ray.push_back(pose);
  }
}

Waveforms read_waveforms(const Paths& inputs, const std::filesystem::path& calibration) {
  const WaveformSetup setup = read_waveform_calibration(calibration);
  Waveforms frames;
  frames.calibration = setup.calibration;
  frames.grid = setup.grid;
  std::vector<std::string> names = {"samples.npy", "directions.npy"};
  if (setup.is_gated) names.push_back("first_samples.npy");
  if (setup.is_moving) names.push_back("poses.npy");
  const Paths paths = files_of(inputs, names);
  read_samples(paths[0], frames);
  read_directions(paths[1], frames);
  if (setup.is_gated) read_first_samples(paths[2], frames);
  if (setup.is_moving) read_ray_poses(paths.back(), frames);
  const std::size_t rays = frames.directions.size();
  if (frames.samples.size() != rays * frames.samples_per_ray)
    throw Error(Trouble::input, paths[0].string() + ": has " +
                                    std::to_string(frames.samples.size() / frames.samples_per_ray) +
                                    " rays, " + paths[1].string() + " has " + std::to_string(rays));
  const std::size_t cells = std::size_t{setup.grid.rows} * setup.grid.columns;
  if (cells != 0 && cells != rays)
    throw Error(Trouble::input, calibration.string() + ": rows x columns is " +
                                    std::to_string(cells) + ", there are " + std::to_string(rays) +
                                    " rays");
  return frames;
}

void write_frames(const std::filesystem::path& folder, const StripeImages& frames) {
  for (std::size_t i = 0; i < frames.images.size(); ++i)
    write_png(folder / numbered(i, ".png"), frames.images[i]);
}

void write_frames(const std::filesystem::path& folder, const ImagePair& frames) {
  write_png(folder / "left.png", frames.left);
  write_png(folder / "right.png", frames.right);
}

void write_frames(const std::filesystem::path& folder, const PhaseTaps& frames) {
  for (std::size_t f = 0; f < frames.taps.size(); ++f)
    for (std::size_t tap = 0; tap < 4; ++tap)
      write_png(folder / tap_name(f, tap), frames.taps[f][tap]);
}

void write_frames(const std::filesystem::path& folder, const Waveforms& frames) {
  std::vector<double> directions;
  for (const Eigen::Vector3d& direction : frames.directions)
    directions.insert(directions.end(), direction.begin(), direction.end());
  const std::size_t rays = frames.directions.size();
  write_npy(folder / "samples.npy", {rays, frames.samples_per_ray}, frames.samples);
  write_npy(folder / "directions.npy", {rays, 3}, directions);
  if (!frames.first_sample.empty())
    write_npy(folder / "first_samples.npy", {rays},
              std::vector<double>(frames.first_sample.begin(), frames.first_sample.end()));
  std::vector<double> poses;
  for (const Pose& pose : frames.scanner_from_ray)
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) poses.push_back(pose(row, column));
  if (!poses.empty()) write_npy(folder / "poses.npy", {rays, 12}, poses);
}

}  // namespace

std::string_view kind_of(const RawFrames& frames) {
  constexpr std::string_view kinds[] = {"laser-line", "stereo", "phase", "waveform"};
  static_assert(std::variant_size_v<RawFrames> == std::size(kinds));
  return kinds[frames.index()];
}

void write_raw_frames(const std::filesystem::path& folder, const RawFrames& frames) {
  std::visit(
      [&](const auto& device) {
        write_frames(folder, device);
        write_file(folder / "calibration.json", calibration_json(device).dump(1) + "\n");
      },
      frames);
}

RawFrames read_raw_frames(std::string_view kind, const std::vector<std::filesystem::path>& inputs,
                          const std::filesystem::path& calibration) {
  if (kind == "laser-line") return read_stripes(inputs, calibration);
  if (kind == "stereo") return read_pair(inputs, calibration);
  if (kind == "phase") return read_taps(inputs, calibration);
  if (kind == "waveform") return read_waveforms(inputs, calibration);
  throw Error(Trouble::usage, "device '" + std::string(kind) +
                                  "' is not one of laser-line, stereo, phase, waveform");
}

}  // namespace scan
