"""Fingers on the review page, sent to a real browser as touches: a pinch zooms, two fingers shift, one turns, a tap chooses."""

import math

import pytest

from plan_cutters import plan
from tests.support.browser import chromium, opened, place_of, seen, touch, wait_for_map
from tests.support.places import SAMPLES

pytest.importorskip("playwright.sync_api", reason="playwright is not installed: setup.sh dev")

pytestmark = pytest.mark.slow(
    "draws many pictures in software, once more with inertia", but=("test_a_tap_chooses_the_sample_there[reduce]",)
)


@pytest.fixture(scope="module")
def planned():
    chromium()
    return plan(SAMPLES / "pocket_top.step", grid=15, cutters=["R10L12"], holder="R22L30", machine="tilt:40", area_budget=0)


@pytest.fixture(params=["no-preference", "reduce"])
def phone(browser, path, request):
    """A page on a phone, with and without inertia."""
    context = browser.new_context(
        viewport={"width": 390, "height": 844},
        has_touch=True,
        is_mobile=True,
        # Inertia draws many pictures: those of a coarse screen are drawn sooner.
        device_scale_factor=2 if request.param == "reduce" else 1,
        reduced_motion=request.param,
    )
    page = opened(context, path)
    page.inertia = request.param != "reduce"
    yield page
    said = page.said
    context.close()
    assert said == []


def aim(page):
    return page.evaluate("review.stage.table.aim")


def settled(page):
    """Where one looks once nothing moves any more."""
    looks = []
    for _ in range(300):
        looks.append(aim(page))
        if len(looks) > 3 and all(each == looks[-1] for each in looks[-3:]):
            return looks[-1]
        # Frames, not seconds: a browser that draws in software may take a while for one.
        page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    raise AssertionError("the picture moves without end")


def test_a_pinch_zooms_about_what_lies_between_the_fingers_and_turns_nothing(phone):
    before = aim(phone)
    touch(phone, [(-30, 0), (-90, 0)], [(30, 0), (90, 0)])
    after = settled(phone)
    assert before["half"] / after["half"] == pytest.approx(3.0, rel=0.1)
    assert (after["turn"], after["rise"]) == pytest.approx((before["turn"], before["rise"]), abs=0.01)
    assert math.dist(after["target"], before["target"]) < 0.05 * before["half"]
    touch(phone, [(-90, 0), (-30, 0)], [(90, 0), (30, 0)])
    assert settled(phone)["half"] == pytest.approx(before["half"], rel=0.1)


def test_two_fingers_shift_the_picture_with_them(phone):
    point = phone.evaluate("review.samples.point(0)")
    where = "point => review.stage.project(point)"
    before, look = phone.evaluate(where, point), aim(phone)
    touch(phone, [(-40, -20), (20, 20)], [(40, -20), (100, 20)])
    after = settled(phone)
    x, y = phone.evaluate(where, point)
    assert (x - before[0], y - before[1]) == pytest.approx((60, 40), abs=6)
    assert (after["turn"], after["rise"], after["half"]) == pytest.approx((look["turn"], look["rise"], look["half"]), rel=1e-3)


def test_one_finger_turns_and_inertia_comes_to_rest(phone):
    before = aim(phone)
    touch(phone, [(-50, 0), (50, 20)])
    at_once = aim(phone)
    after = settled(phone)
    assert after["turn"] - before["turn"] == pytest.approx(-45, abs=4)
    assert after["rise"] - before["rise"] == pytest.approx(9, abs=1.5)
    assert after["half"] == pytest.approx(before["half"])
    assert after["target"] == pytest.approx(before["target"])
    if not phone.inertia:
        assert at_once == after


def test_a_tap_chooses_the_sample_there(phone):
    row = seen(phone, range(0, 225, 7))[0]
    before = aim(phone)
    phone.touchscreen.tap(*place_of(phone, row))
    wait_for_map(phone, row)
    assert aim(phone) == before


def test_buttons_zoom_and_fit(phone):
    before = aim(phone)
    for name, share in (("Zoom in (+)", 1 / 1.5), ("Zoom out (-)", 1.5)):
        start = aim(phone)["half"]
        phone.get_by_role("button", name=name).tap()
        assert settled(phone)["half"] == pytest.approx(share * start, rel=1e-3)
    touch(phone, [(-30, 0), (-90, 0)], [(30, 0), (90, 0)])
    phone.get_by_role("button", name="Fit the part (f)").tap()
    assert settled(phone)["half"] == pytest.approx(before["half"], rel=0.02)


def smaller(page, least):
    """Targets that are seen and less high than so many pixels, or less wide than 24."""
    return page.evaluate(
        """least => [...document.querySelectorAll("button, select, summary, input")]
             .filter(each => each.checkVisibility()).map(each => {
             const { width, height } = each.getBoundingClientRect();
             return [each.id || each.textContent.slice(0, 30) || each.type, Math.round(width), Math.round(height)]; })
             .filter(([, width, height]) => height < least || width < 24)""",
        least,
    )


def test_targets_are_large_enough_for_fingers(phone):
    assert smaller(phone, 44) == []


def test_zoom_buttons_and_large_targets_are_for_fingers_alone(page):
    assert page.locator(".zoom").is_hidden()
    assert smaller(page, 24) == []
