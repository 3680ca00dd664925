"""Bodies: one in another, two that touch, two apart, a hollow, and what clamps a part."""

from conformance.forms import box
from conformance.made.blocks import Point3, cuboid, on_rectangles, together
from conformance.made.part import Answer, MadePart, Setup
from conformance.made.planar import along, at, ball_from, ball_until, flat_until, heel_from, holder
from conformance.tool import Tool

_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
_BACK, _DOWN = (-1.0, 0.0, 0.0), (0.0, 0.0, -1.0)
_FLAT, _WIDE, _BALL, _BULL = Tool.flat(8.0, 40.0), Tool.flat(16.0, 40.0), Tool.ball(6.0, 40.0), Tool.flat(8.0, 40.0, corner=1.5)

_OUTER, _INNER = ((-20.0, -20.0, -20.0), (20.0, 20.0, 20.0)), ((-6.0, -6.0, -6.0), (6.0, 6.0, 6.0))

BODY_IN_BODY = MadePart(
    "body_in_body",
    "bodies",
    "A body inside another body",
    """Two boxes, both solid, the small one inside the large one. A contact on the small one lies within the large one, not on
    its skin, so that the large one's depth counts there: the end of a tool that stands in material is in it, and every posture
    is blocked. On the large one all is behind the contact.""",
    lambda: together(cuboid(*_OUTER), cuboid(*_INNER)),
    (box("outer", *_OUTER), box("inner", *_INNER)),
    (_FLAT, _BALL, _BULL),
    on_rectangles(((-6, -6, 6), (6, 6, 6), _Z), ((-15, -15, 20), (15, 15, 20), _Z), ((6, -6, -6), (6, 6, 6), _X), ((20, -15, -15), (20, 15, 15), _X)),
    answers=(
        Answer("free_tilts", [], "the contact is in the outer body", _FLAT.name, given=at((0, 0, 6), _Z, _X)),
        Answer("free_tilts", [], "the contact is in the outer body", _BALL.name, given=at((6, 0, 0), _X, _Z)),
        Answer("free_tilts", [[0.0, 90.0]], "all material is behind the plane of the contact", _FLAT.name, given=at((5, 0, 20), _Z, _X)),
    ),
)

_A, _B = 20.0, 8.0
_SLABS: dict[str, tuple[Point3, Point3]] = {
    "below": ((-_A, -_A, -_A), (_A, _A, -_B)),
    "above": ((-_A, -_A, _B), (_A, _A, _A)),
    "+x": ((_B, -_A, -_B), (_A, _A, _B)),
    "-x": ((-_A, -_A, -_B), (-_B, _A, _B)),
    "+y": ((-_B, _B, -_B), (_B, _A, _B)),
    "-y": ((-_B, -_A, -_B), (_B, -_B, _B)),
}

HOLLOW = MadePart(
    "closed_hollow",
    "bodies",
    "A block with a closed hollow",
    """A cube of 40 mm with a hollow of 16 mm in its middle: six slabs side by side. Each tool is 40 mm long, more than the
    hollow's diagonal, 16 sqrt 3 = 27.7: a tool that touches a wall of the hollow goes through another wall. On the outer faces
    all is behind the contact.""",
    lambda: cuboid((-_A, -_A, -_A), (_A, _A, _A)).cut(cuboid((-_B, -_B, -_B), (_B, _B, _B))),
    tuple(box(name, *c) for name, c in _SLABS.items()),
    (_FLAT, _BALL, _BULL),
    on_rectangles(((-_B, -_B, -_B), (_B, _B, -_B), _Z), ((-_B, -_B, -_B), (-_B, _B, _B), _X)),
    answers=(
        Answer("free_tilts", [], "the tool is longer than the hollow's diagonal", _BALL.name, given=at((0, 0, -_B), _Z, _X)),
        Answer("free_tilts", [], "the tool is longer than the hollow's diagonal", _FLAT.name, given=at((-_B, 2, 1), _X, (0, 1, 1))),
        Answer("free_tilts", [[0.0, 90.0]], "all material is behind the plane of the contact", _BALL.name, given=at((3, 4, _A), _Z, _Y)),
    ),
)

_HIGH, _LOW = ((-20.0, -30.0, -20.0), (0.0, 30.0, 15.0)), ((0.0, -30.0, -20.0), (20.0, 30.0, 0.0))

TOUCHING = MadePart(
    "touching_bodies",
    "bodies",
    "Two bodies that touch",
    """Two boxes that share the plane x = 0 below z = 0. A contact on what they share lies on the skin of both, and a tool that
    stands on the one goes into the other: blocked. Above, the second body is a step of 20 mm: down, the side of the tool comes
    to its edge (planar.ball_until, flat_until).""",
    lambda: together(cuboid(*_HIGH), cuboid(*_LOW)),
    (box("high", *_HIGH), box("low", *_LOW)),
    (_FLAT, _BALL, _BULL),
    on_rectangles(((0, -8, 0), (0, 8, 15), _X), ((0, -8, -20), (0, 8, 0), _X), ((0, -8, 0), (20, 8, 0), _Z)),
    answers=(
        Answer("free_tilts", [], "the shared plane: the tool is in the second body", _FLAT.name, given=at((0, 0, -8), _X, _Z)),
        Answer("free_tilts", [], "the shared plane: the tool is in the second body", _BALL.name, given=at((0, 3, -10), _X, _DOWN)),
        Answer("free_tilts", [[0.0, ball_until((8.0, 20.0), 3.0)]], "planar.ball_until", _BALL.name, given=at((0, 0, 8), _X, _DOWN)),
        Answer("free_tilts", [[0.0, flat_until((8.0, 20.0))]], "atan(z / 20)", _FLAT.name, given=at((0, 0, 8), _X, _DOWN)),
    ),
)

