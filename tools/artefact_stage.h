// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A scanner's data sheet: calibrated bodies simulated, scanned and measured.
#pragma once

#include <optional>
#include <vector>

#include "libscan/verify/verdict.h"
#include "tools/console.h"
#include "tools/recipe.h"

namespace scan {

// `predicted`: from the smallest to the largest of the same figure of 39 draws of points around the
// true ones, with the sigma that the scan itself states, shared by rays as its noise window says
// and without bias. Another draw lies there 38 times out of 40: 95 %. A measured figure beyond
// shows what that sigma leaves out. None where the scan states none. Drawn points lie where the
// scan's own do, so that of the structural resolution is the limit of its sampling; what a
// footprint or a matching window blurs stands above it.
struct SheetLine {
  Measurement measured;
  std::optional<Interval> predicted = {};
};

// From the recipe's first viewpoint (for the merged figures from up to three of them), with its
// scanner, effects, lights and medium, and the bodies of its first material in the place of its
// objects. Points count where the true surface is turned away from the ray by less than 60 degrees
// and, on plates and steps, lies in the inner 0.9 of the face. Throws scan::Error (computation) for
// a place without enough points or waves too fine from the first, (input) for a recipe without
// artefacts.
std::vector<SheetLine> artefact_sheet(const Recipe& recipe, Console& console);

}  // namespace scan
