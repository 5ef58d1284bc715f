// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// Text. `words` between backticks are set as code, also in captions and headers of tables; not in
/// cells, titles and settings, which contain names that users choose.
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
  std::string id = {};       ///< unique on a page; may be empty
  std::string title = {};    ///< above the table; may be empty
  std::string caption = {};  ///< below a table with a title, above one without
  std::vector<TableColumn> columns = {};
  std::vector<std::vector<std::string>> rows = {};
  std::optional<int> highlighted_row = {};  ///< index of the row to stress, e.g. the best code
};

/// Text as typed: a command line, a file.
struct CodeBlock {
  std::string text = {};
};

using Block = std::variant<Paragraph, KeyValueList, KeyNumbers, Table, CodeBlock, Figure>;

/// Layout of a section: one block below the other, the same behind a closed title, or the first
/// screen of a page, which arranges its blocks side by side.
enum class SectionLayout { open, folded, front };

struct Section {
  std::string title = {};
  std::vector<Block> blocks = {};
  SectionLayout layout = SectionLayout::open;
};

struct Page {
  std::string title = {};
  std::string subtitle = {};
  std::vector<Section> sections = {};
  std::string footer = {};  ///< one line at the end, e.g. version and seed
};

/// The page as a JSON document: {title, subtitle, footer, sections: [{title, layout, blocks}]}.
/// Blocks have a `kind`; docs/report_pages.md lists the kinds. The same page has the same bytes.
/// @throws std::invalid_argument if two figures or tables share an id, or a table row does not fit
///         its columns
std::string page_document(const Page& page);

/// The page as one HTML file that needs no other file and no network: the viewer, which draws the
/// figures as they scroll into view, and page_document(). Scripts find
/// `window.tofsmithFigures` = {total, rendered, errors} and `window.tofsmithRenderAll()`, a promise
/// that every figure is drawn.
/// @throws std::invalid_argument as page_document()
std::string render(const Page& page);

}  // namespace tofsmith
