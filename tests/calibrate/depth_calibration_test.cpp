// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/shared/random.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double turn_rad = 2 * std::numbers::pi;

Camera phase_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.fundamental_frequency_hz = 60e6;
  camera.exposure_s.total_s = 1e-3;
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  camera.sensor.drain = false;
  return camera;
}

/// A camera with known depth errors, and a scene with its true depth.
struct Bench {
  int frames = 6, height = 40, width = 56;
  double first_share = 0.0, last_share = 1.0;  // of the range, spanned by the scene
  double wrong_share = 0.05;                   // of reference pixels
  double second_harmonic = 0.0;                // relative to the first; not explained by any depth
  bool reversed = false;
  bool one_albedo = false;  // signal depends on the distance squared only
  std::uint64_t seed = 1;

  DepthErrorTerms truth;
  RawFrames raw = {};
  ReferenceDepth reference = {};

  double range_m = phase_camera().range_m();

  void run() {
    RandomStream random(seed, 1, 0);
    raw = {.frames = frames, .height = height, .width = width, .measurements = 4};
    reference.depth_m.clear();
    const DepthCorrection error{.height = height, .width = width, .known = truth};
    for (int f = 0; f < frames; ++f) {
      Image<float> depth_m(height, width);
      for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
          const double wave = 0.5 + 0.5 * std::sin(0.11 * row + 0.17 * column + f);
          const double share = (f + wave) / frames;
          const double nominal_m = range_m * (first_share + share * (last_share - first_share));
          const double true_m = nominal_m - error.error_m(nominal_m, range_m, row, column, 1.0);
          depth_m(row, column) =
              static_cast<float>(true_m - range_m * std::floor(true_m / range_m));
          if (random.uniform() < wrong_share)
            depth_m(row, column) = static_cast<float>(range_m * random.uniform());
          const double amplitude = one_albedo ? 2e5 * std::pow(0.3 + nominal_m / range_m, -2)
                                              : 2e5 * (1.2 + std::cos(0.3 * column));
          const double phase_rad = (reversed ? -1.0 : 1.0) * turn_rad * nominal_m / range_m;
          for (int k = 0; k < 4; ++k)
            raw.values.push_back(static_cast<float>(
                amplitude * std::cos(phase_rad - k * turn_rad / 4) +
                second_harmonic * amplitude * std::cos(2 * (phase_rad - k * turn_rad / 4)) +
                std::sqrt(amplitude) * random.normal()));
        }
      reference.depth_m.push_back(std::move(depth_m));
    }
  }

  CalibratedDepth calibrate() const {
    const Camera camera = phase_camera();
    return calibrate_depth(raw, reference, build_family("sinusoid-k4", camera), camera);
  }

  /// Decodes and subtracts the correction of the table.
  double median_error_m(const MeasuredTable& measured) const {
    const Decoder decoder(make_decoding_table(measured, phase_camera()));
    std::vector<double> left_m;
    for (int f = 0; f < frames; ++f) {
      DepthImage image = decoder.decode(raw, f);
      apply(*measured.correction, range_m, DecodedView::of(image), height, width, 0,
            image.depth_m.size());
      for (std::size_t i = 0; i < image.depth_m.size(); ++i) {
        const double off_m = static_cast<double>(
            image.depth_m.pixels[i] - reference.depth_m[static_cast<std::size_t>(f)].pixels[i]);
        left_m.push_back(std::abs(off_m - range_m * std::round(off_m / range_m)));
      }
    }
    std::ranges::nth_element(left_m, left_m.begin() + static_cast<int>(left_m.size() / 2));
    return left_m[left_m.size() / 2];
  }
};

Bench ran(Bench bench) {
  bench.run();
  return bench;
}

