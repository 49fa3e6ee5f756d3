// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/text.h"

#include <algorithm>

namespace scan {

std::optional<std::string_view> Lines::next() {
  if (rest_.empty()) return std::nullopt;
  ++number_;
  const std::size_t end = rest_.find_first_of("\r\n");
  const std::string_view line = rest_.substr(0, end);
  if (end == std::string_view::npos) {
    rest_ = {};
    return line;
  }
  const bool is_pair = rest_.substr(end, 2) == "\r\n";
  rest_.remove_prefix(end + (is_pair ? 2 : 1));
  return line;
}

std::string_view take_word(std::string_view& line, std::string_view also) {
  const auto separates = [&](char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' ||
           also.find(c) != std::string_view::npos;
  };
  const auto* begin = std::find_if_not(line.begin(), line.end(), separates);
  const auto* end = std::find_if(begin, line.end(), separates);
  const std::string_view word(begin, static_cast<std::size_t>(end - begin));
  line.remove_prefix(static_cast<std::size_t>(end - line.begin()));
  return word;
}

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace scan
