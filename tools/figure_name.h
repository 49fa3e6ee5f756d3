// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Words of a recipe's limits: the name of a figure, held against those that verify knows before
// anything runs.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "libscan/io/json_reader.h"
#include "libscan/verify/definitions.h"

namespace scan {

// The words of a recipe's limits and the relations that they mean; "within" is of the size of what
// may be below 0.
inline constexpr std::pair<const char*, const char*> limit_words[] = {
    {"at_most", "<="}, {"at_least", ">="}, {"equals", "=="}, {"within", "within"}};

inline std::string_view text_of(FigureSource source) {
  switch (source) {
    case FigureSource::artefact:
      return "a data sheet (artefact_limits)";
    case FigureSource::disparity:
      return "a disparity";
    case FigureSource::surface_or_run:
      break;
  }
  return "a surface or a run";
}

// scan::Error (input) for a name of no figure, with the nearest one, and for a figure that what
// will be measured does not have.
inline std::string read_figure(JsonReader& reader, std::string_view key, FigureSource source) {
  const std::string name = reader.text(key), hint = figure_hint(name);
  const auto figure = figure_definition(name);
  if (!figure)
    reader.fail(
        key, "'" + name + "' is no figure of a verdict" + (hint.empty() ? "" : " (" + hint + ")"));
  if (figure->source != source)
    reader.fail(key, "'" + name + "' is a figure of " + std::string(text_of(figure->source)) +
                         ", not of " + std::string(text_of(source)));
  return name;
}

}  // namespace scan