DepthErrorTerms wiggle() {
  DepthErrorTerms terms;
  terms.offset_m = 0.7;
  terms.harmonic_m = Eigen::VectorXd::Zero(16);
  terms.harmonic_m[0] = 3e-3;
  terms.harmonic_m[6] = 9e-3;
  terms.harmonic_m[7] = -5e-3;
  terms.harmonic_m[15] = 2e-3;
  terms.field_m = Eigen::Vector2d(4e-3, -6e-3);
  return terms;
}

/// Some harmonics up to the 8th of 1 to 20 mm, slopes, any offset.
DepthErrorTerms random_terms(std::uint64_t seed) {
  RandomStream random(seed, 9, 0);
  const auto signed_m = [&](double min_m, double max_m) {
    const double magnitude = min_m * std::pow(max_m / min_m, random.uniform());
    return random.uniform() < 0.5 ? -magnitude : magnitude;
  };
  DepthErrorTerms terms;
  terms.offset_m = 0.5 * (2.0 * random.uniform() - 1.0);
  terms.harmonic_m = Eigen::VectorXd::Zero(16);
  for (double& term : terms.harmonic_m)
    if (random.uniform() < 0.4) term = signed_m(1e-3, 20e-3);
  terms.field_m = Eigen::Vector2d(signed_m(1e-3, 20e-3), signed_m(1e-3, 20e-3));
  return terms;
}

double term_m(const DepthErrorTerms& terms, const std::string& name) {
  if (name == "offset") return terms.offset_m;
  if (name == "row") return terms.field_m[0];
  if (name == "column") return terms.field_m[1];
  for (int h = 1; h <= 8; ++h) {
    if (name == "cos " + std::to_string(h)) return terms.harmonic_m[2 * h - 2];
    if (name == "sin " + std::to_string(h)) return terms.harmonic_m[2 * h - 1];
  }
  return 0.0;
}

TEST(DepthCalibration, RecoversKnownTermsWithinTheirIntervalsIn100Cameras) {
  int inside = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Bench bench =
        ran({.frames = 4, .height = 24, .width = 32, .seed = seed, .truth = random_terms(seed)});
    const CalibratedDepth found = bench.calibrate();
    EXPECT_FALSE(found.reversed) << seed;
    EXPECT_LT(bench.median_error_m(found.table), 4e-3) << seed;
    for (const CalibratedTerm& term : found.terms) {
      ++all;
      const double off_m = term.value_m.value - term_m(bench.truth, term.name);
      if (std::abs(off_m) <= 1.96 * term.value_m.standard_error) ++inside;
    }
  }
  EXPECT_GT(all, 100 * 8);
  EXPECT_GE(inside, 0.93 * all);
  RecordProperty("inside", inside);
  RecordProperty("all", all);
}

TEST(DepthCalibration, EstimatesTheModelErrorThatDecodersMustTolerate) {
  const auto inconsistent_share = [](const Bench& bench, const MeasuredTable& table) {
    const Decoder decoder(make_decoding_table(table, phase_camera()));
    const DepthImage image = decoder.decode(bench.raw, 2);
    return static_cast<double>(std::ranges::count(image.status.pixels, PixelStatus::inconsistent)) /
           static_cast<double>(image.status.pixels.size());
  };
  for (const double share : {0.0, 0.01, 0.03, 0.2}) {
    Bench bench = ran({.second_harmonic = share, .reversed = share > 0.05, .truth = wiggle()});
    const CalibratedDepth found = bench.calibrate();
    ASSERT_TRUE(found.model_error_percent);
    const double percent = *found.model_error_percent;
    EXPECT_EQ(found.table.model_error_percent, percent);
    EXPECT_EQ(percent > 10.0, std::ranges::any_of(found.notes, [](const std::string& note) {
                return note.find("no depth explains") != std::string::npos;
              }));
    EXPECT_GE(percent, 100.0 * share);
    EXPECT_LE(percent, 170.0 * share);  // at most sqrt(2), by fifths
    EXPECT_LT(inconsistent_share(bench, found.table), 0.02);
    MeasuredTable strict = found.table;
    strict.model_error_percent = 0.0;
    EXPECT_GE(inconsistent_share(bench, strict), share > 0.0 ? 0.4 : 0.0);

    const auto path = std::filesystem::path(testing::TempDir()) / "model_error.npz";
    write_calibrated_table(path, found.table, OutputPolicy::overwrite);
    EXPECT_EQ(read_measured_table(path, {}).table.model_error_percent, percent);
  }
}

