// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where `scan align` starts from: the scans' own guesses, a file of poses, or nothing at all.
#pragma once

#include <string>
#include <vector>

#include "libscan/align/multiview.h"
#include "libscan/core/scan.h"
#include "tools/console.h"
#include "tools/global_guesses.h"

namespace scan {

struct Starts {
  std::vector<std::size_t> scans;     // that have a start
  std::vector<Pose> world_from_scan;  // of these
  std::vector<GuessSigma> sigmas;     // how far off they are; empty: nobody knows
  std::vector<GlobalGuess> found;     // of all scans if they were found without a guess; else empty
};

// How far off the scans' own guesses are; empty unless every scan states it.
std::vector<GuessSigma> guess_sigmas(const std::vector<Scan>& scans);

// From the file `init`, by the scans' names, else in its order; without a file the scans' own.
Starts given_starts(const std::string& init, const std::vector<std::string>& inputs,
                    const std::vector<Scan>& scans, Console& console);

// Without a guess. Scans that are tied to no other have no start, which is told.
Starts found_starts(const std::vector<std::string>& inputs, const std::vector<Scan>& scans,
                    Console& console);

// The result for the scans that have a start as one for all; the others overlap with none or have
// too few points.
MultiviewResult of_all(MultiviewResult result, const Starts& starts, std::size_t scans);

// A file's name without folder and ending.
std::string stem(const std::string& path);

}  // namespace scan
