// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The media that a recipe can name.
#include "tools/recipe_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"

namespace scan {
namespace {

synth::Medium read(const char* text, double wavelength_m) {
  const auto json = nlohmann::json::parse(text);
  return read_medium(JsonReader(json, "medium"), {}, wavelength_m).medium;
}

std::string complaint(const char* text) {
  try {
    read(text, 905e-9);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// 5 % of the contrast is left at the optical range, whatever the wavelength.
TEST(RecipeMedium, IsFogByItsOpticalRange) {
  for (const double wavelength_m : {550e-9, 1550e-9}) {
    const synth::Medium fog = read(R"({"fog": {"optical_range_m": 80}})", wavelength_m);
    EXPECT_NEAR(std::exp(-80 * extinction_per_m(fog)), 0.05, 1e-15);
    EXPECT_EQ(fog.absorption_per_m, 0);
  }
}

// 3.91 / V at 550 nm; (wavelength / 550 nm)^-1.3 of it at 8 km (Kruse et al. 1962), none of a
// colour in fog (Kim et al. 2001).
TEST(RecipeMedium, IsHazeByItsVisibilityAtTheDevicesWavelength) {
  const char* text = R"({"haze": {"visibility_m": 8000, "single_scattering_albedo": 0.9}})";
  const synth::Medium green = read(text, 550e-9), infrared = read(text, 905e-9);
  EXPECT_DOUBLE_EQ(extinction_per_m(green), 3.91 / 8000);
  EXPECT_DOUBLE_EQ(extinction_per_m(infrared), 3.91 / 8000 * std::pow(905.0 / 550, -1.3));
  EXPECT_DOUBLE_EQ(infrared.scattering_per_m, 0.9 * extinction_per_m(infrared));
  EXPECT_EQ(std::get<synth::HenyeyGreenstein>(infrared.phase).mean_cosine, 0.7);
  EXPECT_DOUBLE_EQ(extinction_per_m(read(R"({"haze": {"visibility_mm": 3e5}})", 905e-9)),
                   3.91 / 300);
}

TEST(RecipeMedium, IsWrittenAsItsCoefficients) {
  const auto json =
      nlohmann::json::parse(R"({"haze": {"visibility_m": 8000, "mean_cosine": 0.5}})");
  const RecipeMedium haze = read_medium(JsonReader(json, "medium"), {}, 905e-9);
  const nlohmann::json written = to_json(haze);
  const synth::Medium again = read_medium(JsonReader(written, "medium"), {}, 1550e-9).medium;
  EXPECT_EQ(again.scattering_per_m, haze.medium.scattering_per_m);
  EXPECT_EQ(std::get<synth::HenyeyGreenstein>(again.phase).mean_cosine, 0.5);
}

TEST(RecipeMedium, NamesWhatIsWrong) {
  EXPECT_EQ(complaint(R"({"haze": {"visibility_m": 0}})"),
            "medium/haze/visibility_m: must be positive");
  EXPECT_EQ(complaint(R"({"fog": {"optical_range_m": -5}})"),
            "medium/fog/optical_range_m: must be positive");
  EXPECT_NE(complaint(R"({"haze": {"optical_range_m": 100}})").find("visibility"),
            std::string::npos);
  EXPECT_NE(
      complaint(R"({"haze": {"visibility_m": 9}, "fog": {"optical_range_m": 9}})").find("haze"),
      std::string::npos);
}

}  // namespace
}  // namespace scan
