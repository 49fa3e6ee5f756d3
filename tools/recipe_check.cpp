// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/recipe_check.h"

#include "libscan/core/error.h"

namespace scan {
namespace {

void require(bool holds, const std::string& setting, double value, const std::string& must) {
  if (holds) return;
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  throw Error(Trouble::input, setting + " is " + text + ", must be " + must);
}

void require_not_negative(const std::string& setting, double value) {
  require(value >= 0, setting, value, "0 or more");
}

void check(const AcquireOptions& o) {
  check(o.stereo);
  require(o.normals.neighbours >= 3, "acquire/normals/neighbours", o.normals.neighbours,
          "3 or more");
  require_not_negative("acquire/laser_line/threshold_sigmas", o.laser_line.threshold_sigmas);
  require_not_negative("acquire/laser_line/max_shape_error", o.laser_line.max_shape_error);
  require_not_negative("acquire/phase/min_amplitude_sigmas", o.phase.min_amplitude_sigmas);
  require_not_negative("acquire/phase/max_inconsistency_sigmas", o.phase.max_inconsistency_sigmas);
  require_not_negative("acquire/waveform/threshold_sigmas", o.waveform.threshold_sigmas);
}

void check(const ReconstructSettings& s) {
  check(s.ssd);
  require_not_negative("reconstruct/thin_m", s.thin_m);
  require_not_negative("reconstruct/trim_m", s.trim_m);
  require_not_negative("reconstruct/decimate_m", s.decimate_m);
  require_not_negative("reconstruct/max_sigma_m", s.max_sigma_m);
}

void check(const VerifySettings& s) {
  require_not_negative("verify/seen_distance_m", s.seen_distance_m);
  require_not_negative("verify/f_score_threshold_m", s.f_score_threshold_m);
  require(s.samples >= 1, "verify/samples", s.samples, "1 or more");
}

}  // namespace

void check_settings(const Recipe& recipe, const std::string& place) {
  try {
    check(recipe.scanner);
    check(recipe.viewpoints);
    check(recipe.acquire);
    check(recipe.align);
    check(recipe.reconstruct);
    check(recipe.verify);
    check(recipe.effects);
    if (recipe.artefacts) check(*recipe.artefacts);
    check_standing(recipe.scene.scene, true_poses(recipe.viewpoints));
  } catch (const Error& error) {
    throw Error(Trouble::input, place + ": " + error.what(), error.hint());
  }
}

}  // namespace scan
