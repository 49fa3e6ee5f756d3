// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Neighbour searches side by side, on uniform and on surface-like clouds: building; one nearest,
// ten nearest and all within a radius (that holds ten points about), one query after the other in
// random order; and the same in the order of a curve, by libscan's batches. `moved`: the queries
// once more after a small motion, for which the batch knows the neighbours of before; the peers,
// which have no such thing, are asked anew.
//
// One thread but for the last table, one process, the same queries in the same order for all, the
// rivals in turn, the median of the rounds. Each must come to nanoflann's sum of distances, to
// single precision. Arguments: number of points (1e5 and 1e6 if none), then rounds (7 if none).
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <string>

#include "libscan/core/pose.h"
#include "libscan/core/random.h"
#include "libscan/search/batch.h"
#include "libscan/search/search.h"
#include "tests/benchmarks/search_peers.h"

namespace scan {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t query_count = 20000, brute_force_count = 20, ten_neighbours = 10;

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

Points draw(bool surface, std::size_t count, std::uint32_t stream) {
  RandomStream random(1, stream, 0);
  Points points(count);
  for (auto& point : points) point = surface ? surface_point(random) : uniform_point(random);
  return points;
}

enum class Ask { nearest, ten, within, nearest_curve, ten_curve, nearest_moved };

constexpr std::pair<Ask, const char*> questions[] = {
    {Ask::nearest, "1 nearest"},           {Ask::ten, "10 nearest"},
    {Ask::within, "within radius"},        {Ask::nearest_curve, "1 nearest, batch"},
    {Ask::ten_curve, "10 nearest, batch"}, {Ask::nearest_moved, "1 nearest, batch, moved"}};

struct Work {
  Points points, queries, moved;
  std::vector<std::uint32_t> given, order;
  double radius_m = 0;
};

Work make_work(bool surface, std::size_t count) {
  Work work{draw(surface, count, 1), draw(surface, query_count, 2), {}, {}, {}};
  const KdTree tree(work.points);
  std::vector<Neighbour> found;
  std::vector<double> radii;
  for (const auto& query : work.queries) {
    tree.k_nearest(query, ten_neighbours, found);
    radii.push_back(std::sqrt(found.back().distance2_m2));
  }
  std::nth_element(radii.begin(), radii.begin() + query_count / 2, radii.end());
  work.radius_m = radii[query_count / 2];
  // As between two iterations of ICP: a third of the distance of neighbours.
  const Eigen::Vector3d step = Eigen::Vector3d(1, -1, 1).normalized() * work.radius_m / 6;
  for (const auto& query : work.queries) work.moved.push_back(query + step);
  work.order = curve_order(work.queries);
  for (std::uint32_t i = 0; i < query_count; ++i) work.given.push_back(i);
  return work;
}

// Asks the first `count` queries in the order of the question; returns the sum of distances.
using Rival = std::function<double(Ask, std::size_t count)>;

template <class Peer>
Rival peer(const Work& work) {
  const auto tree = std::make_shared<Peer>(work.points);
  return [tree, &work](Ask ask, std::size_t count) {
    const bool curve =
        ask == Ask::nearest_curve || ask == Ask::ten_curve || ask == Ask::nearest_moved;
    const auto& order = curve ? work.order : work.given;
    const Points& queries = ask == Ask::nearest_moved ? work.moved : work.queries;
    const std::size_t k = ask == Ask::ten || ask == Ask::ten_curve ? ten_neighbours : 1;
    double sum = 0;
    for (std::size_t place = 0; place < count; ++place) {
      const Eigen::Vector3d& query = queries[order[place]];
      sum += ask == Ask::within ? tree->within(query, work.radius_m) : tree->nearest(query, k);
    }
    return sum;
  };
}

double sum_of(std::span<const Neighbour> found) {
  double sum = 0;
  for (const Neighbour& neighbour : found) sum += std::sqrt(neighbour.distance2_m2);
  return sum;
}

template <class Search>
double ask_one_by_one(const Search& search, const Work& work, Ask ask, std::size_t count) {
  std::vector<Neighbour> found;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& query = work.queries[i];
    if (ask == Ask::nearest) {
      sum += std::sqrt(search.nearest(query)->distance2_m2);
      continue;
    }
    if (ask == Ask::ten)
      search.k_nearest(query, ten_neighbours, found);
    else
      search.within(query, work.radius_m, found);
    sum += sum_of(found);
  }
  return sum;
}

