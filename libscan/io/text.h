// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Words and numbers of text files: exact in both directions and independent of the locale.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "libscan/core/shortest.h"

namespace scan {

// The whole of `word` as a number of this very type, correctly rounded; none if it is anything else
// or lies outside the type's range. A number too small for the type becomes zero.
template <class Number>
std::optional<Number> number_from(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  Number number{};
  const char* const end = word.data() + word.size();
  const auto [stopped, error] = std::from_chars(word.data(), end, number);
  if (stopped != end || word.empty() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    if constexpr (std::is_floating_point_v<Number>) {
      // from_chars leaves open which side was left: the exponent tells
      const auto exponent = word.find_first_of("eE");
      const bool is_tiny = exponent != std::string_view::npos && exponent + 1 < word.size() &&
                           word[exponent + 1] == '-';
      if (is_tiny) return Number{0};
    }
    return std::nullopt;
  }
  return number;
}

// Walks through a text line by line; lines end with \n, \r\n or \r.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  std::optional<std::string_view> next();
  std::size_t number() const { return number_; }  // of the line that next() gave last, from 1

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

// Takes the next word off the front of `line`; empty at its end. Blanks and tabs separate words,
// and so do the characters of `also`.
std::string_view take_word(std::string_view& line, std::string_view also = {});

std::string lower_case(std::string_view word);

}  // namespace scan
