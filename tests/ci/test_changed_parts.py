"""Five parts that changed, and what must be known of their faces: a radius, a hole, a slot, a mirror, another export."""

import cadquery as cq
import numpy as np
import pytest
from OCP.IGESControl import IGESControl_Writer

from cad_io.read import read_part
from plan_cutters import Cutter, Holder, plan
from plan_cutters_ci.matching import match_faces
from plan_cutters_ci.plans import compare
from plan_cutters_ci.review import Picture, Side, page
from plan_cutters_ci.wording import face_rows, headline, remarks


def block(radius=5.0, hole=15.0, slot=False):
    """A block with round corners, a pocket with round corners, and a hole through it."""
    body = cq.Workplane().box(80, 60, 30).edges("|Z").fillet(radius).faces(">Z").workplane().rect(40, 30).cutBlind(-15)
    body = body.edges(cq.selectors.BoxSelector((-21, -16, -1), (21, 16, 16))).edges("|Z").fillet(radius)
    body = body.cut(cq.Workplane().circle(3).extrude(60).translate((-30, hole, -30)))
    return body.cut(cq.Workplane().box(6, 60, 8).translate((30, 0, 15))) if slot else body


def bracket():
    """A block with a corner cut out, a hole and a short groove: no mirror leaves it as it is."""
    body = cq.Workplane().box(80, 60, 30).cut(cq.Workplane().box(20, 30, 20).translate((-25, 10, 10)))
    body = body.cut(cq.Workplane().circle(4).extrude(60).translate((20, -15, -30)))
    return body.cut(cq.Workplane().box(30, 8, 6).translate((25, 10, 15)))


def planned(shape, radii=(2, 4)):
    tools = [Cutter.flat(radius=r, length=30, holder=Holder.parse("R12L30")) for r in radii]
    return plan(read_part(shape), cutters=tools, faces="all", grid=4, area_budget=0, jobs=2).plan


@pytest.fixture(scope="module")
def before():
    return planned(block())


@pytest.fixture(scope="module")
def chiral():
    return planned(bracket(), (2,))


def test_after_a_smaller_radius_the_rounds_are_new_and_all_else_is_known(before):
    after = planned(block(2.0))
    found = compare(before, after)
    assert found.comparable
    mine, theirs = (
        {f.id for f in each.faces if f.shape == "cylinder" and f.carrier.radius_mm != pytest.approx(3.0)}
        for each in (before, after)
    )
    assert {f.old for f in found.faces if f.new is None} == mine
    assert {f.new for f in found.faces if f.old is None} == theirs
    assert all(f.lost == (f.now.reach != "reached") for f in found.faces if f.old is None)
    # Rows of both sides say what was changed.
    assert all(f.radius_mm == pytest.approx((5.0, 2.0)) for f in found.faces if None in (f.old, f.new))
    assert all("R5 to R2" in row[2] for row in face_rows(found) if row[0] in ("gone", "new", "lost"))
    # The larger cutter rounded the pocket no more than the smaller one does now.
    assert not [f for f in found.faces if f.won]


def test_a_hole_that_moved_is_gone_and_new(before):
    for at in (9.0, -15.0):
        after = planned(block(hole=at))
        found = compare(before, after)
        assert found.comparable
        assert sorted((f.old is None, f.new is None) for f in found.faces) == [(False, True), (True, False)]
        assert (found.lost, found.won) == (False, False)


def test_of_a_slot_the_walls_and_the_floor_are_new(before):
    after = planned(block(slot=True))
    found = compare(before, after)
    new = [f for f in found.faces if f.old is None]
    assert [f for f in found.faces if f.new is None] == []
    # Two walls, the floor, and what the slot leaves of the top on its other side.
    assert len(new) == 4
    assert {f.kind for f in new} == {"plane"}
    assert all(f.lost == (f.now.reach != "reached") for f in new)
    pairs = {b.id: a for a, b, _ in match_faces(before, after)}
    for face in after.faces:
        if face.id in pairs:
            assert face.carrier.outward == pairs[face.id].carrier.outward


def test_a_rib_in_place_of_a_slot_is_another_feature():
    """Both have walls that join the same faces and look the same ways, on the other side of the top."""
    body = cq.Workplane().box(80, 60, 30)
    slot = planned(body.cut(cq.Workplane().box(6, 60, 8).translate((-5, 0, 11))), (2,))
    rib = planned(body.union(cq.Workplane().box(6, 60, 8).translate((5, 0, 19))), (2,))
    for old, new in ((slot, rib), (rib, slot)):
        for a, b, _ in match_faces(old, new):
            # Walls, floor and top of either have no more than 480 mm2.
            assert min(a.area_mm2, b.area_mm2) > 1000.0


@pytest.mark.slow("plans pairs of parts", but=("turned",))
@pytest.mark.parametrize(
    "moved",
    [
        lambda body: body.mirror("YZ").translate((10, 0, 5)),
        lambda body: body.translate((10, 0, 5)),
        lambda body: body.rotate((0, 0, 0), (0, 0, 1), 90),
    ],
    ids=["mirrored", "moved", "turned"],
)
def test_a_part_that_moved_as_a_whole_is_told_in_one_line(chiral, moved):
    found = compare(chiral, planned(moved(bracket()), (2,)), name="bracket")
    (line,) = found.why_not
    assert "it was moved, turned or mirrored as a whole; export both from one origin" in line
    assert (headline(found), list(face_rows(found)), remarks(found)) == ("bracket: not comparable.", [], [])


