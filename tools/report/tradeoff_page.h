// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What accuracy costs, as one self-contained page: advice, curve, table; and the curve alone.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace scan {

// `tradeoff` has the keys of tradeoff_json() (tools/tradeoff_json.h).
std::string tradeoff_page(const std::string& title, const nlohmann::ordered_json& tradeoff);

// The page's curve as an SVG file.
std::string tradeoff_picture(const nlohmann::ordered_json& tradeoff);

// The same without head and end, for pages that show more.
std::string tradeoff_parts(const nlohmann::ordered_json& tradeoff);

}  // namespace scan
