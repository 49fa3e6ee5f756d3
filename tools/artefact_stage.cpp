// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Each test's places on the bench; figures of what was measured and of what was to expect.
#include "tools/artefact_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "libscan/acquire/disparity_refinement.h"
#include "libscan/acquire/window_bias.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/verify/artefacts.h"
#include "libscan/verify/structural_resolution.h"
#include "tools/artefact_bench.h"

namespace scan {
namespace {

constexpr std::size_t most_views = 3, merged_places = 3, repetitions = 10, draws = 39;

using Test = std::vector<std::vector<BodyPoints>>;  // per place, per body
using Select = std::function<Points(const BodyPoints&)>;
using Figures = std::function<std::vector<Measurement>(const Select&)>;

Points measured_points(const BodyPoints& body) {
  return body.measured;
}

// The figures of the measured points, and beside each what the draws give.
void add_lines(std::vector<SheetLine>& sheet, const Bench& bench, const Test& test,
               const Figures& figures) {
  const std::size_t first = sheet.size();
  for (Measurement& measurement : figures(measured_points))
    sheet.push_back({std::move(measurement)});
  if (test.front().front().stated.empty()) return;
  std::vector<std::vector<double>> drawn(sheet.size() - first, std::vector<double>(draws));
  parallel_for(
      draws,
      [&](std::size_t draw) {
        const auto of_draw = figures([&](const BodyPoints& body) {
          return drawn_points(body, bench.seed(), static_cast<std::uint32_t>(draw));
        });
        for (std::size_t i = 0; i < drawn.size(); ++i) drawn[i][draw] = of_draw[i].value;
      },
      1);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const auto [least, most] = std::minmax_element(drawn[i].begin(), drawn[i].end());
    sheet[first + i].predicted = Interval{*least, *most};
  }
}

std::vector<Points> first_bodies(const Test& test, const Select& select) {
  std::vector<Points> bodies;
  for (const auto& place : test) bodies.push_back(select(place[0]));
  return bodies;
}

std::vector<BallBar> ball_bars(const Test& bars, const Select& select) {
  std::vector<BallBar> pairs;
  for (const auto& place : bars) pairs.push_back({select(place[0]), select(place[1])});
  return pairs;
}

Pose in_scanner(const Bench& bench, const synth::Object& body) {
  return bench.world_from_scanner().inverse() * body.world_from_object;
}

void test_balls(std::vector<SheetLine>& sheet, Bench& bench, const synth::Artefacts& sized) {
  const Test balls =
      bench.scanned("balls", ball_places(sized, bench.world_from_scanner()), counts_anywhere);
  add_lines(sheet, bench, balls, [&](const Select& select) {
    return probing_errors(first_bodies(balls, select), sized.ball_diameter_m);
  });
  const auto places = ball_places(sized, bench.world_from_scanner());
  add_lines(sheet, bench, balls, [&](const Select& select) {
    std::vector<PlacedBall> placed;
    for (std::size_t i = 0; i < balls.size(); ++i)
      placed.push_back({select(balls[i][0]), in_scanner(bench, places[i].front()).translation()});
    return length_errors(placed);
  });
  const Test bars =
      bench.scanned("ball bars", bar_places(sized, bench.world_from_scanner()), counts_anywhere);
  add_lines(sheet, bench, bars, [&](const Select& select) {
    return spacing_errors(ball_bars(bars, select), sized.bar_length_m);
  });
}

// The first places again from several viewpoints of the recipe, put together by their true poses:
// what the views disagree in shows as form.
void test_merged_views(std::vector<SheetLine>& sheet, Bench& bench, const synth::Artefacts& sized) {
  const std::size_t views = std::min(most_views, bench.viewpoints().size());
  if (views < 2) return;
  const auto some = [](std::vector<synth::PlacedObjects> places) {
    places.resize(merged_places);
    return places;
  };
  const Test balls =
      bench.scanned("balls, merged", some(ball_places(sized, bench.world_from_scanner())),
                    counts_anywhere, views);
  const Test bars =
      bench.scanned("ball bars, merged", some(bar_places(sized, bench.world_from_scanner())),
                    counts_anywhere, views);
  add_lines(sheet, bench, balls, [&](const Select& select) {
    auto figures = probing_errors(first_bodies(balls, select), sized.ball_diameter_m);
    const auto spacing = spacing_errors(ball_bars(bars, select), sized.bar_length_m);
    figures.insert(figures.end(), spacing.begin(), spacing.end());
    for (Measurement& figure : figures) figure.name = "merged_" + figure.name;
    return figures;
  });
}

// One ball and one bar ten times.
void test_repeatability(std::vector<SheetLine>& sheet, Bench& bench,
                        const synth::Artefacts& sized) {
  const auto repeated = [](const std::vector<synth::PlacedObjects>& places) {
    return std::vector<synth::PlacedObjects>(repetitions, places.front());
  };
  const Test balls = bench.scanned(
      "balls, again", repeated(ball_places(sized, bench.world_from_scanner())), counts_anywhere);
  const Test bars = bench.scanned(
      "ball bars, again", repeated(bar_places(sized, bench.world_from_scanner())), counts_anywhere);
  add_lines(sheet, bench, balls, [&](const Select& select) {
    std::vector<double> sizes_m, spacings_m;
    for (const auto& place : balls)
      sizes_m.push_back(probing_errors(std::vector<Points>{select(place[0])}, sized.ball_diameter_m)
                            .back()
                            .value);
    for (const BallBar& bar : ball_bars(bars, select))
      spacings_m.push_back(spacing_errors(std::vector{bar}, sized.bar_length_m).front().value);
    return std::vector{repeatability({.name = "probing_size", .unit = "m"}, sizes_m),
                       repeatability({.name = "sphere_spacing_error", .unit = "m"}, spacings_m)};
  });
}

void test_faces(std::vector<SheetLine>& sheet, Bench& bench, const synth::Artefacts& sized) {
  const Test plates = bench.scanned("plates", plate_places(sized, bench.world_from_scanner()),
                                    counts_on_inner_face);
  add_lines(sheet, bench, plates,
            [&](const Select& select) { return flatness_errors(first_bodies(plates, select)); });
  const auto places = plate_places(sized, bench.world_from_scanner());
  add_lines(sheet, bench, plates, [&](const Select& select) {
    std::vector<PlacedPlate> placed;  // the three in a line, of which the nearest is the last
    for (const std::size_t i : {2, 1, 0}) {
      const Pose plate = in_scanner(bench, places[i].front());
      const double half_m =
          std::get<BoxShape>(std::get<Shape>(places[i].front().geometry)).size_m.z() / 2;
      placed.push_back({select(plates[i][0]), plate * Eigen::Vector3d(0, 0, half_m)});
    }
    return relative_range_errors(placed, Eigen::Vector3d::UnitZ());
  });
  const Test steps =
      bench.scanned("steps", step_places(sized, bench.world_from_scanner()), counts_on_inner_face);
  add_lines(sheet, bench, steps, [&](const Select& select) {
    std::vector<Step> pairs;
    for (const auto& place : steps) pairs.push_back({select(place[0]), select(place[1])});
    return step_errors(pairs, sized.step_m);
  });
}

void test_cylinders(std::vector<SheetLine>& sheet, Bench& bench, const synth::Artefacts& sized) {
  const Pose& world_from_scanner = bench.world_from_scanner();
  const auto places = cylinder_places(sized, world_from_scanner);
  const Test cylinders = bench.scanned("cylinders", places, counts_on_mantle);
  add_lines(sheet, bench, cylinders, [&](const Select& select) {
    std::vector<CylinderPlace> measured;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Pose pose = in_scanner(bench, places[i].front());
      measured.push_back({select(cylinders[i][0]), {pose.translation(), pose.linear().col(2)}});
    }
    return cylinder_errors(measured, sized.cylinder_diameter_m);
  });
}

