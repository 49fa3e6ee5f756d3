// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Surface figures beside those of other programs: CloudCompare and Open3D for distances, CGAL for
// the Hausdorff distance, on five pairs of meshes. Each program draws its own 200,000 samples, so
// figures differ by their sampling errors: behind each peer's mean, root mean square and 95 %
// quantile stands the difference over the half-width of the two 95 % intervals together; at most 1
// in 19 of 20 cases. Peers compute in single precision, whose rounding of the coordinates is added.
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "libscan/io/scan_file.h"
#include "libscan/verify/statistics.h"
#include "libscan/verify/surface_error.h"
#include "tests/benchmarks/metrics_peers.h"
#include "tests/benchmarks/open3d_scene.h"
#include "tests/core/meshes.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

constexpr std::size_t samples = 200'000;

Mesh turned(const Mesh& mesh) {
  return transformed(exp((Vector6() << 0.01, 0.02, -0.03, 0.01, 0, 0.02).finished()), mesh);
}

Mesh grown(Mesh mesh, double factor) {
  for (auto& v : mesh.vertices) v *= factor;
  return mesh;
}

std::vector<MetricsCase> cases() {
  const std::filesystem::path data = LIBSCAN_SOURCE_DIR "/../shared/data";
  std::vector<MetricsCase> all;
  all.push_back({"box, turned", turned(cube(1)), cube(1), {}, {}});
  all.push_back({"ring, coarse", torus(3, 1, 60, 30), torus(3, 1, 400, 200), {}, {}});
  all.push_back(
      {"ring, noisy", shaken(torus(3, 1, 300, 150), 0.01), torus(3, 1, 300, 150), {}, {}});
  for (const auto& [name, file] :
       {std::pair("anchor, grown", "anchor.off"), std::pair("quas, noisy", "lordquas.off")}) {
    const auto path = data / "reconbench" / "mesh" / file;
    if (!std::filesystem::exists(path)) continue;
    const Mesh truth = read_mesh(path);
    const double size_m = bounds_of(truth.vertices).diagonal().norm();
    all.push_back(
        {name, file[0] == 'a' ? grown(truth, 1.002) : shaken(truth, 5e-4 * size_m), truth, {}, {}});
  }
  return all;
}

struct Figure {
  double value = NAN, half_width = NAN;
};

Figure with(double value, const std::optional<Interval>& interval) {
  return {value, interval ? (interval->high - interval->low) / 2 : 0};
}

std::array<Figure, 3> figures_of(const std::vector<double>& distances_m) {
  return {with(mean(distances_m), mean_interval(distances_m)),
          with(root_mean_square(distances_m), root_mean_square_interval(distances_m)),
          with(quantile(distances_m, 0.95), quantile_interval(distances_m, 0.95))};
}

void print(const char* program, const std::array<Figure, 3>& figures,
           const std::array<Figure, 3>& own, double rounding_m) {
  std::printf("  %-13s", program);
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const double both = std::hypot(figures[i].half_width, own[i].half_width) + rounding_m;
    std::printf("  %.6g (%.2f)", figures[i].value,
                std::abs(figures[i].value - own[i].value) / both);
  }
  std::printf("\n");
}

void compare(MetricsCase& of, const std::filesystem::path& folder) {
  of.measured_file = folder / "measured.ply";
  of.truth_file = folder / "truth.ply";
  write_mesh(of.measured_file, of.measured);
  write_mesh(of.truth_file, of.truth);
  const auto figures = surface_error(of.measured, {{}, {of.truth}}, {.samples = samples});
  std::array<Figure, 3> own;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const auto& m =
        measurement(figures, std::array{"accuracy_mean", "accuracy_rms", "accuracy_p95"}[i]);
    own[i] = with(m.value, m.interval);
  }
  std::printf("%s: %zu and %zu triangles\n", of.name, of.measured.triangles.size(),
              of.truth.triangles.size());
  std::printf("  %-13s", "libscan");
  for (const Figure& f : own) std::printf("  %.6g +- %.1e", f.value, f.half_width);
  std::printf("\n");
  const Bounds box = bounds_of(of.truth.vertices);
  const double rounding_m =
      0x1p-23 * std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  if (const auto peer = cloudcompare_distances_m(of, samples))
    print("CloudCompare", figures_of(*peer), own, rounding_m);
  if (const auto peer = Open3dScene::of(of.truth)) {
    const auto distances_m = peer->distances_m(open3d_samples(of.measured, samples));
    print("Open3D", figures_of({distances_m.begin(), distances_m.end()}), own, rounding_m);
  }
  const double bound_m = 1e-4 * box.diagonal().norm();
  const Interval hausdorff = measurement(figures, "hausdorff").interval.value();
  std::printf("  Hausdorff: libscan %.6g to %.6g, CGAL %.6g +- %.1g\n", hausdorff.low,
              hausdorff.high, cgal_hausdorff_m(of, bound_m), bound_m);
  std::fflush(stdout);
}

}  // namespace
}  // namespace scan

int main() {
  const auto folder =
      std::filesystem::temp_directory_path() / ("libscan-metrics-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::printf("mean, root mean square, 95 %% quantile of the distances to the truth\n");
  for (scan::MetricsCase& of : scan::cases()) scan::compare(of, folder);
  std::filesystem::remove_all(folder);
}
