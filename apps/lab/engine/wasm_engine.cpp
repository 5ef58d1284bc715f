// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The engine as a page's worker calls it; worker.js is the other side.
#include <emscripten.h>

#include <cstdint>
#include <exception>
#include <type_traits>

#include "answer.hpp"

// clang-format off
EM_JS(void, tofsmith_lab_progress, (double fraction, const char* text), {
  if (Module.onProgress) Module.onProgress(fraction, UTF8ToString(text));
})
// clang-format on

namespace tofsmith::lab {

namespace {

/// Of the last answer, until the next one: its arrays are read where they are.
Reply current;

const char* name_of_numbers(const NamedArray& array) {
  constexpr const char* names[] = {"Float32Array", "Float64Array", "Int32Array", "Uint8Array"};
  return names[array.values.index()];
}

/// The reply's JSON with the list of its arrays, each by its place in memory.
void list_arrays(Reply& reply) {
  if (reply.arrays.empty()) return;
  Json list = Json::array();
  for (const NamedArray& array : reply.arrays)
    std::visit(
        [&](const auto& values) {
          list.push_back({{"name", array.name},
                          {"type", name_of_numbers(array)},
                          {"pointer", reinterpret_cast<std::uintptr_t>(values.data())},
                          {"length", values.size()},
                          {"shape", array.shape}});
        },
        array.values);
  reply.json.pop_back();  // the closing brace
  reply.json += ",\"arrays\":" + list.dump() + "}";
}

bool tell(double fraction, std::string_view step) {
  tofsmith_lab_progress(fraction, std::string(step).c_str());
  return true;  // who wants no answer ends the worker
}

}  // namespace

}  // namespace tofsmith::lab

extern "C" {

/// @return the reply's JSON: {answer} or {error}, and {arrays: [{name, type, pointer, length,
///         shape}]}; valid until the next call, as the arrays are
EMSCRIPTEN_KEEPALIVE const char* tofsmith_lab_answer(const char* request) {
  using namespace tofsmith::lab;
  constexpr const char* too_large =
      R"({"error":{"message":"this needs more memory than a page has"}})";
  try {
    current = {};
    current = answer(request, tell);
    list_arrays(current);
    return current.json.c_str();
  } catch (const std::exception&) {
    return too_large;  // not even the message of an error could be written
  }
}
}
