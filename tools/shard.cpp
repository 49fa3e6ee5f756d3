// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/shard.h"

#include <charconv>

#include "libscan/core/error.h"

namespace scan {

Shard parse_shard(const std::string& text) {
  std::size_t part = 0, parts = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, part);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, parts) : first;
  if (!slash || second.ec != std::errc() || second.ptr != end || part < 1 || part > parts)
    throw Error(Trouble::usage,
                "--shard: '" + text + "' is not a part of several, such as 1/4 to 4/4");
  return {part - 1, parts};
}

}  // namespace scan
