"""Laws of comparing plans: nothing differs from itself, what is lost of a face one way is won the other way, order does not
matter; a face that is gone is never won."""

import json
import math
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters_ci.matching import match_faces
from plan_cutters_ci.model import REQUESTED, Comparison, schema_text
from plan_cutters_ci.plans import SLACK, compare
from plan_cutters_ci.wording import cutter_rows, escaped, face_rows, markdown, remarks
from tests.support.places import ROOT
from tests.support.plan_files import cutter, face, made, verdicts

IDS = ("R3L40", "R6L80", "R8L90")
PARTS = st.sampled_from([0, 0, 0, 1, 2, 300, 1000])


@st.composite
def plans(draw, sha="a"):
    """A plan of some faces at places of their own, not all of them targets, and some cutters."""
    numbers = draw(st.lists(st.integers(1, 9), min_size=1, max_size=6, unique=True))
    faces = [
        face(
            k + 1,
            centre=(10.0 * n, 0.0, draw(st.sampled_from([0.0, 0.0, 2.0]))),
            area=draw(st.sampled_from([50.0, 60.0, math.nan])),
            shape=draw(st.sampled_from(["plane", "sculptured"])),
            name=draw(st.sampled_from(["", "", "rim", "web"])),
            target=draw(st.booleans()),
        )
        for k, n in enumerate(numbers)
    ]
    chosen = draw(st.lists(st.sampled_from(IDS), min_size=1, max_size=3, unique=True))

    def on_face():
        lost = draw(PARTS)
        return verdicts(lost, draw(st.sampled_from([0, 0, 1000 - lost])), draw(st.sampled_from(["holder", "neck"])))

    tools = [cutter(name, {f.id: on_face() for f in faces if f.target}) for name in chosen]
    return made(faces, tools, sha=draw(st.sampled_from(["a", "b"])))


def mirrored(found):
    """What the comparison in reverse order must say of each face and cutter.

    Of faces that one plan has alone it says that they are there: a new one that is not reached is lost, a gone one is not won.
    """
    return (
        {(f.new, f.old, *((f.won, f.lost) if f.old and f.new else ()), f.now, f.was) for f in map(_Hashable, found.faces)},
        {(_id(c.now), _id(c.was), c.won, c.lost) for c in found.cutters},
        {_id(c.now) or _id(c.was): ({p[::-1] for p in c.faces_won}, {p[::-1] for p in c.faces_lost}) for c in found.cutters},
        found.selected[::-1],
    )  # fmt: skip


def straight(found):
    return (
        {(f.old, f.new, *((f.lost, f.won) if f.old and f.new else ()), f.was, f.now) for f in map(_Hashable, found.faces)},
        {(_id(c.was), _id(c.now), c.lost, c.won) for c in found.cutters},
        {_id(c.was) or _id(c.now): (set(c.faces_lost), set(c.faces_won)) for c in found.cutters},
        found.selected,
    )


def both(found):
    """Whether something of what both plans have was lost, and won."""
    rows = [f for f in found.faces if f.old and f.new] + found.cutters
    return any(each.lost for each in rows), any(each.won for each in rows)


class _Hashable:
    def __init__(self, face):
        self.old, self.new, self.lost, self.won = face.old, face.new, face.lost, face.won
        self.was, self.now = (None if s is None else s.model_dump_json() for s in (face.was, face.now))


def _id(state):
    return None if state is None else state.id


@settings(deadline=None, max_examples=60)
@given(plans())
def test_a_plan_does_not_differ_from_itself(plan):
    found = compare(plan, plan)
    assert found.same
    assert found.comparable
    assert (found.lost, found.won) == (False, False)


@settings(deadline=None, max_examples=60)
@given(plans(), plans())
def test_what_is_lost_one_way_is_won_the_other_way(old, new):
    there, back = compare(old, new), compare(new, old)
    assert straight(there) == mirrored(back)
    assert both(there) == both(back)[::-1]
    for found in (there, back):
        assert not any(f.won for f in found.faces if f.old is None or f.new is None)
        assert not any(f.lost for f in found.faces if f.new is None)
    assert there.comparable == back.comparable
    assert [(c.what, c.old, c.new) for c in there.changes] == [(c.what, c.new, c.old) for c in back.changes]


@settings(deadline=None, max_examples=40)
@given(plans(), plans(), st.integers(0, 99))
def test_the_order_of_cutters_does_not_matter(old, new, seed):
    def shuffled(plan):
        tools = list(plan.cutters)
        random.Random(seed).shuffle(tools)
        return plan.model_copy(update={"cutters": tools})

    assert compare(shuffled(old), shuffled(new)) == compare(old, new)


