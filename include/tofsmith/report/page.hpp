// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// Text. `words` between backticks are set as code, [[id]] becomes a link that reads "Figure 3" or
/// "Table 1". Captions and headers of tables are read in the same way; cells, titles and settings,
/// which hold names that users give, stay as they are.
struct Paragraph {
  std::string text = {};
};

/// A name and its value, both as text.
struct KeyValue {
  std::string key = {};
  std::string value = {};
};

/// A list of settings, e.g. the camera.
struct KeyValueList {
  std::vector<KeyValue> entries = {};
};

/// The few numbers a reader should take home: large values over small labels.
struct KeyNumbers {
  std::vector<KeyValue> entries = {};
};

struct TableColumn {
  std::string header = {};
  bool numeric = false;  ///< aligned to the right, digits of one width
};

struct Table {
  std::string id = {};       ///< unique on a page, for [[id]]; may be empty
  std::string caption = {};  ///< stands above, after "Table 1."
  std::vector<TableColumn> columns = {};
  std::vector<std::vector<std::string>> rows = {};
  std::optional<int> highlighted_row = {};  ///< index of the row to stress, e.g. the best code
};

/// Text as typed: a command line, a file.
struct CodeBlock {
  std::string text = {};
};

/// How a statement fared against our numbers; shown as a word and a colour.
enum class Verdict { holds, in_part, fails };

/// "holds", "holds in part", "does not hold".
std::string_view name_of(Verdict verdict);

/// What somebody stated, and what we found.
struct CheckedStatement {
  Verdict verdict = Verdict::fails;
  std::string statement = {};
  std::string measured = {};  ///< our number beside it
  std::string why = {};       ///< what explains a difference; may be empty
};

struct CheckedStatementList {
  std::vector<CheckedStatement> entries = {};
};

/// A way to another file, by a path relative to the page.
struct Link {
  std::string text = {};
  std::string path = {};
  std::string note = {};  ///< after the link; may be empty
};

struct LinkList {
  std::vector<Link> entries = {};
};

using Block = std::variant<Paragraph, KeyValueList, KeyNumbers, Table, CodeBlock, Figure,
                           CheckedStatementList, LinkList>;

struct Section {
  std::string title = {};
  std::vector<Block> blocks = {};
};

struct Page {
  std::string title = {};
  std::string subtitle = {};
  std::vector<Section> sections = {};
  std::string footer = {};  ///< one line at the end, e.g. version and seed
};

/// The page as one HTML document that needs no other file and no network; figures are drawn by the
/// embedded plotly.js as they scroll into view. The same page gives the same bytes. Scripts find
/// `window.tofsmithFigures` = {total, rendered, errors} and `window.tofsmithRenderAll()`, a promise
/// that every figure is drawn.
/// @throws std::invalid_argument if two figures or tables share an id, a table row does not fit its
///         columns, or [[id]] names nothing on the page
std::string render(const Page& page);

}  // namespace tofsmith
