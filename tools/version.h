// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What this program is.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace scan {

std::string version_text();             // "0.1.0"
std::string machine_text();             // the processor's name
nlohmann::ordered_json version_json();  // version, compiler, and the libraries it was built with

}  // namespace scan
