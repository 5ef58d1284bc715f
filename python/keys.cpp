// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
//
// Prints the description of all keys of a camera, from which make_camera_fields.py makes Python
// classes.
#include <cstdio>

#include "tofsmith/io/camera_toml.hpp"

int main() { return std::puts(tofsmith::camera_keys_json().c_str()) < 0 ? 1 : 0; }
