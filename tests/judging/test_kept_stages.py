"""What the stages say of small parts is kept in `kept`: verdicts, reasons, witnesses, cells between samples, maps."""

import math

import pytest

from cad_io.part.edges import inside_edges
from plan_cutters import Cutter, Options
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.preference import handed, order
from plan_cutters.domain.verdicts import CONVEX, over_setups
from plan_cutters.judging.between import in_each
from plan_cutters.judging.judge import JudgeOnce, in_setup, judge
from plan_cutters.judging.limits import AXES, travels, within_limits
from plan_cutters.judging.phases import march_differs
from plan_cutters.judging.posture_maps import posture_maps
from plan_cutters.judging.reasons import Reasons, exempt, strips, with_sharp_edges
from plan_cutters.judging.witness import witnesses
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.work import Work
from tests.support.kept_parts import ready

SLIM = "D3.1L23F7N2.7x9S4.4HR9.3L31"
UP, DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
#: A T-slot cutter: flutes of 7.4 x 1.9 below a neck of 3.
SLOT = Cutter.form(((0, 0), (3.7, 0), (3.7, 1.9), (1.5, 1.9)), length=27.0)


def told(made, *, budget=None, maps=None):
    """All that the stages say of a part that is ready, in the order of a plan."""
    samples, n, part = made.samples, len(made.samples), made.scene.part
    once, work = JudgeOnce(motions=sum(len(each.motions) for each in made.patterns if each.whole)), Work()
    here = {}
    for cutter in order(made.cutters):
        earlier = {each: here[each] for each in made.cutters if each in here}
        here[cutter] = once(made, cutter, known=handed(cutter, earlier, n), work=work)
    reasons = Reasons(samples, made.setups, made.somewhere, made.machinable)
    edges = inside_edges(part, made.scene.orientation, made.scene.doubles)
    said, reaches, everywhere = {}, {}, {}
    for cutter, mine in here.items():
        others = [in_setup(made, cutter, k + 1, mine, judged=once) for k in range(len(made.others))]
        over, which = over_setups([mine, *others])
        explained = reasons.of(cutter, over)
        at_edge = strips(samples, explained.verdicts, cutter, edges)
        reaches[cutter], everywhere[cutter] = with_sharp_edges(explained.verdicts, at_edge), (mine, which)
        context = Context.of(cutter, made.conditions)
        said[cutter.id] = {
            "again": reasons.of(cutter, over).verdicts.reason,
            "here": mine,
            "others": others,
            "reasons": explained,
            "edges": at_edge,
            "march": march_differs(samples, made.surface_class == CONVEX, made.region, mine.interference_free),
            "witnesses": witnesses(samples, reaches[cutter], context, inside=made.shut, part=part),
        }
        if budget is not None:
            contexts = [Context.of(cutter, each) for each in made.setups]
            said[cutter.id]["between"] = in_each(samples, over, which, contexts, part, made.scene.orientation, budget=budget,
                                                 covered_samples=made.inside_bodies)  # fmt: skip
            said[cutter.id]["share"] = [said[cutter.id]["between"].share, said[cutter.id]["between"].feasible]
        if maps is not None:
            bare = judge(made.under(machine=Options().machine), cutter)
            said[cutter.id]["maps"] = posture_maps(samples, context, bare, inside=made.inside_bodies, shut=made.shut >= 0,
                                                   most=maps)  # fmt: skip
    return {
        "class": made.surface_class, "region": made.region, "inside": made.inside, "looked": work.looked,
        "carried": once.carried, "exempt": exempt(reaches, made.inside_bodies), "cutters": said,
        "limits": [within_limits(samples, made.cutters, made.conditions, axis) for axis in (None, *AXES)],
        "travels": travels(made.options, samples, {cutter: mine for cutter, (mine, _) in everywhere.items()}),
    }  # fmt: skip


def held(axis, *words, clamped=()):
    return Placement(axis, clamped=clamped, fixtures=tuple(map(Fixture.parse, words)))


def pair():
    """Two setups of the pocketed block: jaws and a table below, and a block above."""
    first = held(UP, "box:30,40,26@33.7,-5,-20", "table:-20.5", clamped=("F1",))
    return {"setup": first, "other_setups": (held(DOWN, "box:9,9,9@-9,5,2.2"), (0.6, 0.0, 0.8))}


