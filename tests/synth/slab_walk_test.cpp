// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The oracle itself, against what is known exactly.
#include "tests/synth/slab_walk.h"

#include <gtest/gtest.h>

namespace scan::synth {
namespace {

TEST(SlabWalk, ClosesItsEnergy) {
  const Slab slab{0.3, 2, 0.6, 1.4, 1.5};
  const SlabLight light = light_of(slab, 32000);
  double entered = 0;
  const int nodes = 2000;  // 1 - mean reflectance, midpoint rule in the squared cosine
  for (int i = 0; i < nodes; ++i)
    entered += (1 - fresnel_of_slab(std::sqrt((i + 0.5) / nodes), 1.4)) / nodes;
  const double sum = light.reflected.mean + light.transmitted.mean + light.absorbed.mean;
  // each photon closes its own balance; what enters is known to its sampling error, at most 0.3 per
  // photon (the reflectance's spread)
  EXPECT_NEAR(sum, entered, 4.5 * 0.3 / std::sqrt(32000.0));
}

// A slab of optical thickness tau that absorbs nothing lets (4/3) / (tau + 2 q) of even light
// through, q = 0.710446 (Hopf), up to terms of exp(-tau).
TEST(SlabWalk, TransmitsByHopfsConstant) {
  const SlabLight light = light_of({0, 1, 0, 1, 8}, 64000);
  EXPECT_NEAR(light.transmitted.mean, 4.0 / 3 / (8 + 2 * 0.7104461), 4.5 * light.transmitted.error);
  EXPECT_LT(light.transmitted.error, 0.005 * light.transmitted.mean * 2);
}

// However it scatters, a body that absorbs nothing in even light keeps each ray for 4 index^2
// volume / surface (Blanco and Fournier 2003): here 2 index^2 thickness, of rays that fall on it.
TEST(SlabWalk, KeepsLightForTheMeanChord) {
  for (const Slab& slab : {Slab{0, 3, 0.5, 1, 0.8}, Slab{0, 1, -0.3, 1.5, 2}}) {
    const SlabLight light = light_of(slab, 32000);
    EXPECT_NEAR(light.leaving_path_m.mean, 2 * slab.index * slab.index * slab.thickness_m,
                4.5 * light.leaving_path_m.error);
    EXPECT_LT(light.leaving_path_m.error, 0.01 * light.leaving_path_m.mean);
  }
}

}  // namespace
}  // namespace scan::synth