TEST(DepthCalibration, TheModelErrorOfACodeWithoutDegreesOfFreedomIsUnknown) {
  Bench bench = ran({.truth = wiggle()});
  Camera camera = phase_camera();
  camera.sensor.taps = 1;
  camera.sensor.drain = true;
  camera.sensor.readout = Readout::separate;
  RawFrames three = bench.raw;
  three.measurements = 3;
  three.values.clear();
  // Computes phases 0, 120 and 240 degrees from 0 and 90 degrees, with ambient light.
  for (std::size_t i = 0; i < bench.raw.values.size(); i += 4) {
    const float c = bench.raw.values[i], s = bench.raw.values[i + 1];
    for (int k = 0; k < 3; ++k) {
      const double angle_rad = k * turn_rad / 3;
      three.values.push_back(static_cast<float>(1e6 + std::cos(angle_rad) * static_cast<double>(c) +
                                                std::sin(angle_rad) * static_cast<double>(s)));
    }
  }
  const CalibratedDepth found =
      calibrate_depth(three, bench.reference, build_family("sinusoid-k3", camera), camera);
  EXPECT_FALSE(found.model_error_percent);
  EXPECT_EQ(found.table.model_error_percent, 0.0);
  EXPECT_THAT(found.notes, Contains(HasSubstr("no degrees of freedom")));
}

TEST(DepthCalibration, ReversedDelayIsCorrectedInTableAndCamera) {
  Bench bench = ran({.reversed = true, .truth = wiggle()});
  const CalibratedDepth found = bench.calibrate();
  EXPECT_TRUE(found.reversed);
  EXPECT_THAT(found.notes, Contains(HasSubstr("delay is reversed")));
  EXPECT_LT(bench.median_error_m(found.table), 2e-3);
  // The camera without the table decodes up to the harmonic errors.
  const Camera camera = with_depth(phase_camera(), found);
  ASSERT_TRUE(camera.playback);
  EXPECT_TRUE(camera.playback->reversed);
  MeasuredTable plain = found.table;
  plain.correlation =
      ForwardModel(build_family("sinusoid-k4", camera), camera).correlation_table(camera.samples);
  plain.correction = DepthCorrection{.height = bench.height, .width = bench.width};
  EXPECT_LT(bench.median_error_m(plain), 15e-3);
}

TEST(DepthCalibration, PartOfTheRangeIsKnownAndTheRestIsExtrapolated) {
  Bench bench = ran({.last_share = 0.4, .truth = wiggle()});
  const CalibratedDepth found = bench.calibrate();
  EXPECT_GT(found.known_share, 0.35);
  EXPECT_LT(found.known_share, 0.5);
  EXPECT_THAT(found.notes, Contains(HasSubstr("is extrapolated by a model")));
  EXPECT_LT(bench.median_error_m(found.table), 2e-3);
  // There, harmonics contribute to the offset; the camera stores the mean error.
  EXPECT_NEAR(with_depth(phase_camera(), found).playback->offset_m, 0.7, 15e-3);
}

TEST(DepthCalibration, TermsHaveTheSizeOfDepthErrorsOnAnyPartOfTheRange) {
  for (const double share : {0.05, 0.1, 0.2, 0.4})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Bench bench =
          ran({.first_share = 0.3, .last_share = 0.3 + share, .seed = seed, .truth = wiggle()});
      const CalibratedDepth found = bench.calibrate();
      for (const CalibratedTerm& term : found.terms) {
        const double offset_m = term.name == "offset" ? found.mean_error_m : 0.0;
        EXPECT_LT(std::abs(term.value_m.value - offset_m), 0.3 * bench.range_m)
            << share << " of the range, " << term.name;
      }
      EXPECT_LT(bench.median_error_m(found.table), 4e-3);
    }
}

