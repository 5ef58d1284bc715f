// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/reproduction_directory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

const PaperItem item{"fig5", "A title", nullptr, 1.0};

Reproduction sample() {
  const std::vector<double> values = {1, 2, 3};
  return {.findings = {{Verdict::in_part, "statement", "measured", "why"},
                       {Verdict::holds, "second", "2", ""}},
          .sections = {{"Section", {Paragraph{"words"}}}},
          .arrays = {{"values", NpyArray::of<double>({3}, values)}},
          .files = {{"table.csv", "a\n1\n"}}};
}

class ReproductionFiles : public testing::Test {
 protected:
  TemporaryDirectory temporary_;
  ReproductionDirectory directory_{temporary_.path() / "out"};
};

TEST_F(ReproductionFiles, AreFinishedForTheSameOptionsOnly) {
  EXPECT_FALSE(directory_.finished(item, {}));
  directory_.write(item, sample(), {});
  const auto findings = directory_.finished(item, {});
  ASSERT_TRUE(findings);
  ASSERT_EQ(findings->size(), 2u);
  EXPECT_EQ(findings->front().verdict, Verdict::in_part);
  EXPECT_EQ(findings->front().why, "why");
  EXPECT_EQ(findings->back().statement, "second");
  EXPECT_FALSE(directory_.finished(item, {.fast = true}));
  EXPECT_FALSE(directory_.finished(item, {.seed = 2}));
}

TEST_F(ReproductionFiles, DependOnTheMeshOnlyWhereItIsShown) {
  const ReproduceOptions cow{.mesh = TriangleMesh{.vertices = {{0, 0, 0}}}, .mesh_name = "cow.obj"};
  ReproduceOptions other = cow;
  other.mesh->triangles = {{0, 0, 0}};
  PaperItem shows = item;
  shows.shows_mesh = true;
  directory_.write(item, sample(), {});
  EXPECT_TRUE(directory_.finished(item, cow));
  EXPECT_FALSE(directory_.finished(shows, cow));
  directory_.write(shows, sample(), cow);
  EXPECT_TRUE(directory_.finished(shows, cow));
  EXPECT_FALSE(directory_.finished(shows, other));
}

TEST_F(ReproductionFiles, HoldWhatTheFigureGave) {
  directory_.write(item, sample(), {});
  const auto figure = directory_.path() / "fig5";
  EXPECT_EQ(read_text_file(figure / "table.csv"), "a\n1\n");
  EXPECT_EQ(read_npz(figure / "data.npz").at("values").to_doubles(),
            (std::vector<double>{1, 2, 3}));
  const std::string page = read_text_file(figure / "index.html");
  EXPECT_THAT(page, HasSubstr("holds in part"));
  EXPECT_THAT(page, HasSubstr("href=\"data.npz\""));
  EXPECT_THAT(page, HasSubstr("href=\"table.csv\""));
}

TEST_F(ReproductionFiles, CountAsUnfinishedWhenDamaged) {
  directory_.write(item, sample(), {});
  const auto file = directory_.path() / "fig5" / "findings.json";
  const std::string content = read_text_file(file);
  for (const std::size_t length : {std::size_t{0}, content.size() / 2, content.size() - 3}) {
    write_file_atomically(file, content.substr(0, length), OutputPolicy::overwrite);
    EXPECT_FALSE(directory_.finished(item, {})) << length;
  }
}

TEST_F(ReproductionFiles, LeaveThePagesOfOthersAlone) {
  directory_.write(item, sample(), {});
  directory_.write_index({});
  EXPECT_NO_THROW(directory_.require_ours({}));
  EXPECT_THROW(directory_.require_ours({.fast = true}), IoError);
  EXPECT_THROW(directory_.require_ours({.seed = 2}), IoError);
  write_file_atomically(directory_.path() / "index.html", "<html>mine</html>",
                        OutputPolicy::overwrite);
  EXPECT_THROW(directory_.require_ours({}), IoError);
}

TEST_F(ReproductionFiles, IndexListsWhatIsFinishedAndCountsItsVerdicts) {
  directory_.write(item, sample(), {});
  directory_.write_index({});
  const std::string page = read_text_file(directory_.path() / "index.html");
  EXPECT_THAT(page, HasSubstr("href=\"fig5/index.html\""));
  EXPECT_THAT(page, HasSubstr("<dt>holds</dt><dd>1</dd>"));
  EXPECT_THAT(page, HasSubstr("<dt>holds in part</dt><dd>1</dd>"));
  EXPECT_THAT(page, HasSubstr("<dt>does not hold</dt><dd>0</dd>"));
}

TEST(PaperItems, AreFoundByNameAndOthersRefusedWithTheNearest) {
  for (const PaperItem& one : paper_items()) EXPECT_EQ(&paper_item(one.name), &one);
  try {
    paper_item("fg5");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean fig5?"));
  }
}

TEST(OverallVerdict, IsInPartUnlessAllAgree) {
  using enum Verdict;
  EXPECT_EQ(overall_verdict({}), holds);
  EXPECT_EQ(overall_verdict({{holds}, {holds}}), holds);
  EXPECT_EQ(overall_verdict({{fails}, {fails}}), fails);
  EXPECT_EQ(overall_verdict({{holds}, {fails}}), in_part);
  EXPECT_EQ(overall_verdict({{in_part}}), in_part);
}

TEST(CodeShelf, KeepsCodesInFilesAndTakesThemFromThere) {
  const TemporaryDirectory temporary;
  const ReproduceOptions options{.fast = true};
  Camera camera = paper_camera(6, 0);
  camera.samples = 60;
  CodeShelf first(temporary.path() / "codes");
  const CodeSet& made = first.redesigned(3, camera, options);
  EXPECT_EQ(&first.redesigned(3, camera, options), &made);

  CodeShelf second(temporary.path() / "codes");
  int reports = 0;
  const CodeSet& read = second.redesigned(3, camera, options, [&](double, std::string_view) {
    ++reports;
    return true;
  });
  EXPECT_EQ(reports, 0) << "was designed again";
  EXPECT_EQ(read.modulation_samples(), made.modulation_samples());
  EXPECT_EQ(read.demodulation_samples(), made.demodulation_samples());
}

TEST(CodeShelf, RedesignsWithinThePeak) {
  CodeShelf shelf;
  Camera camera = paper_camera(3, 0);
  camera.samples = 60;
  const CodeSet& code = shelf.redesigned(3, camera, {.fast = true});
  EXPECT_NO_THROW(require_fits(code, camera));
  EXPECT_EQ(code.exposures(), 3);
}

}  // namespace
}  // namespace tofsmith
