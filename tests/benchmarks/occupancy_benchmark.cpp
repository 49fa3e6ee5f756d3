// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Share of the reconstruction benchmark's 100,000 places (Berger et al. 2013) that a surface from
// the 3,000 points has on the right side, and what the points themselves allow.
//
//   occupancy_benchmark [DATA_DIR]
//
// Each method; then SSD from the same places without noise and with the true normals, and from the
// points with true samples added where the scan has none within 1.5 spacings. Of the wrong places,
// how many lie beside such a gap, and how many are empty with a ray passing within a spacing before
// its end: the others no ray tells.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/reconstruct.h"
#include "libscan/search/kd_tree.h"
#include "libscan/verify/true_surface_parts.h"
#include "tests/benchmarks/reconstruct_inputs.h"

namespace scan {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

constexpr std::size_t places = 100'000;
constexpr double gap_spacings = 1.5;

std::size_t number_at(const Bytes& bytes, std::size_t at) {
  return bytes.at(at) + 256u * bytes.at(at + 1);
}

// What is deflated at `at`; moves `at` behind it.
Bytes inflated(Bytes& bytes, std::size_t& at) {
  Bytes out(1 << 20);
  z_stream stream{};
  stream.next_in = bytes.data() + at;
  stream.avail_in = static_cast<unsigned>(bytes.size() - at);
  stream.next_out = out.data();
  stream.avail_out = static_cast<unsigned>(out.size());
  const bool done = inflateInit2(&stream, -MAX_WBITS) == Z_OK && inflate(&stream, Z_FINISH) == 1;
  at += stream.total_in;
  out.resize(stream.total_out);
  inflateEnd(&stream);
  if (!done) throw Error(Trouble::input, "points.npz: an array that is not deflated");
  return out;
}

// The numbers of an array of a NumPy archive, as they are stored.
Bytes array_in(const fs::path& file, const std::string& name) {
  std::ifstream in(file, std::ios::binary);
  Bytes zip((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const Bytes mark = {'P', 'K', 3, 4};
  for (std::size_t at = 0;;) {
    const auto entry = std::search(zip.begin() + static_cast<std::ptrdiff_t>(at), zip.end(),
                                   mark.begin(), mark.end());
    if (entry == zip.end()) throw Error(Trouble::input, file.string() + ": no array " + name);
    at = static_cast<std::size_t>(entry - zip.begin());
    const std::string found(entry + 30, entry + 30 + static_cast<int>(number_at(zip, at + 26)));
    at += 30 + number_at(zip, at + 26) + number_at(zip, at + 28);
    const Bytes numpy = inflated(zip, at);
    if (found != name) continue;
    return {numpy.begin() + 10 + static_cast<int>(number_at(numpy, 8)), numpy.end()};
  }
}

double from_half(std::size_t bits) {
  const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
  const double size =
      exponent > 0 ? std::ldexp(1024 + mantissa, exponent - 25) : std::ldexp(mantissa, -24);
  return bits >> 15 ? -size : size;
}

class Question {
 public:
  Question(const std::string& name, const fs::path& data)
      : input(make_reconstruct_input(name + "-3000", data)),
        truth(input.truth.meshes.front()),
        spacing_m(std::sqrt(area_m2(truth.mesh()) / static_cast<double>(input.cloud.size()))),
        tree_(input.cloud.points) {
    const fs::path file = data / "reconbench" / "eval" / name / "points.npz";
    const Bytes halves = array_in(file, "points.npy"), bits = array_in(file, "occupancies.npy");
    for (std::size_t i = 0; i < places; ++i) {
      Eigen::Vector3d x;
      for (std::size_t a = 0; a < 3; ++a) x[a] = from_half(number_at(halves, 2 * (3 * i + a)));
      place_.push_back(x);
      inside_.push_back(bits.at(i / 8) >> (7 - i % 8) & 1);
    }
  }

  void print_row(const std::string& name, const Mesh& mesh) const {
    const MeshPart part(mesh);
    std::vector<char> wrong(places), gap(places), ray(places);
    parallel_for(places, [&](std::size_t i) {
      wrong[i] = (part.nearest(place_[i]).signed_distance_m < 0) != inside_[i];
      if (!wrong[i]) return;
      gap[i] = is_in_gap(truth.nearest(place_[i]).point);
      ray[i] = !inside_[i] && is_passed(place_[i]);
    });
    const auto share = [](const std::vector<char>& which) {
      return 100 * static_cast<double>(std::count(which.begin(), which.end(), 1)) / places;
    };
    std::printf("  %-14s %8.2f %8.2f %8.2f\n", name.c_str(), 100 - share(wrong), share(gap),
                share(ray));
    std::fflush(stdout);
  }

  bool is_in_gap(const Eigen::Vector3d& x) const {
    return std::sqrt(tree_.nearest(x, unlimited_m)->distance2_m2) > gap_spacings * spacing_m;
  }

  ReconstructInput input;
  MeshPart truth;
  double spacing_m;

 private:
  // Whether a ray from a scanner passes within a spacing before it ends at its point.
  bool is_passed(const Eigen::Vector3d& x) const {
    for (std::size_t i = 0; i < input.cloud.size(); ++i) {
      const Eigen::Vector3d ray = input.cloud.points[i] - input.viewpoints[i];
      const double along = (x - input.viewpoints[i]).dot(ray) / ray.squaredNorm();
      if (along >= 0 && along <= 1 && (input.viewpoints[i] + along * ray - x).norm() < spacing_m)
        return true;
    }
    return false;
  }

  KdTree tree_;
  std::vector<Eigen::Vector3d> place_;
  std::vector<char> inside_;
};

void print_methods(const Question& question) {
  const ReconstructInput& in = question.input;
  for (std::size_t m = 1; m < reconstruct_method_names().size(); ++m) {
    const auto method = static_cast<ReconstructMethod>(m);
    try {
      question.print_row(std::string(name_of(method)),
                         reconstruct(in.cloud, in.viewpoints, {.method = method}).surface);
    } catch (const Error& error) {
      std::printf("  %-14s %s\n", std::string(name_of(method)).c_str(), error.what());
    }
  }
}

void print_limits(const Question& question) {
  PointCloud exact = question.input.cloud, filled = exact;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const PartNearest nearest = question.truth.nearest(exact.points[i]);
    exact.points[i] = nearest.point;
    exact.normals[i] = nearest.normal;
  }
  std::vector<Eigen::Vector3d> viewpoints = question.input.viewpoints;
  for (const SurfaceSample& sample : sample_surface(question.truth.mesh(), exact.size(), 3)) {
    if (!question.is_in_gap(sample.point)) continue;
    filled.points.push_back(sample.point);
    filled.normals.push_back(sample.normal);
    viewpoints.push_back(sample.point + question.spacing_m * sample.normal);
  }
  question.print_row("ssd, exact", reconstruct(exact, question.input.viewpoints, {}).surface);
  question.print_row("ssd, filled", reconstruct(filled, viewpoints, {}).surface);
  std::printf("  (%zu of %zu true samples lie in gaps)\n", filled.size() - exact.size(),
              exact.size());
}

int run(const fs::path& data) {
  for (const char* name : {"anchor", "lordquas"}) {
    const Question question(name, data);
    std::printf("%s: per cent of %zu places\n  %-14s %8s %8s %8s\n", name, places, "", "right",
                "wrong by", "wrong by");
    std::printf("  %-14s %8s %8s %8s\n", "", "", "a gap", "tells");
    question.print_row("truth", question.truth.mesh());
    print_methods(question);
    print_limits(question);
  }
  return 0;
}

}  // namespace
}  // namespace scan

int main(int argc, char** argv) {
  try {
    return scan::run(argc > 1 ? argv[1] : LIBSCAN_SOURCE_DIR "/../shared/data");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
