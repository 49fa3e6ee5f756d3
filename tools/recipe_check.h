// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Settings that no stage could use, told before the first one runs.
#pragma once

#include <string>

#include "tools/recipe.h"

namespace scan {

// scan::Error (input) with the setting, its value and its limit; `place` is the recipe's name.
void check_settings(const Recipe& recipe, const std::string& place);

}  // namespace scan
