// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0

// Assimp's readers drop what they have allocated when a file turns out to be damaged. The leak
// sanitizer asks this function, if it is there at all, what not to report.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }
