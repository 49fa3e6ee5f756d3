// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What SSD costs on a torus whose ripples ask for cells of depth 10: seconds and memory against
// points and depth, with the slopes of their logarithms.
//
//     ssd_scaling [--points 1e4,1e5,1e6] [--depths 8,9,10] [--threads 1,2] [--memory GiB]
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "libscan/core/cost.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/core/random.h"
#include "libscan/reconstruct/ssd.h"

namespace scan {
namespace {

// At depth 10 a cell is 2.8 mm: a ripple is some nine cells long, and a million points are closer
// than a cell.
constexpr double ring_m = 1, tube_m = 0.15, ripple_m = 0.0015;
constexpr double ripples_along = 240, ripples_around = 36;

double tube_radius_m(double along, double around) {
  return tube_m + ripple_m * std::sin(ripples_along * along) * std::sin(ripples_around * around);
}

struct Side {
  double value_m;  // below zero inside
  Eigen::Vector3d slope;
};

Side side_of(const Eigen::Vector3d& x) {
  const double from_axis = std::hypot(x[0], x[1]), from_ring = std::hypot(from_axis - ring_m, x[2]);
  const double along = std::atan2(x[1], x[0]), around = std::atan2(x[2], from_axis - ring_m);
  const Eigen::Vector3d outwards(std::cos(along), std::sin(along), 0),
      up = Eigen::Vector3d::UnitZ();
  const double a = ripples_along * along, b = ripples_around * around;
  const Eigen::Vector3d radial = std::cos(around) * outwards + std::sin(around) * up;
  const Eigen::Vector3d ahead(-std::sin(along), std::cos(along), 0);
  const Eigen::Vector3d turned = std::cos(around) * up - std::sin(around) * outwards;
  return {from_ring - tube_radius_m(along, around),
          radial - ripple_m * (ripples_along * std::cos(a) * std::sin(b) / from_axis * ahead +
                               ripples_around * std::sin(a) * std::cos(b) / from_ring * turned)};
}

PointCloud rippled_torus(std::size_t count) {
  PointCloud cloud;
  RandomStream random(1, 0, 0);
  while (cloud.size() < count) {
    const double along = 2 * std::numbers::pi * random.uniform();
    const double around = 2 * std::numbers::pi * random.uniform();
    const double tube = tube_radius_m(along, around);
    const double from_axis = ring_m + tube * std::cos(around);
    if (random.uniform() * (ring_m + tube_m + ripple_m) > from_axis) continue;
    cloud.points.emplace_back(from_axis * std::cos(along), from_axis * std::sin(along),
                              tube * std::sin(around));
    cloud.normals.push_back(side_of(cloud.points.back()).slope.normalized());
  }
  return cloud;
}

// To first order, of the vertices, in 1e-5 of the box's diagonal.
double mean_error(const Mesh& mesh) {
  double sum = 0;
  for (const Eigen::Vector3d& x : mesh.vertices) {
    const Side side = side_of(x);
    sum += std::abs(side.value_m) / side.slope.norm();
  }
  const double wide_m = 2 * (ring_m + tube_m), high_m = 2 * tube_m;
  return 1e5 * sum / static_cast<double>(mesh.vertices.size()) /
         std::sqrt(2 * wide_m * wide_m + high_m * high_m);
}

struct Run {
  double points = 0;
  int depth = 0;
  double seconds = 0, cpu_seconds = 0, peak_mib = 0;
};

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Run print_run(const PointCloud& cloud, int depth, double memory_gib) {
  restart_peak_memory();
  const double cpu_before = cpu_seconds();
  const Stopwatch watch;
  const SurfaceResult result = ssd(cloud, {.depth = depth, .memory_gib = memory_gib});
  const Run run{static_cast<double>(cloud.size()), depth, watch.seconds(),
                cpu_seconds() - cpu_before, peak_memory_mib()};
  std::printf("%9.0f %5d %7d %5zu %9zu %10zu %9.1f %9.1f %8.0f %7.3f %9.3f\n", run.points, depth,
              result.depth, result.parts.parts_per_axis, result.unknowns,
              result.surface.triangles.size(), run.seconds, run.cpu_seconds, run.peak_mib,
              mean_error(result.surface), 1e3 * result.parts.seam_rms_m);
  std::fflush(stdout);
  return run;
}

// Of the line through the logarithms with the least squares.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a;
    sy += b;
    sxx += a * a;
    sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

// Against `x(run)`, of the runs that `chosen` takes.
template <class Chosen, class X>
void print_slopes(const std::vector<Run>& runs, const std::string& heading, Chosen&& chosen,
                  X&& x) {
  std::vector<double> xs, seconds, cpu, peaks;
  for (const Run& run : runs) {
    if (!chosen(run)) continue;
    xs.push_back(x(run));
    seconds.push_back(run.seconds);
    cpu.push_back(run.cpu_seconds);
    peaks.push_back(run.peak_mib);
  }
  if (xs.size() > 1)
    std::printf("%s: seconds %.2f, CPU seconds %.2f, MiB %.2f\n", heading.c_str(),
                slope(xs, seconds), slope(xs, cpu), slope(xs, peaks));
}

struct Arguments {
  std::vector<double> points{1e4, 1e5, 1e6}, depths{8, 9, 10}, threads{1, 2};
  double memory_gib = SsdOptions().memory_gib;
};

void print_table(const Arguments& arguments, int threads) {
  const ThreadLimit limit(threads);
  std::printf("\n%d threads; mean error in 1e-5 of the diagonal\n", threads);
  std::printf("%9s %5s %7s %5s %9s %10s %9s %9s %8s %7s %9s\n", "points", "depth", "reached",
              "parts", "unknowns", "triangles", "seconds", "CPU s", "MiB", "error", "seam/mm");
  std::vector<Run> runs;
  for (const double points : arguments.points) {
    const PointCloud cloud = rippled_torus(static_cast<std::size_t>(points));
    for (const double depth : arguments.depths)
      runs.push_back(print_run(cloud, static_cast<int>(depth), arguments.memory_gib));
  }
  for (const double depth : arguments.depths)
    print_slopes(
        runs, "slope against points, depth " + std::to_string(static_cast<int>(depth)),
        [&](const Run& run) { return run.depth == depth; },
        [](const Run& run) { return run.points; });
  for (const double points : arguments.points)
    print_slopes(
        runs,
        "slope against cells along an edge, " + std::to_string(static_cast<long>(points)) +
            " points",
        [&](const Run& run) { return run.points == points; },
        [](const Run& run) { return std::ldexp(1.0, run.depth); });
}

std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string number; std::getline(stream, number, ',');) numbers.push_back(std::stod(number));
  return numbers;
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string flag = argv[i];
    if (i + 1 == argc) throw Error(Trouble::usage, flag + ": needs a value");
    const std::vector<double> numbers = numbers_in(argv[i + 1]);
    if (flag == "--points")
      arguments.points = numbers;
    else if (flag == "--depths")
      arguments.depths = numbers;
    else if (flag == "--threads")
      arguments.threads = numbers;
    else if (flag == "--memory")
      arguments.memory_gib = numbers.front();
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
    for (const double threads : arguments.threads)
      scan::print_table(arguments, static_cast<int>(threads));
    return 0;
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
