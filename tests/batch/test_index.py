"""The index of many parts: its rows, its tables, its summary, and its page in a browser."""

import csv
import hashlib
import io
import json
import math
import re
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from plan_cutters import plan
from plan_cutters.plan_file.model import CutterEntry
from plan_cutters.plan_file.shares import reached_share
from plan_cutters_batch import summary as table
from plan_cutters_batch.row import OUTCOMES, PartRow, code_of, outcome, row_of
from plan_cutters_batch.summary import NAMED, Summary, schema_text, write_index
from tests.support.browser import opened
from tests.support.places import ROOT

HOSTILE = "</script><script>document.title='gone'</script>\"'&\n\x1b[2J\u202e部品\udcff"
AXE = ROOT / "page" / "node_modules" / "axe-core" / "axe.min.js"
PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010806000000" + "1f15c4890000000d49444154789c6360f8cfc0000003010100"
    "c9fe92ef0000000049454e44ae426082"
)


def part(name="blade", status="planned", code=0, **more):
    return PartRow(name=name, file=f"{name}.step", status=status, code=code, **more)


ROWS = [
    part(verdict="Take flat end D12 x 60", cutter="flat end D12 x 60", share=1.0, seconds=3.0, folder="blade",
         page="blade/review.html", picture="blade/review.png"),
    part("rim 10", code=1, verdict="No cutter finishes rim 10.step", cutter="R6", share=0.25, reason="holder", seconds=61.0),
    part("rim 9", code=1, verdict="No cutter finishes rim 9.step", cutter="R6", share=0.99999, reason="neck", seconds=20.0),
    part("arm", "kept", 4, verdict="Take R6", cutter="R6", share=1.0, seconds=4000.0, error="not written: review.png: full disk"),
    part(HOSTILE, "failed", 3, error=f"<img src=x onerror=\"document.title='gone'\">{HOSTILE}", page="javascript:alert(1)",
         picture="../../secret.png", seconds=math.nan),
    part("lost", "failed", 0),
]  # fmt: skip


def written(rows=ROWS, **facts):
    files = {}
    write_index(rows, files.__setitem__, title="Week <47>", seconds=90.0, cluster=facts)
    return files


@pytest.fixture(scope="module")
def files():
    return written(workers=2, scheduler="tcp://127.0.0.1:8786", odd=object, nan=math.nan)


# The row of a plan


@pytest.fixture(scope="module")
def judged():
    return plan("samples/v_groove.step", cutters=["R12L60", "R3L8"], grid=9, area_budget=0, holder="R15L30")


def test_the_row_says_what_the_samples_say(judged):
    row = row_of(judged.plan, name="groove", file="a/groove.step", code=1, folder="groove", seconds=2.5)
    entry = min(judged.plan.cutters, key=lambda c: c.not_reached)
    reach, area = judged.reaches[entry.id], judged.samples.area
    reached = np.isin(reach.verdict, (1, 2))
    assert row.share == pytest.approx(area[reached].sum() / area.sum(), rel=1e-6)
    if reached.all():
        assert (row.share, row.reason) == (1.0, None)
    else:
        lost = {code: area[~reached & (reach.reason == k)].sum() for k, code in enumerate(judged.plan.reasons)}
        assert row.reason == max(lost, key=lost.get)
    assert (row.name, row.file, row.code, row.seconds) == ("groove", "a/groove.step", 1, 2.5)
    assert (row.cutters, row.samples, row.faces) == (2, len(judged.samples), 3)


def test_the_row_links_to_what_was_written_alone(judged):
    files = {"html": {"name": "review.html", "sha256": "", "size_bytes": 1}}
    document = type(judged.plan).model_validate({**judged.plan.model_dump(), "files": files})
    row = row_of(document, name="groove", file="groove.step", code=0, folder="a/groove")
    assert (row.page, row.picture) == ("a/groove/review.html", None)
    assert row.seconds == judged.plan.run.total
    assert row_of(document, name="groove", file="groove.step", code=0).page is None


def entry(share, **counts):
    known = {"id": "R6L80", "name": "R6L80", "group": "flat", "radius": 6.0, "corner_radius": 0.0, "length": 80.0,
             "feasible": None, "march_differs": 0, "by_reason": {}, "undecided_by_reason": {},
             "faces": {}, "witnesses": []}  # fmt: skip
    return CutterEntry.model_validate({**known, **counts, "area_share": share})


