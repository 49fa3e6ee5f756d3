// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Functions of one cosine that cost an integral: tabulated at first use, one table per set of
// parameters, kept for the life of the program.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

namespace scan::synth {

// Cubic (Catmull and Rom 1974) between nodes that lie densest at grazing angles, cosine = (i /
// n)^2.
class DirectionalTable {
 public:
  explicit DirectionalTable(const std::function<double(double)>& function_of_cosine);
  double operator()(double cosine) const;

 private:
  static constexpr int intervals = 64;
  std::array<double, intervals + 1> nodes_;
};

// Integral over [0, 1] by 64-point Gauss-Legendre quadrature.
double integral_over_unit(const std::function<double(double)>& function);

using TableKey = std::array<double, 4>;

// What `make` gives for that key, made once; its address stays. Any thread may ask: a thread's last
// eight answers need no lock. `Owner` keeps the keys of different uses apart.
template <class Owner, class Value, class Make>
const Value& tabulated(const TableKey& key, Make&& make) {
  struct Recent {
    TableKey key;
    const Value* value;
  };
  thread_local std::array<Recent, 8> recent{};
  thread_local unsigned next = 0;
  for (const Recent& entry : recent)
    if (entry.value && entry.key == key) return *entry.value;

  static std::mutex mutex;
  static std::map<TableKey, std::unique_ptr<const Value>> all;
  const std::lock_guard lock(mutex);
  std::unique_ptr<const Value>& value = all[key];
  if (!value) value = std::make_unique<const Value>(make());
  recent[next++ % recent.size()] = {key, value.get()};
  return *value;
}

}  // namespace scan::synth
