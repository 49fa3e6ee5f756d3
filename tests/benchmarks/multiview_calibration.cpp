// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Whether the poses of many scans know their own uncertainty: mean normalised error squared per
// degree of freedom over simulated sets of four scans, for each kind of scanner noise; then of
// surfaces that leave motions open, from guesses whose errors are known, that of the anchor right
// or off as well.
//
// multiview_calibration [sets [side]]; without arguments 200 sets of scans of 80 x 80 points, each
// set of another surface.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "libscan/core/parallel.h"
#include "libscan/core/units.h"
#include "tests/align/open_views.h"

namespace scan::test {
namespace {

struct Set {
  double error2 = 0, turns2_rad2 = 0, said2_rad2 = 0;  // mean over the scans that have a covariance
  int scans = 0, weak = 0;
};

Set align_set(const SimulatedViews& views, const MultiviewOptions& options) {
  const MultiviewResult result = align_scans(views.clouds, views.guesses, options);
  Set set;
  for (std::size_t i = 1; i < views.clouds.size(); ++i) {
    const auto error2 = normalised_error2(result, views.truth, i);
    if (!error2) {
      ++set.weak;
      continue;
    }
    const Pose should = result.scans[0].world_from_scan * views.truth[0].inverse() * views.truth[i];
    const double turn_rad = rotation_distance_rad(result.scans[i].world_from_scan, should);
    set.error2 += *error2 / 6;
    set.turns2_rad2 += turn_rad * turn_rad;
    set.said2_rad2 += result.scans[i].covariance->topLeftCorner<3, 3>().trace();
    ++set.scans;
  }
  return set;
}

// Scans of one set share the first one's errors: the spread is taken between sets.
template <class AlignSet>
void calibrate(const std::string& name, std::size_t count, AlignSet&& align) {
  std::vector<Set> sets(count);
  parallel_for(
      count, [&](std::size_t k) { sets[k] = align(k + 1); }, 1);
  double sum = 0, squares = 0, used = 0, turns2 = 0, said2 = 0, scans = 0, weak = 0;
  for (const Set& set : sets) {
    weak += set.weak;
    scans += set.scans;
    turns2 += set.turns2_rad2;
    said2 += set.said2_rad2;
    if (set.scans == 0) continue;
    const double mean = set.error2 / set.scans;
    sum += mean;
    squares += mean * mean;
    ++used;
  }
  const double mean = sum / used, sigma = std::sqrt((squares / used - mean * mean) / used);
  std::printf("%-20s %6.0f %6.0f  %7.3f +- %.3f  %10.4f  %10.4f\n", name.c_str(), scans, weak, mean,
              sigma, deg_from_rad(std::sqrt(turns2 / scans)),
              deg_from_rad(std::sqrt(said2 / scans)));
  std::fflush(stdout);
}

}  // namespace
}  // namespace scan::test

int main(int argc, char** argv) {
  using namespace scan;
  const std::size_t sets = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 200;
  const int side = argc > 2 ? std::atoi(argv[2]) : 80;
  std::printf("noise                 scans   weak  e^T C^-1 e / 6    rms turn deg   as said deg\n");
  for (const test::ScannerNoise noise : test::scanner_noises)
    test::calibrate(test::name_of(noise), sets, [&](std::uint64_t seed) {
      return test::align_set(test::simulated_views(noise, side, seed), {});
    });
  for (const bool anchor_off : {false, true})
    for (const test::OpenShape shape : test::open_shapes)
      test::calibrate(std::string(test::name_of(shape)) + (anchor_off ? ", anchor off" : ""), sets,
                      [&](std::uint64_t seed) {
                        const auto open = test::open_views(shape, side, seed, anchor_off);
                        return test::align_set(open.views, open.options);
                      });
  return 0;
}
