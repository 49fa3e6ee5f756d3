// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The report's tables of figures, from its twin (tools/report/twin.h); each is empty where there is
// nothing.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace scan {

// The figures that have a limit, with interval, margin and the limit's reason.
std::string limit_table(const nlohmann::ordered_json& measurements);

// All figures with what each was taken over, and whether an uncertainty is honest; columns of
// intervals, predictions, limits and verdicts where some figure has one.
std::string figure_table(const std::string& caption, const nlohmann::ordered_json& measurements);

std::string statistics_table(const nlohmann::ordered_json& statistics);
std::string call_out_table(const nlohmann::ordered_json& call_outs);

}  // namespace scan
