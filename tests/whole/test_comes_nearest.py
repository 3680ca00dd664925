"""Where no cutter finishes, all who speak of a plan name one: the cutter that leaves the least area, not the fewest samples."""

import math

import pytest

from plan_cutters import plan
from plan_cutters.command.summary import summary
from plan_cutters.plan_file.load import plan_of
from plan_cutters.plan_file.model import leaves, nearest
from plan_cutters.plan_file.words.cutters import remaining_text
from plan_cutters.plan_file.words.headline import shown_cutter as shown_of
from plan_cutters.plan_file.words.text import story_of
from plan_cutters.report.page.tables import Drawing, of
from plan_cutters_agents.plan_answers import planned, ranked
from plan_cutters_batch.row import row_of
from tests.support import shapes
from tests.support.plan_files import cutter, face, made, verdicts

#: As wide as the groove is not, and as short as the wall is not high.
WIDE, SHORT = "D10L60", "D2L12rc1HD50L30"


@pytest.fixture(scope="module")
def uneven():
    """A large plane beside a wall and a small groove, with as many samples each: by number and by area cutters differ."""
    part = shapes.shell(
        shapes.plane((200, 300), (-50, 50)),
        shapes.plane((-50, 50), (0, 40), (190, 0, 0), (1, 0, 0), (0, 1, 0)),
        shapes.trough(3, 10, 0.8 * math.pi),
    )
    return plan(part, cutters=[WIDE, SHORT], grid=5, faces="1,3", machine="3-axis", area_budget=0)


def test_fewer_samples_may_be_more_area(uneven):
    wide, short = uneven.plan.cutters
    assert (wide.name, short.name) == (WIDE, SHORT)
    assert wide.not_reached > 2 * short.not_reached
    assert short.area_share.not_reached > 5 * wide.area_share.not_reached


def test_all_name_the_one_that_leaves_the_least_area(uneven, capsys):
    document, (wide, short) = uneven.plan, uneven.plan.cutters
    story = story_of(document)
    assert {uneven.shown, document.shown, story.shown, nearest(document.cutters).id} == {wide.id}
    # Together they finish it, which is what comes first.
    assert story.headline.title.endswith("finish all 10,200 mm²")
    assert document.selection.why == (f"no cutter reaches every sample; {wide.id} comes nearest and leaves 1 % of the area")
    row = row_of(document, name="part", file="part.step", code=1)
    # A row has one share, that of its sentence.
    assert (row.cutter, row.share) == (story.names[wide.id], document.process.finished_share)
    # An agent reads the file alone.
    found = plan_of(document.model_dump_json(), "plan.json")
    assert (shown_of(found).id, [c.id for c in ranked(found)]) == (wide.id, [wide.id, short.id])
    assert "Each alone reaches: flat end D10 x 60 99 %" in planned(found, 0, {}).told
    summary(document, verbose=True)
    said = " ".join(capsys.readouterr().out.split())
    assert "Where flat end D10 x 60 fails" in said


def test_the_page_lists_it_first(uneven):
    shown = of(uneven, [], {}, Drawing(0.1, ()), [])
    assert [entry.name for _, entry, _ in shown["cutters"]] == [WIDE, SHORT]


def test_of_equal_areas_fewer_samples_decide_and_then_the_order():
    one, many, none = verdicts(), verdicts(500), verdicts(inaccessible=500).model_copy(update={"inaccessible": 400})
    same = [cutter("A", {"F1": many}), cutter("B", {"F1": many})]
    assert nearest(same).id == "A"
    fewer = same[1].model_copy(update={"inaccessible": none.inaccessible})
    assert nearest([same[0], fewer]).id == "B"
    # What samples of no area leave is more than nothing; a share that is not known is more than any.
    spotless, spot = cutter("C", {"F1": one}), cutter("D", {"F1": one}).model_copy(update={"inaccessible": 1})
    assert nearest([spot, spotless]).id == "C"
    share = same[0].area_share.model_copy(update={"inaccessible": math.nan})
    unknown = same[0].model_copy(update={"area_share": share})
    assert nearest([unknown, same[1]]).id == "B"
    assert leaves(unknown)[0] == math.inf


def test_faces_are_named_by_the_area_that_is_lost_on_them():
    faces = [face(1, area=1.0), face(2, area=5000.0)]
    document = made(faces, [cutter("R6L80", {"F1": verdicts(900), "F2": verdicts(10)})])
    assert "They lie on F2, F1." in remaining_text(document, document.cutters[0])
