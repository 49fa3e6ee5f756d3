// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan convert: another format for the same content.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/image_file.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "tools/commands.h"
#include "tools/inputs.h"

namespace scan {
namespace {

bool one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

std::string ending(const std::string& path) {
  std::string text = std::filesystem::path(path).extension().string();
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

void convert_poses(const std::string& from, const std::string& to) {
  const auto poses = read_poses(from);
  if (ending(to) == ".tum") return write_poses_tum(to, poses);
  if (ending(to) == ".kitti") return write_poses_kitti(to, poses);
  if (poses.size() != 1)
    throw Error(Trouble::usage, from + ": holds " + std::to_string(poses.size()) +
                                    " poses, a matrix file holds one (use .tum or .kitti)");
  write_matrix(to, poses.front().pose);
}

void convert_file(const std::string& from, const std::string& to, Console& console) {
  const std::string in = ending(from), out = ending(to);
  if (out == ".pfm") return write_pfm(to, read_float_image(from));
  if (one_of(out, {".tum", ".kitti", ".xf"})) return convert_poses(from, to);
  const bool mesh =
      one_of(out, {".obj", ".stl", ".off"}) || (out == ".ply" && holds_triangles(from));
  if (mesh) return write_mesh(to, read_mesh(from));
  if (one_of(out, {".ply", ".pcd", ".xyz", ".txt", ".asc"})) {
    if (!holds_triangles(from)) {
      const Scan scan = read_scan(from);
      warn_of_lost_points(from, scan, console);
      return write_scan(to, scan);
    }
    return write_scan(to, Scan{.name = "", .cloud = {.points = read_mesh(from).vertices}});
  }
  throw Error(Trouble::usage, to + ": no way to write '" + out + "'",
              "meshes: .ply .obj .stl .off; clouds: .ply .pcd .xyz; poses: .tum .kitti .xf; "
              "disparity: .pfm");
}

}  // namespace

Action convert_command(CommandLine& line) {
  struct Arguments {
    std::string from, to;
  };
  auto arguments = std::make_shared<Arguments>();
  line.input("IN", arguments->from, "the file to read");
  line.input("OUT", arguments->to, "the file to write; its ending names the format");
  return [arguments](Console& console) {
    check_output(arguments->to);
    convert_file(arguments->from, arguments->to, console);
    console.say(arguments->to + ": written");
    console.finish("convert", "ok", {{"file", arguments->to}});
    return 0;
  };
}

}  // namespace scan
