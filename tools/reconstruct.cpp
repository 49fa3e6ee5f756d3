// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan reconstruct: oriented points to a surface.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/json_output.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/stated_poses_file.h"
#include "libscan/io/surface_file.h"
#include "libscan/reconstruct/dual_mesh.h"
#include "tools/commands.h"
#include "tools/inputs.h"
#include "tools/surface_stage.h"

namespace scan {
namespace {

struct Arguments {
  std::vector<std::string> paths;
  std::string method = "ssd";
  std::string poses;
  long depth = SsdOptions{}.depth;
  double memory_gib = SsdOptions{}.memory_gib;
  bool sharp = false;
  bool quads = false;
  double trim_m = 0;
  double decimate_m = 0;
  double thin_m = 0;
};

// An area, and its share of all that there was.
std::string area_text(double part_m2, const SurfaceResult& result) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3g m2 (%.2f %%)", part_m2,
                100 * part_m2 / (area_m2(result.surface) + result.trimmed_area_m2));
  return text;
}

void tell_of_quads(const Mesh& surface, Console& console) {
  const std::size_t others = surface.triangles.size() - 2 * surface.quads;
  const QuadWarp warp = quad_warp(surface);
  char text[160];
  std::snprintf(text, sizeof text,
                "%zu quads and %zu other triangles; quads are off flat by %.2g %% rms, at most "
                "%.2g %% of their width",
                surface.quads, others, 100 * warp.rms, 100 * warp.largest);
  console.say(text);
}

std::vector<Pose> poses_of(const std::string& path, std::size_t scans) {
  std::vector<Pose> poses(scans, Pose::Identity());
  if (path.empty()) return poses;
  const auto named = read_poses(path);
  if (named.size() != scans)
    throw Error(Trouble::input, path + ": has " + std::to_string(named.size()) + " poses for " +
                                    std::to_string(scans) + " scans");
  for (std::size_t i = 0; i < scans; ++i) poses[i] = named[i].pose;
  return poses;
}

ReconstructSettings settings_of(const Arguments& arguments) {
  ReconstructSettings settings;
  const auto& names = reconstruct_method_names();
  settings.method = static_cast<ReconstructMethod>(
      std::find(names.begin(), names.end(), arguments.method) - names.begin());
  settings.ssd.depth = static_cast<int>(arguments.depth);
  settings.ssd.memory_gib = arguments.memory_gib;
  settings.sharp = arguments.sharp;
  settings.quads = arguments.quads;
  settings.trim_m = arguments.trim_m;
  settings.decimate_m = arguments.decimate_m;
  settings.thin_m = arguments.thin_m;
  return settings;
}

void tell_of_surface(const std::string& output, const SurfaceResult& result,
                     const nlohmann::ordered_json& json, Console& console) {
  console.say(output + ": " + std::to_string(result.surface.vertices.size()) + " vertices, " +
              std::to_string(result.surface.triangles.size()) + " triangles, " +
              std::to_string(json.at("components").get<int>()) + " components, " +
              (json.at("watertight").get<bool>() ? "watertight" : "not closed"));
  if (result.surface.quads > 0) tell_of_quads(result.surface, console);
  const double unsupported_m2 = unsupported_area_m2(result);
  if (unsupported_m2 > 0)
    console.say("no data within three spacings of " + area_text(unsupported_m2, result) +
                " of the surface: a guess (support_m in a PLY tells where)");
  if (result.sharp.edge_vertices > 0)
    console.say(std::to_string(result.sharp.edge_vertices) + " vertices put on sharp edges, " +
                std::to_string(result.sharp.corners) + " of them corners");
}

