// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What our pages are made of: one style, a policy that loads nothing, text made safe, table cells.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace scan {

// From the doctype to the open body, with the style. The Content-Security-Policy allows that style,
// pictures that the page carries, and the named scripts among report_assets(), each by its hash;
// nothing is loaded from elsewhere.
std::string page_head(const std::string& title, const std::vector<std::string_view>& scripts = {});

// The text of a file among report_assets(); it must be there.
std::string_view asset(std::string_view name);

// A script of report_assets() that runs where it stands.
std::string inline_script(std::string_view name);

// JSON that scripts may read: {data: ...} under the element's id.
std::string data_script(const std::string& id, const nlohmann::ordered_json& json);

// Text as HTML shows it.
std::string escaped(const std::string& text);

std::string base64(std::string_view bytes);

std::string cell(const std::string& text, bool number = false);

// As readable_value() (tools/console.h) with the signs that a page can show: µ, °.
std::string page_value(double value, const std::string& unit);

// A number with a readable unit and, as the value of a <data>, to the bit; `unit` as in
// Measurement. "unknown" for what is no number. With "signed" a plus stands before what is above
// zero.
std::string exact(const nlohmann::ordered_json& value, const std::string& unit);
std::string signed_exact(const nlohmann::ordered_json& value, const std::string& unit);
std::string exact_cell(const nlohmann::ordered_json& value, const std::string& unit);

// A cell of HTML as it stands.
std::string raw_cell(const std::string& html, bool number = false);

// Words that warn, set off as a verdict is.
std::string warning_tag(const std::string& words);

// A part of a page with a heading that can be linked to.
std::string section(const std::string& id, const std::string& title, const std::string& content);

// A table that scrolls sideways on narrow screens; headings that begin with '#' stand over numbers.
std::string table(const std::string& caption, const std::vector<std::string>& headings,
                  const std::string& rows);

// A part that opens on demand.
std::string details(const std::string& title, const nlohmann::ordered_json& json);

}  // namespace scan
