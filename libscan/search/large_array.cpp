// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/large_array.h"

#include <sys/mman.h>

#include <cstdlib>

namespace scan {
namespace {

constexpr std::size_t cache_line = 64, large_page = std::size_t{1} << 21;

}  // namespace

void* allocate_large(std::size_t bytes) {
  const std::size_t unit = bytes < large_page ? cache_line : large_page;
  const std::size_t size = (bytes + unit - 1) / unit * unit;
  void* memory = std::aligned_alloc(unit, size);
  if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (unit == large_page) madvise(memory, size, MADV_HUGEPAGE);  // a wish: no matter if refused
#endif
  return memory;
}

void release_large(void* memory) {
  std::free(memory);
}

}  // namespace scan
