// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A verdict as it is read: figures, what they are, what is odd about them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/console.h"

namespace scan {

// Of a measurement that lies beyond its "expected": "uncertainty stated too small" (the errors are
// larger) or "uncertainty stated too large"; else empty.
std::string statement_remark(const nlohmann::ordered_json& measurement);

// Of one that lies beyond its "predicted", in a scanner's data sheet: "larger than predicted" or
// "smaller than predicted"; else empty. Of one predicted on both sides of 0 its size counts.
std::string prediction_remark(const nlohmann::ordered_json& measurement);

// Each measurement of a verdict.json, with its sampling interval and its prediction where there are
// some, and its definition in the line below; then PASS or FAIL, and below it what "left_out" names
// (tools/left_out.h).
void say_verdict(const nlohmann::ordered_json& verdict, const Console& console);

}  // namespace scan
