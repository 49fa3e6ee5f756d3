// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Alignment without a first guess, counted: success per overlap over real scans split in two, wrong
// answers over pairs that have nothing in common, the bunny's scans among each other, and the time
// of the consensus against the share of outliers.
//
// global_benchmark [pairs per level, 100] [pairs of them that the Point Cloud Library tries too, at
// nearly a minute each, 2]
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "libscan/align/consensus.h"
#include "libscan/align/global.h"
#include "libscan/core/cost.h"
#include "libscan/core/parallel.h"
#include "tests/benchmarks/pcl_prerejective.h"
#include "tests/real_data/pair_sets.h"

namespace scan::test {
namespace {

double processor_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

struct Count {
  int pairs = 0, right = 0, wrong = 0, ambiguous = 0, none = 0;
  double seconds = 0;  // of processor time, descriptors included
  double features_seconds = 0;
};

void print(const std::string& name, const Count& count) {
  std::printf("%-32s %5d %6d %6d %10d %6d %9.0f %9.0f\n", name.c_str(), count.pairs, count.right,
              count.wrong, count.ambiguous, count.none, 1e3 * count.features_seconds / count.pairs,
              1e3 * (count.seconds - count.features_seconds) / count.pairs);
  std::fflush(stdout);
}

// Right: within a side of the cubes, about 1/50 of the extent.
void add(Count& count, const RealPair& pair, bool overlaps) {
  const double start = processor_seconds();
  const auto [source, target] = describe_pair(pair);
  count.features_seconds += processor_seconds() - start;
  const GlobalResult result = align_globally(source, target);
  count.seconds += processor_seconds() - start;
  ++count.pairs;
  count.none += result.outcome == GlobalOutcome::no_overlap;
  count.ambiguous += result.outcome == GlobalOutcome::ambiguous;
  if (result.outcome != GlobalOutcome::aligned) return;
  const Pose& found = result.hypotheses[0].target_from_source;
  const bool right = overlaps && sides_apart(source, found, pair.target_from_source) < 1;
  ++(right ? count.right : count.wrong);
}

void add_peer(Count& count, const RealPair& pair) {
  const auto [source, target] = describe_pair(pair);
  const double start = processor_seconds();
  const auto found = pcl_prerejective(source, target);
  count.seconds += processor_seconds() - start;
  ++count.pairs;
  if (!found) {
    ++count.none;
    return;
  }
  // It is not refined: three sides are in the reach of what would refine it.
  ++(sides_apart(source, *found, pair.target_from_source) < 3 ? count.right : count.wrong);
}

void split_pairs(const std::vector<RealCloud>& clouds, int pairs, int peer_pairs) {
  for (const double overlap : {1.0, 0.7, 0.5, 0.3}) {
    Count ours, peer;
    for (int k = 0; k < pairs; ++k) {
      const RealPair pair =
          split_pair(clouds[std::size_t(k) % clouds.size()], overlap, std::uint64_t(k));
      add(ours, pair, true);
      if (k < peer_pairs) add_peer(peer, pair);
    }
    const std::string level = std::to_string(int(100 * overlap)) + " % overlap";
    print(level, ours);
    if (peer_pairs > 0) print(level + ", PCL prerejective", peer);
  }
}

void unrelated_pairs(const std::vector<RealCloud>& clouds, int pairs) {
  Count count;
  for (std::uint64_t round = 0; count.pairs < pairs; ++round)
    for (std::size_t i = 0; i < clouds.size() && count.pairs < pairs; ++i)
      for (std::size_t j = 0; j < clouds.size() && count.pairs < pairs; ++j)
        if (clouds[i].thing != clouds[j].thing && (i + 3 * j + round) % 2 == 0)
          add(count, unrelated_pair(clouds[i], clouds[j], 1000 * round + 50 * i + j), false);
  print("different things", count);
}

void bunny_pairs(const std::vector<RealCloud>& scans, const std::vector<NamedPose>& published) {
  Count count;
  std::vector<PointCloud> clouds;
  std::vector<ScanFeatures> features;
  const double start = processor_seconds();
  for (const RealCloud& scan : scans) clouds.push_back(scan.cloud);
  const double side_m = feature_side_m(clouds);
  for (const RealCloud& scan : scans)
    features.push_back(describe(scan.cloud, side_m, scan.viewpoint));
  count.features_seconds = processor_seconds() - start;
  for (std::size_t i = 0; i < scans.size(); ++i)
    for (std::size_t j = i + 1; j < scans.size(); ++j) {
      const GlobalResult result = align_globally(features[j], features[i]);
      ++count.pairs;
      count.none += result.outcome == GlobalOutcome::no_overlap;
      count.ambiguous += result.outcome == GlobalOutcome::ambiguous;
      if (result.outcome != GlobalOutcome::aligned) continue;
      const Pose truth = published[i].pose.inverse() * published[j].pose;
      const Pose& found = result.hypotheses[0].target_from_source;
      ++(sides_apart(features[j], found, truth) < 1 ? count.right : count.wrong);
    }
  count.seconds = processor_seconds() - start;
  print("bunny, ten scans", count);
  std::printf("  %.2f s of processor time for all, peak %.0f MiB\n", count.seconds,
              peak_memory_mib());
}

// Points of a unit cube with 1 cm of noise, outliers in a cube of 5 m.
std::vector<Correspondence> correspondences(std::size_t count, double outliers) {
  RandomStream random(1, 0, count);
  const Pose motion = any_motion(random, 1);
  const auto in_cube = [&](double side_m) -> Eigen::Vector3d {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return side_m * (Eigen::Vector3d(x, y, z).array() - 0.5);
  };
  std::vector<Correspondence> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    all[i].source = in_cube(1);
    if (double(i) < outliers * double(count))
      all[i].target = in_cube(5);
    else
      all[i].target = motion * all[i].source + 0.01 * normal_vector(random);
  }
  return all;
}

void consensus_times() {
  std::printf("\nconsensus, milliseconds of processor time (least of five)\n%12s", "outliers");
  const std::vector<double> shares = {0, 0.5, 0.9, 0.95, 0.99};
  for (const double share : shares) std::printf("%8.0f %%", 100 * share);
  for (const std::size_t count : {100, 500, 1000, 2000, 5000}) {
    std::printf("\n%12zu", count);
    for (const double share : shares) {
      const auto all = correspondences(count, share);
      double least = 1e9;
      for (int k = 0; k < 5; ++k) {
        const double start = processor_seconds();
        find_consensus(all, {.noise_m = 0.03, .least_distance_m = 0.06});
        least = std::min(least, processor_seconds() - start);
      }
      std::printf("%10.1f", 1e3 * least);
    }
  }
  std::printf("\n");
}

int run(int pairs, int peer_pairs) {
  const ThreadLimit two(2);
  const std::filesystem::path data = std::filesystem::path(LIBSCAN_SOURCE_DIR) / "../shared/data";
  if (!std::filesystem::exists(data)) {
    std::fprintf(stderr, "the data is not in %s\n", data.c_str());
    return 1;
  }
  const auto published = read_poses(data / "stanford-bunny/data/bun.conf");
  const std::vector<RealCloud> bunny = bunny_scans(data);
  std::vector<RealCloud> all = bunny;
  for (RealCloud& cloud : other_clouds(data)) all.push_back(std::move(cloud));
  std::printf("%-32s %5s %6s %6s %10s %6s %9s %9s\n", "pairs", "count", "right", "wrong",
              "ambiguous", "none", "features", "ms each");
  split_pairs(all, pairs, peer_pairs);
  unrelated_pairs(all, pairs);
  bunny_pairs(bunny, published);
  consensus_times();
  return 0;
}

}  // namespace
}  // namespace scan::test

int main(int argc, char** argv) {
  return scan::test::run(argc > 1 ? std::atoi(argv[1]) : 100, argc > 2 ? std::atoi(argv[2]) : 2);
}