@settings(deadline=None, max_examples=40)
@given(plans(), st.integers(0, 99))
def test_faces_that_were_only_numbered_anew_are_known_again(old, seed):
    """Each at its place: a face list in another order is the same part, whatever its checksum."""
    faces = [f for f in old.faces if math.isfinite(f.area_mm2)]
    order = list(range(len(faces)))
    random.Random(seed).shuffle(order)
    anew = {faces[i].id: f"F{k + 1}" for k, i in enumerate(order)}

    def with_faces(ids, sha):
        kept = sorted((f.model_copy(update={"id": ids[f.id]}) for f in faces), key=lambda f: f.id)
        tools = [cutter(c.id, {ids[k]: v for k, v in c.faces.items() if k in ids}) for c in old.cutters]
        return made(kept, tools, sha=sha)

    if not faces:
        return
    before, after = with_faces({f.id: f.id for f in faces}, "a"), with_faces(anew, "b")
    assert {(a.id, b.id) for a, b, _ in match_faces(before, after)} == set(anew.items())
    found = compare(before, after)
    assert (found.lost, found.won, found.faces, found.cutters) == (False, False, [], [])


def two(before, after, **more):
    """Two plans of one part with one cutter, whose verdicts on F1 differ."""
    old, new = (made([face(1), face(2)], [cutter("R6L80", {"F1": v, "F2": verdicts()})]) for v in (before, after))
    return compare(old, new, **more)


@pytest.mark.parametrize(
    ("before", "after", "reach"),
    [
        (verdicts(), verdicts(1000), ("reached", "not reached")),
        (verdicts(), verdicts(1), ("reached", "partly")),
        (verdicts(), verdicts(0, 1), ("reached", "undecided")),
        (verdicts(0, 500), verdicts(500), ("undecided", "partly")),
        (verdicts(500), verdicts(502), ("partly", "partly")),
        (verdicts(), verdicts().model_copy(update={"accessible": 999, "unjudged": 1}), ("reached", "undecided")),
    ],
)
def test_what_counts_as_lost(before, after, reach):
    """One sample that is not reached any more, or not for sure, is a loss: undecided is no safe answer."""
    found = two(before, after)
    (told,) = found.faces
    assert (told.was.reach, told.now.reach, told.lost, told.won) == (*reach, True, False)
    assert found.lost
    assert not found.won


def test_shares_within_the_slack_are_the_same():
    assert two(verdicts(500), verdicts(501), slack=0.002).faces == []
    assert two(verdicts(500), verdicts(501), slack=0.0).lost
    assert 0.0 < SLACK < 0.01


def test_a_face_that_another_cutter_reaches_is_not_lost_but_its_cutter_is():
    def plan(lost):
        return made([face(1)], [cutter("R6L80", {"F1": verdicts(lost)}), cutter("R3L40", {"F1": verdicts()}, radius=3)])

    found = compare(plan(0), plan(1))
    assert found.faces == []
    (told,) = found.cutters
    assert (told.was.id, told.faces_lost, told.lost) == ("R6L80", [("F1", "F1")], True)
    assert found.lost
    assert found.unreachable == []


def test_a_new_face_that_no_cutter_reaches_is_lost_and_a_gone_one_is_told():
    def plan(lost, numbers, sha):
        return made([face(n) for n in numbers], [cutter("R6L80", {f"F{n}": verdicts(lost) for n in numbers})], sha=sha)

    grown = compare(plan(0, [1], "a"), plan(0, [1, 40], "b"))
    assert [(f.new, f.lost) for f in grown.faces] == [("F40", False)]
    assert not grown.lost
    (old,) = plan(0, [1], "a").cutters
    faulty = plan(0, [1, 40], "b").model_copy(
        update={"cutters": [old.model_copy(update={"faces": {**old.faces, "F40": verdicts(5)}})]}
    )
    found = compare(plan(0, [1], "a"), faulty)
    assert [(f.old, f.new, f.lost) for f in found.faces] == [(None, "F40", True)]
    assert found.unreachable == ["F40"]
    gone = compare(faulty, plan(0, [1], "a"))
    assert [(f.old, f.new, f.lost, f.won) for f in gone.faces] == [("F40", None, False, False)]
    assert [row[0] for row in face_rows(gone)] == ["gone"]
    assert (gone.lost, gone.won) == (False, False)


@pytest.mark.parametrize(
    ("word", "changed"),
    [
        ("unit", {"unit": "inch"}),
        ("faces", {"faces": "F1"}),
        ("faces", {"flip": True}),
        ("sampling", {"grid": 5, "sampled_by": "grid"}),
        ("postures", {"tilt_deg": (0.0, 30.0)}),
        ("tolerance", {"tolerance_mm": 0.02}),
        ("clearance", {"holder_clearance_mm": 1.0}),
        ("setup", {"setup": (1.0, 0.0, 0.0)}),
    ],
)
def test_two_questions_are_not_comparable_unless_asked_for(word, changed):
    old, new = made([face(1)], [cutter("R6L80", {})]), made([face(1)], [cutter("R6L80", {})], effective=changed)
    found = compare(old, new)
    assert not found.comparable
    assert [c.what for c in found.changes if c.hinders] == [word]
    assert word in REQUESTED
    assert found.why_not[0].startswith(f"{word} differs: ")
    assert compare(old, new, despite=[word]).comparable


def test_another_machine_or_fixture_is_another_question():
    old = made([face(1)], [cutter("R6L80", {})])
    tilted = old.model_copy(update={"machine": old.machine.model_copy(update={"tilt_limit_deg": 30.0})})
    assert [c.what for c in compare(old, tilted).changes if c.hinders] == ["machine"]


