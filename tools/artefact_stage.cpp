// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The bodies' places simulated one by one; figures of what was measured and of what was to expect.
#include "tools/artefact_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "libscan/core/error.h"
#include "libscan/core/median.h"
#include "libscan/core/random.h"
#include "libscan/verify/artefacts.h"
#include "synth/ray_caster.h"

namespace scan {
namespace {

constexpr std::size_t draws = 7;
constexpr std::size_t least_points = 20;
constexpr std::size_t most_views = 3, merged_places = 3, repetitions = 10;

// The points of one body at one place, as measured and as drawn; scanner frame.
struct BodyPoints {
  Points measured;
  std::array<Points, draws> drawn;
};

// Whether a true point of a body counts, in the body's frame.
using Counts = bool (*)(const synth::Object& body, const Eigen::Vector3d& at,
                        const Eigen::Vector3d& normal);

bool counts_anywhere(const synth::Object&, const Eigen::Vector3d&, const Eigen::Vector3d&) {
  return true;
}
bool counts_on_mantle(const synth::Object&, const Eigen::Vector3d&, const Eigen::Vector3d& normal) {
  return std::abs(normal.z()) < 0.5;
}
bool counts_on_inner_face(const synth::Object& body, const Eigen::Vector3d& at,
                          const Eigen::Vector3d& normal) {
  const Eigen::Vector3d half = 0.45 * std::get<BoxShape>(std::get<Shape>(body.geometry)).size_m;
  return normal.z() > 0.9 && std::abs(at.x()) < half.x() && std::abs(at.y()) < half.y();
}

// One place after another: what the scanner sees of its bodies.
class Bench {
 public:
  Bench(const Recipe& recipe, Console& console)
      : recipe_(recipe),
        console_(console),
        viewpoints_(true_poses(recipe.viewpoints)),
        world_from_scanner_(viewpoints_.front()) {}

  const Pose& world_from_scanner() const { return world_from_scanner_; }
  const std::vector<Pose>& viewpoints() const { return viewpoints_; }

  // Per place, per body; from the first viewpoint, or from several and put together by their true
  // poses. Each scan has noise of its own.
  std::vector<std::vector<BodyPoints>> scanned(const std::string& test,
                                               const std::vector<synth::PlacedObjects>& places,
                                               Counts counts, std::size_t views = 1) {
    std::vector<std::vector<BodyPoints>> all;
    synth::Scene scene = recipe_.scene.scene;
    scene.objects = places.front();
    const std::array poses = {world_from_scanner_};
    const synth::EffectSet effects =
        effects_of(plan_effects(recipe_.scanner, scene, poses, recipe_.effects));
    for (std::size_t i = 0; i < places.size(); ++i) {
      console_.progress()(test, static_cast<double>(i) / static_cast<double>(places.size()));
      scene.objects = places[i];
      all.emplace_back(places[i].size());
      for (std::size_t view = 0; view < views; ++view)
        scan_place(scene, effects, counts, viewpoints_[view * viewpoints_.size() / views],
                   all.back());
      for (std::size_t k = 0; k < places[i].size(); ++k)
        if (all.back()[k].measured.size() < least_points)
          throw Error(Trouble::computation,
                      "artefacts: " + places[i][k].name + " at place " + std::to_string(i + 1) +
                          " gave " + std::to_string(all.back()[k].measured.size()) +
                          " points, needs " + std::to_string(least_points) +
                          "; does the scanner see the whole measuring volume?");
    }
    console_.progress()(test, 1);
    return all;
  }

 private:
  void scan_place(const synth::Scene& scene, const synth::EffectSet& effects, Counts counts,
                  const Pose& world_from_view, std::vector<BodyPoints>& bodies) {
    const synth::RenderAddress address{.seed = recipe_.seed, .scan = place_++};
    const synth::RayCaster caster(simplified(scene, effects));
    const auto rendering = render(recipe_.scanner, caster, world_from_view, address, effects);
    const Scan scan = acquire(rendering.frames, recipe_.acquire);
    const auto rays = true_rays(recipe_.scanner, caster, world_from_view);
    const Pose first_from_view = world_from_scanner_.inverse() * world_from_view;
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      const RayTruth& truth = rays[scan.ray[i]];
      if (truth.object < 0 || !is_counted(scene, world_from_view, truth, counts)) continue;
      add(bodies[static_cast<std::size_t>(truth.object)], first_from_view, scan, i, truth, address);
    }
  }

  static bool is_counted(const synth::Scene& scene, const Pose& world_from_view,
                         const RayTruth& truth, Counts counts) {
    const Eigen::Vector3d along = truth.point_in_scanner.normalized();
    if (!(-along.dot(truth.normal_in_scanner) > 0.5)) return false;  // 60 degrees
    const synth::Object& body = scene.objects[static_cast<std::size_t>(truth.object)];
    const Pose body_from_scanner = body.world_from_object.inverse() * world_from_view;
    return counts(body, body_from_scanner * truth.point_in_scanner,
                  body_from_scanner.linear() * truth.normal_in_scanner);
  }

