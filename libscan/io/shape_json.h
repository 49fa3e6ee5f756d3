// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Analytic shapes as JSON: the same keys in a recipe's scene and in a run's truth.
//
//   { "sphere": { "radius_mm": 25 } }          { "cylinder": { "radius_mm": 5, "height_mm": 20 } }
//   { "box": { "size_mm": [40, 30, 20], "rounding_mm": 2 } }            { "plane": {} }
//   { "torus": { "major_radius_mm": 30, "minor_radius_mm": 10 } }
//   { "unite" | "intersect" | "subtract": { "blend_mm": 3,
//       "parts": [ { "shape": {...}, "position_mm": [0, 0, 5], "rotation_deg": [90, 0, 0] } ] } }
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "libscan/core/shape.h"
#include "libscan/io/json_reader.h"

namespace scan {

// Reads the one-key object above and checks it. scan::Error (input) names the place.
Shape read_shape(JsonReader& reader);

// One part as above: its shape and where it stands, by position and rotation or by
// "parent_from_shape": 4x4.
PlacedShape read_placed_shape(JsonReader& reader);
nlohmann::ordered_json to_json(const PlacedShape& placed);

// Writes metres, 17 digits: reading it back gives the same shape to the bit.
nlohmann::ordered_json to_json(const Shape& shape);
nlohmann::ordered_json to_json(const Pose& pose);  // 4x4, row by row
Pose pose_from_json(const nlohmann::json& matrix, const std::string& place);

}  // namespace scan
