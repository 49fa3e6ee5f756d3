// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Work on many threads with results that do not depend on their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace scan {

// While it lives, at most `threads` threads of the process work (0: as many as there are cores).
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

int thread_count();

// Calls body(begin, end) for consecutive chunks of [0, count), each of `chunk` items but the last.
// The cut depends on `count` and `chunk` only. An exception from a body reaches the caller.
void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t, std::size_t)>& body);

// Calls body(i) for each i in [0, count).
template <class Body>
void parallel_for(std::size_t count, Body&& body, std::size_t chunk = 64) {
  parallel_chunks(count, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

// Ascending. Equal keys are one like the other, so the result is the same for any number of
// threads.
void parallel_sort(std::span<std::uint64_t> keys);

// Sum of chunk_sum(begin, end) over the same chunks, added in their order: the same bits for any
// number of threads. T needs a copy and +=.
template <class T, class ChunkSum>
T ordered_sum(std::size_t count, std::size_t chunk, const T& zero, ChunkSum&& chunk_sum) {
  std::vector<T> parts((count + chunk - 1) / chunk, zero);
  parallel_chunks(count, chunk, [&](std::size_t begin, std::size_t end) {
    parts[begin / chunk] = chunk_sum(begin, end);
  });
  T total = zero;
  for (const T& part : parts) total += part;
  return total;
}

}  // namespace scan
