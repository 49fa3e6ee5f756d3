// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_misfit.h"

#include "libscan/core/random.h"
#include "tests/synth/phase_bench.h"

namespace scan::synth {
namespace {

constexpr double goal = 0.04;

// A patch of 16 x 16 pixels 2 m away, under direct light of 10000 electrons, and the fit of
// indirect light of that value at x from -1 to 1, with chance of that deviation in each stream.
class PatchMisfit : public testing::Test {
 protected:
  PatchMisfit() {
    camera_ = small_camera();
    camera_.frequencies_hz = {80e6};
    for (int row = 0; row < 16; ++row)
      for (int column = 0; column < 16; ++column) {
        pixels_.push_back({{column, row}, Eigen::Vector3d::UnitZ(), 2, 0});
        places_.push_back({Eigen::Vector2d(column, row), Eigen::Vector3d::UnitZ()});
      }
  }

  template <class Value>
  PatchFit fit(Value&& value, double deviation_e) const {
    std::array<Eigen::MatrixXd, patch_streams> streams;
    for (int k = 0; k < patch_streams; ++k) {
      RandomStream random(1, 0, static_cast<std::uint64_t>(k));
      streams[k] = Eigen::MatrixXd::Zero(256, 3);
      for (Eigen::Index i = 0; i < 256; ++i)
        streams[k](i, 0) = value((i % 16 - 7.5) / 7.5) + deviation_e * random.normal();
    }
    return fit_patch(patch_basis(places_), streams);
  }

  std::vector<Misfit> misfits(const PatchFit& of_fit) const {
    double constant_e = 10000;
    std::complex<double> phasor = 4000;
    const LightOf direct = [&](const PixelPlace&) {
      return LightSum{constant_e, std::span(&phasor, 1)};
    };
    const std::vector<Tone> tones = tones_of(camera_);
    const PathView view{camera_, transport_, Pose::Identity(), {}, {}};
    return misfits_of(PatchReadings(view, tones, direct), pixels_, of_fit);
  }

  Scene scene_{.objects = {plane_at(2)}, .materials = {plain(0.5)}};
  RayCaster caster_{scene_};
  LightTransport transport_{caster_, {}};
  PhaseCamera camera_;
  std::vector<PatchPixel> pixels_;
  std::vector<PatchPlace> places_;
};

// The best polynomials of the sixth degree leave some per cent of |x|; 20000 electrons of it are
// above the unit, 2.5 times a noise of about 100 electrons.
TEST_F(PatchMisfit, IsStiffAtAKink) {
  EXPECT_TRUE(
      misfits(fit([](double x) { return 20000 * std::abs(x - 0.3); }, 5)).back().is_stiff(goal));
}

// Chance far above the goal does not make a fit stiff, for more paths mend it.
TEST_F(PatchMisfit, IsNotStiffByChance) {
  const auto plain_light = [](double x) { return 3000 * (1 + x * x); };
  for (const double deviation_e : {1.0, 300.0, 10000.0})
    EXPECT_FALSE(misfits(fit(plain_light, deviation_e)).back().is_stiff(goal)) << deviation_e;
}

// The variance of a fit of p functions to n pixels is p / n of a pixel's; here 3 to 28 of 256 and
// four streams. The square of p deviations of three degrees of freedom each scatters by
// sqrt(2 / 3p); four times that.
TEST_F(PatchMisfit, CountsChanceByTheFunctions) {
  const std::vector<Misfit> all = misfits(fit([](double) { return 0; }, 1000));
  const double unit_e2 = 2.5 * 2.5 * tap_variance_e2(camera_.sensor, 10000);
  const double counts[] = {3, 6, 10, 15, 21, 28};
  for (std::size_t d = 0; d < all.size(); ++d)
    EXPECT_NEAR(all[d].chance[0] * unit_e2, counts[d] / 256 * 1e6 / 4,
                4 * std::sqrt(2 / (3 * counts[d])) * counts[d] / 256 * 1e6 / 4);
}

// What the cubics add to 9000 x^3: what the best line in x leaves of it over the 16 columns. The
// pixels that are looked at meet some columns once more than others, in 52 looks: a tenth.
TEST_F(PatchMisfit, IsWhatTheLastDegreeAdds) {
  const std::vector<Misfit> all = misfits(fit([](double x) { return 9000 * x * x * x; }, 0));
  const double unit_e2 = 2.5 * 2.5 * tap_variance_e2(camera_.sensor, 10000);
  Eigen::ArrayXd x(16);
  for (int i = 0; i < 16; ++i) x[i] = (i - 7.5) / 7.5;
  const double slope = x.pow(4).sum() / x.square().sum();
  const double square = 9000.0 * 9000 * (x.cube() - slope * x).square().mean();
  EXPECT_NEAR(all[2].last[0] * unit_e2, square, 0.1 * square);
  EXPECT_NEAR(all[3].last[0] * unit_e2, 0, 1e-6 * square);
}

// By hand, one reading: beyond half of the goal, beyond chance and by four times its own.
TEST(Misfit, IsStiffOnlyByWhatIsBeyondDoubt) {
  const auto is_stiff = [](double chance, double last, double last_chance, double structure) {
    const auto one = [](double value) { return Eigen::ArrayXd::Constant(1, value); };
    return Misfit{one(chance), one(last), one(last_chance), structure}.is_stiff(0.04);
  };
  EXPECT_TRUE(is_stiff(0.01, 0.021, 0.005, 0));
  EXPECT_FALSE(is_stiff(0.01, 0.019, 0.001, 0));
  EXPECT_FALSE(is_stiff(0.03, 0.021, 0.001, 0));
  EXPECT_FALSE(is_stiff(0.01, 0.021, 0.006, 0));
  EXPECT_TRUE(is_stiff(0.01, 0, 0, 0.021));
  EXPECT_FALSE(is_stiff(0.03, 0, 0, 0.021));
}

// Chance of 4 e^2; the last degree adds 0.01 of the unit of 600 e^2, residuals show 0.02 more. What
// is less than chance explains is nothing.
TEST(Misfit, IsPartOfAPixelsErrorBesidesChance) {
  const auto one = [](double value) { return Eigen::ArrayXd::Constant(1, value); };
  const Spread streams{.mean = one(50), .variance = one(4)};
  EXPECT_DOUBLE_EQ(error_e2(streams, {one(9), one(0.01), one(9), 0.02}, 600)[0], 4 + 6 + 12);
  EXPECT_DOUBLE_EQ(error_e2(streams, {one(9), one(-0.01), one(9), 0}, 600)[0], 4);
}

}  // namespace
}  // namespace scan::synth
