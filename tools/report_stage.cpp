// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report_stage.h"

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_output.h"
#include "tools/report/page.h"
#include "tools/report/twin.h"

namespace scan {

void write_report(const std::filesystem::path& run, const std::filesystem::path& page,
                  const std::filesystem::path& artefacts, const std::filesystem::path& tradeoff) {
  std::string html;
  nlohmann::ordered_json twin;
  try {
    const RunRecord record = read_record(run, artefacts, tradeoff);
    twin = report_twin(record);
    html = report_page(record, twin);
  } catch (const nlohmann::json::exception& error) {
    throw Error(Trouble::input,
                run.string() + ": a file of it has not what a run writes: " + error.what());
  }
  write_file(page, html);
  write_json(std::filesystem::path(page).replace_extension(".json"), twin);
  write_file(std::filesystem::path(page).replace_extension(".csv"), report_csv(twin));
}

}  // namespace scan
