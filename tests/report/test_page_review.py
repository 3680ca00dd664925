"""What a reviewer does with the review page: filter cutters, follow links, write notes, decide, print; in a real browser."""

import io
import json
import re
import unicodedata

import pytest

from plan_cutters import plan
from plan_cutters.plan_file.words.text import story_of
from tests.support.browser import chromium, place_of, seen
from tests.support.places import ROOT
from tests.support.review_page import Page

pytest.importorskip("playwright.sync_api", reason="playwright is not installed: setup.sh dev")

pytestmark = pytest.mark.slow("opens a browser", but=("test_a_decision_needs_a_name_and_is_kept_with_the_state_of_notes",))
#: The last two fail at the jaw.
CUTTERS = ["D4L30", "D6L40", "D8L50", "D4L30rc2", "D6L40rc3", "D8L50rc4", "D20L12", "D12L20rc6"]
#: Samples off the border of the face.
INNER = [5 * i + j for i in (1, 2, 3) for j in (1, 2, 3)]


@pytest.fixture(scope="module")
def planned():
    """A block with a sculptured top and a jaw beside it, and eight cutters of which two meet the jaw."""
    chromium()
    return plan(
        ROOT / "samples" / "pocket_top.step", cutters=CUTTERS, holder="D44L60", machine="trunnion-ac", grid=5, area_budget=0,
        fixtures=["box:15,60,40@62,-10,-10"],
    )  # fmt: skip


def status(page, words):
    page.locator("#status", has_text=words).wait_for(timeout=5000)


def rows(page):
    """Ids of the cutters whose rows are seen."""
    return page.eval_on_selector_all(
        "#cutters tr[data-cutter]", "all => all.filter(row => !row.hidden).map(row => row.dataset.cutter)"
    )


def test_a_box_filters_cutters_and_keeps_the_one_that_is_shown(at, planned):
    page = at()
    shown = page.evaluate("review.cutter.id")
    every = rows(page)
    assert len(every) == len(CUTTERS)
    page.fill("#cutters input[type=search]", "d8")
    assert {each for each in rows(page) if each != shown} == {c.id for c in planned.plan.cutters if "D8" in c.name} - {shown}
    assert shown in rows(page)
    assert page.inner_text("#cutters .tools .hint") == "2 of 8"
    page.fill("#cutters input[type=search]", "no such cutter")
    assert rows(page) == [shown]
    assert page.inner_text("#cutters .tools .hint") == "0 of 8"
    page.fill("#cutters input[type=search]", "")
    page.get_by_label("only feasible").check()
    assert set(rows(page)) == {c.id for c in planned.plan.cutters if c.feasible}
    failing = next(c.id for c in planned.plan.cutters if c.feasible is False)
    page.evaluate("id => review.setCutter(id)", failing)
    assert failing in rows(page)
    page.get_by_label("only feasible").uncheck()
    assert set(rows(page)) == set(every)


def aim(page):
    found = page.evaluate("review.stage.table.aim")
    return [found["turn"], found["rise"], found["half"], *found["target"]]


def link(page):
    """The link that the page copies, read from its clipboard."""
    page.evaluate("document.querySelector('#more').open = true")
    page.get_by_role("button", name=re.compile("Copy link")).click()
    status(page, "Copied")
    return page.evaluate("navigator.clipboard.readText()")


def test_a_link_leads_to_the_same_cutter_sample_posture_and_view(at, planned):
    small = {"viewport": {"width": 800, "height": 500}}  # is drawn in little time
    page = at(permissions=["clipboard-read", "clipboard-write"], **small)
    other = next(c.id for c in planned.plan.cutters if c.id != planned.shown)
    page.evaluate("id => review.setCutter(id)", other)
    row = seen(page, INNER)[-1]
    page.mouse.click(*place_of(page, row))
    page.wait_for_function("row => review.sample?.row === row", arg=row)
    page.evaluate("review.setPosture({tilt: 17, rotation: 40})")
    page.click("#more summary")
    page.select_option("#colouring", "scalar:curvature_max")
    page.evaluate("review.stage.table.set({turn: 33, rise: 21, half: 20})")
    address = link(page)
    assert page.evaluate("location.href") == address

    # Nothing but the part behind `#` changes: a page that is open follows, too.
    wanted = aim(page)
    page.evaluate("id => { review.setCutter(id); location.hash = 'face=F1'; }", planned.shown)
    status(page, "is shown")
    page.goto(address)
    status(page, "The link's place is shown")
    assert page.evaluate("[review.cutter.id, review.sample.row, review.mode]") == [other, row, "scalar:curvature_max"]
    assert page.evaluate("[review.posture.tilt, review.posture.rotation]") == [17, 40]
    assert aim(page) == pytest.approx(wanted, abs=0.02)
    fresh = at(**small)
    fresh.goto("about:blank")
    fresh.goto(address)
    fresh.wait_for_selector("html[data-ready]")
    status(fresh, "The link's place is shown")
    assert fresh.evaluate("[review.cutter.id, review.sample.row]") == [other, row]
    assert aim(fresh) == pytest.approx(wanted, abs=0.02)


