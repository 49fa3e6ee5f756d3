// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/allocation.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::ptrdiff_t> out_bytes{0}, peak_bytes{0};

}  // namespace

namespace scan::test {

void watch_allocations() {
  out_bytes = 0;
  peak_bytes = 0;
}

std::size_t peak_allocated_bytes() {
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(peak_bytes, 0));
}

}  // namespace scan::test

#if defined(__has_feature)  // clang's way to tell; g++ 12 has the macro alone
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__
#endif
#endif
#ifndef __SANITIZE_ADDRESS__

void* operator new(std::size_t size) {
  void* const memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  const std::ptrdiff_t now = out_bytes += static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  std::ptrdiff_t peak = peak_bytes;
  while (now > peak && !peak_bytes.compare_exchange_weak(peak, now)) {
  }
  return memory;
}

void operator delete(void* memory) noexcept {
  if (memory != nullptr) out_bytes -= static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}

#endif
