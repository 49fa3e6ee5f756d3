// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Every recipe of the repository runs and meets its own limits, each of which states its reason.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace scan::test {
namespace {

using nlohmann::json;

std::vector<std::string> recipes() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(LIBSCAN_SOURCE_DIR "/datasets/recipes"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class Recipes : public testing::TestWithParam<std::string> {};

TEST_P(Recipes, MeetTheirLimits) {
  const Folder folder;
  const std::string recipe = LIBSCAN_SOURCE_DIR "/datasets/recipes/" + GetParam() + ".json";
  const Outcome outcome = run_scan({"run", recipe, (folder / "run").string(), "--json"});
  ASSERT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 1) << outcome.err;
  const json result = json::parse(outcome.out);
  std::size_t limits = 0;
  for (const auto& m : result.at("measurements")) {
    std::printf("  %-28s %s %s%s\n", m.at("name").get<std::string>().c_str(),
                m.at("value").dump().c_str(), m.at("unit").get<std::string>().c_str(),
                m.at("limit").is_null() ? "" : (" limit " + m.at("limit").dump()).c_str());
    if (m.at("limit").is_null()) continue;
    ++limits;
    EXPECT_TRUE(m.at("pass").get<bool>()) << m.dump(2);
    EXPECT_GT(m.at("reason").get<std::string>().size(), 40u) << m.at("name");
  }
  EXPECT_GE(limits, 3u) << "a recipe states what it must reach";
  EXPECT_EQ(outcome.exit_code, 0);
}

INSTANTIATE_TEST_SUITE_P(All, Recipes, testing::ValuesIn(recipes()), [](const auto& recipe) {
  std::string name = recipe.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace scan::test