_GAP = 6.0
_ONE, _TWO = ((-20.0, -60.0, -10.0), (0.0, 60.0, 10.0)), ((_GAP, -60.0, -10.0), (20.0 + _GAP, 60.0, 10.0))
_THIN = Tool.ball(4.0, 40.0)

APART = MadePart(
    "blocks_with_gap",
    "bodies",
    "Two blocks with a gap, open above and below",
    """Two boxes, 6 mm apart, from z = -10 to 10. From the face of one a tool comes out above or below when its side passes the
    other's edge: planar.ball_from. A ball end between the two has at most half the gap as its radius.""",
    lambda: together(cuboid(*_ONE), cuboid(*_TWO)),
    (box("one", *_ONE), box("two", *_TWO)),
    (_THIN, Tool.flat(3.0, 40.0), _BALL),
    on_rectangles(((0, -3, -10), (0, 3, 10), _X), ((_GAP, -3, -10), (_GAP, 3, 10), _BACK), ((-15, -3, 10), (0, 3, 10), _Z)),
    answers=(
        Answer("free_tilts", [[ball_from((8.0, _GAP), 2.0), 90.0]], "planar.ball_from, upwards", _THIN.name, given=at((0, 0, 2), _X, _Z)),
        Answer("free_tilts", [[ball_from((12.0, _GAP), 2.0), 90.0]], "planar.ball_from, downwards", _THIN.name, given=at((0, 0, 2), _X, _DOWN)),
        Answer("largest_radius", 0.5 * _GAP, "half the gap", given=along((0, 0, 2), _X, _Z, ball=_THIN)),
    ),
)

_PLATE = ((-30.0, -30.0, -10.0), (20.0, 30.0, 0.0))
_CLAMP = ((24.0, -15.0, -10.0), (34.0, 15.0, 12.0))
_HELD = Tool.ball(6.0, 20.0, holder=holder(20.0, 14.0), name="ball_D6_holder_D28")

NEAR_FIXTURE = MadePart(
    "near_fixture",
    "bodies",
    "A plate near a clamp",
    """One box. The clamp is a box 4 mm from it, 12 mm higher than its top: a wall at 10 mm from the contact at x = 14, for the
    tool that tilts to it in its middle plane. Without the clamp all is behind the contact.""",
    lambda: cuboid(*_PLATE),
    (box("plate", *_PLATE),),
    (_FLAT, _BALL, _HELD),
    on_rectangles(((0, -8, 0), (20, 8, 0), _Z), ((20, -8, -10), (20, 8, 0), _X)),
    setups=(Setup(), Setup("clamped", fixtures=(box("clamp", *_CLAMP),), boxes=(_CLAMP,))),
    answers=(
        Answer("free_tilts", [[0.0, ball_until((10.0, 12.0), 3.0)]], "planar.ball_until", _BALL.name, "clamped", at((14, 0, 0), _Z, _X)),
        Answer("free_tilts", [[0.0, flat_until((10.0, 12.0))]], "atan(10 / 12)", _FLAT.name, "clamped", at((14, 0, 0), _Z, _X)),
        Answer("free_tilts", [[0.0, 90.0]], "no clamp", _FLAT.name, "free", at((14, 0, 0), _Z, _X)),
        Answer("least_stickout", 12.0, "the clamp's height: the holder's radius is more than 10", _HELD.name, "clamped", along((14, 0, 0), _Z, _Z)),
    ),
)

_BASE = ((-30.0, -30.0, -10.0), (30.0, 30.0, 0.0))
_STRAP = ((5.0, -8.0, 0.0), (15.0, 8.0, 10.0))

FIXTURE_ON_FACE = MadePart(
    "fixture_on_face",
    "bodies",
    "A clamp on the face that is to be cut",
    """One box, and a clamp that stands on its top from x = 5 to 15. Below the clamp a contact lies on the skin of both, and a
    tool there is in the clamp. At x = -3 the clamp is a wall at 8 mm, 10 mm high: the front side comes to its edge, or the heel
    has to be clear of it or above it.""",
    lambda: cuboid(*_BASE),
    (box("plate", *_BASE),),
    (_FLAT, _WIDE, _BALL),
    on_rectangles(((-12, -8, 0), (5, 8, 0), _Z), ((5, -8, 0), (15, 8, 0), _Z)),
    setups=(Setup("clamped", fixtures=(box("clamp", *_STRAP),), boxes=(_STRAP,)),),
    answers=(
        Answer("free_tilts", [], "the contact is below the clamp", _FLAT.name, "clamped", at((10, 0, 0), _Z, _X)),
        Answer("free_tilts", [], "the contact is below the clamp", _BALL.name, "clamped", at((10, 0, 0), _Z, _Y)),
        Answer("free_tilts", [[0.0, flat_until((8.0, 10.0))]], "atan(8 / 10)", _FLAT.name, "clamped", at((-3, 0, 0), _Z, _X)),
        Answer("free_tilts", [[0.0, ball_until((8.0, 10.0), 3.0)]], "planar.ball_until", _BALL.name, "clamped", at((-3, 0, 0), _Z, _X)),
        Answer(
            "free_tilts",
            [[heel_from((8.0, 10.0), 8.0), 90.0]],
            "atan(10 / 8): the disk passes above the edge",
            _WIDE.name,
            "clamped",
            at((-3, 0, 0), _Z, _BACK),
        ),
    ),
)

PARTS = (BODY_IN_BODY, HOLLOW, TOUCHING, APART, NEAR_FIXTURE, FIXTURE_ON_FACE)