TEST(DepthCalibration, TargetsOfOneAlbedoDoNotDetermineSignalTerms) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Bench bench = ran({.last_share = 0.5, .one_albedo = true, .seed = seed, .truth = wiggle()});
    const CalibratedDepth found = bench.calibrate();
    EXPECT_FALSE(found.table.correction->needs_signal());
    Bench other = ran({.last_share = 0.5, .seed = seed + 10, .truth = wiggle()});
    EXPECT_LT(other.median_error_m(found.table), 3e-3);
  }
}

TEST(DepthCalibration, DepthAlongTheAxisIsConvertedWithTheLens) {
  Bench bench = ran({.wrong_share = 0.0, .truth = wiggle()});
  Camera camera = phase_camera();
  camera.lens = Lens{.fx_px = 60.0, .fy_px = 60.0, .cx_px = 27.5, .cy_px = 19.5};
  const CodeSet code = build_family("sinusoid-k4", camera);
  const CalibratedDepth radial = calibrate_depth(bench.raw, bench.reference, code, camera);
  ReferenceDepth z = bench.reference;
  z.is_z = true;
  const PinholeView view = view_of(camera.lens, bench.width, bench.height);
  for (Image<float>& depth_m : z.depth_m) depth_m = z_from_radial(depth_m, view);
  const CalibratedDepth found = calibrate_depth(bench.raw, z, code, camera);
  EXPECT_NEAR(found.mean_error_m, radial.mean_error_m, 1e-5);
  EXPECT_NEAR(found.rms_m.value(), radial.rms_m.value(), 1e-5);
  camera.lens.reset();
  EXPECT_THAT([&] { calibrate_depth(bench.raw, z, code, camera); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("lens = none")));
}

