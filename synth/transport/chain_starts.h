// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where the search for ways over smooth surfaces starts.
#pragma once

#include <optional>
#include <vector>

#include "synth/transport/shooting.h"

namespace scan::synth {

// A first direction, and where the ray is to be reflected on its way; elsewhere it is refracted.
struct Start {
  Eigen::Vector3d direction;
  Chain reflections;
};

// The chain of sheets that a ray meets until it has done its reflections and passes the target;
// none if it meets a mirror that is not among them, misses one of them, is reflected totally or
// turns more than `most` times, or not at all. All in the frame of SmoothSurfaces.
std::optional<Chain> follow(const SmoothSurfaces& surfaces, const Start& start,
                            const Eigen::Vector3d& from, const Eigen::Vector3d& target, int most);

// Starts through clear bodies that the straight ray does not meet although it passes them near, and
// out of one that it does not leave.
void add_aims(const SmoothSurfaces& surfaces, const Eigen::Vector3d& from,
              const Eigen::Vector3d& target, const Chain& straight, std::vector<Start>& starts);

// Starts at the images of the lamp in facets, and in facets seen in facets; `most` in a row.
void add_images(const SmoothSurfaces& surfaces, const Eigen::Vector3d& from, const Lamp& lamp,
                int most, std::vector<Start>& starts);

// Starts at points of curved sheets, those nearest to Fermat's principle: reflection, passage, and
// passage with one inner reflection.
void add_curved_starts(const SmoothSurfaces& surfaces, const Eigen::Vector3d& from,
                       const Lamp& lamp, int most, std::vector<Start>& starts);

}  // namespace scan::synth
