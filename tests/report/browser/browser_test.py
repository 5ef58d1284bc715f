#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a report in headless Chromium and checks that it shows what it holds.

Every figure has drawn something of non-zero size, the console has no error, and nothing came over
the network. Exit status 0 passed, 1 failed, 2 wrong usage, 77 no browser here.
"""

import argparse
import contextlib
import pathlib
import sys
import tempfile
import time

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
except ImportError:
    print("skipped: python3-selenium is missing")
    sys.exit(77)

CHROMIUM = "/usr/bin/chromium"
CHROMEDRIVER = "/usr/bin/chromedriver"
FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--enable-unsafe-swiftshader",  # WebGL without a GPU
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--hide-scrollbars",
]

# What a figure has drawn: the area of its largest picture, and the number of pictures.
DRAWN = """
return Array.from(document.querySelectorAll('.plot'), plot => {
  const shapes = Array.from(plot.querySelectorAll(
      '.main-svg .trace, .main-svg .hm, .main-svg .bars, .gl-container canvas'));
  const areas = shapes.map(s => { const b = s.getBoundingClientRect(); return b.width * b.height; });
  return {id: plot.dataset.figure, drawings: areas.length, area: Math.max(0, ...areas),
          message: (plot.querySelector('.no-webgl') || {textContent: ''}).textContent};
});
"""


# Moves every slider and gives the figures whose picture does not follow.
SLIDE = """
const done = arguments[0], stuck = [];
(async () => {
  for (const input of document.querySelectorAll('.slider input')) {
    const plot = input.closest('figure').querySelector('.plot');
    const lines = () => plot.layout.shapes.map(shape => shape.x0).join();
    const pictures = () => plot.querySelectorAll('.hm image').length;
    const before = lines(), count = pictures();
    input.value = Number(input.min) + 1;
    input.dispatchEvent(new Event('input'));
    await new Promise(resolve => setTimeout(resolve, 1000));
    if (lines() === before || pictures() !== count || count < 2) stuck.push(plot.dataset.figure);
  }
})().then(() => done(stuck), error => done([String(error)]));
"""


@contextlib.contextmanager
def browser(width, height, dark):
    """A headless Chromium with a profile of its own."""
    with tempfile.TemporaryDirectory(prefix="tofsmith-browser-") as profile:
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        for flag in FLAGS:
            options.add_argument(flag)
        options.add_argument(f"--user-data-dir={profile}")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        driver = webdriver.Chrome(service=Service(CHROMEDRIVER), options=options)
        try:
            driver.set_script_timeout(180)
            driver.execute_cdp_cmd(
                "Emulation.setDeviceMetricsOverride",
                {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600},
            )
            scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
            driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})
            yield driver
        finally:
            driver.quit()


def problems_of(driver, page):
    """What is wrong with the page, as sentences."""
    driver.get(page.resolve().as_uri())
    driver.execute_async_script(
        "const done = arguments[0]; window.tofsmithRenderAll().then(() => done(), () => done());"
    )
    stuck = driver.execute_async_script(SLIDE)
    time.sleep(1)  # late drawing (3D, automatic margins) and its complaints
    status = driver.execute_script("return window.tofsmithFigures")
    problems = [f"script error: {error}" for error in status["errors"]]
    problems += [f"the slider of figure {figure} moves nothing" for figure in stuck]
    if status["rendered"] != status["total"]:
        problems.append(f"{status['rendered']} of {status['total']} figures were rendered")
    for figure in driver.execute_script(DRAWN):
        if figure["message"]:
            problems.append(f"figure {figure['id']}: {figure['message'].strip()}")
        elif figure["area"] < 100:
            problems.append(f"figure {figure['id']} has drawn nothing")
    width = driver.execute_script(
        "return [document.documentElement.scrollWidth, document.documentElement.clientWidth]"
    )
    if width[0] > width[1]:
        problems.append(f"the page is {width[0]} px wide in a window of {width[1]} px")
    for entry in driver.get_log("browser"):
        if entry["level"] == "SEVERE":
            problems.append(f"console: {entry['message']}")
    loads = driver.execute_script("return performance.getEntriesByType('resource').map(e => e.name)")
    problems += [f"loads {name[:100]}" for name in loads if not name.startswith(("data:", "blob:"))]
    return status["total"], problems


def save_screenshot(driver, file):
    """The whole page, from top to bottom."""
    import base64

    size = driver.execute_cdp_cmd("Page.getLayoutMetrics", {})["cssContentSize"]
    shot = driver.execute_cdp_cmd(
        "Page.captureScreenshot",
        {
            "captureBeyondViewport": True,
            "clip": {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1},
        },
    )
    file.write_bytes(base64.b64decode(shot["data"]))


def main():
    """Checks one page; see the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--screenshot", type=pathlib.Path, help="PNG of the whole page")
    parser.add_argument("--width", type=int, default=1280, help="of the window, in pixels")
    parser.add_argument("--height", type=int, default=900)
    parser.add_argument("--dark", action="store_true", help="as a reader who prefers dark pages")
    arguments = parser.parse_args()
    for program in (CHROMIUM, CHROMEDRIVER):
        if not pathlib.Path(program).exists():
            print(f"skipped: {program} is missing")
            return 77
    if not arguments.page.is_file():
        parser.error(f"{arguments.page} is not a file")
    with browser(arguments.width, arguments.height, arguments.dark) as driver:
        total, problems = problems_of(driver, arguments.page)
        if arguments.screenshot:
            save_screenshot(driver, arguments.screenshot)
    for problem in problems:
        print(f"{arguments.page}: {problem}")
    print(f"{arguments.page}: {total} figures, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
