"""Chromium for tests of the review page: Debian's own, with WebGL in software."""

import os
import shutil
from pathlib import Path

import pytest

ARGUMENTS = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking")
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
             row => [Number(row.dataset.rotation), row.cells[1].textContent, row.dataset.certified])"""
    )
    found = {}
    for rotation, text, _ in rows:
        parts = [] if text == "none" else [tuple(map(float, part.split(" to "))) for part in text.split("; ")]
        found[rotation] = parts
    return found, {certified for _, _, certified in rows}
