# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""scripts/wheel/bundle.py makes a small wheel portable, and scripts/wheel/check.py detects wheels
that are not."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts" / "wheel"))
import bundle  # noqa: E402
import check  # noqa: E402

# Prints a number, throws and catches, and calls a function of a library that wheels replace.
EXTENSION = r"""
#include <cstdio>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
extern "C" long curl_easy_init();
extern "C" const char* answer() {
  static std::string text;
  std::ostringstream out;
  out.imbue(std::locale::classic());
  try {
    throw std::runtime_error("thrown");
  } catch (const std::exception& error) {
    out << error.what() << ' ' << 3.25 << ' ' << curl_easy_init();
  }
  text = out.str();
  char copy[64];
  std::snprintf(copy, sizeof copy, "%s.", text.c_str());
  text = copy;
  return text.c_str();
}
"""
# Loads the libraries in the given order and prints their answers.
LOAD = """
import ctypes, sys
for name in sys.argv[1:]:
    library = ctypes.CDLL(name)
    library.answer.restype = ctypes.c_char_p
    print(library.answer().decode())
"""
HARDENED = ["-O2", "-fPIC", "-fstack-protector-strong", "-fcf-protection", "-D_FORTIFY_SOURCE=2",
            "-Wl,-z,relro,-z,now,-z,noexecstack"]


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.directory = pathlib.Path(temporary.name)
        cls.libraries = cls.directory / "build" / "src"
        cls.libraries.mkdir(parents=True)
        cls.curl = cls.libraries / "libcurl.so.4"
        source, script = cls.directory / "curl.c", cls.directory / "versions"
        source.write_text("long curl_easy_init(void) { return 7; }\n")
        script.write_text("CURL_OPENSSL_4 { global: *; };\n")
        cls.compile(source, cls.curl, "-shared", "-Wl,-soname,libcurl.so.4",
                    f"-Wl,--version-script={script}")
        source = cls.directory / "extension.cpp"
        source.write_text(EXTENSION)
        cls.plain = cls.directory / "plain.so"
        cls.compile(source, cls.plain, "-shared", cls.curl, f"-Wl,-rpath,{cls.libraries}")
        cls.program = cls.directory / "program"
        source.write_text(EXTENSION + "int main() { return answer() == nullptr; }\n")
        cls.compile(source, cls.program, "-pie", "-fPIE", cls.curl)
        cls.tree = cls.directory / "tree"
        package, metadata = cls.tree / "tofsmith", cls.tree / "tofsmith-0.1.0.dist-info"
        cls.extension = package / "_tofsmith.cpython-311-x86_64-linux-gnu.so"
        cls.write_tree(package, metadata)
        bundle.copy_libraries(package, [cls.libraries])
        cls.tag = bundle.tag_of(package)
        bundle.set_tag(metadata, cls.tag)

    @staticmethod
    def compile(source, output, *options):
        compiler = "g++" if source.suffix == ".cpp" else "gcc"
        subprocess.run([compiler, *HARDENED, source, "-o", output, *options], check=True)

    @classmethod
    def write_tree(cls, package, metadata):
        (package / "_prefix" / "bin").mkdir(parents=True)
        (metadata / "licenses").mkdir(parents=True)
        (metadata / "licenses" / "libstdc++6.txt").write_text("a licence\n")
        (metadata / "WHEEL").write_text("Wheel-Version: 1.0\nRoot-Is-Purelib: false\nTag: a-b-c\n")
        (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: tofsmith\nVersion: 0.1.0\n")
        (package / "__init__.py").write_text("")
        (package / "py.typed").write_text("")
        shutil.copy(cls.plain, cls.extension)
        shutil.copy(cls.program, package / "_prefix" / "bin" / "tofsmith")

    def packed(self, directory, tag):
        wheel = pathlib.Path(directory) / f"tofsmith-0.1.0-{tag}.whl"
        bundle.pack(self.tree, wheel)
        return wheel

    def problems(self, change):
        with tempfile.TemporaryDirectory() as directory:
            tree = pathlib.Path(directory) / "tree"
            shutil.copytree(self.tree, tree)
            change(tree)
            return "\n".join(check.problems_of_tree(tree, [str(self.directory)]))

    def answers(self, *files):
        environment = {k: v for k, v in os.environ.items() if k != "LD_LIBRARY_PATH"}
        return subprocess.run([sys.executable, "-c", LOAD, *map(str, files)], check=True, text=True,
                              capture_output=True, env=environment).stdout.splitlines()

    def test_works_before_and_after_other_users_of_the_cpp_library(self):
        own, other = "thrown 3.25 0.", "thrown 3.25 7."
        self.assertEqual(self.answers(self.extension, self.plain), [own, other])
        self.assertEqual(self.answers(self.plain, self.extension), [other, own])

    def test_requires_only_the_c_library_and_is_reproducible(self):
        self.assertRegex(self.tag, r"^cp311-cp311-manylinux_2_\d+_x86_64$")
        with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
            wheels = [self.packed(first, self.tag), self.packed(second, self.tag)]
            self.assertEqual(wheels[0].read_bytes(), wheels[1].read_bytes())
            self.assertEqual(list(check.problems(wheels[0], [str(self.directory)])), [])

    def test_is_rejected_if_a_library_is_missing(self):
        def remove(tree):
            next(tree.glob("tofsmith/_prefix/lib/libstdc++-*")).unlink()
        self.assertRegex(self.problems(remove), r"needs libstdc\+\+-\w+\.so\.6, which is not")

    def test_is_rejected_with_a_build_path_or_an_absolute_search_path(self):
        def restore(tree):
            shutil.copy(self.plain, tree / self.extension.relative_to(self.tree))
        problems = self.problems(restore)
        self.assertIn(f"contains the path {self.directory} of this build", problems)
        self.assertIn("expected a path relative to $ORIGIN", problems)

    def test_is_rejected_with_a_tag_of_an_older_c_library(self):
        with tempfile.TemporaryDirectory() as directory:
            wheel = self.packed(directory, "cp311-cp311-manylinux_2_31_x86_64")
            problems = "\n".join(check.problems_of_tag(wheel, (2, 34)))
        self.assertIn("claims to need GLIBC_2.31, but needs GLIBC_2.34", problems)
        self.assertIn("is accepted by pip for glibc 2.31", problems)

    def test_is_rejected_without_licences(self):
        def remove(tree):
            next(tree.glob("*.dist-info/licenses/*")).unlink()
        self.assertIn("has no licences", self.problems(remove))

    def test_is_rejected_with_unique_symbols(self):
        def restore(tree):
            copy = next(tree.glob("tofsmith/_prefix/lib/libstdc++-*"))
            shutil.copy(bundle.make_sbom.installed_libraries()["libstdc++.so.6"], copy)
        self.assertIn("has unique symbols", self.problems(restore))


unittest.main()
