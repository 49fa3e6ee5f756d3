// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Whether alignments know their own uncertainty: mean normalised error squared per degree of
// freedom over simulated pairs of 10,000 points, for each kind of scanner noise and method.
//
// align_calibration [pairs]; without an argument 1000, each of another surface.
#include <cstdio>
#include <cstdlib>

#include "libscan/core/parallel.h"
#include "libscan/core/units.h"
#include "tests/align/simulated_pairs.h"

namespace scan::test {
namespace {

void calibrate(IcpMethod method, ScannerNoise noise, std::size_t pairs) {
  std::vector<double> errors2(pairs), turns_rad(pairs);
  std::vector<char> converged(pairs);
  parallel_for(
      pairs,
      [&](std::size_t i) {
        const SimulatedPair pair = simulated_pair(noise, 100, i + 1);
        const IcpResult result = icp(pair.source, pair.target, pair.guess, {.method = method});
        errors2[i] = normalised_error2(result, pair.truth) / 6;
        turns_rad[i] = rotation_distance_rad(result.target_from_source, pair.truth);
        converged[i] = result.stop == Stop::converged;
      },
      1);
  double sum = 0, squares = 0, turns2 = 0, count = 0;
  for (std::size_t i = 0; i < pairs; ++i) {
    if (!converged[i]) continue;
    sum += errors2[i];
    squares += errors2[i] * errors2[i];
    turns2 += turns_rad[i] * turns_rad[i];
    ++count;
  }
  const double mean = sum / count, sigma = std::sqrt((squares / count - mean * mean) / count);
  std::printf("%-15s %-13s %6.0f  %7.3f +- %.3f  %10.4f\n", std::string(name_of(method)).c_str(),
              name_of(noise), count, mean, sigma, deg_from_rad(std::sqrt(turns2 / count)));
  std::fflush(stdout);
}

}  // namespace
}  // namespace scan::test

int main(int argc, char** argv) {
  using namespace scan;
  const std::size_t pairs = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1000;
  std::printf("method          noise         pairs  e^T I e / 6        rms turn deg\n");
  for (const IcpMethod method :
       {IcpMethod::symmetric, IcpMethod::plane_to_plane, IcpMethod::point_to_plane})
    for (const test::ScannerNoise noise : test::scanner_noises)
      test::calibrate(method, noise, pairs);
  return 0;
}
