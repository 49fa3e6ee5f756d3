// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Numbers as short texts that keep them.
#pragma once

#include <charconv>
#include <string>

namespace scan {

// The shortest text that reads back as the same number ("nan" and "inf" for those).
template <class Number>
void append_number(std::string& text, Number number) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, number);
  text.append(buffer, end);
}

template <class Number>
std::string shortest(Number number) {
  std::string text;
  append_number(text, number);
  return text;
}

}  // namespace scan
