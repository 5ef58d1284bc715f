// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/design_directory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "damaged_directory.hpp"
#include "damaged_files.hpp"
#include "design_setup.hpp"
#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/result_document.hpp"

namespace tofsmith {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

Camera camera() {
  Camera camera = coarse_camera("paper-5f0");
  camera.sensor.impulse_response = {.kind = ImpulseResponse::Kind::file,
                                    .samples = {0.25, 0.5, 0.25},
                                    .time_step_s = 1e-9,
                                    .file = "/nowhere/response.csv"};
  return camera;
}

DesignOptions options() {
  DesignOptions options = small_options();
  options.target = targets_of(build_family("square-k3", camera()));
  options.target->name = "../a/b \xc3\xbc<script>";
  options.baselines->push_back("histogram-k4");  // a family for row readout, unlike this camera's
  return options;
}

const DesignResult& designed() {
  static const DesignResult result = design(camera(), options());
  return result;
}

void expect_same_error(const DepthErrorReport& a, const DepthErrorReport& b) {
  EXPECT_EQ(a.code, b.code);
  EXPECT_EQ(a.measurements, b.measurements);
  EXPECT_EQ(a.trials, b.trials);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.linear.geometric_mean_m.value, b.linear.geometric_mean_m.value);
  EXPECT_EQ(a.circular.mean_m.standard_error, b.circular.mean_m.standard_error);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].point, b.points[i].point);
    EXPECT_EQ(a.points[i].circular_mde_m.value, b.points[i].circular_mde_m.value);
    EXPECT_EQ(a.points[i].linear_rmse_m.value, b.points[i].linear_rmse_m.value);
    EXPECT_EQ(a.points[i].circular_rmse_m.standard_error,
              b.points[i].circular_rmse_m.standard_error);
    EXPECT_EQ(a.points[i].outlier_rate.value, b.points[i].outlier_rate.value);
    EXPECT_EQ(a.points[i].cramer_rao_mae_m, b.points[i].cramer_rao_mae_m);
    EXPECT_EQ(a.points[i].receiver_bound_mae_m, b.points[i].receiver_bound_mae_m);
    EXPECT_EQ(a.points[i].direct_tof_bound_mae_m, b.points[i].direct_tof_bound_mae_m);
  }
}

void expect_same_candidate(const Candidate& a, const Candidate& b) {
  expect_same_code(a.code, b.code);
  expect_same_error(a.error, b.error);
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.rotation_bin, b.rotation_bin);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.seconds, b.seconds);
  EXPECT_EQ(a.target, b.target);
  EXPECT_EQ(a.message, b.message);
  ASSERT_EQ(a.per_measurement.size(), b.per_measurement.size());
  for (std::size_t k = 0; k < a.per_measurement.size(); ++k) {
    const MeasurementReport &x = a.per_measurement[k], &y = b.per_measurement[k];
    EXPECT_EQ(x.residual_rms, y.residual_rms);
    EXPECT_EQ(x.smallest_residual_rms, y.smallest_residual_rms);
    EXPECT_EQ(x.edges, y.edges);
    EXPECT_EQ(x.start, y.start);
    ASSERT_EQ(x.history.size(), y.history.size());
    for (std::size_t i = 0; i < x.history.size(); ++i)
      EXPECT_EQ(x.history[i].playable_residual_rms, y.history[i].playable_residual_rms);
  }
}

TEST(DesignDirectory, ReadingUndoesWriting) {
  const TemporaryDirectory place;
  const DesignDirectory directory(place / "d");
  EXPECT_FALSE(directory.holds_design());
  directory.write(camera(), designed(), options(), OutputPolicy::refuse_existing);
  EXPECT_TRUE(directory.holds_design());
  EXPECT_EQ(place.files(), 1) << "a code's name must not lead out of the directory";
  const DesignRecord record = directory.read();
  Camera written = camera();
  written.sensor.impulse_response.file.clear();  // the directory is self-contained
  EXPECT_EQ(record.camera, written);
  EXPECT_EQ(record.result.best, designed().best);
  EXPECT_EQ(record.result.left_out, designed().left_out);
  EXPECT_FALSE(record.result.left_out.empty());
  ASSERT_EQ(record.result.candidates.size(), designed().candidates.size());
  for (std::size_t i = 0; i < record.result.candidates.size(); ++i)
    expect_same_candidate(record.result.candidates[i], designed().candidates[i]);
}

