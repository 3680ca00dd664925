"""Make the gallery anew: `python docs/gallery.py FOLDER [NAME...]` (needs Debian's Chromium and the `dev` extra).

FOLDER has the files of the parts that are not our own; `docs/gallery/parts.toml` says where they come from. Without names all
parts are made. With `-` as FOLDER nothing is planned: pictures are taken of pages that are there, and `docs/gallery.md` is
written.

Each part is planned by its command, as a reader types it. The script writes a picture, the headline, `docs/gallery.md`, and the
review page into `build/gallery`, from where `docs/hooks/review_pages.py` takes it into the site. The README shows one of the
parts, with all that the command prints and a picture of the whole page: both are written, too.
"""

import io
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

DOCS = Path(__file__).parent
ROOT, GALLERY, PAGE = DOCS.parent, DOCS / "gallery", DOCS / "gallery.md"
PAGES = ROOT / "build" / "gallery"
#: The part that the README shows, and the picture of its page there.
FRONT, FRONT_PICTURE = "impeller", DOCS / "pictures" / "process.png"
#: Dots of a picture; a file has at most so many bytes.
WIDTH, HEIGHT, MOST = 720, 540, 60_000
#: Without these WebGL shows nothing where there is no graphics card.
_CHROMIUM = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"]
#: Only the picture is shown, on the whole window, by verdicts: no controls, no legend.
_ALONE = """view => {
    const { stage } = review, { canvas, table } = stage;
    review.setMode("verdict");
    for (let at = canvas; at !== document.body; at = at.parentElement) {
        for (const other of at.parentElement.children) if (other !== at) other.style.display = "none";
        at.style.cssText += "position:fixed;inset:0;width:100vw;height:100vh;max-width:none;max-height:none";
        at.style.cssText += "margin:0;border:0;border-radius:0";
    }
    window.dispatchEvent(new Event("resize"));
    if (view) table.show(...view);
}"""


def table() -> dict[str, Any]:
    """The table of parts: `intro`, and `part` with a row for each."""
    return tomllib.loads((GALLERY / "parts.toml").read_text("utf-8"))


def main(folder: Path | None, names: list[str]) -> None:
    made = [row for row in table()["part"] if not names or row["name"] in names]
    with tempfile.TemporaryDirectory() as place:
        work = Path(place)
        if folder:
            (work / "samples").symlink_to(ROOT / "samples")
            subprocess.run([sys.executable, DOCS / "gallery_parts.py", work], check=True, stdout=subprocess.DEVNULL)
        for row in made:
            if folder and "source" in row:
                shutil.copy(folder / row["file"], work)
            if folder:
                _plan(row, work)
            (GALLERY / f"{row['name']}.webp").write_bytes(_picture(PAGES / f"{row['name']}.html", row))
    PAGE.write_text(text(), encoding="utf-8")


def _plan(row: dict[str, Any], work: Path) -> None:
    """Plan a part; write its headline and its page."""
    name = row["name"]
    program, *words = shlex.split(row["command"])
    done = subprocess.run(
        [str(Path(sys.executable).with_name(program)), *words, "-o", name, "--formats", "json,html"],
        cwd=work, text=True, capture_output=True, check=False, env={**os.environ, "PYTHONWARNINGS": "ignore"},
    )  # fmt: skip
    if done.returncode not in (0, 1, 4):
        raise SystemExit(f"{name}: exit code {done.returncode}: {done.stderr}")
    plan = json.loads((work / name / "plan.json").read_text("utf-8"))
    (GALLERY / f"{name}.json").write_text(
        json.dumps({"headline": plan["text"]["headline"], "exit_code": done.returncode}, indent=2, ensure_ascii=False) + "\n",
        encoding="utf-8",
    )
    PAGES.mkdir(parents=True, exist_ok=True)
    shutil.copy(work / name / "review.html", PAGES / f"{name}.html")
    if name == FRONT:
        readme = ROOT / "README.md"
        before, fence, rest = readme.read_text(encoding="utf-8").partition("```text\n")
        readme.write_text(f"{before}{fence}{printed(row['command'], done.stdout)}{rest[rest.index('```') :]}", encoding="utf-8")


