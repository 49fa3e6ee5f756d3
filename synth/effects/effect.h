// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The effects that a simulation may include: the words that planner, renderers and recipes share.
//
// To add one: 1. its word here and its name in effect.cpp; 2. what it does in synth/scanners or in
// simplified() (synth/scene.h); 3. its weight in synth/effects/.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace scan::synth {

enum class Effect : std::uint8_t {
  // detector
  shot_noise,
  read_noise,
  quantisation,
  blooming,  // charge of a saturated pixel runs over into its neighbours
  // light transport
  interreflection,    // light over two or more surfaces
  mirror_reflection,  // over smooth metal or glass; off: the light ends there
  refraction,         // off: clear objects are not there
  subsurface,         // off: translucent objects reflect as the Lambert surface of equal albedo
  medium,             // off: the scene stands in vacuum
  scene_lights,       // off: only the device shines
  // device
  footprint,    // a pixel's or a beam's extent; off: its central ray
  beam_spread,  // waist and divergence of a laser; off: as thick as at the focus everywhere
  plane_bow,    // a light plane that is not quite plane
  speckle,
  defocus,
  vignetting,
  miscalibration,  // the device differs from its calibration
  rolling_shutter,
  motion,      // during an exposure, between taps, along a sweep of pulses
  wiggling,    // harmonics of the modulation
  range_walk,  // the detector's delay depends on the signal's strength
};
inline constexpr int effect_count = static_cast<int>(Effect::range_walk) + 1;

// All effects in the order above.
std::array<Effect, effect_count> all_effects();

// In words, such as "shot noise".
std::string_view name(Effect effect);
// Accepts '-' and '_' for spaces; none for an unknown name.
std::optional<Effect> effect_named(std::string_view name);

class EffectSet {
 public:
  constexpr EffectSet() = default;
  EffectSet(std::initializer_list<Effect> effects) {
    for (const Effect effect : effects) set(effect);
  }
  // All effects, everywhere: the reference that a plan is held against.
  static EffectSet all();

  // Whether each ray gets each effect of the set, or just those rays that a renderer's own pilot
  // finds it worth while for (the usual).
  bool everywhere() const { return everywhere_; }

  bool has(Effect effect) const { return bits_.test(static_cast<std::size_t>(effect)); }
  EffectSet& set(Effect effect, bool on = true) {
    bits_.set(static_cast<std::size_t>(effect), on);
    return *this;
  }
  EffectSet without(Effect effect) const { return EffectSet(*this).set(effect, false); }
  bool operator==(const EffectSet&) const = default;

 private:
  std::bitset<effect_count> bits_;
  bool everywhere_ = false;
};

}  // namespace scan::synth
