// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Neighbour searches side by side: build, one and ten nearest, on uniform and on surface-like
// clouds, against nanoflann in single precision (leaves of ten).
//
// All run on one thread, in one process, with the same queries in the same order. Each reports
// `checksum`, the sum of its distances, and fails if that is not nanoflann's to single precision.
// After the runs a table gives each time as a multiple of nanoflann's.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <nanoflann.hpp>

#include "libscan/core/parallel.h"
#include "libscan/core/random.h"
#include "libscan/search/search.h"

namespace scan {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t query_count = 20000;

Eigen::Vector3d uniform_point(RandomStream& random) {
  const double x = random.uniform(), y = random.uniform();
  return {x, y, random.uniform()};
}

// A bumpy sphere of radius about 0.4 with a noise of 1e-4, as from a scanner.
Eigen::Vector3d surface_point(RandomStream& random) {
  const double x = random.normal(), y = random.normal();
  const Eigen::Vector3d direction = Eigen::Vector3d(x, y, random.normal()).normalized();
  const double bumps = std::sin(7 * direction.x()) * std::cos(5 * direction.y());
  return direction * (0.4 + 0.05 * bumps + 1e-4 * random.normal());
}

Points draw(const std::string& shape, std::size_t count, std::uint32_t stream) {
  RandomStream random(1, stream, 0);
  Points points(count);
  for (auto& point : points)
    point = shape == "uniform" ? uniform_point(random) : surface_point(random);
  return points;
}

// nanoflann over floats, with the interface of our models as far as it is timed.
class Nanoflann {
 public:
  explicit Nanoflann(std::span<const Eigen::Vector3d> points) {
    for (const auto& point : points) cloud_.points.push_back(point.cast<float>());
    tree_ = std::make_unique<Tree>(3, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    tree_->buildIndex();
  }
  double sum_of_nearest(const Eigen::Vector3d& query, std::size_t k) const {
    const Eigen::Vector3f at = query.cast<float>();
    std::array<std::uint32_t, 10> index;
    std::array<float, 10> distance2;
    const std::size_t found = tree_->knnSearch(at.data(), k, index.data(), distance2.data());
    double sum = 0;
    for (std::size_t i = 0; i < found; ++i) sum += std::sqrt(distance2[i]);
    return sum;
  }

 private:
  struct Cloud {
    std::vector<Eigen::Vector3f> points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return points[i][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Metric = nanoflann::L2_Simple_Adaptor<float, Cloud>;
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Cloud, 3, std::uint32_t>;
  Cloud cloud_;
  std::unique_ptr<Tree> tree_;
};

template <class Search>
double sum_of_nearest(const Search& search, const Eigen::Vector3d& query, std::size_t k,
                      std::vector<Neighbour>& found) {
  if constexpr (std::is_same_v<Search, Nanoflann>) {
    return search.sum_of_nearest(query, k);
  } else {
    if (k == 1) return std::sqrt(search.nearest(query)->distance2_m2);
    search.k_nearest(query, k, found);
    double sum = 0;
    for (const Neighbour& neighbour : found) sum += std::sqrt(neighbour.distance2_m2);
    return sum;
  }
}

// Checksums of nanoflann by case, which it, as the first of each case, sets.
std::map<std::string, double>& reference_sums() {
  static std::map<std::string, double> sums;
  return sums;
}

template <class Search>
void time_queries(benchmark::State& state, const std::string& shape, std::size_t count,
                  std::size_t k) {
  const Search search(draw(shape, count, 1));
  const Points queries = draw(shape, query_count, 2);
  std::vector<Neighbour> found;
  double sum = 0;
  for (auto _ : state) {
    sum = 0;
    for (const auto& query : queries) sum += sum_of_nearest(search, query, k, found);
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(query_count));
  state.counters["checksum"] = sum;
  const std::string name = shape + std::to_string(count) + "/" + std::to_string(k);
  const double reference = reference_sums().try_emplace(name, sum).first->second;
  // Coordinates below 1 lose up to 2^-25 in float, distances here are above 1e-3 on average.
  if (std::abs(sum - reference) > 1e-3 * reference) state.SkipWithError("checksum differs");
}

template <class Search>
void time_build(benchmark::State& state, const std::string& shape, std::size_t count) {
  const Points points = draw(shape, count, 1);
  for (auto _ : state) {
    const Search search(points);
    benchmark::DoNotOptimize(&search);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

template <class Search>
void add(const std::string& model) {
  for (const std::size_t count : {100000, 1000000})
    for (const std::string shape : {"uniform", "surface"}) {
      const std::string of = shape + "/" + std::to_string(count) + "/" + model;
      const auto build = [=](benchmark::State& s) { time_build<Search>(s, shape, count); };
      benchmark::RegisterBenchmark(("build/" + of).c_str(), build)->Unit(benchmark::kMillisecond);
      for (const std::size_t k : {1, 10}) {
        const auto query = [=](benchmark::State& s) { time_queries<Search>(s, shape, count, k); };
        benchmark::RegisterBenchmark((std::to_string(k) + "-nearest/" + of).c_str(), query)
            ->Unit(benchmark::kMillisecond);
      }
    }
}

// The usual lines, and the times by case and model for the table at the end.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.error_occurred) failed_ = true;
      if (run.error_occurred || run.run_type != Run::RT_Iteration) continue;
      const std::string name = run.benchmark_name();
      const std::size_t slash = name.rfind('/');
      const double time = run.GetAdjustedRealTime();
      double& best =
          best_ms_[name.substr(0, slash)].try_emplace(name.substr(slash + 1), time).first->second;
      best = std::min(best, time);
    }
  }
  void print_ratios() const {
    std::printf("\n%-28s time as a multiple of nanoflann's (below 1: quicker)\n", "");
    for (const auto& [name, times] : best_ms_) {
      const auto base = times.find("nanoflann");
      if (base == times.end()) continue;
      std::printf("%-28s nanoflann %8.2f ms", name.c_str(), base->second);
      for (const auto& [model, time] : times)
        if (model != "nanoflann") std::printf("  %s %.2f", model.c_str(), time / base->second);
      std::printf("\n");
    }
  }
  bool failed() const { return failed_; }

 private:
  std::map<std::string, std::map<std::string, double>> best_ms_;
  bool failed_ = false;
};

}  // namespace
}  // namespace scan

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const scan::ThreadLimit one_thread(1);
  scan::add<scan::Nanoflann>("nanoflann");
  scan::add<scan::KdTree>("kd-tree");
  scan::add<scan::Octree>("octree");
  scan::add<scan::FlannIndex>("flann");
  scan::add<scan::PclOctree>("pcl-octree");
  scan::RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.print_ratios();
  return reporter.failed() ? 1 : 0;
}
