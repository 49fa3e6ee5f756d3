// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// JSON Schema of a recipe's scene: objects, materials, lights, medium.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace scan {

// Nested shapes point to "#/$defs/shape", so `shape_schema` must stand there.
nlohmann::ordered_json scene_schema();
nlohmann::ordered_json shape_schema();

}  // namespace scan
