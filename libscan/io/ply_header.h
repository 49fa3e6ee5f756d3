// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file: what follows, in which type and order.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "libscan/io/ply.h"

namespace scan {

// The eight scalar types, in the order of PlyProperty::Values.
inline constexpr std::size_t ply_type_count = 8;
std::size_t ply_type_size(std::size_t type);

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  Ply empty;  // comments, and elements with their counts and properties but no values
  std::vector<std::vector<std::size_t>> length_types;  // per element and property: of list lengths
  std::size_t size = 0;                                // bytes, up to the first row
};

// scan::Error (input) names the file and the header's line.
PlyHeader parse_ply_header(std::string_view content, const std::string& name);

std::string ply_header_text(const Ply& ply, PlyEncoding encoding,
                            const std::vector<std::vector<std::size_t>>& length_types);

}  // namespace scan
