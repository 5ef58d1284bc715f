#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a report in headless Chromium and checks that it shows its content.

Every figure is drawn with non-zero size and without cut-off labels, and can be saved as SVG, PNG
and CSV. Sliders change pictures, folded sections open, the console has no errors, and nothing is loaded
from the network. Exit status: 0 passed, 1 failed, 2 wrong usage, 77 no browser.
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
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--hide-scrollbars",
]

# Returns the area of the largest picture of each figure, and its cut-off labels.
DRAWN = """
return Array.from(document.querySelectorAll('[data-figure]'), figure => {
  const box = node => node.getBoundingClientRect();
  const area = node => box(node).width * box(node).height;
  const shapes = [...figure.querySelectorAll('.plot > svg, .plot > canvas')];
  const cut = [...figure.querySelectorAll('.plot > svg text')].filter(text => {
    const inner = box(text), outer = box(text.closest('svg'));
    return inner.left < outer.left - 1 || inner.right > outer.right + 1 || inner.top < outer.top - 1
      || inner.bottom > outer.bottom + 1;
  });
  const marks = figure.querySelectorAll('.curve, circle, .cell, rect, canvas').length;
  return {id: figure.dataset.figure, area: marks && Math.max(0, ...shapes.map(area)),
          cut: cut.map(text => text.textContent)};
});
"""

# Returns titles that are not next to their row, and tables of prose that scroll.
PLACED = """
const middle = node => { const {top, bottom} = node.getBoundingClientRect(); return (top + bottom) / 2; };
const wrong = [];
for (const title of document.querySelectorAll('.row-title')) {
  const text = document.createRange();
  text.selectNodeContents(title);
  const off = middle(text) - middle(title.nextElementSibling.querySelector('svg .frame'));
  if (Math.abs(off) > 2) wrong.push(`the title '${title.textContent}' is ${off} px off its row`);
}
for (const table of document.querySelectorAll('.table:not(:has(.number))'))
  if (table.scrollHeight > table.clientHeight + 1) wrong.push(`a table scrolls: ${table.textContent.slice(0, 80)}`);
return wrong;
"""

# Moves every slider and returns the figures whose pictures do not change.
SLIDE = """
const stuck = [];
for (const input of document.querySelectorAll('.slider input')) {
  const figure = input.closest('figure.figure');
  const picture = () => [...figure.querySelectorAll('.picture canvas')].map(c => c.toDataURL()).join();
  const before = picture();
  input.value = Number(input.min) + 1;
  input.dispatchEvent(new Event('input'));
  if (picture() === before) stuck.push(figure.dataset.figure);
}
return stuck;
"""

# Presses every choice of a figure and returns the figures that do not change.
CHOOSE = """
const stuck = [];
for (const button of document.querySelectorAll('.choice [aria-pressed=false]')) {
  const figure = button.closest('figure.figure');
  const picture = () => [...figure.querySelectorAll('.picture canvas')].map(c => c.toDataURL()).join();
  const before = picture();
  button.click();
  if (picture() === before || button.getAttribute('aria-pressed') !== 'true') stuck.push(figure.dataset.figure);
}
return stuck;
"""