// What the method did and found.
void tell_of_work(const SurfaceResult& result, Console& console) {
  if (result.decimation.is_proven)
    console.say("decimated from " + std::to_string(result.decimation.triangles_before) +
                " triangles, both surfaces within " + readable_length(result.decimation.bound_m) +
                " of one another");
  if (result.trimmed_area_m2 > 0)
    console.say("trimmed " + area_text(result.trimmed_area_m2, result));
  if (result.depth > 0)
    console.say("depth " + std::to_string(result.depth) + ", points scatter by " +
                readable_length(result.sigma_m) + ", smoothing length " +
                readable_length(result.smoothing_length_m));
  if (result.moved_points > 0)
    console.say(std::to_string(result.moved_points) +
                " points moved to averages that stop at creases, and solved again");
  if (result.parts.parts_per_axis > 1)
    console.say("solved in parts, " + std::to_string(result.parts.parts_per_axis) +
                " an axis; where two meet their surfaces are " +
                readable_length(result.parts.seam_rms_m) + " rms apart, at most " +
                readable_length(result.parts.seam_largest_m));
}

// Errors about the points name the files that they are from.
SurfaceResult surface_of(const std::vector<std::string>& inputs, const std::vector<Scan>& scans,
                         const std::vector<Pose>& poses, const StatedPoses& stated,
                         const ReconstructSettings& settings, Console& console) {
  try {
    return make_surface(joined(scans, poses), joined_viewpoints(scans, poses),
                        common_errors(scans, stated), settings, console);
  } catch (const Error& error) {
    if (error.trouble() != Trouble::input) throw;
    const std::string more =
        inputs.size() > 1 ? " and " + std::to_string(inputs.size() - 1) + " more" : "";
    throw Error(error.trouble(), inputs.front() + more + ": " + error.what(), error.hint());
  }
}

int reconstruct_files(const Arguments& arguments, Console& console) {
  const auto [inputs, output] = split_output(arguments.paths);
  check_output(output);
  check_mesh_ending(output);
  if (arguments.quads && std::filesystem::path(output).extension() == ".stl")
    throw Error(Trouble::usage, "--quads: " + output + " can hold triangles only",
                "PLY, OBJ and OFF hold quads");
  const auto scans = read_scans_with_normals(inputs, console);
  const std::vector<Pose> poses = poses_of(arguments.poses, scans.size());
  StatedPoses stated;
  if (arguments.poses.ends_with(".json")) stated = read_stated_poses(arguments.poses);
  const ReconstructSettings settings = settings_of(arguments);
  const SurfaceResult result = surface_of(inputs, scans, poses, stated, settings, console);
  write_supported_mesh(output, supported(result));
  const auto json = surface_json(result);
  if (settings.method == ReconstructMethod::automatic)
    console.say("method " + result.method + ": " + result.method_reason);
  tell_of_surface(output, result, json, console);
  tell_of_work(result, console);
  console.finish("reconstruct", "ok", json);
  return 0;
}

}  // namespace

Action reconstruct_command(CommandLine& line) {
  auto arguments = std::make_shared<Arguments>();
  line.inputs("INPUT... OUT", arguments->paths, "points with normals; last the mesh to write");
  line.choice("--method", arguments->method, reconstruct_method_names(), "how the surface is made");
  line.whole("--depth", arguments->depth, 3, 12,
             "ssd: most; cells are not narrower than box / 2^depth");
  line.number("--memory", arguments->memory_gib, 0.01, 1e4,
              "ssd: most, GiB; what needs more is solved part by part and blended");
  line.option("--poses", arguments->poses,
              "a pose for each input, in their order; an alignment.json tells their errors, too");
  line.flag("--sharp", arguments->sharp, "put edges and corners back; amid noise by ssd");
  line.flag("--quads", arguments->quads,
            "a surface of quads, for ssd, mls, rbf and range-fusion; not for .stl");
  line.length("--trim", arguments->trim_m, "remove surface farther than this from every point");
  line.length("--decimate", arguments->decimate_m,
              "merge triangles as long as the surface stays within this distance, which is proven");
  line.length("--thin", arguments->thin_m, "first thin the points to one per cube of this side");
  return [arguments](Console& console) { return reconstruct_files(*arguments, console); };
}

}  // namespace scan
