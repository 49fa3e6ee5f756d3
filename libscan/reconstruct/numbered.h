// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What keeps CGAL's triangulations from going by addresses.
#pragma once

#include <cstddef>
#include <type_traits>

namespace scan {

// A vertex or cell of a triangulation with its number in order of making: CGAL compares and hashes
// such by number, others by address. On that depend which cell shows a facet, how a removed
// vertex's hole fills, and which of equals a mesher takes first.
template <class Base>
class Numbered : public Base {
 public:
  template <class Tds>
  struct Rebind_TDS {
    using Other = Numbered<typename Base::template Rebind_TDS<Tds>::Other>;
  };
  using Has_timestamp = std::true_type;
  using Base::Base;
  std::size_t time_stamp() const { return number_; }
  void set_time_stamp(std::size_t number) { number_ = number; }

 private:
  std::size_t number_ = std::size_t(-1);  // none yet
};

}  // namespace scan
