// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/code/sinusoid.hpp"

namespace tofsmith {

/// One line of the list of built-in families.
struct FamilyDescription {
  std::string name;         ///< pattern, such as "hamiltonian-k3..k10"
  std::string example;      ///< a name that can be built
  std::string description;  ///< one line
};

/// All built-in families.
std::vector<FamilyDescription> list_families();

/// Why no code of that name can be built with these options: no family is called so, the family has
/// no such member, or N would round its switching times. None: make_family() builds it.
std::optional<std::string> why_no_family(std::string_view name, const FamilyOptions& options);

/// Builds a family from its name: `sinusoid-k4`, `square-k4`, `hamiltonian-k3` .. `k10`,
/// `multifrequency-k5` (3 steps at f0 and 2 at 7 f0), `multifrequency-1x3-7x2` (any list of
/// frequency x steps), `pulsed-multifrequency-k5` and `-k4` (high frequency 3) or `..-q2` ..
/// `..-q8`, `gray-k3` .. `k10`, `single-ramp-k3`, `double-ramp-k3`.
/// @throws InvalidArgument with the text of why_no_family(), if there is one
CodeSet make_family(std::string_view name, const FamilyOptions& options);

/// Whether `name` is the name of a family (whatever the options).
bool is_family(std::string_view name);

}  // namespace tofsmith
