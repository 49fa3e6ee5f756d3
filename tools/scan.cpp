// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The program `scan`: the table of its commands.
#include "tools/commands.h"

namespace scan {

std::vector<Command> all_commands() {
  return {
      {"run", "all stages of a recipe, from simulated raw data to a report",
       "scan run datasets/recipes/bracket-laser.json /tmp/bracket", run_command},
      {"simulate", "render a recipe's raw frames and decode them into scans",
       "scan simulate datasets/recipes/bracket-laser.json /tmp/bracket --keep-raw",
       simulate_command},
      {"calibrate", "pictures of a chessboard to a device's calibration",
       "scan calibrate camera boards/*.png camera.json --board 9x6 --square 20mm",
       calibrate_command},
      {"acquire", "turn a device's raw data into points",
       "scan acquire stereo left.png right.png points.ply --calibration calib.txt",
       acquire_command},
      {"align", "bring scans into one frame",
       "scan align bun000.ply bun045.ply /tmp/aligned --init bun.conf", align_command},
      {"reconstruct", "make a surface from oriented points",
       "scan reconstruct /tmp/aligned/aligned.ply surface.ply --trim 2mm", reconstruct_command},
      {"verify", "measure a surface, a cloud, poses or a run against the truth",
       "scan verify surface.ply --truth part.stl --threshold 0.2mm", verify_command},
      {"tradeoff", "vary a recipe's settings: error against seconds, and advice",
       "scan tradeoff datasets/recipes/vessel-phase.json /tmp/vessel --tolerance 0.3mm",
       tradeoff_command},
      {"report", "write a run's report as one self-contained page",
       "scan report /tmp/bracket /tmp/bracket.html", report_command},
      {"info", "say what a file holds", "scan info surface.ply", info_command},
      {"convert", "change a file's format", "scan convert part.stl part.ply", convert_command},
      {"schema", "JSON Schema of a recipe, for editors", "scan schema recipe > recipe.schema.json",
       schema_command},
      {"completion", "a script that completes commands and options in a shell",
       "source <(scan completion bash)", completion_command},
      {"version", "this program's version and libraries", "scan version --json", version_command},
  };
}

}  // namespace scan

int main(int argc, char** argv) {
  return scan::run_program(argc, argv, scan::all_commands());
}