@pytest.mark.parametrize(
    ("share", "counts", "expected"),
    [
        ({"accessible": 0.7, "interference_free": 0.3 - 1e-16}, {"accessible": 7, "interference_free": 3}, 1.0),
        # Samples that stand for no area, and sums that are rounded: neither is all, nor nothing.
        ({"accessible": 1.0}, {"accessible": 9, "inaccessible": 1}, math.nextafter(1.0, 0.0)),
        ({"inaccessible": 1.0}, {"accessible": 1, "inaccessible": 9}, math.ulp(0.0)),
        ({"inaccessible": 1.0}, {"inaccessible": 9}, 0.0),
        ({"accessible": 1.0}, {"accessible": 9, "undecided": 1}, math.nextafter(1.0, 0.0)),
        ({"accessible": 1.0}, {"accessible": 9, "unjudged": 1}, math.nextafter(1.0, 0.0)),
        # Inside other bodies there is no surface of the finished part.
        ({"accessible": 1.0}, {"accessible": 9, "inaccessible": 1, "inside_bodies": 1}, 1.0),
        ({}, {}, None),
        ({"accessible": math.nan}, {"accessible": 1}, None),
    ],
)
def test_only_all_is_one(share, counts, expected):
    found = entry(share, **counts)
    assert reached_share(found, found.area_share) == expected


# Summary

rows_of_all_kinds = st.builds(
    PartRow,
    name=st.text(max_size=20),
    file=st.text(max_size=20),
    status=st.sampled_from(["planned", "kept", "failed"]),
    code=st.integers(-9, 200),
    verdict=st.text(max_size=20),
    cutter=st.none() | st.text(max_size=5),
    share=st.none() | st.floats(),
    reason=st.none() | st.sampled_from(["holder", "neck", "unheard_of"]),
    samples=st.none() | st.integers(0, 10**9),
    seconds=st.floats(-1e9, 1e9) | st.sampled_from([math.nan, math.inf, -math.inf]),
    page=st.none() | st.text(st.characters(), max_size=20),
    error=st.none() | st.text(max_size=20),
)


@given(st.lists(rows_of_all_kinds, max_size=4))
@example([PartRow(name="a", file="a", status="planned", code=0, page="\udcff-plan/review.html")])
@settings(max_examples=25, deadline=None)
def test_no_row_is_lost_and_no_failure_is_silent(rows):
    found = written(rows)
    summary = Summary.model_validate_json(found["summary.json"])
    assert summary.parts.count == len(rows) == sum(getattr(summary.parts, word) for word in OUTCOMES)
    assert summary.code == max([code_of(row) for row in rows], default=0)
    failed = [row for row in rows if outcome(row) == "failed"]
    assert len(summary.failures) == len(failed) == summary.parts.failed
    assert all(each.error for each in summary.failures)
    assert not failed or summary.code > 1
    assert sum(each.finished + each.failed + each.not_sure + each.not_finished for each in summary.by_cutter) == sum(
        row.cutter is not None for row in rows
    )
    page = found["index.html"].decode()
    assert [page.count(f'<tr role="row" data-is="{word}"') for word in OUTCOMES] == [getattr(summary.parts, w) for w in OUTCOMES]
    cells = list(csv.reader(io.StringIO(found["index.csv"].decode(), newline=""), strict=True))
    assert len(cells) == 1 + len(rows)
    assert {len(line) for line in cells} == {len(table.COLUMNS)}


def test_the_summary_keeps_to_its_schema(files):
    stored = (ROOT / "plugin/plan_cutters_batch/summary.schema.json").read_text()
    assert stored == schema_text()
    summary = json.loads(files["summary.json"], parse_constant=pytest.fail)
    jsonschema.Draft202012Validator(json.loads(stored)).validate(summary)
    assert (summary["format"], summary["format_version"], summary["code"]) == ("plan-cutters-batch", 1, 4)
    assert summary["parts"] == {"failed": 2, "not_finished": 2, "not_sure": 1, "finished": 1, "count": 6, "planned": 3,
                                "kept": 1}  # fmt: skip
    assert summary["by_cutter"][0] == {"cutter": "R6", "failed": 0, "not_finished": 2, "not_sure": 1, "finished": 0}
    assert summary["by_reason"] == [{"reason": "holder", "parts": 1}, {"reason": "neck", "parts": 1}]
    assert summary["failures"][1] == {
        "name": "lost",
        "file": "lost.step",
        "code": 3,
        "error": "no cause was reported (exit code 0)",
    }
    assert summary["run"]["cluster"] == {"workers": 2, "scheduler": "tcp://127.0.0.1:8786", "odd": str(object), "nan": None}
    assert summary["run"]["seconds_of_parts"] == pytest.approx(84.0)
    assert "plan_cutters" in summary["versions"]


