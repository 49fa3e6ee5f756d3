// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/lzf.h"

namespace scan {

// A control byte below 32 announces that many bytes and one more as they are; any other one a copy
// of bytes already unpacked: length - 2 in its upper three bits (7: the next byte is added),
// distance - 1 in its lower five bits and the byte behind (Lehmann, LibLZF).
std::optional<std::string> lzf_decompressed(std::string_view packed, std::size_t unpacked_bytes) {
  constexpr std::size_t most_per_byte = 264 / 3 + 1;  // the longest copy takes three bytes
  if (unpacked_bytes > most_per_byte * packed.size()) return std::nullopt;
  std::string out;
  out.reserve(unpacked_bytes);
  for (std::size_t at = 0; at < packed.size();) {
    const unsigned control = static_cast<unsigned char>(packed[at++]);
    if (control < 32) {
      const std::size_t count = control + 1;
      if (count > packed.size() - at || count > unpacked_bytes - out.size()) return std::nullopt;
      out.append(packed.substr(at, count));
      at += count;
      continue;
    }
    std::size_t count = control >> 5;
    if (count == 7 && at < packed.size()) count += static_cast<unsigned char>(packed[at++]);
    count += 2;
    if (at == packed.size()) return std::nullopt;
    const std::size_t distance =
        ((control & 31) << 8 | static_cast<unsigned char>(packed[at++])) + 1;
    if (distance > out.size() || count > unpacked_bytes - out.size()) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i)
      out += out[out.size() - distance];  // may overlap itself
  }
  if (out.size() != unpacked_bytes) return std::nullopt;
  return out;
}

}  // namespace scan