DesignRecord written_and_read(const Camera& camera, const DesignResult& result,
                              const DesignOptions& options) {
  const TemporaryDirectory place;
  const DesignDirectory directory(place / "d");
  directory.write(camera, result, options, OutputPolicy::refuse_existing);
  return directory.read();
}

DesignResult judged(const Camera& camera) {
  return judge(camera, {{.code = build_family("sinusoid-k4", camera), .method = "family"}},
               small_options());
}

TEST(DesignDirectory, KeepsMultipathErrors) {
  Camera two_buckets = coarse_camera("paper-10f0", DepthErrorKind::circular);
  two_buckets.sensor.taps = 2;
  two_buckets.operating.multipath.emplace();
  DesignOptions options = small_options();
  options.baselines = {"sinusoid-k4", "hamiltonian-k5"};
  options.exposures = {5};
  options.trials = 1000;
  const DesignResult result = design(two_buckets, options);
  EXPECT_THAT(result.winner().code.name(), testing::HasSubstr("hamiltonian-k5"));
  const DesignRecord record = written_and_read(two_buckets, result, options);
  EXPECT_EQ(record.camera, two_buckets);
  ASSERT_EQ(record.result.candidates.size(), result.candidates.size());
  for (std::size_t i = 0; i < result.candidates.size(); ++i) {
    const auto &a = record.result.candidates[i].multipath, &b = result.candidates[i].multipath;
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->single_path.linear_m.value, b->single_path.linear_m.value);
    EXPECT_EQ(a->single_path.circular_m.standard_error, b->single_path.circular_m.standard_error);
    ASSERT_EQ(a->two_return.has_value(), b->two_return.has_value());
    EXPECT_EQ(a->two_return.has_value(), record.result.candidates[i].code.exposures() >= 5);
    if (a->two_return) {
      EXPECT_EQ(a->two_return->circular_m.value, b->two_return->circular_m.value);
    }
  }
}

TEST(DesignDirectory, KeepsTheOrderOfExposures) {
  Camera moving = coarse_camera("paper-10f0");
  moving.operating.velocity_m_per_s = 1.0;
  const DesignResult result = judged(moving);
  const DesignRecord record = written_and_read(moving, result, small_options());
  const auto& read = record.result.winner().exposure_order;
  const auto& written = result.winner().exposure_order;
  ASSERT_TRUE(read && written);
  EXPECT_EQ(read->order, written->order);
  EXPECT_EQ(read->rms_bias_m, written->rms_bias_m);
  EXPECT_EQ(read->given_rms_bias_m, written->given_rms_bias_m);
}

TEST(DesignDirectory, KeepsErrorsWithOtherCameras) {
  Camera lit = coarse_camera("paper-10f0");
  lit.operating.interference.emplace();
  for (const bool uniform_albedo : {false, true}) {
    lit.operating.uniform_albedo = uniform_albedo;
    const DesignResult result = judged(lit);
    const DesignRecord record = written_and_read(lit, result, small_options());
    EXPECT_EQ(record.camera, lit);
    const auto& read = record.result.winner().interference;
    const auto& written = result.winner().interference;
    ASSERT_TRUE(read && written);
    EXPECT_EQ(read->rms_m, written->rms_m);
    EXPECT_EQ(read->circular.geometric_mean_m.value, written->circular.geometric_mean_m.value);
    EXPECT_EQ(read->points.front().expected_rmse_m, written->points.front().expected_rmse_m);
    EXPECT_EQ(read->points.back().shares.wrong, written->points.back().shares.wrong);
  }
}

