// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/storage_xml.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr std::string_view spaces = " \t\r\n";

struct Content {
  std::string yaml;
  int words = 0, elements = 0;
  bool is_list = true;  ///< all elements are named `_`

  void add_lines(std::string_view text) {
    yaml.append(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), '\n');
  }

  void add_words(std::string_view text) {
    while (!text.empty()) {
      const std::size_t start = std::min(text.find_first_not_of(spaces), text.size());
      add_lines(text.substr(0, start));
      text.remove_prefix(start);
      const std::string_view word = text.substr(0, text.find_first_of(spaces));
      text.remove_prefix(word.size());
      if (word.empty()) continue;
      yaml += fmt::format("{}{}", words++ > 0 ? "," : "", quoted(word));
    }
  }

  void add_element(std::string_view name, const Content& content) {
    if (elements++ > 0) yaml += ",";
    if (name != "_") yaml += quoted(name) + ": ";
    is_list = is_list && name == "_";
    yaml += content.value();
  }

  std::string value() const {
    if (elements > 0) return is_list ? "[" + yaml + "]" : "{" + yaml + "}";
    return words == 1 ? yaml : "[" + yaml + "]";
  }

  static std::string quoted(std::string_view word) {
    std::string text(word);
    std::erase_if(text, [](char c) { return c == '"' || c == '\\'; });
    return '"' + text + '"';
  }
};

class StorageXml {
 public:
  StorageXml(std::string_view text, std::string_view name) : text_(text), name_(name) {}

  /// Reads up to the end of the element, or of the document if the name is empty.
  Content content(std::string_view name, int depth) {
    constexpr int max_depth = 64;
    if (depth > max_depth) fail(fmt::format("expected at most {} nested elements", max_depth));
    Content content;
    while (at_ < text_.size()) {
      const std::string_view words = text_.substr(at_, text_.find('<', at_) - at_);
      content.add_words(words);
      at_ += words.size();
      if (text_.substr(at_).starts_with("<!--")) {
        content.add_lines(until("-->"));
      } else if (at_ < text_.size()) {
        const std::string_view tag = until(">");
        content.add_lines(tag);
        if (tag.starts_with("/")) return check_end(tag, name), content;
        if (!tag.starts_with("?") && !tag.starts_with("!")) add_element(tag, depth, content);
      }
    }
    if (!name.empty()) fail(fmt::format("found the end of the file; expected </{}>", name));
    return content;
  }

 private:
  /// Returns the text before the next `end`, which is skipped.
  std::string_view until(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string_view::npos) fail(fmt::format("found <; expected {} after it", end));
    const std::string_view text = text_.substr(at_ + 1, found - at_ - 1);
    at_ = found + end.size();
    return text;
  }

  void add_element(std::string_view tag, int depth, Content& parent) {
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    if (name.empty()) fail("expected the name of an element after <");
    parent.add_element(name, tag.ends_with("/") ? Content() : content(name, depth + 1));
  }

  void check_end(std::string_view tag, std::string_view name) const {
    const std::string_view ended = tag.substr(1, tag.find_last_not_of(spaces));
    if (name.empty() || ended != name)
      fail(fmt::format("found </{}>; expected {}", ended,
                       name.empty() ? "no end of an element" : fmt::format("</{}>", name)));
  }

  [[noreturn]] void fail(const std::string& problem) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(at_), '\n');
    throw IoError(fmt::format("{}:{}", name_, line), "is not valid XML: " + problem);
  }

  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
};

}  // namespace

std::string yaml_of_storage_xml(std::string_view text, std::string_view name) {
  return "{" + StorageXml(text, name).content("", 0).yaml + "}";
}

}  // namespace tofsmith
