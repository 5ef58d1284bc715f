#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Saves a screenshot of the lab page, like docs/images/lab.png.

    lab_picture.py PAGE -o PICTURE.png [--width 1280] [--height 1000] [--dark] [--section error]
"""

import argparse
import base64
from pathlib import Path

from lab_browser import HELPERS, browser_test


def main():
    """Opens the page, waits until it has finished computing, and saves a screenshot."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--width", type=int, default=1280, help="of the window, in pixels")
    parser.add_argument("--height", type=int, default=1000)
    parser.add_argument("--dark", action="store_true")
    parser.add_argument("--section", default="codes", help="what stands at the top: waveforms, error, scene ..")
    arguments = parser.parse_args()
    with browser_test.browser(arguments.width, arguments.height, arguments.dark) as driver:
        driver.get(arguments.page.resolve().as_uri())
        driver.execute_script(HELPERS)
        driver.execute_async_script(
            "const [section, done] = arguments;"
            "settled().then(() => { document.documentElement.style.scrollBehavior = 'auto';"
            "if (section !== 'codes') document.getElementById(section).scrollIntoView();"
            "requestAnimationFrame(() => requestAnimationFrame(done)); });", arguments.section)
        shot = driver.execute_cdp_cmd("Page.captureScreenshot", {})
        arguments.output.write_bytes(base64.b64decode(shot["data"]))


if __name__ == "__main__":
    main()
