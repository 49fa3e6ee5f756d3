// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The one exception of libscan: broken input, an impossible request, or a computation that failed.
#pragma once

#include <stdexcept>
#include <string>

namespace scan {

// What went wrong; the value is the program's exit code.
enum class Trouble {
  usage = 2,        // the command line or an option is not understood
  input = 3,        // missing, unreadable or invalid data
  computation = 4,  // no overlap, empty result, undetermined
  output = 5,       // cannot be written
  resource = 6,     // over a memory or size limit
};

// Control characters, which broken files bring into messages, as question marks.
inline std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

// `what()` is one line that names file, field, value and limit where they apply; `hint()` may be
// empty and says what the user can do about it.
class Error : public std::runtime_error {
 public:
  Error(Trouble trouble, const std::string& message, std::string hint = {})
      : std::runtime_error(one_line(message)), trouble_(trouble), hint_(std::move(hint)) {}
  Trouble trouble() const { return trouble_; }
  const std::string& hint() const { return hint_; }

 private:
  Trouble trouble_;
  std::string hint_;
};

}  // namespace scan
