"""How soon can one work with a review page? Its marks in headless Chromium without a graphics card.

    python benchmarks/page.py REVIEW.html [--times 5]

`interactive` is when the page answers (clicks, keys, lists), `frame` when the first picture is on the screen; both in ms since
the browser began to load the page. Clocks tell little on a busy machine: the least of several times is told, and beside it the
processor seconds of the page's process and of the one that draws.
"""

import argparse
import os
from pathlib import Path

import psutil
from playwright.sync_api import Browser, Playwright, sync_playwright

_FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"]
_MARKS = """() => new Promise(done => requestAnimationFrame(() => setTimeout(() => done({
    ...Object.fromEntries(performance.getEntriesByType("mark").map(mark => [mark.name, mark.startTime])),
    frame: performance.now() }))))"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=Path)
    parser.add_argument("--times", type=int, default=5)
    told = parser.parse_args()
    with sync_playwright() as playwright:
        runs = [_once(playwright, told.page.resolve()) for _ in range(told.times)]
    for name in runs[0]:
        values = sorted(run[name] for run in runs)
        print(f"{name:18}" + "  ".join(f"{value:8.2f}" for value in values))
    print(f"load of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")


def _once(playwright: Playwright, path: Path) -> dict[str, float]:
    """Load a page in a browser of its own: marks, ms, and processor seconds since it was told to load."""
    browser: Browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=_FLAGS)
    page = browser.new_page(viewport={"width": 1366, "height": 768}, reduced_motion="reduce")
    page.goto("about:blank")
    before = _seconds()
    page.goto(path.as_uri(), wait_until="commit")
    page.wait_for_selector("html[data-ready=yes]", timeout=120_000)
    marks: dict[str, float] = page.evaluate(_MARKS)
    after = _seconds()
    browser.close()
    return {**marks, **{f"{kind}, cpu s": after.get(kind, 0.0) - before.get(kind, 0.0) for kind in ("renderer", "gpu-process")}}


def _seconds() -> dict[str, float]:
    found: dict[str, float] = {}
    for each in psutil.Process().children(recursive=True):
        kind = next((word[7:] for word in each.cmdline() if word.startswith("--type=")), "browser")
        used = each.cpu_times()
        found[kind] = found.get(kind, 0.0) + used.user + used.system
    return found


if __name__ == "__main__":
    main()
