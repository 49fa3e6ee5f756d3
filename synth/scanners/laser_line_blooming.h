// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Charge that a full pixel cannot hold runs along the image row.
#pragma once

#include <span>

namespace scan::synth {

// Of each pixel's charge above full_well_e the share `spilling` runs over, half to each side, and
// on from every pixel that is full, until all is held or has left the row's ends; the rest goes
// down the drain. Held exactly: what leaves a run of full pixels at its two ends keeps its sum and
// its centre, since every step of it moves as much to the left as to the right.
void bloom(std::span<double> row_e, double full_well_e, double spilling);

}  // namespace scan::synth
