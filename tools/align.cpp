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
#include "tools/align_starts.h"
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
  bool global = false;
  double guess_rotation_rad = 0, guess_translation_m = 0;
  double max_distance_m = 0;
  double thin_m = 0;
  bool resume = false;
};

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

// As given, else as the scans state it.
std::vector<GuessSigma> sigmas_of(const Arguments& arguments, const Starts& starts) {
  const double turn_rad = arguments.guess_rotation_rad, shift_m = arguments.guess_translation_m;
  if (turn_rad == 0 && shift_m == 0) return starts.sigmas;
  if (arguments.global)
    throw Error(Trouble::usage,
                "--global: finds poses without a guess, --guess-rotation and "
                "--guess-translation say how far off one is",
                "leave one of them out");
  if (!(turn_rad > 0 && shift_m > 0))
    throw Error(Trouble::usage,
                "--guess-rotation and --guess-translation: must both be given and positive");
  return std::vector<GuessSigma>(starts.scans.size(), {turn_rad, shift_m});
}

// Of all that decides the pairs.
std::string fingerprint_of(const Arguments& arguments, const std::vector<std::string>& inputs,
                           const Starts& starts) {
  nlohmann::ordered_json all = {version_text(),           arguments.method, arguments.search,
                                arguments.max_distance_m, arguments.thin_m, starts.scans};
  for (const std::string& input : inputs) all.push_back(fingerprint(read_file(input)));
  for (const Pose& guess : starts.world_from_scan)
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

void tell_trust(const std::vector<GlobalGuess>& found, nlohmann::ordered_json& json) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    json["scans"][i]["global"] = name_of(found[i].outcome);
    json["scans"][i]["trust"] = found[i].trust;
  }
}

int align_files(const Arguments& arguments, Console& console) {
  const auto [inputs, output] = split_output(arguments.paths);
  if (arguments.global && !arguments.init.empty())
    throw Error(Trouble::usage, "--global: finds poses without a guess, --init gives one",
                "leave one of them out");
  const auto scans = read_scans_with_normals(inputs, console);
  warn_of_units(inputs, scans, console);
  const Starts starts = arguments.global ? found_starts(inputs, scans, console)
                                         : given_starts(arguments.init, inputs, scans, console);
  std::vector<PointCloud> clouds;
  for (const std::size_t i : starts.scans) clouds.push_back(scans[i].cloud);

  make_folder(output);
  const std::filesystem::path folder = output;
  const std::string decided_by = fingerprint_of(arguments, inputs, starts);
  MultiviewOptions options = options_from(arguments);
  options.guess_sigmas = sigmas_of(arguments, starts);
  if (arguments.resume) options.known_edges = read_pairs(folder / "pairs.json", decided_by);
  MultiviewResult part = align_kept(clouds, starts.world_from_scan, options, folder / "pairs.json",
                                    decided_by, console);
  const MultiviewResult result = of_all(std::move(part), starts, scans.size());
  console.time("align", result.cost.seconds);
  auto json = alignment_json(inputs, result, options.icp);
  tell_trust(starts.found, json);
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
  line.angle("--guess-rotation", arguments->guess_rotation_rad,
             "root mean square by which the starts are turned");
  line.length(
      "--guess-translation", arguments->guess_translation_m,
      "root mean square by which they are shifted; where the scans leave motions open, both "
      "tell how far off those are");
  line.flag("--global", arguments->global,
            "find the poses without any guess; the first scan fixes the world");
  line.length("--max-distance", arguments->max_distance_m,
              "pairs farther apart do not count; found from the data if not given");
  line.length("--thin", arguments->thin_m,
              "side of the cubes that thin the clouds for the joint step");
  line.flag("--resume", arguments->resume, "go on with the pairs of an interrupted call in OUT");
  return [arguments](Console& console) { return align_files(*arguments, console); };
}

}  // namespace scan
