"""What is judged where nobody says more, which faces are fillets, and what is said of the rest."""

import json

import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
from OCP.BRepFilletAPI import BRepFilletAPI_MakeChamfer, BRepFilletAPI_MakeFillet
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from cad_io import read_part
from cad_io.kernel import shape_map
from plan_cutters import Cutter, plan
from plan_cutters.command.codes import FEASIBLE, NOT_ALL_JUDGED, code_of
from plan_cutters.domain.figures import size
from plan_cutters.plan_file.words.headline import judged, not_judged, not_seen
from plan_cutters.plan_file.words.names import short_names
from plan_cutters.plan_file.words.text import story_of
from tests.support.cad_parts import as_nurbs, box, compound, cone, cut, loose, moved, patch, pocketed, real, ring, rod
from tests.support.commands import in_lines
from tests.support.forked import run
from tests.support.places import ROOT


def edges(shape):
    found = shape_map(shape, TopAbs_EDGE)
    return [TopoDS.Edge_s(found.FindKey(i)) for i in range(1, found.Extent() + 1)]


def rounded(shape, radius, which=None, make=BRepFilletAPI_MakeFillet):
    made = make(shape)
    for i, edge in enumerate(edges(shape)):
        if which is None or i in which:
            made.Add(radius, edge)
    return made.Shape()


def joined(one, other):
    return BRepAlgoAPI_Fuse(one, other).Shape()


def boss():
    """A boss on a plate, a fillet round its foot."""
    whole = joined(box(40, 40, 10), rod(8, 20, (20, 20, 5)))
    made = BRepFilletAPI_MakeFillet(whole)
    foot = [e for e in edges(whole) if np.ptp(_heights(e)) < 1e-6 and abs(_heights(e)[0] - 10) < 1e-6 and _round(e)]
    for edge in foot:
        made.Add(2.0, edge)
    return made.Shape()


def _points(edge):
    from OCP.BRepAdaptor import BRepAdaptor_Curve

    curve = BRepAdaptor_Curve(edge)
    return np.array([curve.Value(t).Coord() for t in np.linspace(curve.FirstParameter(), curve.LastParameter(), 7)])


def _heights(edge):
    return _points(edge)[:, 2]


def _round(edge):
    return np.ptp(np.hypot(*(_points(edge)[:, :2] - 20).T)) < 1e-6


def slot():
    """A slot with round ends, half a turn each."""
    whole = joined(joined(box(20, 10, 8, (10, 15, 5)), rod(5, 8, (10, 20, 5))), rod(5, 8, (30, 20, 5)))
    return cut(box(40, 40, 10), whole)


def quartered_hole():
    """A hole whose wall is four faces on one cylinder."""
    parts = [box(20, 20, 10, (x, y, 0)) for x in (0, 20) for y in (0, 20)]
    holes = [cut(each, rod(6, 30, (20, 20, -5))) for each in parts]
    return joined(joined(holes[0], holes[1]), joined(holes[2], holes[3]))


BLENDS = {
    "one edge": (lambda: rounded(box(20, 20, 20), 4.0, [0]), {"cylinder": 1}),
    "all edges": (lambda: rounded(box(20, 20, 20), 4.0), {"cylinder": 12, "sphere": 8}),
    "a boss's foot": (boss, {"torus": 1}),
    "chamfers": (lambda: rounded(box(20, 20, 20), 4.0, [0, 5], BRepFilletAPI_MakeChamfer), {}),
    "slot": (slot, {}),
    "hole of four quarters": (quartered_hole, {}),
    "hole": (lambda: cut(box(20, 20, 10), rod(3, 30, (10, 10, -5))), {}),
    "countersink": (lambda: cut(box(20, 20, 10, (-10, -10, 0)), cone(0.0, 8.0, 10.0)), {}),
    "round pocket": (pocketed, {}),
    "ring": (ring, {}),
}


def shapes_of(part):
    found = {}
    for number in part.blends:
        shape = part.faces[number - 1].shape
        found[shape] = found.get(shape, 0) + 1
    return found


@pytest.mark.parametrize("name", BLENDS)
@pytest.mark.parametrize(
    "change", [lambda s: s, as_nurbs, loose, pytest.param(lambda s: s.Moved(TopLoc_Location(moved())),
                                                          marks=pytest.mark.slow("reads each shape once more"))],
    ids=["as made", "as B-splines", "loose", "moved"],
)  # fmt: skip
def test_fillets_are_blends_and_other_round_faces_are_not(name, change):
    make, expected = BLENDS[name]
    assert shapes_of(read_part(change(make()))) == expected


REAL = {
    "asitus_control_arm.step": ({"torus": 24, "cylinder": 30}, {62, 68}),
    "hard/brlcad_NIST_MBE_PMI_2.stp": ({"sphere": 27, "cylinder": 114}, set()),
    "asitus_bolt-colored-faces.stp": ({}, {1}),
}