TEST(DesignDirectory, ExistingFilesAreReplacedOnRequestOnly) {
  const TemporaryDirectory place;
  const DesignDirectory directory(place.path());
  directory.write(camera(), designed(), options(), OutputPolicy::refuse_existing);
  EXPECT_THROW(directory.write(camera(), designed(), options(), OutputPolicy::refuse_existing),
               IoError);
  EXPECT_TRUE(directory.holds_design());
  directory.write(camera(), designed(), options(), OutputPolicy::overwrite);
  EXPECT_TRUE(directory.holds_design());
}

TEST(DesignDirectory, ReadingChangesNothing) {
  const TemporaryDirectory place;
  EXPECT_THROW(DesignDirectory(place.path()).read(), IoError);
  EXPECT_EQ(place.files(), 0);
}

std::optional<Candidate> kept_in(const TemporaryDirectory& place, const Camera& camera,
                                 const DesignOptions& options) {
  const std::vector<Candidate> kept = DesignDirectory(place.path())
                                          .store(camera, options)
                                          .load(designed().candidates.back().code.name());
  if (kept.empty()) return std::nullopt;
  return kept.front();
}

void keep_in(const TemporaryDirectory& place, const Candidate& candidate) {
  DesignDirectory(place.path()).store(camera(), options()).save(candidate.code.name(), {candidate});
}

TEST(DesignStore, ReturnsADesignForTheSameInputsOnly) {
  const TemporaryDirectory place;
  Candidate unjudged = designed().candidates.back();
  unjudged.error = {};
  unjudged.rotation_bin = 0;
  EXPECT_FALSE(kept_in(place, camera(), options()));
  keep_in(place, unjudged);
  const auto kept = kept_in(place, camera(), options());
  ASSERT_TRUE(kept);
  expect_same_candidate(*kept, unjudged);

  const auto reused = [&](auto&& change) {
    Camera other_camera = camera();
    DesignOptions other = options();
    change(other_camera, other);
    return kept_in(place, other_camera, other).has_value();
  };
  EXPECT_TRUE(reused([](Camera&, DesignOptions& o) { o.trials *= 2; })) << "judged afresh";
  EXPECT_TRUE(reused([](Camera&, DesignOptions& o) { o.outlier_threshold_m = 0.1; })) << "likewise";
  EXPECT_FALSE(reused([](Camera& c, DesignOptions&) { c.light.peak_factor = 14; }));
  EXPECT_FALSE(
      reused([](Camera& c, DesignOptions&) { c.sensor.impulse_response.samples[0] = 0.3; }));
  EXPECT_FALSE(reused([](Camera&, DesignOptions& o) { o.seed = 9; }));
  EXPECT_TRUE(reused([](Camera&, DesignOptions& o) { o.factorize.seed = 9; })) << "not used";
  EXPECT_FALSE(reused([](Camera&, DesignOptions& o) { o.factorize.kept = 4; }));
  EXPECT_FALSE(
      reused([](Camera&, DesignOptions& o) { o.target->measurements[0].samples[3] += 1e-9; }));
  EXPECT_FALSE(reused([](Camera&, DesignOptions& o) { o.target->measurements[0].ideal.reset(); }));
  EXPECT_FALSE(
      reused([](Camera&, DesignOptions& o) { o.target->measurements[0].demodulation_mean = .4; }));
}

fs::path only_file(const fs::path& directory) { return fs::directory_iterator(directory)->path(); }

TEST(DesignStore, DamagedDesignsAreDesignedAgain) {
  const TemporaryDirectory place;
  keep_in(place, designed().candidates.back());
  const fs::path path = only_file(place / "finished");
  const FileBytes whole = read_binary_file(path);
  for (std::size_t length = 0; length < whole.size(); length += 199) {
    overwrite_bytes(path, std::span(whole).first(length));
    EXPECT_FALSE(kept_in(place, camera(), options())) << "cut after " << length << " bytes";
  }
  for (std::uint64_t i = 0; i < 150; ++i) {
    RandomStream random(3, i);
    overwrite_bytes(path, damaged(whole, random));
    const auto kept = kept_in(place, camera(), options());  // may be read or not, but never throws
    if (kept) {
      EXPECT_NO_THROW(require_fits(kept->code, camera()));
    }
  }
}

