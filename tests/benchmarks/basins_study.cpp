// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Convergence basins: which share of starts each method solves, against how far off they are, for
// six shapes and four overlaps, libscan's methods beside PCL's and Open3D's; and how fast.
//
//   basins_study trials FOLDER STARTS SHAPE...   writes FOLDER/SHAPE.csv, on one thread; goes on
//                                                where an earlier call was ended, each method for
//                                                itself: of one that has changed delete the rows
//   basins_study figures FOLDER OUT              tables and pictures of all trials in FOLDER
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "libscan/align/icp.h"
#include "libscan/core/parallel.h"
#include "libscan/io/atomic_file.h"
#include "tests/benchmarks/align_peers.h"
#include "tests/benchmarks/basins_figures.h"
#include "tests/benchmarks/basins_pairs.h"

namespace scan::test {
namespace {

constexpr std::size_t points = 2000;
constexpr std::array overlaps = {1.0, 0.75, 0.5, 0.25};
constexpr std::array turns_deg = {5.0, 15.0, 30.0, 45.0, 60.0, 90.0};
constexpr std::array shifts_percent = {5.0, 10.0, 20.0, 35.0, 50.0};

template <IcpMethod method>
Outcome by_libscan(const PairCase& pair) {
  const IcpResult result = icp(pair.source, pair.target, pair.guess, {.method = method});
  return {.pose = result.target_from_source, .stop = std::string(name_of(result.stop))};
}

std::vector<AlignPeer> methods() {
  std::vector<AlignPeer> all = {{"symmetric", by_libscan<IcpMethod::symmetric>},
                                {"plane-to-plane", by_libscan<IcpMethod::plane_to_plane>},
                                {"point-to-plane", by_libscan<IcpMethod::point_to_plane>},
                                {"point-to-point", by_libscan<IcpMethod::point_to_point>}};
  for (const AlignPeer& peer : pcl_align_peers())
    if (peer.name != "PCL plane") all.push_back(peer);
  for (const AlignPeer& peer : open3d_align_peers(1)) all.push_back(peer);
  return all;
}

// Processor time, so that other work on the machine does not count.
double processor_s() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

constexpr std::size_t of_a_start = overlaps.size() * (turns_deg.size() + shifts_percent.size());

// How many starts of a shape a method has been through.
std::size_t starts_of(const std::string& method, const std::vector<Trial>& trials) {
  return static_cast<std::size_t>(
             std::count_if(trials.begin(), trials.end(),
                           [&](const Trial& trial) { return trial.method == method; })) /
         of_a_start;
}

void try_all(const PairCase& pair, Trial trial, const std::vector<AlignPeer>& methods,
             std::vector<Trial>& trials) {
  for (const AlignPeer& method : methods) {
    const double begin_s = processor_s();
    const Outcome outcome = method.align(pair);
    trial.seconds = processor_s() - begin_s;
    trial.method = method.name;
    trial.error_percent = 100 * moved_rms_m(pair, outcome.pose);
    trial.claims_success = outcome.stop == "converged";
    trials.push_back(trial);
  }
}

// One start of every overlap and offset, all from pairs of the same seed.
void add_start(const std::string& shape, std::uint64_t seed, const std::vector<AlignPeer>& methods,
               std::vector<Trial>& trials) {
  for (const double overlap : overlaps) {
    PairCase pair = basin_pair(shape, overlap, points, seed);
    Trial trial{.shape = shape, .overlap = overlap};
    for (const double turn_deg : turns_deg) {
      start_off(pair, turn_deg, 0, seed);
      trial.turn_deg = turn_deg;
      try_all(pair, trial, methods, trials);
    }
    trial.turn_deg = 0;
    for (const double shift_percent : shifts_percent) {
      start_off(pair, 0, shift_percent / 100, seed);
      trial.shift_percent = shift_percent;
      try_all(pair, trial, methods, trials);
    }
  }
}

// Written after each start, so that a call may be ended at any time and another one go on.
void make_trials(const std::filesystem::path& folder, std::size_t starts,
                 const std::vector<std::string>& shapes) {
  make_folder(folder);
  std::vector<std::vector<Trial>> trials(shapes.size());
  for (const Trial& trial : read_trials(folder))
    for (std::size_t i = 0; i < shapes.size(); ++i)
      if (shapes[i] == trial.shape) trials[i].push_back(trial);
  for (std::size_t k = 0; k < starts; ++k)
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      std::vector<AlignPeer> missing = methods();
      std::erase_if(missing, [&](const AlignPeer& m) { return starts_of(m.name, trials[i]) > k; });
      if (missing.empty()) continue;
      add_start(shapes[i], k + 1, missing, trials[i]);
      write_trials(folder / (shapes[i] + ".csv"), trials[i]);
    }
}

int run(int count, char** arguments) {
  const std::string verb = count > 3 ? arguments[1] : "";
  if (verb == "trials") {
    const ThreadLimit limit(1);
    make_trials(arguments[2], std::strtoul(arguments[3], nullptr, 10),
                {arguments + 4, arguments + count});
    return 0;
  }
  if (verb == "figures") {
    const std::vector<Trial> trials = read_trials(arguments[2]);
    const std::filesystem::path out = arguments[3];
    make_folder(out);
    write_tables(out, trials);
    write_file(out / "success_over_turn.svg",
               success_figure(trials, &Trial::turn_deg, "start turned by, degrees"));
    write_file(out / "success_over_shift.svg",
               success_figure(trials, &Trial::shift_percent, "start shifted by, % of the size"));
    write_file(out / "time_to_accuracy.svg", time_figure(trials));
    return 0;
  }
  std::fprintf(stderr, "usage: basins_study trials FOLDER STARTS SHAPE... | figures FOLDER OUT\n");
  return 2;
}

}  // namespace
}  // namespace scan::test

int main(int count, char** arguments) {
  return scan::test::run(count, arguments);
}