@pytest.mark.slow("searches long", only=("brlcad",))
@pytest.mark.parametrize("path", real(*REAL), ids=lambda p: p.name)
def test_blends_of_real_files(path):
    """Numbers that were looked at on pictures; the second ones are walls of bosses between fillets."""
    expected, walls = next(found for name, found in REAL.items() if name.endswith(path.name))
    part = read_part(path)
    assert shapes_of(part) == expected
    assert not walls & part.blends


CUTTERS = [Cutter.flat(radius=3, length=40)]


def topped():
    """A block with fillets, and a sculptured patch beside it."""
    return compound(rounded(box(40, 40, 20, (60, 60, 0)), 4.0, [0, 2]), patch())


@pytest.fixture(scope="module")
def mixed():
    return plan(topped(), cutters=CUTTERS, grid=5, area_budget=0).plan


def test_sculptured_faces_and_blends_are_judged_by_default(mixed):
    assert mixed.effective.faces == "sculptured,blends"
    kinds = {f.id: f.kind for f in mixed.faces}
    assert {kinds[name] for name in mixed.effective.target_faces} == {"sculptured", "blend"}
    assert mixed.scope.judged_by_kind == {"blend": 2, "sculptured": 1}
    assert mixed.scope.not_judged_by_kind == {"plane": 6}
    area = {f.id: f.area_mm2 for f in mixed.faces}
    assert mixed.scope.judged_mm2 == pytest.approx(sum(area[name] for name in mixed.effective.target_faces))
    assert mixed.scope.judged_mm2 + mixed.scope.not_judged_mm2 == pytest.approx(sum(area.values()))


def test_the_first_words_say_what_was_judged(mixed):
    assert judged(mixed).startswith("the free-form face and 2 fillets of the part, 142 x 142 x 25.91 mm (")
    assert not_judged(mixed) == ["6 plane faces were not judged, only obstacles: `--faces all`."]
    story = story_of(mixed)
    assert "the free-form face and 2 fillets" in story.headline.title + story.headline.about
    assert story.scope[0].startswith("6 plane faces were not judged")
    assert mixed.legend_words["check"] == "not judged (obstacle only)"


@pytest.mark.parametrize(
    ("faces", "said"),
    [([1, 2, 3], "the 3 faces asked for of the part, "), ("F2", "the face asked for of the part, "), ("all", "the part, "),
     ("blends", "the 2 fillets of the part, ")],
)  # fmt: skip
def test_faces_that_were_asked_for_are_called_so(faces, said):
    found = plan(topped(), cutters=CUTTERS, grid=3, area_budget=0, faces=faces).plan
    assert judged(found).startswith(said)
    assert bool(not_judged(found)) == (faces != "all")


def test_where_nothing_is_sculptured_all_is_judged():
    """Fillets alone are not what a finisher would finish."""
    found = plan(rounded(box(20, 20, 20), 4.0, [0]), cutters=CUTTERS, grid=3, area_budget=0).plan
    assert found.scope.judged == 7
    assert any("No face that can be judged is sculptured" in note for note in found.notes)
    assert judged(found) == f"the part, {size(found.part.size_mm)}"


def test_what_lies_between_samples_that_are_far_apart_is_said_not_to_be_seen(monkeypatch):
    """A default plan whose budget binds: the samples are farther apart than the cutter is wide."""
    monkeypatch.setattr("plan_cutters.scene.preparation.BUDGET", 40)
    part = read_part(box(90, 90, 5))
    found = plan(part, cutters=CUTTERS, faces="F6", area_budget=0).plan
    assert found.selected == "R3L40"
    (entry,) = found.cutters
    assert entry.feasible
    assert not entry.seen
    assert "was not seen" in " ".join(not_seen(found, short_names(found)))
    assert "was not seen" in " ".join(story_of(found).scope)
    assert code_of(found) == NOT_ALL_JUDGED
    assert any("times as far apart as curvature and the smallest cutter ask" in note for note in found.notes)
    # Who asks for it is told, too, but has what was requested.
    asked = plan(part, cutters=CUTTERS, faces="F6", area_budget=0, spacing=20.0).plan
    assert not_seen(asked, short_names(asked))
    assert code_of(asked) == FEASIBLE
    # What is proved between the samples was seen.
    proved = plan(part, cutters=CUTTERS, faces="F6", spacing=20.0).plan
    assert proved.cutters[0].area.feasible
    assert not not_seen(proved, short_names(proved))


def test_on_the_command_line(tmp_path):
    done = run(str(ROOT / "samples" / "pocket_top.step"), "--cutter", "R3L40", "--grid", "5", "-o", str(tmp_path),
                        "--formats", "json", "--area-budget", "0", cwd=tmp_path)  # fmt: skip
    said = in_lines(done.stdout)
    assert said.startswith("Take flat end D6 x 40: it finishes all 2,520 mm².")
    assert "For the free-form face of pocket_top.step, 60 x 40 x 24.51 mm (27.9 % of the area)" in said
    assert "5 plane faces were not judged, only obstacles: --faces all." in said
    assert json.loads((tmp_path / "plan.json").read_text())["scope"]["not_judged"] == 5
