// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The name of a figure in a recipe, held against those that verify knows before anything runs.
#pragma once

#include <string>
#include <string_view>

#include "libscan/io/json_reader.h"
#include "libscan/verify/definitions.h"

namespace scan {

// scan::Error (input) for a name of no figure, with the nearest one.
inline std::string read_figure(JsonReader& reader, std::string_view key) {
  const std::string name = reader.text(key), hint = figure_hint(name);
  if (definition(name).empty())
    reader.fail(
        key, "'" + name + "' is no figure of a verdict" + (hint.empty() ? "" : " (" + hint + ")"));
  return name;
}

}  // namespace scan
