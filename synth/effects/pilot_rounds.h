// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pilot rays whose paths end as soon as they have decided.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "synth/effects/weight.h"

namespace scan::synth {

// look(i, with_paths) for each i of [0, count), in rounds that are each spread over all of them.
// Paths are asked for until every effect that they weigh, `by_paths`, moves some ray so far that it
// is included, whatever others show: the decisions are those of all rays with paths; the bound of
// an effect that is included is then that of the rays so far. The rays seen, in order of i.
std::vector<PilotRay> look_in_rounds(
    std::size_t count, const EffectSet& by_paths,
    const std::function<std::optional<PilotRay>(std::size_t, bool)>& look);

}  // namespace scan::synth
