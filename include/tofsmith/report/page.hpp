// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// Text. `words` between backticks are set as code, also in captions and table headers, but not in
/// cells, titles and settings, which contain user-defined names.
struct Paragraph {
  std::string text = {};
};

struct KeyValue {
  std::string key = {};
  std::string value = {};
};

/// A list of settings, e.g. the camera.
struct KeyValueList {
  std::vector<KeyValue> entries = {};
};

/// The most important numbers: large values with small labels.
struct KeyNumbers {
  std::vector<KeyValue> entries = {};
};

struct TableColumn {
  std::string header = {};
  bool numeric = false;  ///< right-aligned, with digits of equal width
};

struct Table {
  std::string id = {};       ///< unique on a page; may be empty
  std::string title = {};    ///< above the table; may be empty
  std::string caption = {};  ///< below a table with a title, else above it
  std::vector<TableColumn> columns = {};
  std::vector<std::vector<std::string>> rows = {};
  std::optional<int> highlighted_row = {};  ///< index, e.g. of the best code
};

/// Preformatted text, e.g. a command line or a file.
struct CodeBlock {
  std::string text = {};
};

using Block = std::variant<Paragraph, KeyValueList, KeyNumbers, Table, CodeBlock, Figure>;

/// Layout of a section. open: blocks one below the other; folded: the same, initially hidden;
/// front: side by side, for the first screen of a page.
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
  std::string footer = {};  ///< last line, e.g. version and seed
};

/// Returns the page as a JSON document: {title, subtitle, footer, sections: [{title, layout,
/// blocks}]}. docs/report_pages.md lists the values of a block's `kind`. Equal pages give equal
/// bytes.
/// @throws std::invalid_argument if two figures or tables share an id, or a table row does not fit
///         its columns
std::string page_document(const Page& page);

/// Returns the page as a self-contained HTML file that needs no network: page_document() and the
/// viewer, which draws figures as they scroll into view. Scripts can use `window.tofsmithFigures` =
/// {total, rendered, errors} and `window.tofsmithRenderAll()`, a promise that resolves when every
/// figure is drawn.
/// @throws std::invalid_argument as page_document()
std::string render(const Page& page);

}  // namespace tofsmith
