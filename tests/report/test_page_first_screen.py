"""The review page as people meet it: first screen, list of cutters, selection, notes and schemes, on a desk and on a phone."""

import re

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.plan_file.operations import RemainingEntry
from plan_cutters.plan_file.words.text import CHIPS, chip, story_of
from plan_cutters.report.page.write import write_html
from tests.support.browser import SCREENS, chromium, place_of, seen
from tests.support.places import ROOT
from tests.support.review_page import Page

pytest.importorskip("playwright.sync_api", reason="playwright is not installed: setup.sh dev")

pytestmark = pytest.mark.slow("opens a browser", but=("test_the_first_screen_has_verdict_picture_process_and_decision[phone]",))
#: The last one alone is too short for its holder.
CUTTERS = [
    "D2L20", "D3L25", "D4L30", "D5L35", "D6L40", "D8L50", "D10L60", "D12L80", "D16L90", "D4L30rc2", "D6L40rc3", "D8L50rc4",
    "D10L60rc5", "D12L80rc6", "D16L90rc8", "D6L40rc0.5", "D8L50rc1", "D10L60rc1", "D20L12",
]  # fmt: skip
#: Samples off the border of the face.
INNER = [5 * i + j for i in (1, 2, 3) for j in (1, 2, 3)]


@pytest.fixture(scope="module")
def planned():
    """A block with a sculptured top, nineteen cutters, and a jaw beside it that is in the way of all but slender ones."""
    chromium()
    return plan(
        ROOT / "samples" / "pocket_top.step", cutters=CUTTERS, holder="D44L60", machine="trunnion-ac", grid=5, area_budget=0,
        fixtures=["box:15,60,40@62,-10,-10"],
    )  # fmt: skip


def names(page):
    """Ids of the cutters as they are listed, from the top."""
    return page.eval_on_selector_all("#cutters tr[data-cutter]", "rows => rows.map(row => row.dataset.cutter)")


def within(page, selector):
    """Whether an element lies in the window as a whole, and nothing covers its middle."""
    return page.evaluate(
        """selector => { const element = document.querySelector(selector), box = element.getBoundingClientRect();
             const there = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
             return box.height > 0 && box.top >= 0 && box.bottom <= innerHeight && box.left >= 0 && box.right <= innerWidth
               && (element.contains(there) || there.contains(element)); }""",
        selector,
    )


@pytest.mark.parametrize("screen", SCREENS)
def test_the_first_screen_has_verdict_picture_process_and_decision(at, planned, screen):
    page = at(screen)
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        assert page.evaluate("document.documentElement.scrollWidth") <= SCREENS[screen][0]
        cutters = () if screen == "phone" else ("#cutters tr[data-cutter] th",)
        first = ("#verdict", "h1", "#approve", "#reject", "#to-note", "#picture", "#process tr[data-step] th")
        for selector in (*first, *cutters):
            assert within(page, selector), selector
        # One row: no control of it stands below another one.
        rows = page.eval_on_selector_all(
            "#toolbar > :not([hidden])", "all => all.map(each => each.getBoundingClientRect()).map(box => [box.top, box.bottom])"
        )
        assert screen == "phone" or max(top for top, _ in rows) < min(bottom for _, bottom in rows)
        ground = page.evaluate("getComputedStyle(document.querySelector('header')).backgroundColor")
        assert (min(map(int, re.findall(r"\d+", ground)[:3])) > 128) == (scheme == "light")
    assert names(page)[0] == planned.shown == page.evaluate("review.cutter.id")
    # The process is the subject: no cutter says more before it is shown.
    assert page.locator("#cutters tr.more:visible").count() == 0
    if screen != "phone":
        # All of nineteen cutters in one list, each in a line.
        lines = page.eval_on_selector_all("#cutters tr[data-cutter]", "rows => rows.map(row => row.offsetHeight)")
        assert len(lines) == len(CUTTERS)
        assert max(lines) <= 34


def test_the_verdict_is_told_by_sign_and_word(planned, path):
    page = Page(path.read_bytes())
    said = chip(planned.plan, story_of(planned.plan))
    assert page.of("strong", id="verdict") == [f"{said.sign} {said.word}"]
    assert len({each.sign for each in CHIPS.values()} | {said.sign}) >= 3