TEST(DepthCalibration, RejectsReferencesOfOtherUnitsOrientationsAndShapes) {
  Bench bench = ran({.truth = wiggle()});
  const auto refuses = [&](const Bench& changed, const char* why) {
    EXPECT_THAT([&] { changed.calibrate(); }, ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  const auto each_pixel = [&](const auto& change) {
    Bench changed = bench;
    for (Image<float>& image : changed.reference.depth_m) {
      const Image<float> before = image;
      for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column)
          image(row, column) = change(before, row, column);
    }
    return changed;
  };
  refuses(each_pixel([](const auto& image, int r, int c) { return 1e3f * image(r, c); }), "metres");
  refuses(each_pixel([&](const auto& i, int r, int c) { return i(bench.height - 1 - r, c); }),
          "flipped top to bottom");
  refuses(each_pixel([&](const auto& i, int r, int c) { return i(r, bench.width - 1 - c); }),
          "mirrored left to right");
  refuses(each_pixel([](const auto&, int, int) { return NAN; }), "at least 100 pixels");
  Bench few = bench;
  few.reference.depth_m.resize(2);
  refuses(few, "one for each of the 6 frames");
  // With several frequencies, the reference is checked first.
  const Camera camera = phase_camera();
  RawFrames two_frequencies{.frames = 32, .height = 8, .width = 8, .measurements = 8};
  two_frequencies.values.assign(32 * 64 * 8, 1.0f);
  EXPECT_THAT(
      [&] {
        calibrate_depth(two_frequencies, {{Image<float>(8, 8, 1.0f), Image<float>(8, 8, 1.0f)}},
                        build_family("multifrequency-1x4-2x4", camera), camera);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("one for each of the 32 frames")));
}

TEST(DepthCalibration, AFewDepthsAreNotMistakenForAnotherUnit) {
  Bench bench{.first_share = 0.1, .last_share = 0.2, .truth = wiggle()};
  bench.truth.offset_m = 0.1;
  bench.run();
  const auto refuses = [&](const auto& change, const char* why) {
    Bench changed = bench;
    for (Image<float>& image : changed.reference.depth_m)
      for (float& depth_m : image.pixels) depth_m = change(depth_m);
    EXPECT_THAT([&] { changed.calibrate(); }, ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  RandomStream random(3, 1, 0);
  refuses([](float depth_m) { return 1e2f * depth_m; }, "reference = centimetres");
  refuses([](float depth_m) { return 1e3f * depth_m; }, "millimetres");
  refuses([&](float) { return static_cast<float>(bench.range_m * random.uniform()); }, "agreement");
}

TEST(DepthCalibration, ReportsExposuresInAnotherOrder) {
  Bench bench = ran({.first_share = 0.4, .last_share = 0.5, .truth = wiggle()});
  EXPECT_THAT(bench.calibrate().notes, Not(Contains(HasSubstr("order of exposures"))));
  for (std::size_t i = 0; i < bench.raw.values.size(); i += 4)
    std::swap(bench.raw.values[i + 1], bench.raw.values[i + 2]);
  EXPECT_THAT(bench.calibrate().notes, Contains(HasSubstr("order of exposures")));
}

TEST(DepthCalibration, ReportsImplausibleErrors) {
  Bench bench = ran({.first_share = 0.3, .last_share = 0.6});
  EXPECT_THAT(bench.calibrate().notes, Not(Contains(HasSubstr("more than usual wiggling"))));
  for (Image<float>& image : bench.reference.depth_m)
    for (float& depth_m : image.pixels) depth_m *= 0.5F;
  EXPECT_THAT(bench.calibrate().notes, Contains(HasSubstr("more than usual wiggling")));
}

TEST(DepthCalibration, AConstantReferenceGivesAnOffsetAndAField) {
  Bench bench = ran({.frames = 1, .first_share = 0.5, .last_share = 0.5, .truth = wiggle()});
  const CalibratedDepth found = bench.calibrate();
  EXPECT_THAT(found.notes, Contains(HasSubstr("hardly changes")));
  for (const CalibratedTerm& term : found.terms) EXPECT_THAT(term.name, Not(HasSubstr("cos")));
  EXPECT_LT(bench.median_error_m(found.table), 2e-3);
}

TEST(DepthCalibration, ReportsAReferenceOfAnotherScene) {
  Bench bench = ran({.first_share = 0.4, .last_share = 0.6, .truth = wiggle()});
  for (Image<float>& depth_m : bench.reference.depth_m) depth_m = Image<float>(1, 1, 0.8f);
  EXPECT_THAT(bench.calibrate().notes, Contains(HasSubstr("0.8 m everywhere")));
}

TEST(DepthCalibration, ThePictureShowsErrorsBeforeAndAfter) {
  Bench bench = ran({.frames = 8, .truth = wiggle()});
  const DepthErrorPicture picture = bench.calibrate().picture;
  const DepthCorrection truth{.height = 1, .width = 1, .known = wiggle()};
  ASSERT_EQ(picture.depth_m.size(), picture.before_m.size());
  for (std::size_t p = 0; p < picture.depth_m.size(); ++p) {
    if (std::isnan(picture.before_m[p])) continue;
    const double wiggle_m = truth.error_m(picture.depth_m[p], bench.range_m, 0, 0, 1.0) - 0.7;
    EXPECT_NEAR(picture.before_m[p], wiggle_m, 6e-3) << picture.depth_m[p];
    EXPECT_NEAR(picture.after_m[p], 0.0, 2e-3) << picture.depth_m[p];
  }
  EXPECT_EQ(picture.after_image_m.height, bench.height);
  EXPECT_EQ(picture.after_image_m.width, bench.width);
  for (const float left_m : picture.after_image_m.pixels) EXPECT_NEAR(left_m, 0.0, 0.02);
}

/// Keeps the reference where a predicate of row and column is true.
template <typename Predicate>
void keep_reference(Bench& bench, const Predicate& is_kept) {
  for (Image<float>& depth_m : bench.reference.depth_m)
    for (int row = 0; row < bench.height; ++row)
      for (int column = 0; column < bench.width; ++column)
        if (!is_kept(row, column)) depth_m(row, column) = NAN;
}

TEST(DepthCalibration, HoldsOutBlocksWhereverTheReferenceIs) {
  const auto parts = std::to_array<bool (*)(int, int)>({
      [](int row, int column) { return (row / 8 + column / 10) % 2 == 0; },  // same checkerboard
      [](int row, int column) { return row / 16 % 2 == 0 && column / 20 % 2 == 1; },
      [](int row, int column) { return row < 8 && column < 10; },  // one block
      [](int row, int column) { return row == column; },
  });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Bench bench = ran({.height = 64, .width = 80, .wrong_share = 0.0, .truth = wiggle()});
    keep_reference(bench, parts[i]);
    const CalibratedDepth found = bench.calibrate();
    EXPECT_EQ(found.skipped_folds, 0) << i;
    ASSERT_TRUE(found.rms_m.has_value()) << i;
    EXPECT_GT(*found.rms_m, 1e-4) << i;  // noise of depth
    EXPECT_LT(*found.rms_m, 0.5 * found.rms_before_m) << i;
  }
}

TEST(DepthCalibration, AReferenceAtOneDistanceHasNoErrorBeyondIt) {
  Bench bench = ran({.frames = 1, .first_share = 0.4, .last_share = 0.4, .wrong_share = 0.0});
  for (Image<float>& depth_m : bench.reference.depth_m)
    depth_m = Image<float>(1, 1, static_cast<float>(0.4 * bench.range_m));
  const CalibratedDepth found = bench.calibrate();
  EXPECT_TRUE(found.rms_m.has_value());
  EXPECT_FALSE(found.far_rms_m.has_value());
  EXPECT_EQ(found.skipped_folds, 4);
}

TEST(DepthCalibration, LeavesSmallerErrorsThanPublishedModelsOnARealCamera) {
  const auto folder = std::filesystem::path(TOFSMITH_SOURCE_DIR) / "../shared/data/melexis_quads";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "without the recording";
  std::vector<std::vector<double>> quads;
  for (const char* name : {"phase0_avg.npy", "phase90_avg.npy", "phase180_avg.npy",
                           "phase270_avg.npy", "dist_avg.npy", "amp_avg.npy"})
    quads.push_back(read_npy(folder / name).to_doubles());
  Bench bench{.frames = 1, .height = 385, .width = 640};
  bench.raw = {.frames = 1, .height = 385, .width = 640, .measurements = 4};
  Image<float> known(385, 640), all(385, 640);
  for (std::size_t i = 0; i < known.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k) bench.raw.values.push_back(static_cast<float>(quads[k][i]));
    all.pixels[i] = static_cast<float>(1e-3 * quads[4][i]);
    const bool is_held_out = (i / 640 / 55 + i % 640 / 80) % 2 == 1;
    known.pixels[i] = is_held_out ? NAN : all.pixels[i];
  }
  bench.reference.depth_m = {known};
  const CalibratedDepth found = bench.calibrate();
  const Decoder decoder(make_decoding_table(found.table, phase_camera()));
  DepthImage image = decoder.decode(bench.raw, 0);
  apply(*found.table.correction, bench.range_m, DecodedView::of(image), 385, 640, 0, all.size());
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!std::isnan(known.pixels[i]) || !(quads[5][i] > 100)) continue;
    const double off_m = static_cast<double>(image.depth_m.pixels[i] - all.pixels[i]);
    sum += std::pow(off_m - bench.range_m * std::round(off_m / bench.range_m), 2);
    count += 1.0;
  }
  EXPECT_LT(std::sqrt(sum / count), 1.3e-3);
}

}  // namespace
}  // namespace tofsmith
