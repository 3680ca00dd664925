"""A part as it stands to be judged: its faces' sides, what is in the way, and the tolerance that can be kept."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Unpack

import numpy as np

from cad_io import Orientation, Part, read_part
from cad_io.arrays import Record, Triangles
from cad_io.part.bodies import orient
from cad_io.part.patterns import repeated_faces, repeats
from cad_io.tessellate.triangles import At
from plan_cutters.domain.checks import flag, number, spelled_out
from plan_cutters.domain.clamping import Clamping
from plan_cutters.domain.fixture import STOCK, Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.posture import Direction, plane_of, unit
from plan_cutters.domain.stock import Stock
from plan_cutters.domain.verdicts import CHORD_REQUESTED
from plan_cutters.errors import OptionError
from plan_cutters.option_table import MOST_TOLERANCE, OF_A_SCENE
from plan_cutters.options import Options, SceneOptions
from plan_cutters.scene.faces import ignored_faces, ignored_words
from plan_cutters.scene.fixtures import FixtureCache, body_near, entered, joined, overlaps, packable, read, refuse_overlaps
from plan_cutters.scene.surroundings import Surroundings, surroundings
from plan_cutters.setups.clamping import Hold, held
from plan_cutters.setups.workpiece import PartMesh, Workpiece, material_bodies, rods_of
from plan_cutters_base.stage_cache import NO_CACHE, Cache

#: The options of a plan that are a scene's.
_DEFAULTS = {word: getattr(Options(), word) for word in OF_A_SCENE}


@dataclass(slots=True)
class _Memory:
    """A scene has read and made this: it is not done twice. `alone` are the surroundings without fixtures."""

    sources: FixtureCache = field(default_factory=dict)
    alone: Surroundings | None = None
    around: Surroundings | None = None
    holds: dict[Any, Hold] = field(default_factory=dict)
    mesh: tuple[Triangles, PartMesh] | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Scene(Record):
    """One part under one setup, which any number of answers may share: `surround` gathers what is in the way, once.

    Attributes
    ----------
    part : Part
    orientation : Orientation
        Which side of each face is out of the material.
    setup : (float, float, float)
        Unit direction of the part along the machine's spindle at zero angles.
    flip : bool
        The other side of open shells and loose faces is machined.
    ignore : tuple of str
        The words for faces that are neither targets nor obstacles.
    ignored : tuple of int
        Their numbers, ascending, and those of `repeated`.
    repeated : mapping of int to int
        Faces of bodies that are there more than once in one place: by number, which face stands for it.
    asked : float
        The gouge tolerance that was requested, mm.
    fixtures : tuple of Fixture
        What holds the part: obstacles, never targets.
    targets : tuple of int
        Faces of which a vise or chuck is to hide as little as it can; empty: of all.
    """

    part: Part
    orientation: Orientation
    setup: tuple[float, float, float]
    flip: bool
    ignore: tuple[str, ...]
    ignored: tuple[int, ...]
    asked: float
    fixtures: tuple[Fixture, ...] = ()
    targets: tuple[int, ...] = ()
    repeated: Mapping[int, int] = field(default_factory=dict)
    _memory: _Memory = field(default_factory=_Memory, init=False, compare=False)

    @classmethod
    @spelled_out(SceneOptions, Options)
    def of(cls, part: Any, **options: Unpack[SceneOptions]) -> "Scene":
        """The scene of a part; of a scene, itself.

        Parameters
        ----------
        part : Scene, Part, path, TopoDS_Shape, CadQuery or build123d object
        **options
            `setup`, `flip`, `ignore`, `tolerance` and `fixtures`, as in `Options`; for a Scene, none but its own, but for
            fixtures: with others it is another scene of the same triangles of the part.

        Raises
        ------
        CadIoError
            The part cannot be read.
        OptionError
            A value has no meaning, or is not that of the Scene.

        Examples
        --------
        >>> scene = Scene.of("samples/v_groove.step", tolerance=0.02)
        >>> scene.surround().tolerance(scene.asked), Scene.of(scene) is scene
        (0.02, True)
        >>> Scene.of(scene, tolerance=0.01)
        Traceback (most recent call last):
        plan_cutters.errors.OptionError: the scene was made with tolerance=0.02: give another one there
        """
        if unknown := sorted(set(options) - set(_DEFAULTS)):
            raise OptionError(f"a scene has no option {unknown[0]}; it has {', '.join(_DEFAULTS)}")
        result: dict[str, Any] = {**_DEFAULTS, **options}
        tolerance, flip = number(result["tolerance"], "tolerance"), flag(result["flip"], "flip")
        if not 0 < tolerance <= MOST_TOLERANCE:
            raise OptionError(f"tolerance {tolerance:g} must lie between 0 and {MOST_TOLERANCE:g} mm")
        if isinstance(result["setup"], Placement) or plane_of(result["setup"]) is not None:
            raise OptionError(
                "a scene keeps the setup axis alone, and a placement or plane says more: give its z here, and itself to plan"
            )
        setup: Any = tuple(unit(result["setup"], "setup axis").tolist())
        fixtures = Fixture.each_of(result["fixtures"])
        if isinstance(part, Scene):
            ignore = ignored_words(part.part, result["ignore"])
            request = {"setup": setup, "flip": flip, "tolerance": tolerance, "ignore": ignore}
            for word in [each for each in options if each != "fixtures"]:
                own = part.options[word]
                if not (np.allclose(own, setup, atol=1e-12) if word == "setup" else own == request[word]):
                    raise OptionError(f"the scene was made with {word}={own!r}: give another one there")
            return part.clamped(fixtures) if "fixtures" in options else part
        whole = part if isinstance(part, Part) else read_part(part)
        words = ignored_words(whole, result["ignore"])
        requested = ignored_faces(whole, words)
        again = repeated_faces(whole, requested)
        ignored, orientation = tuple(sorted({*requested, *again})), orient(whole, towards=setup, flip=flip)
        return cls(whole, orientation, setup, flip, words, ignored, tolerance, fixtures, repeated=again)

    def clamped(self, fixtures: Any) -> "Scene":
        """The same part with other fixtures, given as in `Options`: it is not tessellated again."""
        others = Fixture.each_of(fixtures)
        if others == self.fixtures:
            return self
        return self._sharing(fixtures=others)

    def for_targets(self, targets: Sequence[int]) -> "Scene":
        """The same part, of which other faces are to be machined: a vise or chuck is to hide as little of them as it can."""
        return self if tuple(targets) == self.targets else self._sharing(targets=tuple(targets))

    def _sharing(self, **changes: Any) -> "Scene":
        """The same part with what was read and tessellated of it."""
        scene = replace(self, **changes)
        scene._memory.sources, scene._memory.alone = self._memory.sources, self._memory.alone
        return scene

    @property
    def doubles(self) -> tuple[int, ...]:
        """Ignored faces, ascending, in whose place other faces stand: without them the part is the same."""
        out = set(self.ignored)
        doubled = (each.faces for each in repeats(self.part) if any(out.isdisjoint(faces) for faces in each.faces))
        return tuple(sorted(out.intersection(n for each in doubled for faces in each for n in faces)))

    def turned_faces(self) -> tuple[str, ...]:
        """List the faces whose side is a guess towards the setup axis, and would be the other with the part's own Z as setup."""
        other = orient(self.part, towards=(0.0, 0.0, 1.0), flip=self.flip).sign
        return tuple(f.id for f, one, two in zip(self.part.faces, self.orientation.sign, other, strict=True) if one != two)

    def same_sides(self, setup: tuple[float, float, float]) -> bool:
        """Whether faces have the sides that they would be given with a setup axis."""
        return self.orientation.confident or bool(
            (orient(self.part, towards=setup, flip=self.flip).sign == self.orientation.sign).all()
        )

    @property
    def tolerance(self) -> float:
        """The tolerance that can be kept, mm: `asked`, or what the triangles allow."""
        return self.surround().tolerance(self.asked)

    @property
    def options(self) -> dict[str, Any]:
        """Give the requested values as options of a plan."""
        return {"setup": self.setup, "flip": self.flip, "ignore": self.ignore, "tolerance": self.asked, "fixtures": self.fixtures}

    def __getstate__(self) -> dict[str, Any]:
        # Files of fixtures are read again where they are needed.
        fixtures = tuple(packable(each, self._memory.sources) for each in self.fixtures)
        return self.__dict__ | {"fixtures": fixtures, "_memory": replace(self._memory, sources={}, mesh=None)}

    def read_fixtures(self, timeout: float) -> None:
        """Read the fixtures' files, before any work is done; `timeout`: the most seconds that a faulty one may take."""
        for each in self.fixtures:
            read(each, self._memory.sources, timeout=timeout)

    def _joined(
        self, alone: Surroundings, fixtures: Sequence[Fixture], chord: float, setup: Direction | None = None,
        own: Sequence[Fixture] = (), own_setup: Direction = (0.0, 0.0, 1.0),
    ) -> Surroundings:  # fmt: skip
        """Join surroundings without fixtures with some, as `joined` does, for this setup axis or another one."""
        sources, axis, sign = self._memory.sources, setup or self.setup, self.orientation.sign
        return joined(alone, fixtures, chord, sources, axis, own, own_setup, self.hold, sign)

    def surround(self, at: At = lambda whose, face: None, *, jobs: int = 1, cache: Cache = NO_CACHE) -> Surroundings:
        """Gather the possible and the certain obstacles, unless that was done before.

        While it works, `at` is called with the owner of the work and the face; `jobs` faces are worked on at a time. `cache`
        keeps the triangles of the part.

        Raises
        ------
        FixtureError
            A fixture stands in the part.
        """
        memory, chord = self._memory, CHORD_REQUESTED * self.asked
        if memory.around is None:
            if memory.alone is None:
                memory.alone = cache.cached(
                    "triangles",
                    (self.part.key, chord, self.ignored),
                    lambda: surroundings(self.part, chord, ignored=self.ignored, jobs=jobs, at=at),
                    # What is missing may be so for a limit of time.
                    lambda made: not made.missing,
                ).sharing()
            obstacles = self._joined(memory.alone, self.fixtures, chord)
            refuse_overlaps(obstacles, obstacles.tolerance(self.asked))
            memory.around = obstacles
        return memory.around

    def surround_in(self, setup: tuple[float, float, float], shared: Sequence[Fixture], own: Sequence[Fixture]) -> Surroundings:
        """Gather the obstacles of another setup, with the same triangles of the part; `surround` must have been called.

        Parameters
        ----------
        setup : (float, float, float)
            Unit setup axis, across which the tables of `own` lie; those of `shared` stay where they are in this setup.
        shared, own : sequence of Fixture
            Those that stand in all setups, and those of that setup alone.

        Raises
        ------
        FixtureError
            A fixture stands in the part.
        """
        memory, chord = self._memory, CHORD_REQUESTED * self.asked
        mine = tuple(Fixture.each_of([*shared, *own]))
        alone = memory.alone
        if alone is None or (mine == self.fixtures and not (setup != self.setup and any(f.follows_setup for f in own))):
            return self.surround()
        surroundings = self._joined(alone, mine[: len(shared)], chord, self.setup, mine[len(shared) :], setup)
        refuse_overlaps(surroundings, surroundings.tolerance(self.asked))
        return surroundings

    def turned_to(self, setup: tuple[float, float, float]) -> "Scene":
        """The same part in another setup, the sides of its faces as they are, without fixtures: it is not tessellated again."""
        return self._sharing(setup=setup, fixtures=())

    def surround_held(self, setup: tuple[float, float, float], held: Fixture, stock: Stock | None = None) -> Surroundings:
        """Gather the obstacles where the part stands on a table across a setup axis, or in a vise or chuck, and nothing else
        holds it; or where its stock does so.

        The table touches the part at its lowest point, and a vise or chuck where it grips: nothing is to be refused.

        Raises
        ------
        FixtureError
            The vise or chuck has nothing to grip.
        """
        memory, chord = self._memory, CHORD_REQUESTED * self.asked
        if memory.alone is None:
            memory.alone = surroundings(self.part, chord, ignored=self.ignored)
        blank = [] if stock is None else [Fixture(f"{STOCK}:{stock.text}")]
        return self._joined(memory.alone, Fixture.each_of([*blank, held]), chord, setup)

    def hold(self, fixture: Fixture, setup: Sequence[float]) -> Hold:
        """Place a vise or chuck for a unit setup axis; `surround` must have been called.

        Raises
        ------
        FixtureError
            It has nothing to grip.
        """
        memory = self._memory
        key = (fixture, tuple(setup), self.targets)
        if key not in memory.holds:
            alone = memory.alone
            assert alone is not None, "a part is tessellated before it is clamped"
            triangles, tolerance = alone.certain.triangles, alone.tolerance(self.asked)
            planes = [face.number for face in self.part.faces if face.shape == "plane"]
            bodies = material_bodies(alone.bodies, self.orientation.sign)
            piece = Workpiece.of(self.mesh(triangles), planes, self.targets, tuple(setup), bodies, rods=rods_of(self.part.faces))
            chord = CHORD_REQUESTED * self.asked

            def plainly(placed: Fixture, clamping: Clamping) -> bool:
                # What the full search would find as well, for most places where the part is in the way, at once.
                return entered(alone.certain, placed, clamping, tolerance + triangles.chord_error)

            def searched(placed: Fixture, clamping: Clamping) -> bool:
                return overlaps(alone.certain, body_near(clamping, placed, chord, alone.certain), tolerance)

            memory.holds[key] = held(fixture, piece, plainly, searched, triangles.chord_error)
        return memory.holds[key]

    def mesh(self, triangles: Triangles) -> PartMesh:
        """The part as it is clamped, of its triangles, which may have others among them; of those that came last it is kept."""
        memory = self._memory
        if memory.mesh is None or memory.mesh[0] is not triangles:
            own = triangles.take(triangles.face > 0) if (triangles.face <= 0).any() else triangles
            memory.mesh = triangles, PartMesh.of(own.vertex, own.face, self.orientation.sign)
        return memory.mesh[1]

    def surround_closer(self, chord: float) -> Surroundings:
        """The same, with triangles for another chord error, mm, which are not kept."""
        alone, memory = surroundings(self.part, chord, ignored=self.ignored), self._memory
        # A vise stays where it is, however close triangles are.
        memory.alone = alone if memory.alone is None else memory.alone
        return self._joined(alone, self.fixtures, chord)