@pytest.mark.parametrize(
    ("change", "wanted"), [({}, "Feasible"), ({"unjudged": 1}, "Feasible where judged"), ({"selected": None}, "Feasible in part")]
)
def test_feasible_is_said_only_of_what_is(planned, change, wanted):
    """One sample that could not be judged is enough to say so in the first word."""
    whole = planned.plan
    made = whole.model_copy(update={"selected": change["selected"]} if "selected" in change else {})
    if "unjudged" in change:
        made = made.model_copy(update={"samples": whole.samples.model_copy(update=change)})
    if wanted == "Feasible in part":
        made = made.model_copy(update={"cutters": [c.model_copy(update={"feasible": False}) for c in whole.cutters]})
        left = RemainingEntry(cause="rear_gouge", area_mm2=1.0, share=0.1, samples=1, faces=["F1"], place_mm=None)
        made = made.model_copy(update={"process": whole.process.model_copy(update={"finished_share": 0.9, "left": [left]})})
    assert chip(made, story_of(made)).word == wanted


def test_the_cutter_shown_comes_to_the_top_and_says_more(at, planned):
    page = at()
    shown = page.locator("#cutters tr[data-cutter]:visible")
    other = shown.nth(shown.count() - 1).get_attribute("data-cutter")
    button = page.locator(f'#cutters tr[data-cutter="{other}"] th button.text')
    button.focus()
    page.keyboard.press("Enter")
    assert names(page)[0] == other == page.evaluate("review.cutter.id")
    assert sorted(names(page)) == sorted(each.id for each in planned.plan.cutters)
    # Who came by the keyboard is still there.
    assert page.evaluate("document.activeElement.closest('tr').dataset.cutter") == other
    assert page.locator("#cutters tr.more:visible").count() == 1
    # What another one's row says is opened without showing that cutter.
    opener = page.locator("#cutters tr[data-cutter]:not(.shown) .opener").first
    opener.click()
    assert opener.get_attribute("aria-expanded") == "true"
    assert page.locator("#cutters tr.more:visible").count() == 2
    assert page.evaluate("review.cutter.id") == other


def test_cutters_are_sorted_by_exact_shares_below_the_one_shown(at, planned):
    page = at()
    head = page.locator("#cutters thead button", has_text="Reached")
    share = {c.id: c.area_share.interference_free + c.area_share.accessible for c in planned.plan.cutters}
    assert len(set(share.values())) > 2
    for direction, sign in (("ascending", 1), ("descending", -1)):
        head.click()
        assert page.get_attribute("#cutters thead th:nth-child(3)", "aria-sort") == direction
        order = names(page)
        assert order[0] == planned.shown
        below = [sign * share[each] for each in order[1:]]
        assert below == sorted(below)
        # What a row says more stays below it.
        pairs = page.eval_on_selector_all(
            "#cutters tr.more",
            """rows => rows.map(row =>
                 [row.id, row.previousElementSibling.querySelector('.opener').getAttribute('aria-controls')])""",
        )
        assert all(one == other for one, other in pairs)


def lost(page):
    """Share of the lost area, of the cutter shown, that faces the eye and that nothing hides."""
    return page.evaluate(
        """() => { const { back } = review.stage.table.frame(); let [all, seen] = [0, 0];
             for (let row = 0; row < review.samples.count; row++) {
               if (!["inaccessible", "undecided"].includes(review.samples.verdict(review.cutter.id, row))) continue;
               const normal = review.samples.normal(row), front = normal.reduce((sum, x, k) => sum + x * back[k], 0);
               all += review.samples.area(row);
               if (front > 0.1 && !review.picker.hidden(review.samples.point(row), back)) seen += review.samples.area(row); }
             return all ? seen / all : null; }"""
    )


def part_of_the_frame(page):
    """Share of the picture that shows the part, by what lies under places on a grid, seen through what is faded."""
    return page.evaluate(
        """() => { let [hit, all] = [0, 0];
             for (let y = -0.975; y < 1; y += 0.05) for (let x = -0.975; x < 1; x += 0.05) {
               all++; if ((review.picker.at(x, y)?.owner ?? -1) >= 0) hit++; }
             return hit / all; }"""
    )


