// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Tables of figures: which columns they have, and what is set off in them.
#include "tools/report/figure_tables.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "libscan/io/json_output.h"
#include "tools/report/run_tables.h"
#include "tools/verdict_text.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

Measurement flatness(double value) {
  return {.name = "flatness", .value = value, .unit = "m", .over = "plates", .count = 4};
}

Measurement stated(double value) {
  return {.name = "normalised_range_error_rms",
          .value = value,
          .unit = "1",
          .expected = Interval{0.9, 1.1}};
}

std::string table_of(const std::vector<Measurement>& measurements,
                     const std::vector<Limit>& limits) {
  const ordered_json json = verdict_json(judge(measurements, limits));
  return figure_table("caption", json.at("measurements"));
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

// Of what is predicted on both sides of 0 the side is chance.
TEST(PredictionRemark, TellsWhatLiesBeyond) {
  const auto remark = [](double value, double low, double high) {
    return prediction_remark({{"value", value}, {"predicted", {low, high}}});
  };
  EXPECT_EQ(remark(2, 1, 3), "");
  EXPECT_EQ(remark(0.5, 1, 3), "smaller than predicted");
  EXPECT_EQ(remark(4, 1, 3), "larger than predicted");
  EXPECT_EQ(remark(-2, -3, -1), "");
  EXPECT_EQ(remark(-4, -3, -1), "larger than predicted");
  EXPECT_EQ(remark(-2.5, -1, 3), "");
  EXPECT_EQ(remark(-3.5, -1, 3), "larger than predicted");
  EXPECT_EQ(prediction_remark({{"value", 1}, {"predicted", nullptr}}), "");
  EXPECT_EQ(prediction_remark({{"value", 1}}), "");
}

TEST(FigureTable, HasNoColumnsThatNobodyFills) {
  const std::string html = table_of({flatness(1e-5)}, {});
  EXPECT_FALSE(holds(html, "limit</th>")) << html;
  EXPECT_FALSE(holds(html, "verdict</th>")) << html;
  EXPECT_FALSE(holds(html, "interval</th>")) << html;
  EXPECT_EQ(count(html, "<th "), count(html, "<td"));
}

TEST(FigureTable, JudgesEachRowWithALimit) {
  const std::vector<Limit> limits = {{"flatness", "<=", 2e-5, "A tenth of the step."}};
  for (const double value : {1e-5, 3e-5}) {
    const std::string html = table_of({flatness(value), stated(1)}, limits);
    EXPECT_TRUE(holds(html, "limit</th>")) << html;
    EXPECT_TRUE(holds(html, "verdict</th>")) << html;
    EXPECT_TRUE(holds(html, "≤ <data value=\"2e-05\">20 µm</data>")) << html;
    EXPECT_EQ(count(html, ">pass<"), value < 2e-5 ? 1u : 0u) << html;
    EXPECT_EQ(count(html, ">FAIL<"), value < 2e-5 ? 0u : 1u) << html;
    EXPECT_EQ(2 * count(html, "<th "), count(html, "<td"));
  }
}

TEST(FigureTable, SetsOffUncertaintiesThatAreNotHonest) {
  const std::string text = "<span class=\"tag warn\">uncertainty stated too ";
  EXPECT_FALSE(holds(table_of({stated(0.9), stated(1.1)}, {}), "too "));
  EXPECT_TRUE(holds(table_of({stated(1.101)}, {}), text + "small</span>"));
  EXPECT_TRUE(holds(table_of({stated(0.899)}, {}), text + "large</span>"));
  EXPECT_TRUE(holds(table_of({stated(3)}, {}),
                    "honest: <data value=\"0.9\">0.9</data> to <data value=\"1.1\">1.1</data>"));
}

TEST(EffectTable, SetsOffWhatWasLeftOut) {
  const ordered_json off = {{"effect", "fog"},
                            {"decision", "off"},
                            {"reason", ""},
                            {"bound_m", 0.001},
                            {"bound_sigma", 2}};
  EXPECT_TRUE(
      holds(effect_table(ordered_json::array({off})), "<span class=\"tag warn\">left out</span>"));
  ordered_json harmless = off;
  harmless["bound_sigma"] = 0.01;
  EXPECT_FALSE(holds(effect_table(ordered_json::array({harmless})), "left out</span>"));
}

std::string limits_of(Measurement measurement, const Limit& limit) {
  return limit_table(verdict_json(judge({std::move(measurement)}, {limit})).at("measurements"));
}

// What is used: of an upper limit the value's share, of a lower one what of the value it asks for,
// of a bound both ways the size's.
TEST(LimitTable, TellsHowMuchOfALimitIsUsed) {
  EXPECT_TRUE(holds(limits_of(flatness(1e-5), {"flatness", "<=", 4e-5, ""}), "'25 percent"));
  EXPECT_TRUE(holds(limits_of(flatness(4e-5), {"flatness", ">=", 1e-5, ""}), "'25 percent"));
  EXPECT_TRUE(holds(limits_of(flatness(-1e-5), {"flatness", "within", 4e-5, ""}), "'25 percent"));
}

TEST(LimitTable, SaysWhereSamplingMayDecide) {
  const auto close = [](double limit) {
    Measurement m = flatness(1e-5);
    m.interval = Interval{0.9e-5, 1.1e-5};
    return holds(limits_of(m, {"flatness", "<=", limit, ""}), "within its sampling");
  };
  EXPECT_FALSE(close(0.8e-5));
  EXPECT_TRUE(close(0.95e-5));
  EXPECT_TRUE(close(1.05e-5));
  EXPECT_FALSE(close(1.2e-5));
}

TEST(CallOutTable, HasMillimetresBelowAMetre) {
  const auto row = [](double x) {
    return call_out_table(ordered_json::array({{{"number", 1},
                                                {"deviation_m", 1e-3},
                                                {"position_m", {x, 0.0, -0.25}},
                                                {"support_m", nullptr}}}));
  };
  EXPECT_TRUE(holds(row(0.5), ">500.0</data>")) << row(0.5);
  EXPECT_TRUE(holds(row(0.5), " mm</td>"));
  EXPECT_TRUE(holds(row(2), ">2.000</data>")) << row(2);
  EXPECT_TRUE(holds(row(2), " m</td>"));
}

TEST(CostTable, TellsEffectsThatTookTimeFromThoseSpared) {
  const ordered_json effects = {{{"effect", "speckle"}, {"decision", "on"}},
                                {{"effect", "fog"}, {"decision", "off"}}};
  const std::string html =
      cost_table({{"machine", "m"},
                  {"threads", 2},
                  {"seconds", {{"align", 1.5}}},
                  {"effect_seconds", {{"speckle", 1234.0}, {"fog", 26316.0}, {"motion", 0.0}}}},
                 effects);
  EXPECT_TRUE(holds(html, "effect speckle, estimated")) << html;
  EXPECT_TRUE(holds(html, "effect fog, had it been on")) << html;
  EXPECT_FALSE(holds(html, "motion")) << html;
  for (const char* took : {">1.5 s<", ">1234 s<", ">7.31 h<"})
    EXPECT_TRUE(holds(html, took)) << html;
}

}  // namespace
}  // namespace scan
