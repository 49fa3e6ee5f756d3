// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan align: scans into one frame.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "libscan/align/multiview.h"
#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_output.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "tools/commands.h"
#include "tools/inputs.h"
#include "tools/pairs_file.h"
#include "tools/version.h"

namespace scan {
namespace {

struct Arguments {
  std::vector<std::string> paths;
  std::string method{name_of(IcpOptions{}.method)};
  std::string search = "kd-tree";
  std::string init;
  double max_distance_m = 0;
  double thin_m = 0;
  bool resume = false;
};

std::string stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

// A .conf names its scans' files: those that are not among the inputs were perhaps forgotten.
void warn_of_missing(const std::vector<NamedPose>& named, const std::string& file,
                     const std::vector<std::string>& inputs, Console& console) {
  if (std::filesystem::path(file).extension() != ".conf") return;
  for (const NamedPose& pose : named) {
    const bool given = std::any_of(inputs.begin(), inputs.end(), [&](const std::string& input) {
      return stem(input) == stem(pose.name);
    });
    if (!given) console.warn(file + ": names " + pose.name + ", which is not among the scans");
  }
}

// The first guess of each scan: by name from the file of poses, else by order, else the scan's own.
std::vector<Pose> guesses(const Arguments& arguments, const std::vector<std::string>& inputs,
                          const std::vector<Scan>& scans, Console& console) {
  std::vector<Pose> poses;
  if (arguments.init.empty()) {
    for (const Scan& scan : scans) poses.push_back(scan.world_from_scanner_guess);
    return poses;
  }
  const auto named = read_poses(arguments.init);
  warn_of_missing(named, arguments.init, inputs, console);
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

// Of all that decides the pairs.
std::string fingerprint_of(const Arguments& arguments, const std::vector<std::string>& inputs,
                           const std::vector<Pose>& guesses) {
  nlohmann::ordered_json all = {version_text(), arguments.method, arguments.search,
                                arguments.max_distance_m, arguments.thin_m};
  for (const std::string& input : inputs) all.push_back(fingerprint(read_file(input)));
  for (const Pose& guess : guesses)
    all.push_back(std::vector<double>(guess.matrix().data(), guess.matrix().data() + 16));
  return fingerprint(all.dump());
}

// Keeps the pairs in the folder, also when the work is interrupted.
MultiviewResult align_kept(const std::vector<PointCloud>& clouds, const std::vector<Pose>& guesses,
                           MultiviewOptions options, const std::filesystem::path& pairs,
                           const std::string& inputs, const Console& console) {
  std::vector<ScanEdge> finished = options.known_edges;
  options.on_edge = [&](const ScanEdge& edge) { finished.push_back(edge); };
  const auto keep = [&] {
    std::stable_sort(finished.begin(), finished.end(), [](const ScanEdge& a, const ScanEdge& b) {
      return std::pair(a.source, a.target) < std::pair(b.source, b.target);
    });
    write_pairs(pairs, inputs, finished);
  };
  try {
    MultiviewResult result = align_scans(clouds, guesses, options, console.progress());
    keep();
    return result;
  } catch (const Interrupted&) {
    keep();
    throw;
  }
}

// One line per scan, then what became of the pairs. False if a scan could not be aligned.
bool tell(const std::vector<std::string>& inputs, const MultiviewResult& result, Console& console) {
  bool complete = true;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const ScanPose& pose = result.scans[i];
    console.say(inputs[i] + ": " + std::string(name_of(pose.stop)) + ", rms " +
                readable_length(pose.rms_m) + ", inliers " +
                readable_value(100 * pose.inlier_fraction_of_source, "count") + " %");
    complete &= tell_of_pose(inputs[i], pose, console);
  }
  std::size_t accepted = 0;
  for (const ScanEdge& edge : result.edges) {
    accepted += edge.accepted;
    if (!edge.accepted)
      console.detail(inputs[edge.source] + " and " + inputs[edge.target] + ": rejected, " +
                     (edge.stop == Stop::converged ? "disagrees with the other pairs"
                                                   : std::string(name_of(edge.stop))));
  }
  console.say(std::to_string(accepted) + " of " + std::to_string(result.edges.size()) +
              " pairs agree");
  return complete;
}

int align_files(const Arguments& arguments, Console& console) {
  const auto [inputs, output] = split_output(arguments.paths);
  const auto scans = read_scans_with_normals(inputs, console);
  warn_of_units(inputs, scans, console);
  const auto first = guesses(arguments, inputs, scans, console);
  std::vector<PointCloud> clouds;
  clouds.reserve(scans.size());
  for (const Scan& scan : scans) clouds.push_back(scan.cloud);

  make_folder(output);
  const std::filesystem::path folder = output;
  const std::string decided_by = fingerprint_of(arguments, inputs, first);
  MultiviewOptions options = options_from(arguments);
  if (arguments.resume) options.known_edges = read_pairs(folder / "pairs.json", decided_by);
  const MultiviewResult result =
      align_kept(clouds, first, options, folder / "pairs.json", decided_by, console);
  console.time("align", result.cost.seconds);
  const auto json = alignment_json(inputs, result, options.icp);
  write_results(folder, inputs, scans, result, json);
  if (!tell(inputs, result, console))
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
  line.flag("--resume", arguments->resume, "go on with the pairs of an interrupted call in OUT");
  return [arguments](Console& console) { return align_files(*arguments, console); };
}

}  // namespace scan
