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
/// cells, titles and settings.
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

/// Important numbers, shown large with small labels.
struct KeyNumbers {
  std::vector<KeyValue> entries = {};
};

struct TableColumn {
  std::string header = {};
  bool numeric = false;  ///< right-aligned
};

struct Table {
  std::string id = {};
  std::string title = {};
  std::string caption = {};  ///< below a table with a title, else above it
  std::vector<TableColumn> columns = {};
  std::vector<std::vector<std::string>> rows = {};
  std::optional<int> highlighted_row = {};  ///< e.g. the best code
};

/// Preformatted text.
struct CodeBlock {
  std::string text = {};
};

using Block = std::variant<Paragraph, KeyValueList, KeyNumbers, Table, CodeBlock, Figure>;

/// Layout of a section. folded: initially hidden; front: blocks side by side, for the first screen.
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
  std::string footer = {};
};

/// Returns the page as JSON: {title, subtitle, footer, sections: [{title, layout, blocks}]}, see
/// docs/report_pages.md. Equal pages give equal bytes.
/// @throws std::invalid_argument if an id is repeated, or a table row does not fit its columns
std::string page_document(const Page& page);

/// Returns the page as a self-contained HTML file: page_document() and the viewer. Scripts can use
/// `window.tofsmithFigures` = {total, rendered, errors} and `window.tofsmithRenderAll()`, a promise
/// that resolves when every figure is drawn.
/// @throws std::invalid_argument as page_document()
std::string render(const Page& page);

}  // namespace tofsmith
