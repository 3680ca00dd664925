"""Make the pictures of the tutorial anew: `python docs/pictures.py` (needs Debian's Chromium and the `dev` extra)."""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

DOCS = Path(__file__).parent
ROOT, PICTURES = DOCS.parent, DOCS / "pictures"
#: Without these WebGL shows nothing where there is no graphics card.
_CHROMIUM = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"]
_CUTTERS = ["--cutters", "samples/shop.toml", "--cutter", "D16L90", "--holder", "D40L30+D62L40"]


def run(*words: str) -> str:
    """Run one of the commands as a user does; what it found."""
    command, *rest = words
    done = subprocess.run([str(Path(sys.executable).with_name(command)), *rest], cwd=ROOT, text=True, capture_output=True,
                          check=False)  # fmt: skip
    if done.returncode > 1:
        raise SystemExit(done.stderr)
    return done.stdout


def main() -> None:
    PICTURES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        said = run(
            "plan-cutters", "samples/peaks_and_valleys.step", *_CUTTERS, "--answers", "stick-out,mend", "-o", str(out / "p")
        )
        # The last line is a path.
        text = said[: said.index("\nReview page")]
        (PICTURES / "summary.txt").write_text(text.rstrip() + "\n", encoding="utf-8")
        run("plan-cutters", "map", "samples/peaks_and_valleys.step", "--at", "-2.241,4.502,-22.43", "--cutter", "D16L90", "-o",
            str(PICTURES / "map.png"))  # fmt: skip
        run("plan-cutters", "tools", "samples/shop.toml", "--draw", str(out / "drawings"))
        shutil.copy(next((out / "drawings").glob("*flat*12*.svg")), PICTURES / "tool.svg")
        run("plan-cutters", "samples/pocket_top.step", "--cutters", "samples/shop.toml", "--machine", "trunnion-ac", "--fixture",
            "table", "--formats", "png", "-o", str(out / "sheet"))  # fmt: skip
        shutil.copy(out / "sheet" / "review.png", PICTURES / "sheet.png")
        _page(out / "p" / "review.html", PICTURES / "review.png")
        _card(out / "card.html", PICTURES / "notebook.png")


def _card(page: Path, picture: Path) -> None:
    """The card of the notebook's result, as a notebook shows it, with its page opened."""
    from plan_cutters import Cutter, plan

    ball = Cutter.ball(radius=8, length=20, flutes=16.0, shank_radius=8.0, holder="R25L40")
    result = plan(ROOT / "samples/v_groove.step", cutters=[ball, "R3L40"], spacing=6, area_budget=0)
    page.write_text(f"<!doctype html><meta charset=utf-8>{result._repr_html_()}", encoding="utf-8")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=_CHROMIUM)
        tab = browser.new_page(viewport={"width": 1000, "height": 1600})
        tab.goto(page.as_uri())
        tab.click("summary")
        tab.wait_for_timeout(5000)
        tab.screenshot(path=str(picture))
        browser.close()


def _page(page: Path, picture: Path) -> None:
    """The review page with the worst spot of the cutter that fails."""
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=_CHROMIUM)
        tab = browser.new_page(viewport={"width": 1366, "height": 768})
        tab.goto(page.as_uri())
        tab.wait_for_timeout(2000)
        tab.locator("#cutters tr[data-cutter]").filter(has_text="rear gouge").first.click()
        tab.wait_for_timeout(500)
        tab.keyboard.press("n")
        tab.wait_for_timeout(2500)
        tab.screenshot(path=str(picture))
        browser.close()


if __name__ == "__main__":
    main()