// Waves along one axis of the scanner, their periods falling by the root of two from a quarter of
// the plate, until neither the measured points nor the drawn ones resolve them; at most down to a
// thousandth of the plate, where 32 facets a period still make a small mesh.
struct WaveSeries {
  std::vector<BodyPoints> bodies;
  std::vector<double> periods_m;
  Pose scanner_from_plate;
};

WavePlate wave_plate(const WaveSeries& series, std::size_t i, const synth::Artefacts& sized,
                     const Select& select) {
  WavePlate plate{.edge_m = 0.9 * sized.plate_m,
                  .period_m = series.periods_m[i],
                  .amplitude_m = synth::wave_amplitude_m(series.periods_m[i])};
  const Pose plate_from_scanner = series.scanner_from_plate.inverse();
  for (const Eigen::Vector3d& x : select(series.bodies[i]))
    plate.points.push_back(plate_from_scanner * x);
  return plate;
}

bool last_is_resolved(const WaveSeries& series, const synth::Artefacts& sized, std::uint64_t seed) {
  const auto resolves = [&](const Select& select) {
    return is_resolved(wave_response(wave_plate(series, series.bodies.size() - 1, sized, select)));
  };
  return resolves(measured_points) ||
         resolves([&](const BodyPoints& body) { return drawn_points(body, seed, 0); });
}

