// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Interface of the engine to the page's worker (worker.js).
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

/// The arrays of the last reply are read in place until the next call.
Reply current;

const char* name_of_numbers(const NamedArray& array) {
  constexpr const char* names[] = {"Float32Array", "Float64Array", "Int32Array", "Uint8Array"};
  return names[array.values.index()];
}

/// Adds the list of arrays, with their addresses, to the JSON of a reply.
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
  return true;  // the worker is terminated to cancel work
}

}  // namespace

}  // namespace tofsmith::lab

extern "C" {

/// @return the JSON of the reply: {answer} or {error}, and {arrays: [{name, type, pointer, length,
///   shape}]}. JSON and arrays are valid until the next call.
EMSCRIPTEN_KEEPALIVE const char* tofsmith_lab_answer(const char* request) {
  using namespace tofsmith::lab;
  constexpr const char* too_large =
      R"({"error":{"message":"this requires more memory than a web page can use"}})";
  try {
    current = {};
    current = answer(request, tell);
    list_arrays(current);
    return current.json.c_str();
  } catch (const std::exception&) {
    return too_large;  // not enough memory for an error message
  }
}
}
