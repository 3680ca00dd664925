"""The fixtures of each setup in what is drawn: the page and the model of operations."""

import math

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.report import models
from plan_cutters.report.page import write
from tests.support import gltf
from tests.support.browser import launch, opened
from tests.support.cad_parts import box
from tests.support.review_page import Page


@pytest.fixture(scope="module")
def held():
    """A cube of 10 mm with a jaw below in its first setup, a block above in the other, and a post in both."""
    jaw, block = Fixture.parse("box:20,10,5@10,0,0"), Fixture.parse("box:20,10,4@10,0,6")
    return plan(
        box(), cutters="R2L40rc2", faces="all", grid=4, area_budget=0, machine="trunnion-ac", operations="fewest",
        index_step=math.radians(30.0), fixtures=["box:2,2,2@-9,0,0"], setup=Placement((0.0, 0.0, 1.0), fixtures=(jaw,)),
        other_setups=[Placement((0.0, 0.0, -1.0), fixtures=(block,))],
    )  # fmt: skip


@pytest.fixture(scope="module")
def data(held):
    return write.page(held, triangles=2000)


#: Setups, least and largest corner of each fixture: the first setup's in front.
CORNERS = [([0, 1], (-9, 0, 0), (-7, 2, 2)), ([0], (10, 0, 0), (30, 10, 5)), ([1], (10, 0, 6), (30, 10, 10))]


def test_the_page_has_the_fixtures_of_all_setups_and_where_they_stand(held, data):
    read = Page(data)
    point, triangle = read.points("mesh.position"), read.array("mesh.triangle")
    found = read.meta["fixtures"]
    assert [each["name"] for each in found] == [each.name for each in held.plan.fixtures]
    assert [each["setups"] for each in found] == [each.setups for each in held.plan.fixtures]
    assert len(found) == len(CORNERS)
    for each, (setups, low, high) in zip(found, CORNERS, strict=True):
        mine = point[triangle[each["start"] : each["start"] + each["count"]]].reshape(-1, 3)
        assert each["setups"] == setups
        assert np.abs(mine.min(axis=0) - low).max() < 1e-2
        assert np.abs(mine.max(axis=0) - high).max() < 1e-2


def test_the_model_of_operations_has_a_node_of_fixtures_for_each_setup(held, tmp_path):
    split = models.split_operations(held, 0)
    models.write_operations_glb(held, split, tmp_path / "operations.glb")
    document, _ = gltf.read(tmp_path / "operations.glb")
    nodes = document["nodes"]
    for k in (0, 1):
        (group,) = (node for node in nodes if node["name"] == f"fixtures of setup {k + 1}")
        below = [nodes[child] for child in group["children"]]
        assert len(below) == 2
        assert all("mesh" in node for node in below)
        assert all(node["extras"]["setups"] == [k] for node in below)
    assert not any(node["name"] == "fixtures" for node in nodes)


@pytest.mark.slow("opens a browser")
def test_a_browser_shows_and_picks_the_fixtures_of_the_setup_of_the_tool(held, data, tmp_path):
    """A click at a sample that the other setup serves takes its fixtures there, and the first ones away."""
    api = pytest.importorskip("playwright.sync_api")
    (tmp_path / "review.html").write_bytes(data if isinstance(data, bytes) else data.encode())
    (name,) = held.reaches
    made, which = held.answers.operations.plans[0], held.served_in[name]
    setup = np.array([each.setup for each in made.operations])[made.label]
    rows = [int(np.flatnonzero((which == k) & (setup == k) & (made.label >= 0))[0]) for k in (0, 1)]
    with api.sync_playwright() as playwright:
        browser = launch(playwright)
        page = opened(browser.new_context(reduced_motion="reduce"), tmp_path / "review.html")
        for k in (0, 1, 0):
            there = page.evaluate(
                "row => { review.select(row); return [-1, -2, -3].map((owner) => review.drawn.there(owner)); }", rows[k]
            )
            assert there == [True, k == 0, k == 1]
            seen = page.evaluate("() => review.part.group.children.slice(-3).map((mesh) => mesh.visible)")
            assert seen == there
        browser.close()
