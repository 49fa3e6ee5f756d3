// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/effect.h"

#include <algorithm>
#include <string>

namespace scan::synth {
namespace {

constexpr std::array<std::string_view, effect_count> names = {
    "shot noise",        "read noise",     "quantisation",    "blooming", "interreflection",
    "mirror reflection", "refraction",     "subsurface",      "medium",   "scene lights",
    "footprint",         "beam spread",    "plane bow",       "speckle",  "defocus",
    "vignetting",        "miscalibration", "rolling shutter", "motion",   "wiggling",
    "range walk"};

}  // namespace

std::array<Effect, effect_count> all_effects() {
  std::array<Effect, effect_count> effects;
  for (int i = 0; i < effect_count; ++i) effects[i] = static_cast<Effect>(i);
  return effects;
}

std::string_view name(Effect effect) {
  return names[static_cast<std::size_t>(effect)];
}

std::optional<Effect> effect_named(std::string_view word) {
  std::string spaced(word);
  std::replace_if(
      spaced.begin(), spaced.end(), [](char c) { return c == '-' || c == '_'; }, ' ');
  const auto found = std::find(names.begin(), names.end(), spaced);
  if (found == names.end()) return std::nullopt;
  return static_cast<Effect>(found - names.begin());
}

EffectSet EffectSet::all() {
  EffectSet set;
  set.bits_.set();
  set.everywhere_ = true;
  return set;
}

}  // namespace scan::synth
