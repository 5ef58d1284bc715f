// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/measured_table_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ResponseFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name) << text;
    return directory_ / name;
  }
  std::string refusal(const std::string& text, std::optional<double> time_step_s) const {
    return io_error_of([&] { read_impulse_response(write("r.csv", text), time_step_s); });
  }
  TemporaryDirectory directory_;
};

TEST_F(ResponseFile, TimesDetermineTheStep) {
  const auto path = write("r.csv", "time_s,value\n5e-9,1\n6e-9,3\n7e-9,0.5\n");
  const ImpulseResponse response = read_impulse_response(path);
  EXPECT_EQ(response.kind, ImpulseResponse::Kind::file);
  EXPECT_THAT(response.samples, ElementsAre(1.0, 3.0, 0.5));
  EXPECT_NEAR(response.time_step_s, 1e-9, 1e-15);
  EXPECT_EQ(response.file, path.string());
  EXPECT_EQ(read_impulse_response(path, 1e-9).time_step_s, 1e-9);
}

TEST_F(ResponseFile, ReadsOscilloscopeFiles) {
  const std::vector<double> expected = {1.0, 3.0, 0.5};
  for (const char* text : {"Model,DSO,,5e-9,1,\n,,,6e-9,3,\n,,,7e-9,0.5,\n",
                           "\xef\xbb\xbftime_ns;V\n5;1\n6;3\n7;0,5\n",
                           "X,CH1,Increment\nSequence,Volt,1e-9\n0,1,\n1,3,\n2,0.5,\n",
                           "V,time_s\n1,5e-9\n3,6e-9\n0.5,7e-9\n"}) {
    const ImpulseResponse response = read_impulse_response(write("r.csv", text));
    EXPECT_EQ(response.samples, expected) << text;
    EXPECT_NEAR(response.time_step_s, 1e-9, 1e-15) << text;
  }
  EXPECT_EQ(read_impulse_response(write("r.csv", "0,1\n1,3\n2,0.5\n"), 2e-9).samples, expected);
  EXPECT_THAT(refusal("1\n9.91E+37\n", 1e-9), HasSubstr("r.csv:2:1: found '9.91E+37'"));
}

TEST_F(ResponseFile, ValuesWithoutTimesNeedAStep) {
  EXPECT_THAT(read_impulse_response(write("r.txt", "1\n2\n"), 2e-9).samples, ElementsAre(1.0, 2.0));
  write_npy(directory_ / "r.npy", NpyArray::of<float>({3}, std::vector<float>{1, 2, 4}),
            OutputPolicy::overwrite);
  const ImpulseResponse response = read_impulse_response(directory_ / "r.npy", 2e-9);
  EXPECT_THAT(response.samples, ElementsAre(1.0, 2.0, 4.0));
  EXPECT_EQ(response.time_step_s, 2e-9);
  EXPECT_THAT(refusal("1\n2\n", std::nullopt), HasSubstr("expected time_step_s"));
}

TEST_F(ResponseFile, RejectsInvalidResponses) {
  EXPECT_THAT(refusal("0,1\n1e-9,2\n3e-9,1\n", {}),
              HasSubstr("row 1: found the time 1e-09 s; expected 1.5e-09 s"));
  EXPECT_THAT(refusal("2e-9,1\n1e-9,2\n", {}), HasSubstr("do not increase"));
  EXPECT_THAT(refusal("time_s,value\n0,1\n", {}), HasSubstr("found one time"));
  EXPECT_THAT(refusal("1,2,3\n", 1e-9), HasSubstr("found 3 columns"));
  EXPECT_THAT(refusal("value,time_s\n1,1\n1,0\n", {}), HasSubstr("do not increase"));
  EXPECT_THAT(refusal("0,1\n1e-9,2\n", 2e-9), HasSubstr("expected time_step_s = 2e-09"));
  EXPECT_THAT(refusal("1\n-1\n", 1e-9), HasSubstr("samples sum = 0; must be > 0"));
  EXPECT_THAT(refusal("1\n", -1.0), HasSubstr("time_step_s = -1; must be finite and > 0"));
  EXPECT_THAT(io_error_of([&] { read_impulse_response("r.png", 1e-9); }),
              HasSubstr("expected one of .csv, .txt, .tsv, .dat, .npy"));
  write_npy(directory_ / "r.npy", NpyArray(NpyType::float64, {3, 2}), OutputPolicy::overwrite);
  EXPECT_THAT(io_error_of([&] { read_impulse_response(directory_ / "r.npy", 1e-9); }),
              HasSubstr("found an array of shape (3, 2); expected one axis"));
}

}  // namespace
}  // namespace tofsmith
