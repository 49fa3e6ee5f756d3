// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Tests that run for each method, named after it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "libscan/reconstruct/reconstruct.h"

namespace scan::test {

// Indices of reconstruct_method_names().
inline auto each_method() {
  return testing::Range<std::size_t>(0, reconstruct_method_names().size());
}

inline std::string method_name(const testing::TestParamInfo<std::size_t>& index) {
  std::string name = reconstruct_method_names()[index.param];
  std::erase(name, '-');
  return name;
}

}  // namespace scan::test
