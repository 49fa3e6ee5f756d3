// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan align: scans into one frame.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "libscan/align/multiview.h"
#include "libscan/core/error.h"
#include "libscan/io/json_output.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "tools/commands.h"
#include "tools/inputs.h"

namespace scan {
namespace {

struct Arguments {
  std::vector<std::string> paths;
  std::string method{name_of(IcpOptions{}.method)};
  std::string search = "kd-tree";
  std::string init;
  double max_distance_m = 0;
  double thin_m = 0;
};

std::string stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

// The first guess of each scan: by name from the file of poses, else by order, else the scan's own.
std::vector<Pose> guesses(const Arguments& arguments, const std::vector<std::string>& inputs,
                          const std::vector<Scan>& scans) {
  std::vector<Pose> poses;
  if (arguments.init.empty()) {
    for (const Scan& scan : scans) poses.push_back(scan.world_from_scanner_guess);
    return poses;
  }
  const auto named = read_poses(arguments.init);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const NamedPose* found = nullptr;
    for (const NamedPose& pose : named)
      if (stem(pose.name) == stem(inputs[i])) found = &pose;
    if (!found && named.size() == inputs.size()) found = &named[i];
    if (!found)
      throw Error(Trouble::input, arguments.init + ": has no pose for " + inputs[i] + " and " +
                                      std::to_string(named.size()) + " poses for " +
                                      std::to_string(inputs.size()) + " scans");
    poses.push_back(found->pose);
  }
  return poses;
}

MultiviewOptions options_from(const Arguments& arguments) {
  MultiviewOptions options;
  options.icp.method = *icp_method_from(arguments.method);
  options.icp.search = *search_method_from(arguments.search);
  options.icp.max_pair_distance_m = arguments.max_distance_m;
  options.thin_m = arguments.thin_m;
  return options;
}

void write_results(const std::filesystem::path& folder, const std::vector<std::string>& inputs,
                   const std::vector<Scan>& scans, const MultiviewResult& result,
                   const nlohmann::ordered_json& json) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(Trouble::output, folder.string() + ": " + error.message());
  std::vector<Pose> poses;
  std::vector<NamedPose> named;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    poses.push_back(result.scans[i].world_from_scan);
    named.push_back({stem(inputs[i]), poses.back()});
  }
  write_json(folder / "alignment.json", json);
  write_poses_tum(folder / "poses.tum", named);
  write_scan(folder / "aligned.ply", Scan{.name = "aligned", .cloud = joined(scans, poses)});
}

int align_files(const Arguments& arguments, Console& console) {
  const auto [inputs, output] = split_output(arguments.paths);
  const auto scans = read_scans_with_normals(inputs, console);
  const auto first = guesses(arguments, inputs, scans);
  std::vector<PointCloud> clouds;
  clouds.reserve(scans.size());
  for (const Scan& scan : scans) clouds.push_back(scan.cloud);

  const MultiviewOptions options = options_from(arguments);
  const MultiviewResult result = align_scans(clouds, first, options, console.progress());
  console.time("align", result.cost.seconds);
  const auto json = alignment_json(inputs, result, options.icp);
  write_results(output, inputs, scans, result, json);

  bool complete = true;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const ScanPose& pose = result.scans[i];
    console.say(inputs[i] + ": " + std::string(name_of(pose.stop)) + ", rms " +
                readable_length(pose.rms_m) + ", inliers " +
                readable_value(100 * pose.inlier_fraction_of_source, "count") + " %");
    complete &= tell_of_pose(inputs[i], pose, console);
  }
  if (!complete)
    throw Error(Trouble::computation, "not every scan could be aligned; " + output +
                                          "/alignment.json says which and why");
  console.finish("align", "ok", json);
  return 0;
}

}  // namespace

Action align_command(CommandLine& line) {
  auto arguments = std::make_shared<Arguments>();
  line.inputs("INPUT... OUT", arguments->paths, "scans; last the folder to write into");
  line.choice("--method", arguments->method,
              {"point-to-point", "point-to-plane", "symmetric", "plane-to-plane"},
              "what the pairs of points are held against");
  line.choice("--search", arguments->search,
              {"kd-tree", "octree", "brute-force", "flann", "pcl-octree"}, "neighbour search");
  line.option("--init", arguments->init,
              "poses to start from (TUM, KITTI, 4x4, Stanford .conf, alignment.json)");
  line.length("--max-distance", arguments->max_distance_m,
              "pairs farther apart do not count; found from the data if not given");
  line.length("--thin", arguments->thin_m,
              "side of the cubes that thin the clouds for the joint step");
  return [arguments](Console& console) { return align_files(*arguments, console); };
}

}  // namespace scan
