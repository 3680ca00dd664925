"""Gather the possible and the certain obstacles: everything that stands around the faces to machine."""

from collections.abc import Collection, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from cad_io import Part
from cad_io.arrays import Floats, LostFace, Record, Triangles, rows_by_face
from cad_io.part.bodies import Body, bodies
from cad_io.part.part import CROSSES, face_box
from cad_io.read.mesh import Mesh
from cad_io.tessellate import tessellate
from cad_io.tessellate.proxies import StandIn, StandIns, boxed, stand_ins
from cad_io.tessellate.triangles import At
from plan_cutters.domain.figures import ranges
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.verdicts import effective_tolerance
from plan_cutters.errors import UnjudgeableError
from plan_cutters.scene.obstacles import Obstacles, weights
from plan_cutters.scene.triangles import thickened
from plan_cutters.setups.clamping import Hold
from plan_cutters_base.stage_cache import NO_CACHE, Cache

#: Triangles of a loose face that are looked at to tell whether it lies on a body, about.
_LOOKED_AT = 50


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PlacedFixture(Record):
    """A fixture where it stands."""

    number: int  #: Face number of all its triangles, negative.
    fixture: Fixture
    source: Part | Mesh | None  #: What was read of it; None for words.
    obstacles: Obstacles  #: Its own, in part coordinates.
    body: Body | None  #: That it surely encloses something.
    #: Faces of it that stand in the way only as a guess, with the reason and what stands in for each.
    missing: tuple[tuple[str, str, StandIn], ...]
    notes: tuple[str, ...]  #: What the plan must say of it.
    shown: Floats  #: (n, 3, 3) float: triangles to draw of it, mm.
    requested: Fixture | None = None  #: What was requested where it was placed for the setup; None: `fixture` itself.
    hold: Hold | None = None  #: What it grips, where it was placed for the setup.
    unheld: tuple[int, ...] = ()  #: Of a vise or chuck: bodies of the part that its jaws do not hold, each by its first face.

    @property
    def name(self) -> str:
        """As obstacles are called in plans."""
        return f"fixture:{self.fixture.name}"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Surroundings(Record):
    """The surroundings hold the possible and the certain obstacles of a part in one setup."""

    possible: Obstacles  #: Everything that may be in the way: a posture that misses it is safe.
    #: Everything that is surely in the way: a posture that hits it is blocked. The same object where nothing is uncertain.
    certain: Obstacles
    #: Bodies that enclose a volume, made of the faces that are not ignored; for an open shell the volume is a guess.
    bodies: tuple[Body, ...]
    #: Faces that stand in the way only as a guess, with the reason and the proxy geometry of each: its own `triangles`, a `box`,
    #: or `none` where its place is not known.
    missing: tuple[tuple[int, str, StandIn], ...]
    on_bodies: tuple[int, ...] = ()  #: Faces of no body that lie on the faces of one, as construction geometry does.
    #: Faces of the file that the part does not have; those it has in another form are in `missing`.
    lost: tuple[LostFace, ...] = ()
    fixtures: tuple[PlacedFixture, ...] = ()  #: Fixtures that stand among the obstacles; nothing else here is about them.
    alone: "Surroundings | None" = None  #: The part's own, without the fixtures; None where there are none.

    @property
    def doubtful(self) -> bool:
        """Whether something that may be in the way is not known well enough to call any posture safe beyond doubt."""
        return bool(self.doubts)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Name the obstacles that are missing or only guessed, with the reasons."""
        return (
            *(f"F{number}: {why}" for number, why, _ in self.missing),
            *map(str, self.lost),
            *(f"{each.name} {face}: {why}" for each in self.fixtures for face, why, _ in each.missing),
        )

    @property
    def loose(self) -> dict[int, float]:
        """Faces that triangles do not follow closely, with the bound of the distance between them, mm: there the surface may be
        anywhere within it. All else is judged as if it were not so."""
        return dict(self.certain.triangles.loose)

    @property
    def enclosing(self) -> tuple[Body, ...]:
        """List the bodies that enclose a volume: those of the part, then those of fixtures."""
        return (*self.bodies, *(each.body for each in self.fixtures if each.body is not None))

    def tolerance(self, requested: float) -> float:
        """Give the gouge tolerance that is kept, mm (`tolerance.effective_tolerance`)."""
        return effective_tolerance(requested, self.certain.triangles.chord_error)

    def called(self, face: int) -> str:
        """The name of a face number: `F12`, or `fixture:vise`."""
        return f"F{face}" if face >= 0 else self.fixtures[-face - 1].name

    @classmethod
    def sheet(cls, obstacles: Obstacles) -> "Surroundings":
        """Obstacles that are surely in the way and enclose nothing."""
        return cls(obstacles, obstacles, (), ())

    def sharing(self) -> "Surroundings":
        """The same, with one tree of the triangles that may be and that surely are in the way."""
        if self.possible is not self.certain:
            self.possible.among(self.certain)
        return self

    def build(self, jobs: int, cache: Cache = NO_CACHE) -> None:
        """Build the trees of what may be and of what surely is in the way, where they are not one, side by side."""
        # Those of the part alone, which both share, first.
        (self.alone or self).certain.build(cache)
        with ThreadPoolExecutor(min(jobs, 2)) as pool:
            for _ in pool.map(lambda each: each.build(cache), {id(o): o for o in (self.possible, self.certain)}.values()):
                pass

    @property
    def skins(self) -> "Surroundings":
        """The same without what is enclosed."""
        return replace(self, possible=self.possible.skin, certain=self.certain.skin)


def surroundings(
    part: Part, chord: float, *, ignored: Collection[int] = (), jobs: int = 1, at: At = lambda who, face: None
) -> Surroundings:
    """Gather all that stands in a cutter's way.

    Raises UnjudgeableError: no face has triangles.

    `chord`: chord error to ask for, mm. `ignored`: numbers of faces to leave out. `jobs`: faces that are worked on at a time.
    `at`: told whose work is under way and at which face, as in `tessellate`.
    """
    faces = [f.number for f in part.faces if f.number not in ignored]
    triangles = tessellate(part, chord, faces=faces, jobs=jobs, at=at)
    if not len(triangles):
        causes = "; ".join(sorted({why for _, why in triangles.missing}))
        turned = [f.number for f in part.faces if f.unjudged == CROSSES and f.number not in ignored]
        if turned:
            which = f"{ranges(turned)} {CROSSES}"
            remedy = "STEP makes such faces larger than they were, so give the shape in Python or as BREP"
            raise UnjudgeableError(f"{which}, and no other face is left: {remedy}", file=part.file)
        raise UnjudgeableError(f"no face can be read: {causes}" if causes else "all faces are left out", file=part.file)
    result = bodies(part, without=ignored)
    loose = dict(triangles.loose)
    close = triangles.without(loose)
    # A skin without its loose faces has holes: what it encloses is then a guess.
    sure = [b for b in result if b.closed and loose.keys().isdisjoint(b.faces)]
    certain = Obstacles(close, weights(close, sure), gap=part.looseness)
    stand = stand_ins(part, triangles.missing, chord)
    missing = tuple((n, why, stand.how[n]) for n, why in triangles.missing if stand.how[n] != "edges")
    unread = tuple(each for each in part.lost if each.face is None)
    possible = _possible(part, triangles, stand, result, certain)
    if possible is not certain:
        # What is the same is there once.
        certain = replace(certain, triangles=replace(close, vertex=possible.triangles.vertex[: len(close)]))
    return Surroundings(possible, certain, result, missing, _on_bodies(certain, result), unread).sharing()


def _possible(part: Part, triangles: Triangles, stand: StandIns, result: Sequence[Body], certain: Obstacles) -> Obstacles:
    """Everything that may be in the way: the certain obstacles themselves where nothing is guessed."""
    loose, everything = dict(triangles.loose), weights(triangles, result)
    caps = np.concatenate([np.zeros((0, 3, 3)), *(body.cap for body in result)])
    if not len(stand.vertex) and not len(caps) and not loose and (everything == certain.weight).all():
        return certain
    # A surface that triangles do not follow closely may be anywhere within their error, and is for certain nowhere.
    rows = rows_by_face(triangles.face)
    shells = [(n, _shell(part, n, triangles.vertex[rows.get(n, [])], error)) for n, error in loose.items()]
    shell = np.concatenate([np.zeros((0, 3, 3)), *(made for _, made in shells)])
    of_shell = np.repeat(np.array([n for n, _ in shells], np.int32), [len(made) for _, made in shells])
    # Those that are certain come first.
    order = np.argsort(np.isin(triangles.face, list(loose)), kind="stable") if loose else slice(None)
    all_triangles = replace(
        triangles,
        vertex=np.concatenate([triangles.vertex[order], stand.vertex, caps, shell]),
        face=np.concatenate([triangles.face[order], stand.face, np.zeros(len(caps), np.int32), of_shell]),
    )
    open_boxes = [_box(triangles, body) for body in result if not body.closed]
    filled = np.ones(len(caps) + len(shell), np.int8)
    return Obstacles(
        all_triangles,
        np.concatenate([everything[order], stand.weight, filled]),
        np.array([box for box in open_boxes if np.isfinite(box).all()]).reshape(-1, 2, 3),
        part.looseness,
        first=len(certain.triangles),
    )


def _shell(part: Part, number: int, vertex: Floats, error: float) -> Floats:
    """Triangles (t, 3, 3) of skins that enclose a face, which is within an error of triangles: at the most the box around it."""
    low, high = face_box(part.face(number), tight=False)
    if np.isfinite([low, high]).all() and error > 0.5 * float((high - low).max()):
        return boxed(low, high)
    return thickened(vertex, error)


def _on_bodies(certain: Obstacles, bodies: Sequence[Body]) -> tuple[int, ...]:
    """Numbers of faces of no body, most of whose triangles' middles lie on the skin of one."""
    from plan_cutters.kernels.material import near_shell

    triangles = certain.triangles
    own = {number for body in bodies for number in body.faces}
    if not certain.weight.any():
        return ()
    close = 2.0 * triangles.chord_error + 1e-9 * float(np.abs(triangles.vertex).max())
    lying = []
    for number, rows in rows_by_face(triangles.face).items():
        if number in own:
            continue
        middle = triangles.vertex[rows].mean(axis=1)
        middle = np.ascontiguousarray(middle[:: 1 + len(middle) // _LOOKED_AT])
        near = np.zeros(len(middle), bool)
        near_shell(middle, close, certain.solids, near)
        if near.mean() > 0.5:
            lying.append(number)
    return tuple(lying)


def _box(triangles: Triangles, body: Body) -> Floats:
    """Corners (2, 3) of the box around a body's triangles, infinite if it has none."""
    mine = triangles.vertex[np.isin(triangles.face, body.faces)]
    return np.array([mine.min(axis=(0, 1), initial=np.inf), mine.max(axis=(0, 1), initial=-np.inf)])
