// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Numbers of binary files in either byte order, at any alignment.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

namespace scan {

template <class Number>
Number swapped_unless(std::endian order, Number number) {
  if (order == std::endian::native) return number;
  char bytes[sizeof(Number)];
  std::memcpy(bytes, &number, sizeof(Number));
  std::reverse(bytes, bytes + sizeof(Number));
  std::memcpy(&number, bytes, sizeof(Number));
  return number;
}

// The number at `bytes`, which must have sizeof(Number) of them.
template <class Number>
Number load(const char* bytes, std::endian order) {
  Number number;
  std::memcpy(&number, bytes, sizeof(Number));
  return swapped_unless(order, number);
}

template <class Number>
void store(std::string& bytes, Number number, std::endian order) {
  number = swapped_unless(order, number);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(Number));
}

}  // namespace scan
