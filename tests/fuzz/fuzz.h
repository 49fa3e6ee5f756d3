// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Hands broken copies of good files to a reader and looks at what it makes of them.
#pragma once

#include <functional>
#include <string>

#include "libscan/core/mesh.h"
#include "libscan/core/point_cloud.h"
#include "libscan/core/pose.h"
#include "tests/io/io_test_support.h"

namespace scan::test {

// Reads the file and throws std::logic_error if what it claims to be valid is not. Returns anything
// else.
using Reader = std::function<void(const std::filesystem::path&)>;

// What a reader may allocate: so many bytes for each of the file's and for what any reader needs.
struct Allowance {
  std::size_t fixed_bytes = std::size_t{1} << 22;
  std::size_t per_byte = 512;
};

// Reads `path`, which must succeed, then broken copies of it in its place: 200 of them, or as many
// as the environment's LIBSCAN_FUZZ says. Each must end in a value or in a scan::Error of one line
// that names the file, within the allowance. The good file is put back.
void fuzz(const std::filesystem::path& path, const Reader& read, const Allowance& allowance = {});

// Throw std::logic_error for a number that is not finite, and for a corner that no vertex is.
void expect_sound(const Mesh& mesh);
void expect_sound(const PointCloud& cloud);
void expect_finite(const std::string& what, const Eigen::MatrixXd& numbers);

}  // namespace scan::test
