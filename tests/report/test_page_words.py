"""What the page says in words: sentences, holders by name, what is not sure told as not sure; tables that are whole."""

import re
from html.parser import HTMLParser

import pytest

from plan_cutters import plan
from plan_cutters.domain.figures import up
from plan_cutters.library import read_library
from plan_cutters.plan_file.frozen import Posture
from plan_cutters.plan_file.model import WitnessEntry
from plan_cutters.plan_file.words.cutters import spot
from plan_cutters.report.page import write
from tests.support.places import ROOT


class Rows(HTMLParser):
    """Rows of tables: the columns that each one spans."""

    def __init__(self):
        super().__init__()
        self.tables, self.open = [], []

    def handle_starttag(self, tag, attrs):
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append(0)
        elif tag in ("td", "th"):
            self.tables[-1][-1] += int(dict(attrs).get("colspan", 1))


@pytest.fixture(scope="module")
def planned():
    """A closed block with a sculptured top, the cutters of a library in their chuck, and a vise jaw in their way."""
    return plan(
        ROOT / "samples" / "pocket_top.step", cutters=read_library(ROOT / "samples" / "shop.toml"), grid=7, faces="all",
        area_budget=0, machine="tilt:40", fixtures=["box:15,60,40@62,-10,-10"], answers="stick-out,mend",
    )  # fmt: skip


@pytest.fixture(scope="module")
def text(planned):
    return write.page(planned, triangles=2000).decode()


@pytest.mark.slow("opens a browser")
def test_every_row_of_a_table_is_as_wide_as_its_head(text):
    found = Rows()
    found.feed(re.sub(r"(?s)<script.*?</script>", "", text))
    assert len(found.tables) >= 4
    for table in found.tables:
        assert set(table) == {table[0]}, table


@pytest.mark.slow("plans whole parts")
def test_the_reasons_name_the_holder_and_how_short_it_may_be(planned, text):
    head = text[text.index('<details id="why"') : text.index('<section id="cutters"')]
    entry = next(c for c in planned.plan.cutters if c.id == planned.shown)
    assert entry.holder == "ER32 chuck"
    assert f"{entry.length:g} mm out of its holder ER32 chuck" in head
    assert f"It can be held as short as {up(entry.least_stick_out.least_mm)}." in head


def witness(**more):
    best = Posture(tilt=71.0, rotation=300.0, axis=(0.0, 0.0, 1.0))
    return WitnessEntry(**({"sample": 0, "point": (0, 0, 0), "face": "F1", "reason": "rear_gouge",
                            "obstacle_face": "fixture:table",
                            "obstacle_point": (0, 0, 0), "best_posture": best, "depth_mm": 2.9} | more))  # fmt: skip


def test_what_is_undecided_is_not_told_as_blocked():
    sure, unsure = spot(witness(verdict="inaccessible")), spot(witness(verdict="undecided"))
    assert "is still 2.9 mm too deep in fixture table" in sure
    assert "Rear gouge, undecided." in unsure
    assert "may reach 2.9 mm into the tool" in unsure
    assert "too deep" not in unsure
    nothing = {"best_posture": None, "depth_mm": None}
    assert spot(witness(**nothing)) == "Rear gouge. Fixture table is in the way."
    assert spot(witness(verdict="undecided", **nothing)).endswith("may be in the way.")


def test_witnesses_have_the_verdicts_of_their_samples():
    from plan_cutters.domain.verdicts import INACCESSIBLE, UNDECIDED
    from plan_cutters.report.page.arrays import spots_of

    planned = plan(
        ROOT / "samples" / "pocket_top.step", cutters=["R3L40"], holder="D50L60", grid=7, faces="all", area_budget=0,
        machine="tilt:40", fixtures=["box:15,60,40@62,-10,-10"], tolerance=0.2,
    )  # fmt: skip
    words_of = {INACCESSIBLE: "inaccessible", UNDECIDED: "undecided"}
    spots, _ = spots_of(planned)
    assert spots
    assert {each.witness.verdict for each in spots} == set(words_of.values())
    for each in spots:
        assert each.witness.verdict == words_of[planned.reaches[each.cutter].verdict[each.sample]]