CASES = {
    # Necks, shanks and holders; sharp edges; a limit of the axis.
    "slim": ("bracket", {"cutters": (SLIM, "D5L30rc2.5"), "machine": "tilt:55", "grid": 6}, {}),
    "trunnion": ("bracket", {"cutters": ("D4L26rc0.7", "D9L50"), "machine": "trunnion-ac", "grid": 5}, {"maps": 11}),
    "fixed": ("bracket", {"cutters": ("D4L26", SLIM), "machine": "3-axis", "grid": 6}, {}),
    "setups": ("bracket", {"cutters": ("D4L14F9S8HR9L20",), "machine": "tilt:80", "grid": 5, **pair()}, {"budget": 90}),
    "left over": ("bracket", {"cutters": (SLIM,), "machine": "4-axis-a", "grid": 4, "allowance": 0.3, "holder_clearance": 0.7,
                              "setup": Placement(UP, clamped=("F1",)), "other_setups": (DOWN,)}, {}),
    # Corners that no round cutter enters, in pockets that it enters and does not.
    "pocket": ("pocket", {"cutters": ("D5L30", "D7.7L30rc1.2", "D14.1L30"), "grid": 9}, {}),
    "lollipop": ("deep", {"cutters": (Cutter.lollipop(radius=2.2, neck_radius=1.3, length=24, holder="R8.6L20"),), "grid": 4,
                          "machine": "tilt:60"}, {}),
    "alone": ("bracket", {"cutters": ("D3L20rc0.4",), "grid": 4, "tilt": (0.1, 1.3), "rotation": (0.3, 4.1), "patterns": False},
              {"budget": 120, "maps": 5}),
    "turned": ("drum", {"cutters": ("D3L40rc1.5", "D4L40rc1"), "machine": "trunnion-bc", "grid": 11}, {"budget": 400}),
    "patch": ("patch", {"cutters": ("D4L40", "D5L40rc2.5"), "grid": 19}, {"budget": 700}),
    "holed": ("holed", {"cutters": ("D6L50rc1.1",), "machine": "head-head-ca", "grid": 17}, {"budget": 400}),
    "barrel": ("patch", {"cutters": (Cutter.barrel(radius=2, flank_radius=20, tip_radius=0.7, length=40, flutes=7.0),
                                     Cutter.ball(radius=1.5, length=40, taper=math.radians(4))), "grid": 23}, {"budget": 300}),
    "slot": ("groove", {"cutters": (SLOT,), "machine": "3-axis", "spacing": 2.9}, {"budget": 40}),
    "pockets": ("plate", {"cutters": ("D5.3L17F6S9", ), "machine": "tilt:47", "spacing": 2.1, "fixtures": ("table",),
                          "other_setups": (DOWN, (1.0, 0.0, 0.0))}, {}),
    # What keeps a cutter off a deep bore, part by part, beside a wall and in two setups that hold the part differently.
    "deep": ("deep", {"cutters": ("D4L21F7N3.4x8S7HR8.6L20", "D4L21F7N3.4x8S7", "D4L9"), "machine": "tilt:38", "grid": 5,
                      "fixtures": ("box:9,40,50@24.5,-5,3",)}, {}),
    "deep twice": ("deep", {"cutters": ("D4L21F7N3.4x8S7HR8.6L20", "D5L60F11S9"), "grid": 4,
                            "setup": held(UP, "box:9,40,50@24.5,-5,3"),
                            "other_setups": (held((0.0, 0.6, 0.8), "box:3,40,50@-9,-5,3"),)}, {}),
    "deep limited": ("deep", {"cutters": ("D4L21F7N3.4x8S7HR8.6L20",), "grid": 4, "machine": "tilt:22",
                              "setup": held(UP, "box:9,40,50@24.5,-5,3"),
                              "other_setups": (held((0.0, 0.6, 0.8), "box:3,40,50@-9,-5,3"),)}, {}),
    "deep free": ("deep", {"cutters": ("D4L21F7N3.4x8S7HR8.6L20",), "grid": 4, "tilt": (0.0, 0.4)}, {}),
    # What may be in the way is more than what surely is.
    "open": ("bodies", {"cutters": ("D2.2L12",), "grid": 5, "ignore": "F2", "machine": "tilt:80"}, {"budget": 40, "maps": 40}),
    "bodies": ("bodies", {"cutters": ("D3L18",), "grid": 4, "fixtures": ("box:20,20,9@-3,-4,-9", "cylinder:4,11@19,3,8.1")},
               {"budget": 60, "maps": 30}),
}  # fmt: skip


@pytest.mark.slow(
    "plans, judges or places a part at length; others of its kind run every time", only=("slim", "alone", "setups", "deep free")
)
@pytest.mark.parametrize("name", CASES)
def test_what_the_stages_say_is_kept(name, keeps):
    of, options, asked = CASES[name]
    keeps(name.replace(" ", "_"), told(ready(of, **options), **asked))