def test_a_face_is_a_link_by_its_number(at):
    page = at()
    before = aim(page)
    page.evaluate("location.hash = 'F3'")
    status(page, "F3")
    third = aim(page)
    assert third != before
    page.evaluate("location.hash = 'face=f5'")
    status(page, "is shown")
    assert aim(page) != third


@pytest.mark.parametrize(
    ("words", "missing"),
    [
        ("cutter=R99L1", "cutter R99L1"),
        ("sample=999999", "sample 999999"),
        ("sample=-1&face=F1", "sample -1"),
        ("sample=1.5", "sample 1.5"),
        ("sample=2&face=F4", "sample 2 of F4"),
        ("sample=6&face=F1&posture=400,3", "its posture"),
        ("view=1,2,3", "its view"),
        ("view=0,0,NaN,0,0,0", "its view"),
        ("view=0,0,1e99,0,0,0", "its view"),
        ("view=0,0,10,1e30,0,0", "its view"),
        ("view=1e300,0,30,0,0,0", "its view"),
        ("face=F1&sample=", "sample "),
        ("sample=0x3", "sample 0x3"),
        ("sample=1e0", "sample 1e0"),
        ("face=F88", "F88"),
        ("=", "not understood"),
        ("F3%", "not understood"),
        ("colours=<b>", "its colours"),
        ("F77", "F77"),
    ],
)
def test_a_link_of_another_plan_is_reported_and_moves_nothing(at, words, missing):
    page = at()
    before = aim(page)
    page.evaluate("words => { location.hash = words; }", words)
    status(page, missing)
    if "sample=6" not in words:
        assert aim(page) == before
        assert page.evaluate("review.sample") is None


def saved(path):
    """A page that a browser wrote: it ends the elements that have nothing in them."""
    return Page(path.read_bytes().replace(b"></rect>", b"/>").replace(b"></path>", b"/>"))


def test_notes_are_kept_in_the_copy_that_is_saved(at, planned, path, tmp_path):
    page = at()
    text = 'Is F1 to be <b>bold</b>? </script><script>alert(1)</script> & \u2028 "so"'
    page.fill("#note", text)
    page.click("#add-note")
    row = seen(page, INNER)[0]
    page.mouse.click(*place_of(page, row))
    page.click("#note-here")
    page.keyboard.type("here")
    page.keyboard.press("Control+Enter")
    with page.expect_download() as waiting:
        page.click("#save-copy")
    assert waiting.value.suggested_filename == "review-notes.html"
    copy = tmp_path / "review-notes.html"
    waiting.value.save_as(copy)
    assert "Saved as review-notes.html" in page.inner_text("#status")

    # All but the notes is as it was.
    old, new = Page(path.read_bytes()), saved(copy)
    assert (new.meta, new.stream) == (old.meta, old.stream)
    (data,) = (text for tag, a, text in new.elements if a.get("id") == "notes-data")
    assert [each["text"] for each in json.loads(data)["notes"]] == [text, "here"]
    assert [tag for tag, a, _ in new.elements].count("script") == [tag for tag, a, _ in old.elements].count("script")
    # Without scripts they are read, too.
    assert any("F1 to be <b>bold</b>?" in item for item in new.of("li"))

    again = at(where=copy)
    assert again.eval_on_selector_all("ol.notes .said", "all => all.map(each => each.textContent)") == [text, "here"]
    again.locator("ol.notes .place").click()
    assert again.evaluate("review.sample.row") == row
    again.get_by_role("button", name="Remove note 1").click()
    with again.expect_download() as waiting:
        again.click("#save-copy")
    assert waiting.value.suggested_filename == "review-notes.html"
    waiting.value.save_as(copy)
    third = saved(copy)
    (data,) = (text for tag, a, text in third.elements if a.get("id") == "notes-data")
    assert [each["text"] for each in json.loads(data)["notes"]] == ["here"]


