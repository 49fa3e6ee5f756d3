// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// JSON Schema (draft 2020-12) of a recipe, for editors that complete keys and mark mistakes.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace scan {

// What it refuses, `read_recipe` refuses; limits between values are `read_recipe`'s alone.
nlohmann::ordered_json recipe_schema();

}  // namespace scan
