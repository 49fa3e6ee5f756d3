// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scripts and styles that the program carries in itself (cmake/embed.cmake writes the source).
#pragma once

#include <string_view>
#include <vector>

namespace scan {

struct EmbeddedFile {
  std::string_view name;  // without its folder
  std::string_view text;
  std::string_view sha256;  // of the text, 64 hexadecimal digits
};

// tools/report/*.{css,js,txt} and three.min.js.
const std::vector<EmbeddedFile>& report_assets();

}  // namespace scan
