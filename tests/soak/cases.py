"""What is drawn: parts, tools, machines, setups, fixtures and options, each of plain words that can be pasted into a test."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from hypothesis import strategies as st
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps

from cad_io.errors import CadIoError
from plan_cutters import Axis, CutterError, Machine, MachineError, PlanError, Scene, plan
from plan_cutters.domain.placement import Placement, frame_of
from tests.soak.solids import Body, Material, angles_of
from tests.soak.truth import Truth
from tests.support.tool_reference import KINDS, random_cutter

Sign = int


class VoidError(Exception):
    """A case that says nothing: the kernel could not make the part, or the program refuses it with a reason."""


@dataclass(frozen=True)
class Part:
    """Bodies that are added (1) and cut out (-1), one after the other; `sheet`: the surface of a field alone."""

    steps: tuple[tuple[Sign, Body], ...]
    sheet: bool = False

    @cached_property
    def material(self):
        return Material(self.steps, sheet=self.sheet)

    @cached_property
    def shape(self):
        """As the kernel makes it.

        Raises
        ------
        VoidError
            The kernel makes something else of it than the formulas.
        """
        try:
            made = self.material.shape()
            right = BRepCheck_Analyzer(made).IsValid() and self._area(made)
        except Exception as error:
            raise VoidError(f"the kernel cannot make the part ({type(error).__name__})") from None
        if not right:
            raise VoidError("the kernel makes something else of the part")
        return made

    def _area(self, made):
        found = GProp_GProps()
        BRepGProp.SurfaceProperties_s(made, found, 1e-4)
        expected = float(self.material.skin(0.8).area.sum())  # nothing is left of some parts
        return expected > 1.0 and abs(found.Mass() - expected) < 0.02 * expected + 2.0


@dataclass(frozen=True)
class Tool:
    """A cutter of a kind by the number that its sizes are drawn with, `bare` without anything above its flutes."""

    kind: str
    number: int = 0
    bare: bool = True
    loose: bool = False

    @cached_property
    def cutter(self):
        made = random_cutter(np.random.default_rng(self.number), self.kind, bare=self.bare, loose=self.loose)
        return made


@dataclass(frozen=True)
class Turn:
    """A rotary axis: what it carries, its direction, its limits, degrees."""

    carries: str
    direction: tuple[float, float, float]
    limits: tuple[float, float] | None = None


@dataclass(frozen=True)
class Mill:
    """A machine: a limit of the tilt from the setup axis, degrees, or up to two rotary axes, or `fixed`: three axes."""

    tilt: float | None = None
    turns: tuple[Turn, ...] = ()
    fixed: bool = False

    @cached_property
    def machine(self):
        if self.tilt is not None:
            return Machine("tilted", math.radians(self.tilt))
        axes = [Axis.rotary(name, each.carries, each.direction, limits_deg=each.limits)
                for name, each in zip("CA", self.turns, strict=False)]  # fmt: skip
        return Machine("mill", axes=axes, fixed=self.fixed)


@dataclass(frozen=True)
class Setting:
    """A part, a tool and how the question is asked.

    `setup` and `x` are directions of the part along the machine's Z and X; `fixtures` are bodies, and `table` a table right below
    the part. `rotations` are counted from 0 in steps, degrees, `tolerance` in mm, `grid` samples along each side of a face.
    """

    part: Part
    tool: Tool
    mill: Mill = Mill()
    setup: tuple[float, float, float] = (0.0, 0.0, 1.0)
    x: tuple[float, float, float] | None = None
    fixtures: tuple[Body, ...] = ()
    table: bool = False
    tolerance: float = 0.05
    grid: int = 4
    step: float = 30.0
    tilt: tuple[float, float] | None = None

    @property
    def frame(self):
        return frame_of(np.array(Placement(self.setup).z), None if self.x is None else np.array(Placement(self.setup, self.x).x))

    @property
    def words(self):
        """Fixtures as the program takes them."""
        made = [f"{'cylinder' if each.kind == 'rod' else each.kind}:{','.join(map(repr, each.sizes))}"
                f"@{','.join(map(repr, (*each.at, *each.turn)))}" for each in self.fixtures]  # fmt: skip
        return [*made, *(["table"] if self.table else [])]

    @property
    def options(self):
        """As `plan` takes them."""
        made = {"cutters": [self.tool.cutter], "machine": self.mill.machine, "setup": self.setup, "fixtures": self.words,
                "faces": "all", "grid": self.grid, "rotation_step_deg": self.step, "tolerance": self.tolerance,
                "area_budget": 0, "jobs": 1}  # fmt: skip
        if self.x is not None:
            made["setup"] = Placement(self.setup, self.x)
        return made | ({} if self.tilt is None else {"tilt_deg": self.tilt})

    def planned(self, **more):
        """The plan of it.

        Raises
        ------
        VoidError
            The program refuses it with a reason: fixtures within the part, tools too small for the tolerance.
        """
        return refused(lambda: plan(self.part.shape, **{**self.options, **more}))

    def scene(self):
        return refused(lambda: Scene.of(self.part.shape, setup=self.setup, tolerance=self.tolerance, fixtures=self.words))

    def truth(self):
        """The exact surfaces and the exact tool."""
        bodies = [self.part.material, *(Material([(1, each)]) for each in self.fixtures)]
        if self.table:
            bodies.append(Material([(1, self._table())]))
        return Truth(bodies, self.tool.cutter)

    def _table(self):
        """A large block right below the part, a hair lower: the lowest point of the skin is known to the points on it alone."""
        z = np.array(Placement(self.setup).z)
        frame, skin = frame_of(z), self.part.material.edged(160)
        low, middle = float((skin @ z).min()) - 0.02, frame @ skin.mean(axis=0)
        corner = frame.T @ np.array([middle[0] - 200, middle[1] - 200, low - 200])
        return Body("box", (400.0, 400.0, 200.0), angles_of(frame.T), tuple(corner.tolist()))

    def but(self, **changes):
        return replace(self, **changes)


def refused(work):
    """What work gives; a case is void where the program refuses it with a reason."""
    try:
        return work()
    except (CadIoError, PlanError, CutterError, MachineError) as error:
        raise VoidError(f"{type(error).__name__}: {error}") from None


# Strategies. Numbers are short, so that what is left of a case can be read; odd shares keep planes apart that would coincide.


def lengths(low, high):
    return st.integers(int(4 * low), int(4 * high)).map(lambda k: k / 4 + 0.0)


ANGLES = st.integers(-180, 180).map(float)
TURNS = st.one_of(st.just((0.0, 0.0, 0.0)), st.tuples(ANGLES, ANGLES, ANGLES))
WAYS = st.one_of(
    st.sampled_from([(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)]),
    st.tuples(*[st.integers(-4, 4).map(float)] * 3).filter(any),
)


@st.composite
def bodies(draw, around, kinds=("box", "rod", "ball", "cone", "ring")):
    """A body of up to a third of the size of what it is put at."""
    kind = draw(st.sampled_from(kinds))
    size = {
        "box": st.tuples(lengths(3, 20), lengths(3, 20), lengths(3, 20)),
        "rod": st.tuples(lengths(1.5, 9), lengths(4, 40)),
        "cone": st.tuples(lengths(3, 10), lengths(1, 2.75), lengths(4, 25)),
        "ball": st.tuples(lengths(2, 11)),
        "ring": st.tuples(lengths(6, 12), lengths(1, 4)),
    }[kind]
    odd = draw(st.integers(1, 9)) * 0.0137
    at = tuple(draw(lengths(-3, side + 3)) + odd * (k + 1) for k, side in enumerate(around))
    return Body(kind, draw(size), draw(TURNS), at)


@st.composite
def parts(draw, most=3, *, one_way=False):
    """A block, a block under a free-form surface, or that surface alone, with bodies added and cut out."""
    if draw(st.integers(0, 3)) == 3:
        sheet = draw(st.booleans())
        field = Body("field", (draw(st.sampled_from([30.0, 40.0])), draw(st.sampled_from([2.0, 5.0, 9.0])), 30.0,
                               float(draw(st.integers(0, 9999)))))  # fmt: skip
        if sheet:
            return Part(((1, field),), sheet=True)
        base, around = field, (field.sizes[0], field.sizes[0], 10.0)
    else:
        around = draw(st.tuples(lengths(12, 40), lengths(12, 40), lengths(8, 30)))
        base = Body("box", around)
    sign = draw(st.sampled_from([-1, 1]))
    more = draw(st.lists(st.tuples(st.just(sign) if one_way else st.sampled_from([-1, -1, 1]), bodies(around)), max_size=most))
    return Part(((1, base), *more))


def tools(kinds=KINDS, **fixed):
    return st.builds(
        Tool, st.sampled_from(kinds), st.integers(0, 9999), **{"bare": st.booleans(), "loose": st.booleans(), **fixed}
    )


SPANS = st.one_of(st.none(), st.tuples(st.integers(-180, 0).map(float), st.integers(0, 180).map(float)), st.just((-20.0, 110.0)))


@st.composite
def mills(draw):
    """No limit, a limit of the tilt, three axes, or one or two rotary axes that carry the part or the tool."""
    kind = draw(st.sampled_from(["free", "tilt", "fixed", "one", "two", "two"]))
    if kind == "tilt":
        return Mill(tilt=float(draw(st.integers(0, 120))))
    if kind in ("free", "fixed"):
        return Mill(fixed=kind == "fixed")
    carried = draw(st.sampled_from([("part", "part"), ("part", "tool"), ("tool", "tool")]))
    first = draw(st.sampled_from([(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]))
    second = draw(
        st.sampled_from([(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 1.0, 1.0), (1.0, 1.0, 1.0)]).filter(lambda d: d != first)
    )
    if kind == "one":
        return Mill(turns=(Turn(carried[0], second, draw(SPANS)),))
    return Mill(turns=(Turn(carried[0], first, draw(SPANS)), Turn(carried[1], second, draw(SPANS))))


@st.composite
def fixtures(draw, part):
    """Boxes and cylinders beside, over and under a part: those that stand in it are refused by the program."""
    size = part.steps[0][1].sizes[:3] if part.steps[0][1].kind == "box" else (part.steps[0][1].sizes[0],) * 2 + (10.0,)
    found = []
    for _ in range(draw(st.integers(0, 2))):
        body = draw(bodies(size, ("box", "rod")))
        way, gap = draw(st.integers(0, 2)), draw(lengths(0.5, 8))
        far = draw(st.booleans())
        at = list(body.at)
        at[way] = size[way] + gap if far else -gap - 20.0
        found.append(replace(body, at=tuple(at), turn=(0.0, 0.0, draw(ANGLES)) if way == 2 else (0.0, 0.0, 0.0)))
    return tuple(found)


@st.composite
def settings(draw, part=None, tool=None, mill=None, held=True):
    """A whole question."""
    part = draw(parts() if part is None else part)
    around = draw(fixtures(part)) if held and not part.sheet else ()
    return Setting(
        part, draw(tools() if tool is None else tool), draw(mills() if mill is None else mill),
        setup=draw(WAYS), fixtures=around, table=held and not part.sheet and draw(st.integers(0, 3)) == 3,
        tolerance=draw(st.sampled_from([0.05, 0.02, 0.1, 0.2])), grid=draw(st.integers(3, 5)),
        step=float(draw(st.sampled_from([45, 30, 20, 10]))),
    )  # fmt: skip