def test_of_many_failures_the_summary_names_the_first():
    found = json.loads(written([part(f"p{k:04}", "failed", 3) for k in range(NAMED + 5)])["summary.json"])
    assert (len(found["failures"]), found["parts"]["failed"]) == (NAMED, NAMED + 5)


def test_tables_come_before_the_summary_that_has_their_checksums(files):
    assert list(files) == ["index.csv", "index.html", "summary.json"]
    for name, entry in json.loads(files["summary.json"])["files"].items():
        assert entry == {"name": f"index.{name}", "sha256": hashlib.sha256(files[f"index.{name}"]).hexdigest()}


def test_a_write_that_fails_leaves_the_summary_unwritten():
    seen = []

    def put(name, data):
        seen.append(name)
        if name == "index.html":
            raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space"):
        write_index(ROWS, put, title="", seconds=0.0, cluster={})
    assert "summary.json" not in seen


def test_the_order_in_which_parts_came_changes_nothing():
    forth, back = written(ROWS), written(ROWS[::-1])
    assert forth["index.csv"] == back["index.csv"]
    timeless = [re.sub(rb"<time.*?</time>", b"", each["index.html"]) for each in (forth, back)]
    assert timeless[0] == timeless[1]


# Tables


def cells_of(rows):
    return list(csv.DictReader(io.StringIO(table.csv_of(rows).decode(), newline=""), strict=True))


def test_columns_are_stable():
    first = "name file outcome key status code verdict cutter share reason cutters samples faces seconds folder page picture"
    assert list(table.COLUMNS)[: len(first.split())] == first.split()
    text = table.csv_of([part()])
    assert text.startswith(b"name,file,outcome,")
    assert text.count(b"\r\n") == text.count(b"\n") == 2


