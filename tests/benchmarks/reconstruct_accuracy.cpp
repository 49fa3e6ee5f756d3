// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Surfaces by each method from each input, held against the truth: distances both ways, normals,
// topology, slivers, seconds and memory, beside what peers reach and what is wanted.
//
//   reconstruct_accuracy [--inputs A,B*] [--methods C,D*] [--points N] [--depth N] [--threads N]
//                        [--data DIR]
//
// The depth is SSD's most. A sliver's height is below 1e-3 of its longest side.
// Names may end in *. Each run has a process of its own, so that its memory is its own and a peer
// that dies leaves only its own row empty.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>

#include "libscan/core/cost.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/reconstruct.h"
#include "libscan/verify/surface_error.h"
#include "tests/benchmarks/reconstruct_inputs.h"
#include "tests/benchmarks/reconstruct_peers.h"
#include "tests/benchmarks/reconstruct_targets.h"
#ifdef LIBSCAN_WITH_CGAL
#include "libscan/reconstruct/advancing_front.h"
#include "libscan/reconstruct/cgal_poisson.h"
#include "libscan/reconstruct/cgal_scale_space.h"
#endif

namespace scan {
namespace {

namespace fs = std::filesystem;

struct Method {
  std::string name;
  std::function<Mesh(const ReconstructInput&, int depth)> surface;
};

// Those of libscan as `scan reconstruct` calls them, then peers as they come.
std::vector<Method> all_methods() {
  std::vector<Method> list;
  const auto add = [&](const std::string& name, ReconstructMethod method, bool sharp, bool quads) {
    list.push_back(
        {name, [=](const ReconstructInput& in, int depth) {
           return reconstruct(
                      in.cloud, in.viewpoints,
                      {.method = method, .ssd = {.depth = depth}, .sharp = sharp, .quads = quads})
               .surface;
         }});
  };
  for (std::size_t i = 0; i < reconstruct_method_names().size(); ++i)
    add(reconstruct_method_names()[i], static_cast<ReconstructMethod>(i), false, false);
  for (const auto method : {ReconstructMethod::ssd, ReconstructMethod::rbf}) {
    add(std::string(name_of(method)) + "-sharp", method, true, false);
    add(std::string(name_of(method)) + "-quads", method, false, true);
  }
#ifdef LIBSCAN_WITH_CGAL
  list.push_back({"cgal-poisson", [](const auto& in, int) { return cgal_poisson(in.cloud); }});
  list.push_back(
      {"cgal-front", [](const auto& in, int) { return advancing_front(in.cloud.points); }});
  list.push_back({"cgal-scale-space",
                  [](const auto& in, int) { return cgal_scale_space(in.cloud.points, 4); }});
#endif
  list.push_back({"pcl-poisson", [](const auto& in, int) { return pcl_poisson(in.cloud); }});
#ifdef LIBSCAN_WITH_OPEN3D
  list.push_back({"open3d-poisson", [](const auto& in, int) { return open3d_poisson(in.cloud); }});
#endif
  return list;
}

const std::vector<Method>& methods() {
  static const std::vector<Method> list = all_methods();
  return list;
}

struct Arguments {
  std::string inputs = "*";
  std::string methods = "*";
  std::string data = LIBSCAN_SOURCE_DIR "/../shared/data";
  std::size_t points = 100'000;
  int depth = SsdOptions{}.depth;
  int threads = 2;
  bool only_row = false;  // print the figures of one run: how the program calls itself
};

bool matches(const std::string& patterns, const std::string& name) {
  std::istringstream list(patterns);
  for (std::string pattern; std::getline(list, pattern, ',');)
    if (pattern == name ||
        (pattern.ends_with('*') && name.starts_with(pattern.substr(0, pattern.size() - 1))))
      return true;
  return false;
}

std::map<std::string, double> figures(const Mesh& mesh, const TrueSurface& truth) {
  std::map<std::string, double> values;
  for (const Measurement& m : surface_error(mesh, truth, {.samples = 100'000}))
    values[m.name] = m.value;
  return values;
}

// Euler's number is 2 (components - genus); each open rim counts for half a handle.
double genus_of(const EdgeCensus& census) {
  return static_cast<double>(census.components) -
         static_cast<double>(census.euler_characteristic) / 2;
}

// Per 10,000 triangles.
double slivers(const Mesh& mesh) {
  std::size_t count = 0;
  for (const Triangle& t : mesh.triangles) {
    double longest_m = 0;
    for (int k = 0; k < 3; ++k)
      longest_m = std::max(longest_m, (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).norm());
    count += !(area_vector(mesh, t).norm() >= 1e-3 * longest_m * longest_m);
  }
  return 1e4 * static_cast<double>(count) / static_cast<double>(mesh.triangles.size());
}

void print_row(const ReconstructInput& input, const Method& method, int depth) {
  restart_peak_memory();
  const Stopwatch watch;
  const Mesh mesh = method.surface(input, depth);
  const double seconds = watch.seconds(), memory_mib = peak_memory_mib();
  if (mesh.empty()) throw Error(Trouble::computation, "no surface");
  const auto values = figures(mesh, input.truth);
  const EdgeCensus census = edge_census(mesh);
  const double unit = 1e-5 * input.diagonal_m;
  std::printf("%9.4g %9.4g %7.2f %7.3g %6zu %7g %7zu %8.3g %8.2f %7.0f\n",
              values.at("accuracy_mean") / unit, values.at("completeness_mean") / unit,
              values.at("normal_error_mean") * 180 / std::numbers::pi,
              values.at("accuracy_max") / input.diagonal_m * 100, census.components,
              genus_of(census), census.boundary_edges, slivers(mesh), seconds, memory_mib);
}

void print_heading(const std::string& input) {
  std::printf("\n%s\n", input.c_str());
  for (const ReconstructTarget& target : reconstruct_targets)
    if (target.input == input)
      std::printf("  SSDRecon %s; best peer %s; wanted %s\n", target.ssdrecon.data(),
                  target.best_peer.data(), target.wanted.data());
  std::printf("  %-18s %9s %9s %7s %7s %6s %7s %7s %8s %8s %7s\n", "method", "to truth", "to surf.",
              "deg", "max %", "comp.", "genus", "open", "slivers", "seconds", "MiB");
}

std::string output_of(const std::string& command) {
  std::string text;
  if (FILE* pipe = popen(command.c_str(), "r")) {
    char part[256];
    while (std::fgets(part, sizeof part, pipe)) text += part;
    pclose(pipe);
  }
  return text.empty() ? "died\n" : text;
}

int print_table(const Arguments& arguments) {
  std::printf(
      "distances in 1e-5 of the diagonal; largest in per cent of it; slivers per 10,000 triangles; "
      "%zu points, "
      "%d threads\n",
      arguments.points, arguments.threads);
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  for (const std::string& input : reconstruct_input_names()) {
    if (!matches(arguments.inputs, input)) continue;
    print_heading(input);
    for (const Method& method : methods()) {
      if (!matches(arguments.methods, method.name)) continue;
      const std::string row =
          output_of("'" + program + "' --only-row --inputs " + input + " --methods " + method.name +
                    " --points " + std::to_string(arguments.points) + " --depth " +
                    std::to_string(arguments.depth) + " --threads " +
                    std::to_string(arguments.threads) + " --data '" + arguments.data + "'");
      std::printf("  %-18s %s", method.name.c_str(), row.c_str());
      std::fflush(stdout);
    }
  }
  return 0;
}

int print_only_row(const Arguments& arguments) {
  const ReconstructInput input =
      make_reconstruct_input(arguments.inputs, arguments.data, arguments.points);
  for (const Method& method : methods())
    if (arguments.methods == method.name) print_row(input, method, arguments.depth);
  return 0;
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    if (flag == "--only-row") {
      arguments.only_row = true;
      continue;
    }
    if (i + 1 == argc) throw Error(Trouble::usage, flag + ": needs a value");
    const std::string value = argv[++i];
    if (flag == "--inputs")
      arguments.inputs = value;
    else if (flag == "--methods")
      arguments.methods = value;
    else if (flag == "--data")
      arguments.data = value;
    else if (flag == "--points")
      arguments.points = std::stoul(value);
    else if (flag == "--depth")
      arguments.depth = std::stoi(value);
    else if (flag == "--threads")
      arguments.threads = std::stoi(value);
    else
      throw Error(Trouble::usage, flag + ": unknown");
  }
  return arguments;
}

}  // namespace
}  // namespace scan

int main(int argc, char** argv) {
  try {
    const scan::Arguments arguments = scan::parse(argc, argv);
    const scan::ThreadLimit limit(arguments.threads);
    return arguments.only_row ? scan::print_only_row(arguments) : scan::print_table(arguments);
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
