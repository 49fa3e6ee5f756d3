// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/align_starts.h"

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "libscan/core/error.h"
#include "libscan/io/poses.h"

namespace scan {
namespace {

// A .conf names its scans' files: those that are not among the inputs were perhaps forgotten.
void warn_of_missing(const std::vector<NamedPose>& named, const std::string& file,
                     const std::vector<std::string>& inputs, Console& console) {
  if (std::filesystem::path(file).extension() != ".conf") return;
  for (const NamedPose& pose : named) {
    const bool given = std::any_of(inputs.begin(), inputs.end(), [&](const std::string& input) {
      return stem(input) == stem(pose.name);
    });
    if (!given) console.warn(file + ": names " + pose.name + ", which is not among the scans");
  }
}

// The first guess of each scan: by name from the file of poses, else by order, else the scan's own.
std::vector<Pose> guesses(const std::string& init, const std::vector<std::string>& inputs,
                          const std::vector<Scan>& scans, Console& console) {
  std::vector<Pose> poses;
  if (init.empty()) {
    for (const Scan& scan : scans) poses.push_back(scan.world_from_scanner_guess);
    return poses;
  }
  const auto named = read_poses(init);
  warn_of_missing(named, init, inputs, console);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const NamedPose* found = nullptr;
    for (const NamedPose& pose : named)
      if (stem(pose.name) == stem(inputs[i])) found = &pose;
    if (!found && named.size() == inputs.size()) found = &named[i];
    if (!found)
      throw Error(Trouble::input, init + ": has no pose for " + inputs[i] + " and " +
                                      std::to_string(named.size()) + " poses for " +
                                      std::to_string(inputs.size()) + " scans");
    poses.push_back(found->pose);
  }
  return poses;
}

void tell_of_guess(const std::string& input, const GlobalGuess& guess, Console& console) {
  if (guess.outcome == GlobalOutcome::ambiguous)
    console.warn(input + ": several poses explain it equally well; one of them was taken");
  else if (guess.outcome != GlobalOutcome::aligned)
    console.warn(input + ": " + std::string(name_of(guess.outcome)) + " with the other scans");
}

}  // namespace

std::string stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

std::vector<GuessSigma> guess_sigmas(const std::vector<Scan>& scans) {
  std::vector<GuessSigma> sigmas;
  for (const Scan& scan : scans) {
    if (!scan.guess_sigma) return {};
    sigmas.push_back(*scan.guess_sigma);
  }
  return sigmas;
}

Starts given_starts(const std::string& init, const std::vector<std::string>& inputs,
                    const std::vector<Scan>& scans, Console& console) {
  Starts starts;
  starts.world_from_scan = guesses(init, inputs, scans, console);
  starts.scans.resize(scans.size());
  if (init.empty()) starts.sigmas = guess_sigmas(scans);
  std::iota(starts.scans.begin(), starts.scans.end(), std::size_t{0});
  return starts;
}

Starts found_starts(const std::vector<std::string>& inputs, const std::vector<Scan>& scans,
                    Console& console) {
  const Stopwatch watch;
  Starts starts;
  starts.found = global_guesses(scans, console.progress());
  console.time("global", watch.seconds());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    tell_of_guess(inputs[i], starts.found[i], console);
    if (starts.found[i].trust == 0) continue;
    starts.scans.push_back(i);
    starts.world_from_scan.push_back(starts.found[i].world_from_scan);
  }
  return starts;
}

MultiviewResult of_all(MultiviewResult result, const Starts& starts, std::size_t scans) {
  std::vector<ScanPose> some(scans);
  some.swap(result.scans);
  for (std::size_t k = 0; k < starts.scans.size(); ++k)
    result.scans[starts.scans[k]] = std::move(some[k]);
  for (ScanEdge& edge : result.edges) {
    edge.source = starts.scans[edge.source];
    edge.target = starts.scans[edge.target];
  }
  for (CommonCovariance& couple : result.covariances_between) {
    couple.first = starts.scans[couple.first];
    couple.second = starts.scans[couple.second];
  }
  for (std::size_t i = 0; i < starts.found.size(); ++i)
    if (starts.found[i].outcome == GlobalOutcome::no_overlap)
      result.scans[i].stop = Stop::no_correspondences;
  if (starts.scans.size() < scans) result.stop = Stop::no_correspondences;
  return result;
}

}  // namespace scan