def printed(command: str, text: str) -> str:
    """A command with what it prints, as the README shows it: without the last line, which is a path."""
    typed = " \\\n    ".join(_lines(command, 76))
    return f"$ {typed}\n{text.partition(chr(10) + 'Review page')[0].rstrip()}\n"


def _picture(page: Path, row: dict[str, Any]) -> bytes:
    """The picture of a review page, in a file that is as good as its size allows."""
    from PIL import Image
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=_CHROMIUM)
        if row["name"] == FRONT:
            tab = browser.new_page(viewport={"width": 1366, "height": 768}, color_scheme="light")
            tab.goto(page.as_uri())
            tab.wait_for_selector("html[data-ready]")
            tab.wait_for_timeout(1500)
            tab.screenshot(path=str(FRONT_PICTURE))
        # Zoomed is a piece of a larger picture: where the page zooms itself, it adds a small picture of the whole.
        zoom, x, y = row.get("zoom", (1, 0, 0))
        wide, high = round(zoom * WIDTH), round(zoom * HEIGHT)
        tab = browser.new_page(viewport={"width": wide, "height": high}, color_scheme="light")
        tab.goto(page.as_uri())
        tab.wait_for_selector("html[data-ready]")
        if "cutter" in row:
            tab.locator(f'#cutters tr[data-cutter="{row["cutter"]}"]').first.click()
        tab.evaluate(_ALONE, row.get("view"))
        tab.wait_for_timeout(1500)
        left, top = round((wide - WIDTH) * (1 + x) / 2), round((high - HEIGHT) * (1 - y) / 2)
        piece = tab.screenshot(clip={"x": left, "y": top, "width": WIDTH, "height": HEIGHT})
        shot = Image.open(io.BytesIO(piece)).convert("RGB")
        browser.close()
    for quality in range(90, 30, -10):
        file = io.BytesIO()
        shot.save(file, "WEBP", quality=quality, method=6)
        if file.tell() <= MOST:
            break
    return file.getvalue()


def text() -> str:
    """The page of the gallery, Markdown: its introduction, and the parts one after the other."""
    parts = table()
    shown = [_entry(row, json.loads((GALLERY / f"{row['name']}.json").read_text("utf-8"))) for row in parts["part"]]
    return "\n\n".join([parts["intro"].strip(), *shown]) + "\n"


def _entry(row: dict[str, Any], result: dict[str, Any]) -> str:
    name, title = row["name"], row["title"]
    command = " \\\n  ".join(_lines(row["command"]))
    return "\n\n".join(
        [
            f"## {title}",
            f"![{title}, coloured by verdict](gallery/{name}.webp){{ width=480 }}",
            f"*{_source(row)}*",
            row["learns"].strip(),
            f"The plan says: **{result['headline']}** <!-- review: {name} -->",
            f"```sh\n{command}\n```",
        ]
    )


def _lines(command: str, most: int = 90) -> list[str]:
    """A command on lines that a page can show, parted before options."""
    first, *options = command.split(" --")
    lines = [first]
    for option in options:
        if len(lines[-1]) + len(option) < most:
            lines[-1] += f" --{option}"
        else:
            lines.append(f"--{option}")
    return lines


def _source(row: dict[str, Any]) -> str:
    """Where the part comes from, and under which licence."""
    if "source" not in row:
        return f"Part: {row['ours']}, {row.get('licence', 'MIT as this project')}."
    repository, path, commit = (row["source"][key] for key in ("repository", "path", "commit"))
    address = f"https://github.com/{repository}/blob/{commit}/{path.replace(' ', '%20')}"
    return f"Part: [{row['file']}]({address}) of {repository}, {row['licence']}."


if __name__ == "__main__":
    main(None if sys.argv[1] == "-" else Path(sys.argv[1]), sys.argv[2:])
