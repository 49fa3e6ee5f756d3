// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Unpacking of LZF, the compression inside PCD files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace scan {

// `packed` as exactly `unpacked_bytes` bytes; none if it is damaged or cannot be that long.
std::optional<std::string> lzf_decompressed(std::string_view packed, std::size_t unpacked_bytes);

}  // namespace scan