def test_what_stands_mirrored_in_a_part_that_stays_is_compared_where_it_stands(chiral):
    """Most of the block is where it was: the corner, the hole and the groove are not."""
    found = compare(chiral, planned(bracket().mirror("YZ"), (2,)))
    assert found.comparable
    assert any("with the same kind and area in both: moved or mirrored" in line for line in remarks(found))
    assert all(f.old is None or f.new is None for f in found.faces)


def test_faces_with_names_are_known_where_the_part_moved(chiral):
    """Names do not move: each is compared with its own."""

    def named(plan_):
        return plan_.model_copy(update={"faces": [f.model_copy(update={"name": f"face {f.id}"}) for f in plan_.faces]})

    found = compare(named(chiral), named(planned(bracket().translate((110, 70, 55)), (2,))))
    assert found.comparable
    assert found.matched == {"name": len(chiral.faces)}
    assert (found.faces, found.lost, found.won) == ([], False, False)


def igs(shape, path):
    writer = IGESControl_Writer("MM", 1)
    writer.AddShape(shape.val().wrapped)
    writer.ComputeModel()
    assert writer.Write(str(path))
    return str(path)


def splines(shape, _):
    return cq.Workplane(shape.val().toNURBS())


@pytest.mark.parametrize("form", [igs, splines])
def test_another_export_of_a_part_is_the_same_part(before, tmp_path, form):
    after = planned(form(block(), tmp_path / "block.igs"))
    if form is splines:
        assert {f.surface for f in after.faces} == {"bspline"}
    pairs = match_faces(before, after)
    assert len(pairs) == len(before.faces) == len(after.faces)
    for a, b, _ in pairs:
        assert np.allclose(a.carrier.point_mm, b.carrier.point_mm, atol=1e-6)
        assert a.area_mm2 == pytest.approx(b.area_mm2, rel=1e-5)
    found = compare(before, after)
    assert (found.faces, found.lost, found.won) == ([], False, False)


def test_of_two_parts_the_reasons_are_all_that_is_told(before):
    other = planned(cq.Workplane().circle(30).extrude(20).faces(">Z").workplane().polygon(6, 30).cutBlind(-8))
    found = compare(before, other, name="part")
    assert not found.comparable
    assert "they seem to be of two parts" in found.why_not[0]
    assert (headline(found), list(face_rows(found)), remarks(found)) == ("part: not comparable.", [], [])
    nothing = Picture(None, "", "not drawn here")
    text = page(found, Side("a", before, nothing), Side("b", other, nothing)).decode()
    assert "they seem to be of two parts" in text
    assert "Faces that changed" not in text
    assert "Faces that changed" in page(compare(before, before), *[Side("a", before, nothing)] * 2).decode()


def rack(radii, at=(0.0, 0.0, 0.0), mirrored=False):
    """A block with a pocket, a corner cut out and a row of bores of these radii, moved or mirrored as a whole."""
    body = cq.Workplane().box(120, 60, 20).cut(cq.Workplane().box(24, 20, 9).translate((-30, 14, 5.5)))
    body = body.cut(cq.Workplane().box(12, 8, 30).translate((-54, -26, 0)))
    for k, radius in enumerate(radii):
        body = body.cut(cq.Workplane().circle(radius).extrude(60).translate((-30 + 20 * k, -12, -30)))
    return (body.mirror("YZ") if mirrored else body).translate(at)


def of_bores(plan_):
    """Ids of the four bores, in the order of the row."""
    bores = [f for f in plan_.faces if f.shape == "cylinder"]
    assert len(bores) == 4
    return [f.id for f in sorted(bores, key=lambda f: f.centre_mm[0])]


@pytest.fixture(scope="module")
def old_rack():
    return planned(rack([4, 1.5, 4, 4]), (2,))


@pytest.mark.slow("plans pairs of parts", but=("at2-True",))
@pytest.mark.parametrize(("at", "mirrored"), [((17, 3, 0), False), ((20, 0, 0), False), ((0, 0, 0), True), ((0, 0, 0), False)])
def test_a_part_that_moved_and_changed_hides_no_loss(old_rack, at, mirrored):
    """A bore narrowed and another one opened: where the row is moved, neither takes the place of the other."""
    old, new = old_rack, planned(rack([1.5, 4, 4, 4], at, mirrored), (2,))
    found = compare(old, new)
    if at != (0, 0, 0):
        assert not found.comparable
        return
    assert found.lost
    if not mirrored:
        mine, theirs = of_bores(old), of_bores(new)
        paired = {a.id: b.id for a, b, _ in match_faces(old, new)}
        assert [paired.get(name) for name in mine] == theirs
        assert {(f.old, f.new) for f in found.faces if f.lost} == {(mine[0], theirs[0])}


def test_a_name_pairs_no_bore_with_a_pin():
    """Both are called `seat`, and material is on other sides of them."""
    bore = cq.Workplane().box(60, 40, 20).cut(cq.Workplane().circle(4).extrude(8).translate((-15, 0, 2)))
    pin = cq.Workplane().box(60, 40, 20).union(cq.Workplane().circle(7).extrude(12).translate((20, 8, 10)))
    old, new = (
        p.model_copy(update={"faces": [f.model_copy(update={"name": "seat" if f.shape == "cylinder" else ""}) for f in p.faces]})
        for p in (planned(bore, (2,)), planned(pin, (2,)))
    )
    assert not any(a.shape == "cylinder" for a, _, _ in match_faces(old, new))
