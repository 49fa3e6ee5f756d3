// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Alignment of one pair of clouds without a first guess, and whether there is an answer at all.
//
// Descriptors propose correspondences, most of them wrong; sets of them that one motion explains
// propose poses; each pose is settled on the surfaces and judged by them alone: by how much of them
// meets, by what contradicts it, and by how far it stands out from the poses that are wrong.
#pragma once

#include <string_view>
#include <vector>

#include "libscan/align/features.h"
#include "libscan/core/cost.h"

namespace scan {

enum class GlobalOutcome {
  aligned,         // one pose stands out
  ambiguous,       // several poses explain the data equally well, listed first; or one may slide
  no_overlap,      // no pose stands out from chance; those of the list are the best of bad ones
  too_few_points,  // a cloud has too few points for descriptors
};
std::string_view name_of(GlobalOutcome outcome);  // "aligned", "ambiguous", "no overlap", ...

struct GlobalOptions {
  double least_trust = 0.5;          // below it a pose is not believed
  std::size_t most_hypotheses = 16;  // in the answer
};

// Throws scan::Error (usage) naming the option and its limit.
void check(const GlobalOptions& options);

struct GlobalHypothesis {
  Pose target_from_source = Pose::Identity();
  double trust = 0;     // 0 to 1: how surely the pose is not one that chance offers
  double overlap = 0;   // share of the smaller cloud's surface that lies on the other's
  double conflict = 0;  // share of the surfaces that should meet, or be seen, and do not
  double rms_m = 0;     // point to plane, of what meets
};

struct GlobalResult {
  GlobalOutcome outcome = GlobalOutcome::too_few_points;
  std::vector<GlobalHypothesis> hypotheses;  // different poses, the best first
  Cost cost;
};

// Both clouds with normals; they keep their frames.
GlobalResult align_globally(const PointCloud& source, const PointCloud& target,
                            const GlobalOptions& options = {});

// Features of equal side_m, else scan::Error (usage): for many scans describe each of them once.
GlobalResult align_globally(const ScanFeatures& source, const ScanFeatures& target,
                            const GlobalOptions& options = {});

}  // namespace scan
