// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/shared/document_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "damaged_files.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(std::string_view text) {
  return io_error_of([&] { parse_json(text, "a.json"); });
}

TEST(JsonText, ParsesJson) { EXPECT_EQ(parse_json("{\"n\": [1, 2]}", "a.json")["n"][1], 2); }

TEST(JsonText, ErrorsNameLineAndColumn) {
  EXPECT_THAT(refusal("{\n  \"a\": 1,\n  \"b\": x\n}"), StartsWith("a.json:3:8: "));
  EXPECT_THAT(refusal("[1 2]"), StartsWith("a.json:1:4: "));
  EXPECT_THAT(refusal(""), StartsWith("a.json:1:1: "));
  EXPECT_THAT(refusal("[1,\n"), StartsWith("a.json:2:1: "));
  EXPECT_THAT(refusal("[1] 2"), StartsWith("a.json:1:5: "));
  EXPECT_THAT(refusal(std::string(10'000'000, '[')), HasSubstr("more than 64 deep"));
  EXPECT_THAT(refusal("\"\xff\""), StartsWith("a.json:1:"));
  EXPECT_THAT(refusal("[1e999]"), StartsWith("a.json"));
  EXPECT_THAT(refusal(std::string_view("[1]\n\0 2", 7)),
              StartsWith("a.json:2:1: found a zero byte"));
}

TEST(JsonText, ErrorsQuoteTheUnexpectedText) {
  EXPECT_THAT(refusal("[1 2]"), HasSubstr("unexpected number literal"));
  EXPECT_THAT(refusal("[1 2]"), testing::Not(HasSubstr("json.exception")));
}

}  // namespace
}  // namespace tofsmith
