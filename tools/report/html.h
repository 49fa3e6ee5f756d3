// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What our pages are made of: one style, text made safe, table cells.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace scan {

// From the doctype to the open body, with the style; nothing is loaded from elsewhere.
std::string page_head(const std::string& title);

// Text as HTML shows it.
std::string escaped(const std::string& text);

std::string base64(const std::string& bytes);

std::string cell(const std::string& text, bool number = false);

// A part that opens on demand.
std::string details(const std::string& title, const nlohmann::ordered_json& json);

}  // namespace scan