  static void add(BodyPoints& body, const Pose& first_from_view, const Scan& scan, std::size_t i,
                  const RayTruth& truth, const synth::RenderAddress& address) {
    body.measured.push_back(first_from_view * scan.cloud.points[i]);
    if (scan.cloud.sigma_m.empty()) return;
    const Eigen::Vector3d along = truth.point_in_scanner.normalized();
    RandomStream random(address.seed + 1, address.scan, scan.ray[i]);
    for (Points& drawn : body.drawn) {
      const double error_m = scan.cloud.sigma_m[i] * random.normal();
      drawn.push_back(first_from_view * (truth.point_in_scanner + error_m * along));
    }
  }

  const Recipe& recipe_;
  Console& console_;
  std::vector<Pose> viewpoints_;
  Pose world_from_scanner_;
  std::uint32_t place_ = 0;
};

using Test = std::vector<std::vector<BodyPoints>>;  // per place, per body
using Select = std::function<const Points&(const BodyPoints&)>;
using Figures = std::function<std::vector<Measurement>(const Select&)>;

// The figures of the measured points, and beside each the median of what the draws give.
void add_lines(std::vector<SheetLine>& sheet, const Test& test, const Figures& figures) {
  const std::size_t first = sheet.size();
  const Select measured = [](const BodyPoints& body) -> const Points& { return body.measured; };
  for (Measurement& measurement : figures(measured))
    sheet.push_back({std::move(measurement), std::numeric_limits<double>::quiet_NaN()});
  if (test.front().front().drawn.front().empty()) return;
  std::vector<std::vector<double>> drawn(sheet.size() - first);
  for (std::size_t draw = 0; draw < draws; ++draw) {
    const auto of_draw =
        figures([&](const BodyPoints& b) -> const Points& { return b.drawn[draw]; });
    for (std::size_t i = 0; i < drawn.size(); ++i) drawn[i].push_back(of_draw[i].value);
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) sheet[first + i].predicted = median(drawn[i]);
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
  add_lines(sheet, balls, [&](const Select& select) {
    return probing_errors(first_bodies(balls, select), sized.ball_diameter_m);
  });
  const auto places = ball_places(sized, bench.world_from_scanner());
  add_lines(sheet, balls, [&](const Select& select) {
    std::vector<PlacedBall> placed;
    for (std::size_t i = 0; i < balls.size(); ++i)
      placed.push_back({select(balls[i][0]), in_scanner(bench, places[i].front()).translation()});
    return length_errors(placed);
  });
  const Test bars =
      bench.scanned("ball bars", bar_places(sized, bench.world_from_scanner()), counts_anywhere);
  add_lines(sheet, bars, [&](const Select& select) {
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
  add_lines(sheet, balls, [&](const Select& select) {
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
  add_lines(sheet, balls, [&](const Select& select) {
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
  add_lines(sheet, plates,
            [&](const Select& select) { return flatness_errors(first_bodies(plates, select)); });
  const auto places = plate_places(sized, bench.world_from_scanner());
  add_lines(sheet, plates, [&](const Select& select) {
    std::vector<PlacedPlate> placed;  // the first three stand one behind the other
    for (std::size_t i = 0; i < 3; ++i) {
      const Pose plate = in_scanner(bench, places[i].front());
      const double half_m =
          std::get<BoxShape>(std::get<Shape>(places[i].front().geometry)).size_m.z() / 2;
      placed.push_back({select(plates[i][0]), plate * Eigen::Vector3d(0, 0, half_m)});
    }
    return relative_range_errors(placed, Eigen::Vector3d::UnitZ());
  });
  const Test steps =
      bench.scanned("steps", step_places(sized, bench.world_from_scanner()), counts_on_inner_face);
  add_lines(sheet, steps, [&](const Select& select) {
    std::vector<Step> pairs;
    for (const auto& place : steps) pairs.push_back({select(place[0]), select(place[1])});
    return step_errors(pairs, sized.step_m);
  });
}

void test_cylinders(std::vector<SheetLine>& sheet, Bench& bench, const synth::Artefacts& sized) {
  const Pose& world_from_scanner = bench.world_from_scanner();
  const auto places = cylinder_places(sized, world_from_scanner);
  const Test cylinders = bench.scanned("cylinders", places, counts_on_mantle);
  add_lines(sheet, cylinders, [&](const Select& select) {
    std::vector<CylinderPlace> measured;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Pose pose = in_scanner(bench, places[i].front());
      measured.push_back({select(cylinders[i][0]), {pose.translation(), pose.linear().col(2)}});
    }
    return cylinder_errors(measured, sized.cylinder_diameter_m);
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
  test_merged_views(sheet, bench, sized);
  test_repeatability(sheet, bench, sized);
  return sheet;
}

}  // namespace scan
