# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the lab page in a headless Chromium for its tests."""

import contextlib
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "report" / "browser"))
import browser_test  # noqa: E402  exits with 77 if Selenium is missing
from native_engine import page_with_engine  # noqa: E402

HELPERS = """
window.waitFor = async (test, seconds = 20) => {
  for (const end = performance.now() + 1000 * seconds; performance.now() < end;) {
    const found = await test();
    if (found) return found;
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  throw new Error('still not: ' + test);
};
// Nothing computes any more, and has not for longer than commands wait.
window.settled = async () => {
  let since = performance.now();
  await waitFor(() => {
    if (!window.tofsmithLab?.engine.isIdle) since = performance.now();
    return window.tofsmithLab && performance.now() - since > 130;
  });
};
window.enter = (node, value) => {
  node.focus();
  node.value = value;
  node.dispatchEvent(new Event('input', {bubbles: true}));
  node.dispatchEvent(new Event('change', {bubbles: true}));
};
window.byId = (id) => document.getElementById(id);
window.dropped = (...files) => {
  const data = new DataTransfer();
  for (const file of files) data.items.add(file);
  dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));
};
"""


class LabTest(unittest.TestCase):
    """Tests in one Chromium per window size; each starts with a fresh page and ends without errors.
    """

    page = None
    width, height, dark = 1200, 900, False
    drivers = {}

    @classmethod
    def setUpClass(cls):
        window = (cls.width, cls.height, cls.dark)
        if window not in cls.drivers:
            context = browser_test.browser(*window)
            cls.drivers[window] = context.__enter__()
            unittest.addModuleCleanup(context.__exit__, None, None, None)
        cls.driver = cls.drivers[window]
        cls.driver.set_script_timeout(120)

    def setUp(self):
        self.open()

    def tearDown(self):
        log = [e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE"]
        self.assertEqual(log, [])
        loads = self.driver.execute_script(
            "return performance.getEntriesByType('resource').map((entry) => entry.name)")
        self.assertEqual([n for n in loads if not n.startswith(("data:", "blob:"))], [])

    def open(self, fragment="", settle=True):
        """Opens a fresh page and waits until it has finished computing."""
        self.driver.get("about:blank")
        self.driver.get(self.page.resolve().as_uri() + fragment)
        self.driver.execute_script(HELPERS)
        if settle:
            self.run_script("await settled();")

    def run_script(self, body, *arguments):
        """Returns the result of an asynchronous function body; an exception in it fails the test.
        """
        reply = self.driver.execute_async_script(
            "const given = Array.from(arguments), done = given.pop();"
            "(async (...args) => {" + body + "})(...given)"
            ".then((value) => done({value}), (error) => done({error: String(error?.stack ?? error)}));",
            *arguments)
        if "error" in reply:
            self.fail(reply["error"])
        return reply.get("value")

    def state(self):
        return self.driver.execute_script("return tofsmithLab.store.state")

    def text(self, selector):
        return self.driver.execute_script(
            "return document.querySelector(arguments[0])?.textContent", selector)

    def wait(self, script):
        self.run_script(f"await waitFor(() => {script});")


def run_tests(page_or_engine):
    """Runs the tests of the main module on a page, or on the engine as a program. Exit 77: skipped."""
    if not all(Path(p).exists() for p in (browser_test.CHROMIUM, browser_test.CHROMEDRIVER)):
        print(f"skipped: {browser_test.CHROMIUM} or its driver is missing")
        sys.exit(77)
    if not page_or_engine.is_file():
        print(f"skipped: {page_or_engine} is not built")
        sys.exit(77)
    is_page = page_or_engine.suffix == ".html"
    with contextlib.nullcontext(page_or_engine) if is_page else page_with_engine(page_or_engine) as page:
        LabTest.page = page
        unittest.main()
