// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Arrays that are read all over: in large pages where the system has them, so that finding the page
// does not cost more than reading it; and not cleared before they are written. Internal to
// libscan/search.
#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace scan {

// Aligned to cache lines at least. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);
void release_large(void* memory);

template <class T>
struct LargePages {
  using value_type = T;
  LargePages() = default;
  template <class U>
  explicit LargePages(const LargePages<U>&) {}

  T* allocate(std::size_t count) { return static_cast<T*>(allocate_large(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { release_large(memory); }
  template <class U, class... Values>
  void construct(U* at, Values&&... values) {
    if constexpr (sizeof...(Values) == 0)
      ::new (static_cast<void*>(at)) U;
    else
      ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
  }
  friend bool operator==(const LargePages&, const LargePages&) { return true; }
};

template <class T>
using LargeArray = std::vector<T, LargePages<T>>;

}  // namespace scan
