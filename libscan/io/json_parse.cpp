// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_reader.h"

namespace scan {
namespace {

using nlohmann::json;

constexpr int max_depth = 256;  // dumps and other programs' parsers recurse

}  // namespace

json parse_json(std::string_view text, const std::string& name) {
  const auto fail = [&](const std::string& what) {
    throw Error(Trouble::input, name + ": " + what);
  };
  const auto limit_depth = [&](int depth, json::parse_event_t, json&) {
    if (depth > max_depth) fail("JSON is nested deeper than " + std::to_string(max_depth));
    return true;
  };
  try {
    return json::parse(text.begin(), text.end(), limit_depth, true, true);
  } catch (const json::parse_error& error) {
    const std::size_t end = std::min<std::size_t>(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(end), '\n');
    fail("not valid JSON near line " + std::to_string(line) + " (byte " +
         std::to_string(error.byte) + ")");
  } catch (const json::exception& error) {
    fail(std::string("not valid JSON: ") + error.what());
  }
  return {};
}

json read_json(const std::filesystem::path& path) {
  return parse_json(read_file(path), path.string());
}

}  // namespace scan