def test_the_first_view_is_from_the_spindle_and_full_of_the_part(at, tmp_path):
    """Whatever holds it is seen through: a jaw stands between the eye's usual place and the part."""
    found = plan(
        ROOT / "samples" / "pocket_top.step", cutters=["D12L80rc6"], holder="D60L60", grid=11, area_budget=0,
        fixtures=["box:15,60,40@62,-10,-10"],
    )  # fmt: skip
    write_html(found, None, tmp_path / "review.html")
    page = at(where=tmp_path / "review.html")
    assert page.inner_text("#verdict") == "◐ Feasible in part"
    assert part_of_the_frame(page) >= 0.4
    back = page.evaluate("review.stage.table.frame().back")
    assert np.dot(back, found.plan.effective.setup) > 0.5
    assert page.evaluate("review.meta.fixtures.every((_, i) => review.drawn.fading.has(-1 - i))")
    page.click("#stays")
    assert re.fullmatch(r"What stays, 1 of \d+", page.inner_text("#stays"))
    assert lost(page) > 0.9
    # A side of the cube is a view along its axis.
    page.click("#scale [data-side='+Z']")
    assert page.evaluate("review.stage.table.frame().back") == pytest.approx([0, 0, 1], abs=1e-6)


def test_cutters_that_finish_too_and_many_faces_are_folded(at, planned):
    page = at()
    feasible = sum(bool(each.feasible) for each in planned.plan.cutters)
    more = page.get_by_role("button", name=f"{feasible - 1} more also finish")
    assert page.locator("#cutters tr[data-cutter]:visible").count() == len(CUTTERS) - feasible + 1
    more.click()
    assert page.locator("#cutters tr[data-cutter]:visible").count() == len(CUTTERS)
    assert more.count() == 0


def test_numbers_are_written_as_people_write_them(planned, path):
    text = re.sub(r"(?s)<script.*?</script>|<style.*?</style>|<code>.*?</code>|<[^>]+>", " ", path.read_text(encoding="utf-8"))
    assert not re.search(r"\d[eE][-+]?\d", text)
    assert not re.search(r"\b-0\b|(?<!\d)360°|\bmm2\b", text)
    page = Page(path.read_bytes())
    rows = page.of("tr")
    assert {"allowance mm0", "setup0, 0, 1", "target facesF1", "proposeno"} <= set(rows)


def test_selected_faces_are_copied_as_the_option_takes_them(at, planned):
    page = at(permissions=["clipboard-read", "clipboard-write"])
    for number in (5, 1, 3, 4):
        page.locator(f"#faces tr[data-face='{number}'] input").check()
    page.get_by_role("button", name="Copy faces").click()
    page.locator("#status", has_text="Copied").wait_for()
    text = page.evaluate("navigator.clipboard.readText()")
    assert text == "F1,3-5"
    # The face under the pointer, by the mouse and by a key.
    row = seen(page, INNER)[0]
    page.keyboard.down("Control")
    page.mouse.click(*place_of(page, row))
    page.keyboard.up("Control")
    assert page.inner_text("#selection output") == "F3-5"
    page.locator("#under", has_text="F1").wait_for()
    page.keyboard.press("s")
    assert page.inner_text("#selection output") == "F1,3-5"
    assert page.locator("#faces tr[data-face='1'] input").is_checked()
    page.get_by_role("button", name="Clear").click()
    assert page.locator("#selection").is_hidden()


def test_a_tapped_spot_is_seen_on_a_phone(at, planned):
    page = at("phone")
    failing = next(c.id for c in planned.plan.cutters if c.witnesses)
    page.locator(f'#cutters tr[data-cutter="{failing}"] th button.text').tap()
    # On a phone the lists are folded.
    page.locator("#spots details:visible summary").tap()
    spot = page.locator("#spots [data-spot]:visible button").first
    spot.scroll_into_view_if_needed()
    spot.tap()
    assert within(page, "#picture")
    assert within(page, "#status")
    assert page.inner_text("#status").startswith("Spot 1 of")
    x, y = place_of(page, page.evaluate("review.sample.row"))
    box = page.locator("#picture").bounding_box()
    assert box["x"] < x < box["x"] + box["width"]
    assert box["y"] < y < box["y"] + box["height"]
    page.locator(".marks circle.sample").wait_for()  # drawn with the next picture
    assert page.locator("#legend details").get_attribute("open") is None
    # The picture keeps its size of the window.
    assert box["height"] < 0.5 * SCREENS["phone"][1]


