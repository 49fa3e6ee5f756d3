// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>

namespace scan {

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{tbb::global_control(
          tbb::global_control::max_allowed_parallelism,
          threads > 0 ? static_cast<std::size_t>(threads) : tbb::info::default_concurrency())}) {}

ThreadLimit::~ThreadLimit() = default;

int thread_count() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  if (chunks == 1) return body(0, count);
  tbb::parallel_for(std::size_t{0}, chunks,
                    [&](std::size_t i) { body(i * chunk, std::min(count, (i + 1) * chunk)); });
}

void parallel_sort(std::span<std::uint64_t> keys) {
  tbb::parallel_sort(keys.begin(), keys.end());
}

}  // namespace scan
