"""Chromium for tests of the review page: Debian's own, with WebGL in software."""

import os
import shutil
from pathlib import Path

import pytest

ARGUMENTS = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking")
#: Windows by name: width and height, pixels.
SCREENS = {"desk": (1366, 768), "wide": (1920, 1080), "phone": (390, 844)}
_NAMES = ("chromium", "chromium-browser", "google-chrome")


def chromium():
    """Path of the browser; skips the test where there is none."""
    found = next((path for path in map(shutil.which, _NAMES) if path), None)
    if found is None:
        pytest.skip(f"no browser is installed: none of {', '.join(_NAMES)} is on the path")
    return found


def launch(playwright, *more):
    """Start it, without its sandbox where that cannot run: for the superuser."""
    sandbox = ("--no-sandbox",) if os.geteuid() == 0 else ()
    return playwright.chromium.launch(executable_path=chromium(), args=[*ARGUMENTS, *sandbox, *more])


def opened(context, path: Path):
    """A page that is ready, with what it said on the console as `said`."""
    page = context.new_page()
    page.said = []
    page.on("console", lambda message: page.said.append(f"{message.type}: {message.text}"))
    page.on("pageerror", lambda error: page.said.append(f"error: {error}"))
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready]", timeout=60_000)
    return page


def place_of(page, row):
    """Where a sample is on the screen."""
    return page.evaluate(
        """row => { const box = review.stage.canvas.getBoundingClientRect();
             const [x, y] = review.stage.project(review.samples.point(row)); return [box.left + x, box.top + y]; }""",
        row,
    )


def seen(page, rows):
    """Those of some samples that a click on their place would choose."""
    return page.evaluate(
        """rows => rows.filter(row => { const { canvas } = review.stage, box = canvas.getBoundingClientRect();
             const [x, y] = review.stage.project(review.samples.point(row));
             return document.elementFromPoint(box.left + x, box.top + y) === canvas
               && review.picker.at(2 * x / box.width - 1, 1 - 2 * y / box.height)?.sample === row; })""",
        list(map(int, rows)),
    )


def choose(page, row):
    """Click a sample and wait for its map."""
    page.mouse.click(*place_of(page, row))
    wait_for_map(page, row)


def wait_for_map(page, row):
    page.wait_for_selector(f'#posture[data-complete="{row}"]', timeout=30_000)


def intervals(page):
    """The free intervals that are shown, degrees, by rotation."""
    rows = page.evaluate(
        """() => [...document.querySelectorAll("#intervals tbody tr")].map(
             row => [Number(row.dataset.rotation), row.cells[1].textContent])"""
    )
    found = {}
    for rotation, text in rows:
        parts = [] if text == "none" else [tuple(map(float, part.split(" to "))) for part in text.split("; ")]
        found[rotation] = parts
    return found


def touch(page, *ways, steps=12, picture="#picture"):
    """Draw fingers along straight ways [(x0, y0), (x1, y1)], pixels from the middle of the picture."""
    box = page.locator(picture).bounding_box()
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    session = page.context.new_cdp_session(page)

    def at(share):
        return [
            {"x": middle[0] + a[0] + share * (b[0] - a[0]), "y": middle[1] + a[1] + share * (b[1] - a[1]), "id": k}
            for k, (a, b) in enumerate(ways)
        ]

    session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": at(0.0)})
    for k in range(1, steps + 1):
        session.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": at(k / steps)})
        page.wait_for_timeout(16)
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    session.detach()
