// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The kernel for the points of a patch, for any instruction set, behind the same Sixteen, Query and
// operations as tree_queries.h. Internal to libscan/search.
#pragma once

#include "libscan/search/tree_walk.h"

namespace scan {
namespace {

// Squared distances as whole numbers, which have their order, with the slot in the lowest six bits:
// no two are equal.
struct Slots {
  static constexpr std::int32_t slot_bits = most_in_patch - 1;
  alignas(64) std::int32_t key[most_in_patch];
  std::uint32_t place[most_in_patch];
  int count = 0;

  void add(std::uint32_t distance2_bits, std::uint32_t at) {
    key[count] = static_cast<std::int32_t>(distance2_bits & ~std::uint32_t{slot_bits}) | count;
    place[count++] = at;
  }
  float least_distance2(int slot) const { return distance2(key[slot] & ~slot_bits); }
  float greatest_distance2(int slot) const { return distance2(key[slot] | slot_bits); }
  // order[i]: the slot of the i-th nearest. Each one's rank is the number of those before it.
  void sort(std::int32_t (&order)[most_in_patch]) {
    typedef std::int32_t Keys __attribute__((vector_size(64)));
    constexpr int width = sizeof(Keys) / sizeof(std::int32_t);
    for (int i = count; i % width != 0; ++i) key[i] = 0x7fffffff;
    for (int first = 0; first < count; first += width) {
      Keys mine, rank = {};
      __builtin_memcpy(&mine, key + first, sizeof mine);
      for (int i = 0; i < count; ++i) rank -= mine > key[i];
      for (int i = 0; i < width && first + i < count; ++i) order[rank[i]] = first + i;
    }
  }

 private:
  static float distance2(std::int32_t bits) {
    float value;
    __builtin_memcpy(&value, &bits, sizeof value);
    return value;
  }
};

int nearest_in(const TreeView& tree, const TreeQuery& query, const std::uint32_t* leaves, int count,
               int k, std::uint32_t (&nearest_places)[most_in_patch]) {
  const Query at(query.at);
  Slots slots;
  for (int i = 0; i < count; ++i) {
    const Sixteen distance2 = point_distances2(tree.leaves[leaves[i]], at);
    std::uint32_t near = not_above(distance2, query.limit2);
    if (near == 0) continue;
    if (slots.count + __builtin_popcount(near) > most_in_patch) return 0;
    alignas(64) std::uint32_t bits[leaf_width];
    store(distance2, bits);
    for (; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(first_of(near));
      slots.add(bits[lane], leaves[i] * leaf_width + lane);
    }
  }
  if (slots.count < k) return 0;
  std::int32_t order[most_in_patch];
  slots.sort(order);
  const float limit2 = widened(slots.greatest_distance2(order[k - 1]), query.widening);
  if (!(limit2 <= query.limit2)) return 0;
  int found = 0;
  while (found < slots.count && slots.least_distance2(order[found]) <= limit2) {
    nearest_places[found] = slots.place[order[found]];
    ++found;
  }
  return found;
}

}  // namespace
}  // namespace scan
