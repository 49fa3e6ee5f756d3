// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where a round body ends for a stripe of light: where light or sight only grazes it.
#pragma once

#include <span>

#include "libscan/acquire/stripe_walk.h"

namespace scan::decoding {

// How far beyond the light plane the body ends, in widths of the beam (1 sigma), going away from
// three of its places on one side of the plane, the nearest first. Along the body the offset from
// the plane comes to an extremum where the light grazes it, the column where the sight does: the
// vertices of the parabolas through the places, over the lengths of the chords between them; the
// first one ahead counts. Negative if the body ends before the plane; infinite if neither lies
// ahead.
double widths_to_rim(std::span<const LitPlace, 3> inner);

// Whether less than two widths of a stripe lie before the body's rim, as places two, four and six
// widths away in a direction (1, -1 step) tell it: cut there a stripe is off by 0.06 widths, cut at
// one by 0.29. False where there are no such places.
bool is_at_rim(const Walk& walk, double width_px, long direction);

}  // namespace scan::decoding
