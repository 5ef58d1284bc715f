// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/resources.hpp"

// Defined by the assembler file that cmake/TofsmithPlotly.cmake writes.
extern "C" {
extern const char tofsmith_resource_plotly_js[];
extern const char tofsmith_resource_plotly_js_end[];
extern const char tofsmith_resource_plotly_licences[];
extern const char tofsmith_resource_plotly_licences_end[];
extern const char tofsmith_resource_page_css[];
extern const char tofsmith_resource_page_css_end[];
extern const char tofsmith_resource_page_js[];
extern const char tofsmith_resource_page_js_end[];
}

namespace tofsmith::resources {
namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view plotly_js() {
  return between(tofsmith_resource_plotly_js, tofsmith_resource_plotly_js_end);
}

std::string_view plotly_licences() {
  return between(tofsmith_resource_plotly_licences, tofsmith_resource_plotly_licences_end);
}

std::string_view page_css() {
  return between(tofsmith_resource_page_css, tofsmith_resource_page_css_end);
}

std::string_view page_js() {
  return between(tofsmith_resource_page_js, tofsmith_resource_page_js_end);
}

}  // namespace tofsmith::resources