def test_who_leaves_with_unsaved_notes_is_asked(at):
    page = at()
    dialogs = []
    page.on("dialog", lambda dialog: (dialogs.append(dialog.type), dialog.accept()))
    page.fill("#note", "not yet saved")
    page.click("#add-note")
    page.close(run_before_unload=True)
    page.wait_for_event("close")
    assert dialogs == ["beforeunload"]


def test_a_decision_needs_a_name_and_is_kept_with_the_state_of_notes(at, path, tmp_path):
    page = at(viewport={"width": 800, "height": 500})
    assert page.locator("#decision").is_hidden()
    page.click("#approve")
    status(page, "Write your name first")
    assert page.locator("#decision").is_hidden()
    page.fill("#reviewer", "R. <i>Viewer</i>")
    page.fill("#note", "first")
    page.click("#add-note")
    page.fill("#note", "second")
    page.click("#add-note")
    page.get_by_label("Note 1 is done").check()
    page.click("#approve")
    status(page, "1 note is still open")
    words = page.inner_text("#decision")
    assert re.fullmatch(r"Approved by R\. <i>Viewer</i>, 20\d\d-\d\d-\d\d \d\d:\d\d", words)
    with page.expect_download() as waiting:
        page.click("#save-copy")
    copy = tmp_path / "review-notes.html"
    waiting.value.save_as(copy)

    # In sight without scripts and on paper, too.
    parsed = saved(copy)
    assert words in parsed.of("strong", id="decision")
    assert any("first" in item and item.endswith("; done)") for item in parsed.of("li"))
    again = at(where=copy, viewport={"width": 800, "height": 500})
    assert again.inner_text("#decision") == words
    assert again.eval_on_selector_all("ol.notes li", "all => all.map(each => each.className)") == ["done", "open"]
    again.click("#reject")
    status(again, "Write your name first")
    assert again.inner_text("#decision") == words
    again.click("#withdraw")
    assert again.locator("#decision").is_hidden()
    with again.expect_download() as waiting:
        again.click("#save-copy")
    waiting.value.save_as(copy)
    assert json.loads(next(text for _, a, text in saved(copy).elements if a.get("id") == "notes-data"))["decision"] is None


@pytest.mark.parametrize(
    ("data", "notes"),
    [
        ('[{"text": "of an older page", "sample": 6, "face": "F1", "cutter": null}, {"no": "text"}, null]', ["of an older page"]),
        ('{"notes": [{"text": "x", "done": "yes"}], "decision": {"state": "approved"}}', ["x"]),
        ('{"notes": 7, "decision": {"state": "toString", "name": "A"}}', []),
        ("null", []),
        ('{"notes": [], "decision": {"state": ["approved"], "name": "A"}}', []),
    ],
)
def test_older_copies_and_broken_ones_are_read(at, path, tmp_path, data, notes):
    """Nothing is approved without a name, and nothing done that is not said to be."""
    text = path.read_text(encoding="utf-8")
    made = text.replace('id="notes-data">[]<', f'id="notes-data">{data}<')
    assert made != text
    (tmp_path / "older.html").write_text(made, encoding="utf-8")
    page = at(where=tmp_path / "older.html")
    assert page.eval_on_selector_all("ol.notes .said", "all => all.map(each => each.textContent)") == notes
    assert page.locator("#decision").is_hidden()
    assert page.locator("ol.notes .done").count() == 0


def test_notes_that_cannot_be_read_are_reported_and_the_picture_stays(at, path, tmp_path):
    text = path.read_text(encoding="utf-8")
    (tmp_path / "broken.html").write_text(text.replace('id="notes-data">[]<', 'id="notes-data">[{"text": <'), encoding="utf-8")
    page = at(where=tmp_path / "broken.html")
    assert page.evaluate("document.documentElement.dataset.ready") == "yes"
    assert "cannot be read" in page.inner_text("#review-notes")


def test_a_note_stays_where_it_was_begun(at):
    page = at()
    page.evaluate("review.select(6)")
    page.fill("#note", "of sample six")
    page.evaluate("review.select(8)")
    assert page.inner_text("#note-place") == "at F1, sample 6"
    page.click("#add-note")
    assert page.inner_text("ol.notes .place").startswith("F1, sample 6")
    assert page.inner_text("#note-place") == "at F1, sample 8"
    # Who asks for it moves the note.
    page.fill("#note", "of the next")
    page.evaluate("review.select(7)")
    page.click("#note-here")
    page.click("#add-note")
    assert page.locator("ol.notes .place").nth(1).inner_text().startswith("F1, sample 7")