def test_both_solutions_of_the_rotary_axes_are_told_at_a_click(at, planned):
    page = at(permissions=["clipboard-read", "clipboard-write"])
    angles, taken = planned.rotary(planned.shown)
    rows = [row for row in seen(page, INNER) if taken[row] >= 0][:3]
    assert rows
    names_ = [axis.name for axis in planned.conditions.machine.rotary]
    for row in rows:
        page.mouse.click(*place_of(page, row))
        assert page.evaluate("review.sample.row") == row
        told = page.eval_on_selector_all("#angles .value", "all => all.map(each => each.textContent)")
        first, other = angles[row][taken[row]], angles[row][1 - taken[row]]
        for text, wanted in zip(told[1:], (first, other), strict=False):
            found = {word[0]: float(word[1:]) for word in re.findall(r"[A-C]-?[\d.]+", text)}
            for name, angle in zip(names_, np.degrees(wanted), strict=True):
                if np.isfinite(angle):
                    assert abs(found[name] - angle) % 360 == pytest.approx(0, abs=0.3)
        page.locator("#angles .copy").nth(1).click()
        page.locator("#status", has_text="Copied").wait_for()
        assert page.evaluate("navigator.clipboard.readText()") == " ".join(re.findall(r"[A-C]-?[\d.]+", told[1]))
    # A posture that is not free may be copied, but not without a word.
    failing = next(c.id for c in planned.plan.cutters if c.witnesses)
    page.locator(f'#cutters tr[data-cutter="{failing}"] th button.text').click()
    page.keyboard.press("n")
    page.locator("#angles .copy").first.click()
    page.locator("#status", has_text="Copied").wait_for()
    assert "not free" in page.inner_text("#status")


def test_the_scheme_is_switched_and_paper_stays_white(at):
    def dark():
        colour = page.evaluate("getComputedStyle(document.querySelector('header')).backgroundColor")
        return max(map(int, re.findall(r"\d+", colour)[:3])) < 128

    page = at(scheme="dark")
    assert dark()
    page.click("#more summary")
    page.select_option("#scheme", "light")
    assert not dark()
    page.select_option("#scheme", "dark")
    page.emulate_media(color_scheme="light")
    assert dark()
    page.emulate_media(media="print")
    assert not dark()


@pytest.mark.slow("opens a browser on a thousand faces")
@pytest.mark.parametrize("screen", SCREENS)
def test_a_thousand_faces_are_listed_filtered_and_selected(at, thousand, screen):
    page = at(screen, where=thousand)
    for scheme in ("dark", "light"):
        page.emulate_media(color_scheme=scheme)
        assert page.evaluate("document.documentElement.scrollWidth") <= SCREENS[screen][0]
    assert page.locator("#faces tbody tr").count() == 1000
    # A page of a thousand faces is no longer than one of twenty.
    assert page.locator("#faces tbody tr:visible").count() == (6 if screen == "phone" else 20)
    assert page.evaluate("document.documentElement.scrollHeight") < 5000
    page.fill("#faces input[type=search]", "f99")
    found = page.locator("#faces tbody tr:visible")
    assert found.count() == page.evaluate("review.meta.faces.filter(face => /^F99/.test(face.id)).length")
    for k in range(found.count()):
        found.nth(k).locator("input").check()
    numbers = sorted(page.evaluate("review.meta.faces.filter(face => /^F99/.test(face.id)).map(face => face.number)"))
    assert numbers == [99, *range(990, 1000)]
    assert page.inner_text("#selection output") == "F99,990-999"


@pytest.fixture(scope="module")
def thousand(tmp_path_factory):
    """A hundred and seventy boxes of six faces on a plane, apart from each other."""
    from cad_io import Part
    from tests.support.cad_parts import box, compound

    part = Part(compound(*(box(4, 4, 4, at=(10 * (k % 13), 10 * (k // 13), 0)) for k in range(170))), file="boxes.step")
    found = plan(part, cutters=["D4L20"], faces="all", grid=2, area_budget=0)
    path = tmp_path_factory.mktemp("thousand") / "review.html"
    write_html(found, None, path)
    return path


def test_a_doubt_is_seen_without_a_click_and_paper_has_the_reasons(at, tmp_path):
    """Which side of an open shell is material is a guess: that is not folded away below a green word."""
    found = plan(ROOT / "samples" / "peaks_and_valleys.step", cutters=["R6L80"], grid=9, area_budget=0)
    write_html(found, None, tmp_path / "review.html")
    page = at(where=tmp_path / "review.html")
    assert page.get_by_text("Doubt:").is_visible()
    facts = page.locator("#why dl.facts")
    assert facts.is_hidden()
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert facts.is_visible()
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert facts.is_hidden()
