// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

namespace tofsmith {

template <typename T>
struct HiddenDeleter {
  void (*destroy)(T*) = nullptr;
  void operator()(T* object) const { destroy(object); }
};

/// Owner of an object whose class is only complete in the source that creates the object. A class
/// with such members needs no destructor and no move operations in that source.
template <typename T>
using Hidden = std::unique_ptr<T, HiddenDeleter<T>>;

template <typename T, typename... Arguments>
Hidden<T> make_hidden(Arguments&&... arguments) {
  return Hidden<T>(new T(std::forward<Arguments>(arguments)...),
                   HiddenDeleter<T>{[](T* object) { delete object; }});
}

}  // namespace tofsmith