TEST(DesignDirectory, DamageIsReadOrRejectedWithTheFileName) {
  const TemporaryDirectory place;
  const DesignDirectory directory(place.path());
  directory.write(camera(), designed(), options(), OutputPolicy::overwrite);
  for (const fs::path& path : {place / "design.json", place / "details.json", place / "camera.toml",
                               place / "codes" / "sinusoid-k4.code.json"})
    expect_damage_of_file_read_or_refused(place.path(), path, 60, [&] { directory.read(); });
  EXPECT_EQ(directory.read().result.candidates.size(), designed().candidates.size());
}

TEST(DesignDirectory, InconsistentPartsAreRejected) {
  const TemporaryDirectory place;
  const DesignDirectory directory(place.path());
  directory.write(camera(), designed(), options(), OutputPolicy::overwrite);
  const auto refusal = [&](const std::string& file, const std::string& from,
                           const std::string& to) {
    const fs::path path = place / file;
    const std::string whole = read_text_file(path);
    std::string changed = whole;
    changed.replace(changed.find(from), from.size(), to);
    write_file_atomically(path, changed, OutputPolicy::overwrite);
    const std::string message = io_error_of([&] { directory.read(); });
    write_file_atomically(path, whole, OutputPolicy::overwrite);
    return message;
  };
  EXPECT_THAT(refusal("design.json", "\"best\": \"", "\"best\": \"not-"),
              AllOf(HasSubstr("design.json: /best"), HasSubstr("one of the codes")));
  EXPECT_THAT(refusal("design.json", "\"tofsmith\": \"", "\"tofsmith\": \"0.0.1-"),
              AllOf(HasSubstr("design.json: /tofsmith: found \"0.0.1-"),
                    HasSubstr("read the design with the version that wrote it")));
  EXPECT_THAT(refusal("details.json", "\"message\"", "\"massage\""),
              AllOf(HasSubstr("details.json"), HasSubstr("message")));
  EXPECT_THAT(refusal("design.json", "\"smallest_residual_rms\"", "\"residual\""),
              AllOf(HasSubstr("design.json"), HasSubstr("smallest_residual_rms")));
  EXPECT_THAT(refusal("design.json", "\"rotation_bin\": ", "\"rotation_bin\": 1e300, \"x\": "),
              HasSubstr("/codes/0/rotation_bin"));
  EXPECT_THAT(refusal("design.json", "square-k4", "sinusoid-k4"), HasSubstr("twice"));
  EXPECT_THAT(refusal("codes/sinusoid-k4.code.json", "sinusoid-k4", "another"),
              AllOf(HasSubstr("sinusoid-k4.code.json"), HasSubstr("another")));
  EXPECT_THAT(refusal("camera.toml", "signal_e_per_s = [", "signal_e_per_s = [ 7.0, "),
              HasSubstr("found 2 operating points; expected 3"));
  EXPECT_THAT(refusal("camera.toml", "samples = 60", "samples = 120"),
              HasSubstr("does not fit the camera"));
}

TEST(FileName, IsPlainAndUniquePerName) {
  EXPECT_EQ(file_name_of("hamiltonian-k4_2.1"), "hamiltonian-k4_2.1");
  EXPECT_EQ(file_name_of("../a"), "%2E.%2Fa");
  EXPECT_EQ(file_name_of("a/b"), "a%2Fb");
  EXPECT_EQ(file_name_of("a%2Fb"), "a%252Fb");
  EXPECT_EQ(file_name_of(std::string_view("a\0b", 3)), "a%00b");
}

}  // namespace
}  // namespace tofsmith
