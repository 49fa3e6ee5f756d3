// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a mistyped word was meant to be.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace scan {

// The member of `words` nearest to `word` (edit distance at most a third of its length, at least
// 1), or empty.
std::string nearest_word(std::string_view word, const std::vector<std::string>& words);

}  // namespace scan
