// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scans with more effects against scans by the plan, in pairs that share their chance: what the
// effects move each ray's point by, and how sure that is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "libscan/core/raw_frames.h"
#include "libscan/core/scan.h"
#include "libscan/verify/median_interval.h"

namespace scan {

struct EffectBound {
  double range_m = 0;
  double sigmas = 0;  // of the point's own
};

// What may be said of one effect, or of all.
//
// The pairs are independent repeats of the simulation. For each point the median of its changes is
// within an interval that no distribution of them makes too narrow (median_interval.h), the chance
// of a miss shared among points and looks, so that no point of the scan is blamed by chance more
// often than `false_alarm`. A point is `beyond` if the interval says that it moved by more than the
// bound; `undecided` if the interval leaves open whether it moved by 0.1 sigma more.
// Its standard error is that of a normal distribution whose interval ends as near to zero.
struct EffectComparison {
  std::string effect;  // switched on besides the plan's; "all" for every effect
  EffectBound bound;   // the plan's, both hold at every point; for "all" the sums
  int repeats = 0;
  std::size_t points = 0;     // judged
  std::size_t beyond = 0;     // of these
  std::size_t undecided = 0;  // of these
  std::size_t lost = 0;       // rays with a point in one scan of a pair but never in both
  std::size_t unsteady = 0;   // with a point in both too seldom to be judged
  std::size_t at_edges = 0;   // that a stereo matcher takes to either side of a depth edge
  // Where the excess over the bound is largest in standard errors, up to which chance explains it.
  double excess_errors = 0;  // 0: no median is above its bound
  double limit_errors = 0;
  double excess_m = 0;
  double resolution_sigma = 0;  // half of the interval over sigma: of 95 in 100 points at most
  double moved_sigma = 0;       // the largest move that is beyond doubt, over the point's own sigma
  // Mean move over all points in their own sigma: median over the repeats, with its interval.
  double bias_sigma = 0;
  double bias_low_sigma = 0;
  double bias_high_sigma = 0;
  // No point is beyond, and points in the mean do not move by more than 0.1 sigma beyond doubt.
  bool pass = true;
};

inline constexpr double matters_sigma = 0.1;

class PairedScans {
 public:
  // Where a stereo pair's matcher may take either side: within its window of a depth edge of the
  // truth. Such a point is left out if its disparity jumps by more than 1 px, the reach of its
  // refinement. Empty: nowhere.
  PairedScans(std::vector<char> at_edge, const StereoCalibration* stereo);

  void add(const Scan& planned, const Scan& fuller);
  int repeats() const { return repeats_; }
  // Whether nothing moved so far.
  bool identical() const { return identical_; }

  // With chance in the scans the repeats must be at least least_repeats(); `is_exact`: there is
  // none, one repeat says all. `slack_sigma` is what else than the effect may move
  // a point, in its sigma.
  EffectComparison judge(const std::string& effect, const EffectBound& bound, double slack_sigma,
                         bool is_exact) const;
  int least_repeats() const;

 private:
  struct RayChanges {
    double sigma_m = 0;  // of the first planned point
    bool jumps = false;
    std::vector<double> change_m;  // fuller less planned, along the ray
  };
  std::optional<MedianInterval> interval_of(const RayChanges& ray, bool is_exact) const;
  double false_alarm_of_point() const;

  std::vector<char> at_edge_;
  const StereoCalibration* stereo_;
  std::vector<RayChanges> rays_;
  std::vector<char> once_;  // that had a point in one scan of a pair
  std::vector<double> bias_sigma_;
  int repeats_ = 0;
  bool identical_ = true;
};

}  // namespace scan
