// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// All methods of icp, for tests that every one of them must pass.
#pragma once

#include <gtest/gtest.h>

#include "libscan/align/icp.h"

namespace scan::test {

inline constexpr IcpMethod icp_methods[] = {IcpMethod::point_to_point, IcpMethod::point_to_plane,
                                            IcpMethod::symmetric, IcpMethod::plane_to_plane};

// For the names of tests: "PointToPlane".
inline std::string camel_case(IcpMethod method) {
  std::string name;
  bool start = true;
  for (const char c : name_of(method)) {
    if (c != '-') name += start ? static_cast<char>(std::toupper(c)) : c;
    start = c == '-';
  }
  return name;
}

inline const auto method_name = [](const testing::TestParamInfo<IcpMethod>& info) {
  return camel_case(info.param);
};

}  // namespace scan::test