// What the scanner's way of reading its images leaves of waves of a period at a depth: the windows
// of stereo matching. Others read each ray by itself.
double reading_transfer(const Recipe& recipe, double period_m, double depth_m) {
  const auto* pair = std::get_if<synth::StereoPair>(&recipe.scanner);
  if (!pair) return 1;
  const int window_px = decoding::refinement_window_px(recipe.acquire.stereo.block_px);
  return decoding::window_transfer(period_m * pair->calibration.focal_px / depth_m, window_px / 2);
}

// Draws know what scatters alone: takes from the waves they lie about what the reading does.
void flatten_truth(const Recipe& recipe, WaveSeries& series) {
  const double period_m = series.periods_m.back(),
               height_m = synth::wave_amplitude_m(period_m) *
                          (1 - reading_transfer(recipe, period_m,
                                                series.scanner_from_plate.translation().z()));
  const Pose plate_from_scanner = series.scanner_from_plate.inverse();
  const Eigen::Vector3d up = series.scanner_from_plate.linear().col(2);
  for (StatedPoints& stated : series.bodies.back().stated)
    for (Eigen::Vector3d& x : stated.truth)
      x -= height_m * std::cos(2 * std::numbers::pi * (plate_from_scanner * x).x() / period_m) * up;
}

WaveSeries wave_series(const Recipe& recipe, Bench& bench, const synth::Artefacts& sized,
                       synth::WaveAxis axis) {
  WaveSeries series;
  const char* test = axis == synth::WaveAxis::x ? "waves along x" : "waves along y";
  for (int i = 0; i < 17; ++i) {
    const double period_m = sized.plate_m / 4 * std::pow(2, -i / 2.0);
    const auto plate = wave_plate(sized, bench.world_from_scanner(), period_m, axis);
    series.scanner_from_plate = in_scanner(bench, plate.front());
    series.periods_m.push_back(period_m);
    series.bodies.push_back(bench.scanned(test, {plate}, counts_anywhere)[0][0]);
    flatten_truth(recipe, series);
    if (!last_is_resolved(series, sized, bench.seed())) break;
  }
  return series;
}

void test_waves(std::vector<SheetLine>& sheet, const Recipe& recipe, Bench& bench,
                const synth::Artefacts& sized) {
  const std::array series = {wave_series(recipe, bench, sized, synth::WaveAxis::x),
                             wave_series(recipe, bench, sized, synth::WaveAxis::y)};
  add_lines(sheet, bench, {series[0].bodies}, [&](const Select& select) {
    std::array<std::vector<WavePlate>, 2> plates;
    for (std::size_t k = 0; k < series.size(); ++k)
      for (std::size_t i = 0; i < series[k].bodies.size(); ++i)
        plates[k].push_back(wave_plate(series[k], i, sized, select));
    return std::vector{structural_resolution(plates)};
  });
}

}  // namespace

std::vector<SheetLine> artefact_sheet(const Recipe& recipe, Console& console) {
  if (!recipe.artefacts)
    throw Error(Trouble::input, "recipe " + recipe.name + ": has no artefacts",
                "give it \"artefacts\": { \"volume_mm\": [200, 200, 100] }");
  const synth::Artefacts sized = with_sizes(*recipe.artefacts);
  Bench bench(recipe, console);
  std::vector<SheetLine> sheet;
  test_balls(sheet, bench, sized);
  test_faces(sheet, bench, sized);
  test_cylinders(sheet, bench, sized);
  test_waves(sheet, recipe, bench, sized);
  test_merged_views(sheet, bench, sized);
  test_repeatability(sheet, bench, sized);
  return sheet;
}

}  // namespace scan
