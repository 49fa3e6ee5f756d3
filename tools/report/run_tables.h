// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The report's tables of what was done, from its twin (tools/report/twin.h); each is empty where
// there is nothing.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace scan {

std::string scan_table(const nlohmann::ordered_json& scans);
std::string pose_table(const nlohmann::ordered_json& alignment,
                       const nlohmann::ordered_json& pose_errors);
std::string pair_table(const nlohmann::ordered_json& alignment);

// With the seconds that each effect took, by its name.
std::string effect_table(const nlohmann::ordered_json& effects);

// Every key with its value; numbers by the unit that the key's ending names.
std::string property_list(const nlohmann::ordered_json& object);

// Seconds of each stage, machine, threads and the cost of each effect, on or not: <table
// id="seconds">.
std::string cost_table(const nlohmann::ordered_json& cost, const nlohmann::ordered_json& effects);

}  // namespace scan
