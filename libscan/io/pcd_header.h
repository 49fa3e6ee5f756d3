// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The header of a PCD file: which fields follow, in which type and packing.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace scan {

struct PcdField {
  std::string name;
  char type = 'F';         // F, I or U
  std::size_t bytes = 4;   // 1, 2, 4 or 8
  std::size_t count = 1;   // entries per point
  std::size_t offset = 0;  // in a point's record, bytes
  std::size_t column = 0;  // of the first entry, in a line of text
};

enum class PcdPacking { ascii, binary, compressed };

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::size_t record_bytes = 0;
  std::size_t columns = 0;
  PcdPacking packing = PcdPacking::ascii;
  std::size_t size = 0;  // bytes, up to the data
};

// scan::Error (input) names the file and the header's line.
PcdHeader parse_pcd_header(std::string_view content, const std::string& name);

}  // namespace scan
