// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan schema: what may stand in a file that the program reads, for editors.
#include <nlohmann/json.hpp>

#include "tools/commands.h"
#include "tools/recipe_schema.h"

namespace scan {

Action schema_command(CommandLine& line) {
  auto what = std::make_shared<std::string>("recipe");
  line.choice("WHAT", *what, {"recipe"}, "whose schema");
  return [what](Console& console) {
    const nlohmann::ordered_json schema = recipe_schema();
    console.say(schema.dump(2));
    console.finish("schema", "ok", {{"schema", schema}});
    return 0;
  };
}

}  // namespace scan
