// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A share of a run's scans, for several processes or machines that write into one folder.
#pragma once

#include <cstddef>
#include <string>

namespace scan {

// Part 0 of 1 is the whole.
struct Shard {
  std::size_t part = 0;
  std::size_t parts = 1;
};

inline bool holds(const Shard& shard, std::size_t scan) {
  return scan % shard.parts == shard.part;
}

// "2/4": the second of four parts. Throws scan::Error (usage) for anything else.
Shard parse_shard(const std::string& text);

}  // namespace scan