def test_nothing_in_common_is_not_comparable():
    old = made([face(1)], [cutter("R6L80", {})])
    other = made([face(1, shape="plane")], [cutter("R3L40", {}, radius=3)], sha="b")
    found = compare(old, other)
    assert not found.comparable
    assert len(found.why_not) == 2
    # The reasons are all that is told; the data have the rest.
    assert (list(face_rows(found)), list(cutter_rows(found)), remarks(found)) == ([], [], [])
    assert len(found.faces) == 2
    both_plans = Comparison(old="a", new="b", slack=0.0, plans=[found], unread=[], only_old=[], only_new=[], comparable=False,
                            lost=found.lost, won=found.won)  # fmt: skip
    text = markdown(both_plans)
    assert text.count("**Not comparable:**") == 2
    assert "|" not in text


def test_plans_of_which_too_little_is_known_again_are_of_two_parts():
    """One face of nine that happens to agree does not make them one part."""
    tools = [cutter("R6L80", {})]
    old = made([face(n, area=100.0 * n) for n in range(1, 10)], tools)
    other = made([face(1), *(face(n, area=7000.0 * n, centre=(0.0, 90.0, 10.0 * n)) for n in range(2, 10))], tools, sha="b")
    found = compare(old, other)
    assert len(match_faces(old, other)) == 1
    assert found.why_not == ["of 9 faces of the old plan and 9 of the new one 1 is known again: they seem to be of two parts"]
    assert compare(made(old.faces[:3], tools), made(other.faces[:3], tools, sha="b")).comparable
    # A plate whose holes were all set anew is the same plate.
    old, other = (
        made([face(1, area=9e5, shape="plane"), *plan.faces[1:]], tools, sha=sha) for plan, sha in ((old, "a"), (other, "b"))
    )
    assert len(match_faces(old, other)) == 1
    assert compare(old, other).comparable


def test_the_worst_rows_come_first():
    """By the area that is lost, whatever the numbers: new faces that are not reached after it, and what is gone last."""

    def plan(shares, sha, extra):
        faces = [face(n, area=100.0 * n) for n in shares] + [extra]
        return made(faces, [cutter("R6L80", {f"F{n}": verdicts(lost, reason=why) for n, (lost, why) in shares.items()})], sha=sha)

    h, n = "holder", "neck"
    old = plan({1: (0, h), 2: (0, h), 3: (900, h), 4: (500, h), 9: (800, h)}, "a", face(20, shape="plane"))
    new = plan({1: (900, h), 2: (900, h), 3: (0, h), 4: (500, n), 9: (900, h)}, "b", face(30))
    rows = [(row[0], row[1]) for row in face_rows(compare(old, new))]
    lost = [("lost", "F2"), ("lost", "F1"), ("less", "F9"), ("lost", "F30")]
    assert rows == [*lost, ("changed", "F4"), ("won", "F3"), ("gone", "F20")]


def test_a_cutter_in_another_holder_is_known_again():
    old = made([face(1)], [cutter("R6L80HR15L30", {}, holder="slim")])
    new = made([face(1)], [cutter("R6L80HR30L60", {}, holder="fat")])
    (told,) = compare(old, new).cutters
    assert (told.matched_by, [c.what for c in told.changes]) == ("cutting part", ["holder"])


def test_the_schema_in_the_package_is_that_of_the_model():
    assert (ROOT / "plugin/plan_cutters_ci/diff.schema.json").read_text(encoding="utf-8") == schema_text()


def test_names_cannot_break_the_markdown():
    old = made([face(1, name="a|b\n<script>")], [cutter("R6L80", {"F1": verdicts()})])
    new = made([face(1, name="a|b\n<script>")], [cutter("R6L80", {"F1": verdicts(9)})])
    found = Comparison(old="a", new="b", slack=0.0, plans=[compare(old, new, name="x*y.step")], unread=[], only_old=["g|h"],
                       only_new=[], comparable=True, lost=True, won=False)  # fmt: skip
    text = markdown(found)
    assert "<script" not in text.replace("\\<script", "")
    (row,) = [line for line in text.splitlines() if "F1" in line and line.startswith("| lost |") and "sculptured" in line]
    assert row.replace("\\|", "").count("|") == 7
    assert escaped("x*y") in text
    assert "g\\|h" in text
    json.loads(found.model_dump_json())


@pytest.mark.parametrize(("left", "lost"), [(500, False), (600, True)])
def test_less_to_reach_is_no_loss_of_a_cutter(left, lost):
    """A reached face was taken away: of what is left a smaller share is reached. It is a loss where more is left than before."""
    whole, part = verdicts(), verdicts(inaccessible=500)
    faces = [face(1), face(2), face(3)]
    old = made(faces, [cutter("R6L80", {"F1": whole, "F2": whole, "F3": part})], sha="a")
    new = made(faces[1:], [cutter("R6L80", {"F2": whole, "F3": verdicts(inaccessible=left)})], sha="b")
    there, back = compare(old, new), compare(new, old)
    assert (there.lost, back.won) == (lost, lost)
    assert not there.won