template <class Search>
Rival model(const Work& work) {
  const auto tree = std::make_shared<Search>(work.points);
  const auto before = std::make_shared<std::vector<Neighbour>>();
  return [tree, before, &work](Ask ask, std::size_t count) {
    if (ask == Ask::nearest || ask == Ask::ten || ask == Ask::within)
      return ask_one_by_one(*tree, work, ask, count);
    const std::span<const std::uint32_t> order(work.order);
    Points queries;  // those to be asked, when not all are
    if (count < query_count)
      for (const std::uint32_t i : order.first(count))
        queries.push_back(ask == Ask::nearest_moved ? work.moved[i] : work.queries[i]);
    std::vector<Neighbour> found;
    const std::span<const Eigen::Vector3d> asked = count < query_count         ? queries
                                                   : ask == Ask::nearest_moved ? work.moved
                                                                               : work.queries;
    const auto asked_order = count < query_count ? std::span(work.given).first(count) : order;
    if (ask == Ask::ten_curve) {
      k_nearest_of_each(*tree, asked, ten_neighbours, asked_order, found);
      return sum_of(found);
    }
    if (ask == Ask::nearest_moved) found = *before;
    nearest_of_each(*tree, asked, unlimited_m, asked_order, found);
    if (ask == Ask::nearest_curve && count == query_count) *before = found;
    return sum_of(found);
  };
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// Processor time on one thread, else the time on the wall.
double seconds(const std::function<void()>& work, bool on_the_wall = false) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const std::clock_t cpu_begin = std::clock();
  work();
  if (on_the_wall) return std::chrono::duration<double>(Clock::now() - begin).count();
  return static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
}

const std::vector<std::string> names = {"nanoflann", "FLANN",      "kd-tree",
                                        "octree",    "pcl-octree", "brute force"};

void print_head(const char* what, const char* unit) {
  std::printf("\n%-26s %s by nanoflann, then times its speed:\n%-26s", what, unit, "");
  for (const auto& name : names) std::printf(" %11s", name.c_str());
  std::printf("\n");
}

void print_row(const char* what, const std::vector<double>& times, double scale) {
  std::printf("%-26s %11.1f", what, times[0] * scale);
  for (std::size_t i = 1; i < times.size(); ++i) std::printf(" %11.3g", times[0] / times[i]);
  std::printf("\n");
  std::fflush(stdout);
}

bool time_questions(const Work& work, int rounds) {
  const std::vector<Rival> rivals = {peer<Nanoflann>(work),  peer<Flann>(work),
                                     model<KdTree>(work),    model<Octree>(work),
                                     model<PclOctree>(work), model<BruteForce>(work)};
  bool agree = true;
  for (const auto& question : questions) {
    const Ask ask = question.first;
    const char* const name = question.second;
    std::vector<std::vector<double>> times(rivals.size());
    for (int round = 0; round < rounds; ++round)
      for (std::size_t i = 0; i < rivals.size(); ++i) {
        const std::size_t count = names[i] == "brute force" ? brute_force_count : query_count;
        double sum = 0;
        const double s = seconds([&] { sum = rivals[i](ask, count); });
        times[i].push_back(s / static_cast<double>(count));
        if (round > 0) continue;
        // Coordinates below 1 lose up to 2^-25 in float, distances here are above 1e-3 on average;
        // the radius in float may take in or leave out a point on the sphere.
        const double reference = rivals[0](ask, count);
        if (std::abs(sum - reference) <= 1e-3 * reference) continue;
        std::printf("%s, %s: sum %g, must be %g\n", name, names[i].c_str(), sum, reference);
        agree = false;
      }
    std::vector<double> medians;
    for (const auto& of_rival : times) medians.push_back(median(of_rival));
    print_row(name, medians, 1e9);
  }
  return agree;
}

template <class Search>
double build_seconds(const Points& points, bool on_the_wall) {
  return seconds([&] { const Search search(points); }, on_the_wall);
}

void time_builds(const Points& points, int rounds, bool on_the_wall) {
  std::vector<std::vector<double>> times(5);
  for (int round = 0; round < rounds; ++round) {
    times[0].push_back(build_seconds<Nanoflann>(points, on_the_wall));
    times[1].push_back(build_seconds<Flann>(points, on_the_wall));
    times[2].push_back(build_seconds<KdTree>(points, on_the_wall));
    times[3].push_back(build_seconds<Octree>(points, on_the_wall));
    times[4].push_back(build_seconds<PclOctree>(points, on_the_wall));
  }
  std::vector<double> medians;
  for (const auto& of_rival : times) medians.push_back(median(of_rival));
  print_row(on_the_wall ? "build, all threads, ms" : "build, ms", medians, 1e3);
}

bool time_cloud(bool surface, std::size_t count, int rounds) {
  const Work work = make_work(surface, count);
  const std::string what = (surface ? "surface, " : "uniform, ") + std::to_string(count);
  print_head(what.c_str(), "nanoseconds a query");
  time_builds(work.points, rounds, true);
  const ThreadLimit one_thread(1);
  time_builds(work.points, rounds, false);
  const double order_s = seconds([&] { curve_order(work.points); });
  const bool agree = time_questions(work, rounds);
  std::printf("%-26s %11.1f\n", "curve order, a point", 1e9 * order_s / static_cast<double>(count));
  return agree;
}

}  // namespace
}  // namespace scan

int main(int argc, char** argv) {
  std::vector<std::size_t> counts = {100000, 1000000};
  if (argc > 1) counts = {static_cast<std::size_t>(std::atof(argv[1]))};
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 7;
  bool agree = true;
  for (const std::size_t count : counts)
    for (const bool surface : {false, true}) agree &= scan::time_cloud(surface, count, rounds);
  return agree ? 0 : 1;
}