@given(st.sampled_from(["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "\n=1", " =1", "＝1", "'=1", "'", "", "a=1"]) | st.text())
@settings(max_examples=100, deadline=None)
def test_no_text_is_a_formula_and_each_comes_back(text):
    (cells,) = cells_of([part(verdict=text)])
    assert not re.match(r"[=+\-@＝＋－＠\s]", cells["verdict"])
    assert cells["verdict"].removeprefix("'") == text


# The page


@pytest.fixture(scope="module")
def folder(tmp_path_factory, files):
    folder = tmp_path_factory.mktemp("index")
    for name, data in files.items():
        (folder / name).write_bytes(data)
    (folder / "blade").mkdir()
    (folder / "blade/review.png").write_bytes(PIXEL)
    return folder


@pytest.fixture
def page(browser, folder):
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    page = opened(context, folder / "index.html")
    yield page
    said = page.said
    context.close()
    assert said == []


def names(page):
    return page.evaluate("[...document.querySelectorAll('#parts tbody tr.in')].map(row => row.cells[0].textContent)")


@pytest.mark.slow("plans a folder of parts")
def test_failures_stand_on_top_with_their_cause(page):
    assert names(page)[1:] == ["lost", "rim 10", "rim 9", "arm", "blade"]
    first = page.inner_text("#parts tbody tr:first-child")
    assert "<img src=x onerror=" in first
    assert "no cause was reported" in page.inner_text("#parts tbody tr:nth-child(2)")
    assert "not written: review.png: full disk" in page.inner_text("#parts tbody tr:nth-child(5)")
    assert page.title() == "Week <47>: 6 parts"
    assert "2 failed" in page.inner_text(".counts")


def test_links_stay_in_the_folder(page, folder):
    links = page.evaluate("[...document.links].map(each => each.href)")
    assert f"{folder.as_uri()}/blade/review.html" in links
    assert all(link.startswith(f"{folder.as_uri()}/") for link in links), links
    assert "secret" not in page.content()
    # The policy of the page lets its pictures in.
    page.wait_for_function("() => document.images.length === 1 && document.images[0].naturalWidth === 1")


def test_columns_are_sorted_by_value_both_ways_and_what_is_not_known_comes_last(page):
    def sorted_by(name):
        page.get_by_role("button", name=name, exact=True).click()
        return names(page)

    assert sorted_by("Part")[-3:] == ["lost", "rim 9", "rim 10"]
    assert page.get_attribute("#parts th:first-child", "aria-sort") == "ascending"
    assert page.locator("#parts th[aria-sort]").count() == 1
    assert sorted_by("Part")[:3] == ["rim 10", "rim 9", "lost"]
    assert sorted_by("Share")[:2] == ["rim 10", "rim 9"]
    assert sorted_by("Share")[2:4] == ["rim 9", "rim 10"]
    assert "lost" in sorted_by("Share")[4:]
    assert sorted_by("Time")[:3] == ["lost", "blade", "rim 9"]
    assert sorted_by("Worst reason")[:2] == ["rim 10", "rim 9"]


def test_rows_are_filtered_by_words_and_by_verdict_with_keys_alone(page):
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert len(names(page)) == 2
    assert page.get_attribute("[data-only=failed]", "aria-pressed") == "true"
    assert page.inner_text("#status") == "2 of 6 parts are shown."
    page.keyboard.press("Space")
    assert len(names(page)) == 6
    page.focus("#filter")
    page.keyboard.type("RIM neck")
    assert names(page) == ["rim 9"]
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert names(page) == ["rim 9"]
    page.fill("#filter", "no such part")
    assert page.inner_text("#status") == "0 of 6 parts are shown."


@pytest.mark.slow("runs a batch", but=("390-light",))
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1366, 390])
def test_axe_finds_nothing_in_the_index(browser, folder, width, scheme):
    if not AXE.exists():
        pytest.skip("axe-core is not installed: npm ci in page/")
    context = browser.new_context(viewport={"width": width, "height": 768}, color_scheme=scheme)
    page = opened(context, folder / "index.html")
    page.evaluate(AXE.read_text())
    found = page.evaluate("axe.run().then(result => result.violations)")
    assert [(each["id"], each["nodes"][0]["html"][:120]) for each in found] == []
    assert page.evaluate("document.documentElement.scrollWidth") == width
    # A table it stays for those who hear it, cards or not.
    assert page.get_by_role("row").count() >= 7
    assert page.get_by_role("rowheader").count() >= 6
    dark = page.evaluate("getComputedStyle(document.documentElement).backgroundColor")
    assert (sum(map(int, re.findall(r"\d+", dark)[:3])) < 200) == (scheme == "dark")
    context.close()


def test_without_scripts_every_row_is_there(browser, folder):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto((folder / "index.html").as_uri())
    assert "no cause was reported" in page.inner_text("#parts")
    assert page.locator("#parts tbody tr:visible").count() == 6
    context.close()


@pytest.mark.slow("opens a browser")
def test_ten_thousand_rows_open_at_once(browser, tmp_path):
    rows = [ROWS[k % 5].model_copy(update={"name": f"part {k}"}) for k in range(10_000)]
    (tmp_path / "index.html").write_bytes(written(rows)["index.html"])
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    page = opened(context, tmp_path / "index.html")
    metrics = context.new_cdp_session(page)
    metrics.send("Performance.enable", {"timeDomain": "timeTicks"})
    used = {each["name"]: each["value"] for each in metrics.send("Performance.getMetrics")["metrics"]}
    # Of the processor: the clock belongs to all who test at the same time.
    assert used["ProcessTime"] < 2.0
    assert len(names(page)) == 200
    page.click("#more")
    assert len(names(page)) == 400
    assert page.evaluate("document.activeElement === document.querySelectorAll('#parts tbody tr.in')[200]")
    page.fill("#filter", "part 9999")
    assert names(page) == ["part 9999"]
    context.close()


def test_the_crop_is_the_view_of_the_sheet():
    """The index shows one view of `review.png`: where it stands is told by the drawing office."""
    from plan_cutters.report.drawing import part as sheet

    style = (Path(table.__file__).parent / "index.css").read_text()
    wide, high = map(float, re.search(r"\n\.picture {[^}]*width: ([\d.]+)rem; height: ([\d.]+)rem", style).groups())
    whole, left, top = map(
        float, re.search(r"\n\.picture img {[^}]*width: ([\d.]+)rem; left: -([\d.]+)rem; top: -([\d.]+)rem", style).groups()
    )
    scale = whole / sheet._SHEET[0]
    x, y = sheet._PLACES[1]
    assert wide == pytest.approx(scale * sheet._VIEW[0], abs=0.1)
    assert high == pytest.approx(scale * sheet._VIEW[1], abs=0.1)
    assert left == pytest.approx(scale * x, abs=0.05)
    assert top == pytest.approx(scale * (sheet._SHEET[1] - y - sheet._VIEW[1]), abs=0.05)
