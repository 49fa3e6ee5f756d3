// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Broken copies of a good file: what discs, networks, editors and ill will make of one.
#pragma once

#include <cstdint>
#include <string>

namespace scan::test {

// The copy with this number: one to three of flipped bits, bytes of chance, a cut end, a chunk that
// is doubled, lost or moved, a written number replaced by a hostile one, and hostile bytes over
// four or eight of a binary one. The same number gives the same bytes.
std::string mutated(const std::string& good, std::uint64_t number);

}  // namespace scan::test