# Saves every figure in every format and returns the problems of the files.
SAVE = """
const done = arguments[0], wrong = [], blobs = [];
URL.createObjectURL = (blob) => { blobs.push(blob); return 'data:,'; };
HTMLAnchorElement.prototype.click = () => {};
const decoded = async (blob) => { try { await createImageBitmap(blob); return true; } catch { return false; } };
const cutTexts = (text) => {
  const place = document.createElement('div');
  place.style.cssText = 'position:absolute;left:0;top:0';
  place.innerHTML = text;
  document.body.append(place);
  const frame = place.firstElementChild.getBoundingClientRect();
  const cut = [...place.querySelectorAll(':scope > svg > text')].filter(
      node => node.getBoundingClientRect().right > frame.right + 4).map(node => node.textContent);
  place.remove();
  return cut;
};
(async () => {
  for (const figure of document.querySelectorAll('[data-figure]')) {
    for (const button of figure.querySelectorAll('.save button')) {
      blobs.length = 0;
      button.click();
      for (let i = 0; i < 100 && !blobs.length; ++i) await new Promise(r => setTimeout(r, 20));
      const [blob] = blobs, name = `${figure.dataset.figure}.${button.textContent}`;
      if (!blob || blob.size < 40) { wrong.push(`${name} is empty`); continue; }
      if (button.textContent === 'PNG' && !await decoded(blob)) wrong.push(`${name} is no picture`);
      const text = button.textContent === 'PNG' ? '' : await blob.text();
      if (button.textContent === 'SVG' &&
          new DOMParser().parseFromString(text, 'image/svg+xml').querySelector('parsererror'))
        wrong.push(`${name} is no XML`);
      if (button.textContent === 'SVG') wrong.push(...cutTexts(text).map((cut) => `${name} cuts '${cut}'`));
      if (button.textContent === 'CSV' && text.split('\\n').length < 3) wrong.push(`${name} has no rows`);
    }
    if (figure.querySelectorAll('.save button').length !== 3) wrong.push(`${figure.dataset.figure} lacks buttons`);
  }
})().then(() => done(wrong), error => done([String(error)]));
"""


@contextlib.contextmanager
def browser(width, height, dark):
    """A headless Chromium with a temporary profile."""
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


def first_screen_problems(driver, page, height):
    """Returns messages if the first screen of a report does not fit into the window."""
    driver.get(page.resolve().as_uri())
    time.sleep(1)
    bottom = driver.execute_script(
        "return document.querySelector('.front').getBoundingClientRect().bottom")
    return [f"the first screen ends at {bottom} of {height} px"] if bottom > height else []


def problems_of(driver, page):
    """Returns messages about the problems of the page."""
    driver.get(page.resolve().as_uri())
    driver.execute_async_script(
        "const done = arguments[0]; window.tofsmithRenderAll().then(() => done(), () => done());"
    )
    time.sleep(1)  # figures draw in the next frame
    stuck = driver.execute_script(SLIDE)
    chosen = driver.execute_script(CHOOSE)
    wrong = driver.execute_async_script(SAVE)
    status = driver.execute_script("return window.tofsmithFigures")
    problems = [f"script error: {error}" for error in status["errors"]]
    problems += [f"the slider of figure {figure} moves nothing" for figure in stuck]
    problems += [f"a choice of figure {figure} changes nothing" for figure in chosen]
    problems += wrong
    problems += driver.execute_script(PLACED)
    if driver.execute_script("return document.querySelectorAll('details.section:not([open])').length"):
        problems.append("a section is still folded")
    if status["rendered"] != status["total"]:
        problems.append(f"{status['rendered']} of {status['total']} figures were rendered")
    for figure in driver.execute_script(DRAWN):
        if figure["area"] < 100:
            problems.append(f"figure {figure['id']} has drawn nothing")
        for label in figure["cut"]:
            problems.append(f"figure {figure['id']}: the label '{label}' is cut off")
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
    """Saves the whole page, from top to bottom."""
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
    parser.add_argument("--one-screen", action="store_true",
                        help="the first screen of the report fits in the window")
    parser.add_argument("--max-bytes", type=int, help="largest size of the page")
    arguments = parser.parse_args()
    for program in (CHROMIUM, CHROMEDRIVER):
        if not pathlib.Path(program).exists():
            print(f"skipped: {program} is missing")
            return 77
    if not arguments.page.is_file():
        parser.error(f"{arguments.page} is not a file")
    with browser(arguments.width, arguments.height, arguments.dark) as driver:
        hidden = first_screen_problems(driver, arguments.page, arguments.height) if arguments.one_screen else []
        total, problems = problems_of(driver, arguments.page)
        problems += hidden
        if arguments.screenshot:
            save_screenshot(driver, arguments.screenshot)
    size = arguments.page.stat().st_size
    if arguments.max_bytes and size > arguments.max_bytes:
        problems.append(f"{size} bytes; expected at most {arguments.max_bytes}")
    for problem in problems:
        print(f"{arguments.page}: {problem}")
    print(f"{arguments.page}: {total} figures, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
