"""The gallery shows what was planned: its headlines, pictures and review pages belong together, and its commands can be typed."""

import json
import re
import shlex

import click
import pytest
from PIL import Image

from docs import gallery
from docs.hooks import review_pages
from plan_cutters.command.entry import module_of
from tests.support import browser
from tests.support.forked import run
from tests.support.places import ROOT

DOCS = ROOT / "docs"
GALLERY = DOCS / "gallery"


COMMAND = module_of("plan-cutters").command
PARTS = gallery.table()["part"]
NAMES = [part["name"] for part in PARTS]
each_part = pytest.mark.parametrize("part", PARTS, ids=NAMES)


def headline(name):
    return json.loads((GALLERY / f"{name}.json").read_text("utf-8"))["headline"]


def test_the_page_is_made_of_the_table_and_the_plans():
    assert (DOCS / "gallery.md").read_text("utf-8") == gallery.text()
    assert len(set(NAMES)) == len(PARTS) == 12


def test_nothing_is_left_of_a_part_that_is_gone():
    stored = {path.stem for path in GALLERY.iterdir() if path.suffix in (".webp", ".json")}
    assert stored == set(NAMES)


@each_part
def test_a_picture_has_the_size_of_all(part):
    path = GALLERY / f"{part['name']}.webp"
    assert path.stat().st_size <= gallery.MOST
    with Image.open(path) as picture:
        assert picture.size == (gallery.WIDTH, gallery.HEIGHT)
        # White, or a part without a colour, is no picture of verdicts.
        assert len(picture.convert("RGB").quantize(64).getcolors()) > 16


@each_part
def test_a_part_has_a_licence_that_its_page_names(part):
    shown = gallery.text().partition(f"## {part['title']}\n")[2].partition("\n## ")[0]
    if "source" in part:
        assert part["licence"] in ("MIT", "BSD-3-Clause", "Apache-2.0", "public domain (NIST)")
        assert part["licence"] in shown
        assert f"{part['source']['repository']}/blob/{part['source']['commit']}/" in shown
        assert re.fullmatch("[0-9a-f]{40}", part["source"]["commit"])
    else:
        assert part["ours"] in shown
    licences = (GALLERY / "licences.txt").read_text("utf-8")
    assert ("source" in part or "licence" in part) == bool(re.search(rf"^  {part['name']} ", licences, re.MULTILINE))


@each_part
def test_a_command_can_be_typed(part):
    """Its options are those of the program, and its part is the one that is shown."""
    program, file, *words = shlex.split(part["command"])
    assert (program, file) == ("plan-cutters", part["file"])
    context = COMMAND.make_context(program, [str(ROOT / "samples/blade.step"), *_with_samples(words)])
    assert context.params["parts"]
    shown = re.findall(r"```sh\n(.*?)```", gallery.text(), re.DOTALL)
    assert shlex.split(shown[NAMES.index(part["name"])].replace("\\\n", " ")) == shlex.split(part["command"])


def _with_samples(words):
    return [str(ROOT / word) if word.startswith("samples/") else word for word in words]


def test_an_option_that_is_none_cannot_be_typed():
    with pytest.raises(click.UsageError):
        COMMAND.make_context("plan-cutters", [str(ROOT / "samples/blade.step"), "--cuter", "D6L40"])


def test_links_stand_only_where_the_page_is(tmp_path):
    text = "a <!-- review: vise --> b <!-- review: gone -->"
    config = type("Config", (), {"docs_dir": str(tmp_path / "docs")})
    assert review_pages.on_page_markdown(text, config) == "a b"
    (tmp_path / "build" / "gallery").mkdir(parents=True)
    (tmp_path / "build" / "gallery" / "vise.html").write_text("<h1>a page</h1>")
    assert review_pages.on_page_markdown(text, config) == "a [Review page](gallery/vise.html) b"


@pytest.mark.slow("plans the gallery again and opens a browser")
@pytest.mark.parametrize("name", ["vise", "blade"])
def test_a_sample_is_planned_with_its_headline_and_its_page_opens_without_the_network(tmp_path, name):
    from playwright.sync_api import sync_playwright

    (part,) = (part for part in PARTS if part["name"] == name)
    _, file, *words = shlex.split(part["command"])
    done = run(ROOT / file, *_with_samples(words), "--formats", "json,html", "-o", tmp_path / "out")
    assert done.returncode == json.loads((GALLERY / f"{name}.json").read_text("utf-8"))["exit_code"]
    assert json.loads((tmp_path / "out" / "plan.json").read_text("utf-8"))["text"]["headline"] == headline(name)
    with sync_playwright() as driver:
        context = browser.launch(driver).new_context(offline=True)
        asked = []
        context.on("request", lambda request: asked.append(request.url))
        tab = browser.opened(context, tmp_path / "out" / "review.html")
        assert tab.inner_text("h1").strip() == headline(name)
        assert [url for url in asked if not url.startswith(("file:", "blob:", "data:"))] == []
        assert [line for line in tab.said if line.startswith("error")] == []
