// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What each figure is, in one line, to stand beside the number.
#pragma once

#include <optional>
#include <string>

namespace scan {

// What has to be measured for a figure.
enum class FigureSource { surface_or_run, artefact, disparity };

struct FigureDefinition {
  std::string text;
  std::string unit;  // of the Measurement's value: "m", "rad", "px", "count" or "1"
  FigureSource source = FigureSource::surface_or_run;
};

// By the name of a Measurement; none for a name that no function of verify gives.
std::optional<FigureDefinition> figure_definition(const std::string& name);

// Its text, or empty. What it was taken over (sample, denominator) the Measurement says itself.
std::string definition(const std::string& name);

// For a name that has none: the nearest that has one ("did you mean 'accuracy_rms'?"), or empty.
std::string figure_hint(const std::string& name);

}  // namespace scan
