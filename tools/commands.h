// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The commands, one source file each.
#pragma once

#include "tools/command_line.h"

namespace scan {

Action run_command(CommandLine& line);
Action simulate_command(CommandLine& line);
Action calibrate_command(CommandLine& line);
Action acquire_command(CommandLine& line);
Action align_command(CommandLine& line);
Action reconstruct_command(CommandLine& line);
Action verify_command(CommandLine& line);
Action tradeoff_command(CommandLine& line);
Action report_command(CommandLine& line);
Action info_command(CommandLine& line);
Action convert_command(CommandLine& line);
Action schema_command(CommandLine& line);
Action completion_command(CommandLine& line);
Action version_command(CommandLine& line);

// In the order of the program's help; the table stands in scan.cpp.
std::vector<Command> all_commands();

}  // namespace scan