def test_paper_has_all_that_a_reviewer_signs(at, planned):
    from pypdf import PdfReader

    page = at()
    page.click("#reject")
    page.fill("#reviewer", "A reviewer")
    page.fill("#note", "of the whole")
    page.click("#add-note")
    page.click("#reject")
    folded = page.eval_on_selector_all("details:not([open])", "all => all.length")
    text = " ".join(each.extract_text() for each in PdfReader(io.BytesIO(page.pdf(format="A4"))).pages)
    p = planned.plan
    wanted = [
        "pocket_top.step", p.machine.name, "spindle along 0, 0, 1", "tolerance 0.01 mm", p.part.sha256, "Printed 20",
        "Rejected by A reviewer",
        "of the whole", "What these words mean", "Options after defaults", "1 / ",
    ]  # fmt: skip
    wanted += [f"Where {c.name} fails" for c in story_of(p).cutters if c.feasible is False]
    # The printer breaks lines, and fonts draw some letters as one.
    squeezed = re.sub(r"\s", "", unicodedata.normalize("NFKC", text))
    assert [words for words in wanted if words.replace(" ", "") not in squeezed] == []
    # Afterwards the page is as it was.
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("details:not([open]):not(#viewer *)").count() == 0
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.eval_on_selector_all("details:not([open])", "all => all.length") == folded


def test_the_picture_fills_the_window_and_gives_it_back(at):
    page = at()
    size = page.evaluate("[review.stage.canvas.clientWidth, review.stage.canvas.clientHeight]")
    page.keyboard.press("w")
    page.wait_for_function("() => review.stage.canvas.clientWidth > 1300")
    assert page.locator("#cutters").is_hidden()
    assert page.evaluate("review.stage.canvas.clientHeight * review.stage.canvas.clientWidth / (innerWidth * innerHeight)") > 0.75
    page.keyboard.press("Escape")
    page.locator("#cutters").wait_for(state="visible")
    page.wait_for_function(
        "size => review.stage.canvas.clientWidth === size[0] && review.stage.canvas.clientHeight === size[1]", arg=size
    )


def drawn_jaw(page):
    """How many places of the picture show the jaw, by what a click there would choose."""
    return page.evaluate(
        """() => { let count = 0; for (let x = -1; x < 1; x += 0.02) for (let y = -1; y < 1; y += 0.02) {
             const hit = review.picker.at(x, y); count += hit && hit.owner < 0 ? 1 : 0; } return count; }"""
    )


def test_eyes_hide_what_is_still_in_the_way(at, planned):
    """The jaw leaves the picture, and the posture at which the tool meets it stays forbidden."""
    page = at()
    failing = next(c.id for c in planned.plan.cutters if any((w.obstacle_face or "").startswith("fixture:") for w in c.witnesses))
    page.evaluate("id => review.setCutter(id)", failing)
    page.keyboard.press("n")
    state = page.evaluate("review.judged.state")
    assert state != "free"
    # What holds the part is seen through at first: hidden and shown again, it is solid.
    page.keyboard.press("b")
    page.keyboard.press("b")
    jaw = drawn_jaw(page)
    assert jaw > 500
    page.keyboard.press("b")
    status(page, "still in the way of the tool")
    assert drawn_jaw(page) < 0.05 * jaw
    page.evaluate("review.setPosture({...review.posture})")
    assert page.evaluate("review.judged.state") == state
    page.keyboard.press("b")
    assert drawn_jaw(page) == pytest.approx(jaw, rel=0.02)


def test_coordinates_have_no_noise_and_wide_bends_are_flat(at):
    page = at()
    page.select_option("#clip select", "1")
    middle = page.evaluate("(review.meta.part.low[1] + review.meta.part.high[1]) / 2")
    assert float(re.search(r"Y (-?[\d.]+) mm", page.inner_text("#clip output")).group(1)) == pytest.approx(middle, abs=6e-4)
    page.evaluate("review.meta.part.low[1] = -1; review.meta.part.high[1] = 1.0005")
    page.select_option("#clip select", "0")
    page.select_option("#clip select", "1")
    assert page.inner_text("#clip output") == "Y 0 mm"
    # A bend of 2 m is flat, one of 0.5 m is not.
    row = INNER[0]
    for radius, words in ((2000, "Curvature flat and flat"), (500, "convex R 500")):
        page.evaluate(
            """([row, radius]) => { const at = review.samples.at.bind(review.samples);
                 review.samples.at = one => ({...at(one), curvature: [0, -1 / radius]});
                 review.select(row); delete review.samples.at; }""",
            [row, radius],
        )
        assert words in page.inner_text("#posture .about")
