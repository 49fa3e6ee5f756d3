// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Files that are there whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace scan {

// Writes `content` to a temporary name beside `path`, then renames. Throws scan::Error (output) if
// that cannot be done; nothing is left behind then.
void write_file(const std::filesystem::path& path, std::string_view content);

// The whole file. Throws scan::Error (input) naming the file if it is missing, a directory or
// unreadable, and scan::Error (resource) above `limit_bytes`.
std::string read_file(const std::filesystem::path& path,
                      std::size_t limit_bytes = std::size_t{1} << 34);

// Creates the folder and those above it where they are missing. Throws scan::Error (output) if that
// cannot be done or a file stands there.
void make_folder(const std::filesystem::path& path);

// "007" + ending: how numbered files are called.
std::string numbered(std::size_t index, std::string_view ending);

// FNV-1a over the bytes, as 16 hex digits: tells whether a stage's inputs are the same as before.
std::string fingerprint(std::string_view bytes);

}  // namespace scan
