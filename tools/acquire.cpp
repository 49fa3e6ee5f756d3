// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan acquire: a device's raw data to points.
#include "libscan/acquire/acquire.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/image_file.h"
#include "libscan/io/json_output.h"
#include "libscan/io/raw_files.h"
#include "libscan/io/scan_file.h"
#include "tools/commands.h"
#include "tools/inputs.h"

namespace scan {
namespace {

struct Arguments {
  std::string device;
  std::vector<std::string> paths;
  std::string calibration;
  std::string disparity;
  std::string peak = "gaussian";
  std::string pulse = "matched-filter";
};

AcquireOptions options_from(const Arguments& arguments) {
  AcquireOptions options;
  if (arguments.peak == "centroid") options.laser_line.peak = PeakMethod::centroid;
  if (arguments.peak == "parabola") options.laser_line.peak = PeakMethod::parabola;
  if (arguments.pulse == "leading-edge") options.waveform.pulse = PulseMethod::leading_edge;
  if (arguments.pulse == "centroid") options.waveform.pulse = PulseMethod::centroid;
  return options;
}

struct Decoded {
  Scan scan;
  Image<float> disparity_px;  // of stereo, if asked for
};

Decoded decode(const Arguments& arguments, const RawFrames& frames) {
  const AcquireOptions options = options_from(arguments);
  if (arguments.disparity.empty()) return {acquire(frames, options), {}};
  const ImagePair& pair = std::get<ImagePair>(frames);
  DisparityMap map = match(pair, options.stereo);
  Scan scan = points_from(map, pair.calibration);
  estimate_normals(scan, options.normals);
  return {std::move(scan), std::move(map.disparity_px)};
}

void check_disparity_output(const Arguments& arguments) {
  const std::string& path = arguments.disparity;
  if (path.empty()) return;
  if (arguments.device != "stereo") throw Error(Trouble::usage, "--disparity goes with stereo");
  if (std::filesystem::path(path).extension() != ".pfm")
    throw Error(Trouble::output, "--disparity: " + path + ": must end in .pfm");
  check_output(path);
}

// What was asked for and would be passed over.
void refuse_unused(const Arguments& arguments) {
  const Arguments usual;
  if (arguments.peak != usual.peak && arguments.device != "laser-line")
    throw Error(Trouble::usage, "--peak: is for laser-line");
  if (arguments.pulse != usual.pulse && arguments.device != "waveform")
    throw Error(Trouble::usage, "--pulse: is for waveform");
}

int acquire_files(const Arguments& arguments, Console& console) {
  const auto [inputs, output] = split_output(arguments.paths);
  refuse_unused(arguments);
  check_output(output);
  check_scan_ending(output);
  check_disparity_output(arguments);
  if (arguments.calibration.empty())
    throw Error(Trouble::usage, "--calibration: is missing, what the device's numbers mean",
                "scan calibrate makes one");
  const Stopwatch watch;
  const RawFrames frames =
      read_raw_frames(arguments.device, {inputs.begin(), inputs.end()}, arguments.calibration);
  const auto [scan, disparity_px] = decode(arguments, frames);
  console.time("acquire", watch.seconds());
  if (scan.cloud.empty())
    throw Error(Trouble::computation, output + ": no ray gave a point; nothing written");
  write_scan(output, scan);
  if (!arguments.disparity.empty()) write_pfm(arguments.disparity, disparity_px);
  const auto summary = scan_json(output, scan);
  console.say(output + ": " + std::to_string(scan.cloud.size()) + " points");
  for (const auto& [reason, count] : scan.misses)
    console.say("  " + std::to_string(count) + " rays without a point: " + reason);
  console.finish("acquire", "ok", {{"device", arguments.device}, {"scans", {summary}}});
  return 0;
}

}  // namespace

Action acquire_command(CommandLine& line) {
  auto arguments = std::make_shared<Arguments>();
  line.choice("DEVICE", arguments->device, {"laser-line", "stereo", "phase", "waveform"},
              "the kind of device");
  line.inputs("INPUT... OUT", arguments->paths,
              "raw files in order, or the folder that holds them; last the points to write");
  line.option("--calibration", arguments->calibration,
              "the device's calibration: JSON, or Middlebury's calib.txt");
  line.option("--disparity", arguments->disparity, "stereo: also write the disparity (.pfm)");
  line.choice("--peak", arguments->peak, {"centroid", "gaussian", "parabola"},
              "laser-line: how the stripe's place is found");
  line.choice("--pulse", arguments->pulse, {"leading-edge", "centroid", "matched-filter"},
              "waveform: how the echo's time is found");
  return [arguments](Console& console) { return acquire_files(*arguments, console); };
}

}  // namespace scan
