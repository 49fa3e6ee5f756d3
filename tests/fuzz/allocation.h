// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How much memory a piece of work asks for at once.
#pragma once

#include <cstddef>

namespace scan::test {

// The most bytes that operator new had given out at once since `watch_allocations`, beyond what was
// out then. 0 under the sanitizers, which have an operator new of their own.
void watch_allocations();
std::size_t peak_allocated_bytes();

}  // namespace scan::test
