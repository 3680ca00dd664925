"""A plan with the arrays behind it."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from cad_io import Part
from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.document.build import counts
from plan_cutters.document.process import OverSetups
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import Kinematics, positions
from plan_cutters.domain.posture import PostureRange
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import DRILLED, NO_REASON, REASONS, UNJUDGED, WORDS, Verdicts
from plan_cutters.errors import OptionError
from plan_cutters.judging.posture_maps import PostureMaps
from plan_cutters.outcome import Answers, Operations
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan, WitnessEntry, nearest
from plan_cutters.plan_file.shares import VerdictCounts
from plan_cutters.plan_file.words.names import called
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.distances import Clearances, clearances_over
from plan_cutters.scene.faces import face_numbers
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.scene import Scene

if TYPE_CHECKING:
    from pandas import DataFrame


@dataclass(frozen=True, slots=True)
class OnFace:
    """The results of one cutter on one face: its verdicts, the reasons, the worst place and the least stick-out.

    Attributes
    ----------
    id, name, component : str
        Of the face: `F12`, its name in the file, the component that it belongs to.
    target : bool
    cutter : str
        Id of the cutter that this is about.
    area : float
        Of the face, mm2.
    samples : int
    verdicts : Verdicts
        Counts of samples.
    shares : dict
        Verdict -> share of the face's area, 0 to 1; those that occur. Each sample stands for its own share of the area; what
        lies inside other bodies of the part does not count.
    reasons : dict
        Reason -> share of the face's area that is not reached for it, the largest first.
    worst : WitnessEntry, optional
        Of the samples not reached that the plan looked at more closely, the one with the deepest collision; None where all is
        reached.
    least_stick_out : float, optional
        With which the cutter in its holder still reaches all that it reaches of this face, mm; None: `why_no_stick_out`.
    why_no_stick_out : str
        Empty where it is known.
    doubtful : bool
        Obstacles are missing, which might be in the way of more.
    why_unjudged : str
        Why the face, or some of its samples, has no verdict; else empty.
    """

    id: str
    name: str
    component: str
    target: bool
    cutter: str
    area: float
    samples: int
    verdicts: VerdictCounts
    shares: dict[str, float] = field(default_factory=dict)
    reasons: dict[str, float] = field(default_factory=dict)
    worst: WitnessEntry | None = None
    least_stick_out: float | None = None
    why_no_stick_out: str = ""
    doubtful: bool = False
    why_unjudged: str = ""

    @property
    def number(self) -> int:
        return int(self.id[1:])

    @property
    def reached(self) -> float | None:
        """Share of the face's area that is reached, 0 to 1; None where the face was not sampled."""
        if not self.shares:
            return None
        shares = [share for word, share in self.shares.items() if word in ("interference_free", "accessible")]
        # Rounding must not make a little less of all, nor more.
        return 1.0 if len(shares) == len(self.shares) else min(1.0, sum(shares))

    @property
    def reason(self) -> str | None:
        """The reason for most of what is not reached; None where all is reached."""
        return next(iter(self.reasons), None)


def on_face(
    entry: FaceEntry, cutter: CutterEntry, samples: SurfaceSamples, reach: Verdicts, stick_out: StickOut | None,
    *, doubtful: bool, inside: NDArray[np.bool_],
) -> OnFace:  # fmt: skip
    """Gather the results of a cutter on a face; `stick_out`: the answer for all samples, or for those of this face alone.

    `inside` (n,): samples that are no surface of the finished part. Those in holes for drills count no more than these.
    """
    whole_face = samples.face == int(entry.id[1:])
    verdicts = counts(reach.verdict[whole_face], inside[whole_face])
    mine = whole_face & ~inside & (reach.verdict != DRILLED)
    area, verdict = samples.area[mine], reach.verdict[mine]
    shares, reasons, whole = {}, {}, float(area.sum())
    if whole > 0.0:
        shares = {WORDS[code]: float(area[verdict == code].sum()) / whole for code in np.unique(verdict).tolist()}
        why = reach.reason[mine]
        not_reached = {REASONS[code]: float(area[why == code].sum()) / whole for code in np.unique(why[why != NO_REASON])}
        reasons = dict(sorted(not_reached.items(), key=lambda each: (-each[1], each[0])))
    deepest = [w for w in cutter.witnesses if w.face == entry.id and not w.inside_bodies]
    least, unknown = _least(entry, mine, reach, stick_out)
    unjudged = "" if entry.target else "it is a check face: not judged, an obstacle only"
    unjudged = "it is ignored: neither a target nor an obstacle" if entry.ignored else unjudged or entry.unjudged or ""
    return OnFace(
        entry.id, entry.name, entry.component, entry.target, cutter.id, entry.area_mm2, int(whole_face.sum()),
        VerdictCounts(**verdicts), shares, reasons, max(deepest, key=lambda w: w.depth_mm or 0.0, default=None), least, unknown,
        doubtful, unjudged,
    )  # fmt: skip


def _least(entry: FaceEntry, mine: NDArray[np.bool_], reach: Verdicts, stick_out: StickOut | None) -> tuple[float | None, str]:
    """The least stick-out for the face, or why it is not known."""
    if not mine.any():
        return None, "the face has no samples"
    if not (reach.reached & mine).any():
        return None, f"the cutter reaches nothing of {entry.id}"
    if stick_out is None:
        return None, "it was not requested: give stick_out=True here"
    if stick_out.why == "no holder":
        return None, "the cutter has no holder"
    return float(stick_out.least), ""


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """A plan with the arrays behind it.

    Attributes
    ----------
    plan : Plan
        What is written as `plan.json`.
    ready : Prepared
        The scene and the samples that the cutters were judged on: for further questions.
    over_setups : OverSetups
        The verdicts of all cutters.
    travels : dict
        Cutter id -> Travel: where the linear axes stand; empty where that is not judged.
    answers : Answers
        The answers that were requested after the plan: `stick_outs`, `radius_maps`, `mends`.
    maps : PostureMaps, optional
        Every free tilt, for the cutter `shown`, where that was requested.
    """

    plan: Plan
    ready: Prepared
    over_setups: OverSetups
    travels: dict[str, Travel]
    answers: Answers
    maps: PostureMaps | None = None

    def __getstate__(self) -> dict[str, Any]:
        # Options may hold objects of a CAD host: words and numbers stand for them.
        options, chosen = self.ready.options, self.ready.chosen
        plain = replace(options, faces=chosen.asked, ignore=chosen.ignore, fixtures=())
        return self.__dict__ | {"ready": replace(self.ready, options=plain)}

    def __repr__(self) -> str:
        return f"Result({self.part!r}, {len(self.samples)} samples, {len(self.cutters)} cutters, selected {self.selected})"

    def __str__(self) -> str:
        return self.plan.text.headline if self.plan.text else repr(self)

    @property
    def names(self) -> dict[str, str]:
        """How the summary calls each cutter, by its id: by its own name where it has one."""
        return {each.id: called(each) for each in self.cutters}

    @property
    def scene(self) -> Scene:
        """The part, its sides and its fixtures: `posture_map` takes it, and so does another `plan`."""
        return self.ready.scene

    @property
    def part(self) -> Part:
        return self.scene.part

    @property
    def samples(self) -> SurfaceSamples:
        """Samples of the target faces."""
        return self.ready.samples

    @property
    def surface_class(self) -> NDArray[np.uint8]:
        """Class (n,) of the surface at each sample."""
        return self.ready.surface_class

    @property
    def postures(self) -> PostureRange:
        """Tilts and rotations that were searched."""
        return self.ready.options.postures

    @cached_property
    def kinematics(self) -> Kinematics | None:
        """The machine's rotary axes in the part's frame; None where any tool axis within a plain limit is possible."""
        return self.conditions.kinematics

    @property
    def conditions(self) -> Conditions:
        """All cutters were judged under these conditions."""
        return self.ready.conditions

    @property
    def reaches(self) -> dict[str, Verdicts]:
        """Verdicts by cutter id: over all setups, with the posture of the first one that reaches a sample."""
        return self.over_setups.reaches

    @property
    def here(self) -> dict[str, Verdicts]:
        """Verdicts by cutter id, in the first setup alone."""
        return self.over_setups.each[0][1]

    @property
    def elsewhere(self) -> tuple[tuple[tuple[float, float, float], dict[str, Verdicts]], ...]:
        """The axis of each other setup, and the verdicts there by cutter id."""
        return self.over_setups.each[1:]

    @property
    def served_in(self) -> dict[str, Ints]:
        """The setup (n,) whose posture a sample has, by cutter id: counted from 0 as in `plan.cutters[].setups`, -1 for none.

        It is empty where there is one setup.
        """
        return self.over_setups.served_in if len(self.over_setups.each) > 1 else {}

    @property
    def cutters(self) -> list[CutterEntry]:
        """One entry a cutter, from the most wanted down."""
        return self.plan.cutters

    @property
    def selected(self) -> str | None:
        """Id of the cutter to take, or None."""
        return self.plan.selected

    @property
    def shown(self) -> str:
        """Id of the cutter that the models show: the selected, else the one that leaves the least area."""
        return self.selected or nearest(self.cutters).id

    @cached_property
    def clearances(self) -> Clearances:
        """How far the cutter `shown` keeps from everything at the postures found, where it does not cut."""
        return self.clearances_of(self.shown)

    def clearances_of(self, cutter: str) -> Clearances:
        """The same for a cutter, by its id."""
        return clearances_over(
            self.samples, self.judged(cutter), self.reaches[cutter], self.ready.setups, self.served_in.get(cutter)
        )

    @property
    def inside_bodies(self) -> NDArray[np.bool_]:
        """Samples (n,) inside other bodies of the part: no surface of the finished part."""
        return self.ready.inside_bodies

    @property
    def exempt(self) -> NDArray[np.bool_] | None:
        """Samples (n,) at sharp inside edges that are not required; None where all are."""
        return self.ready.exempt

    def rotary(self, cutter: str) -> tuple[Floats, NDArray[np.int8]]:
        """Positions of the rotary axes at the postures of a cutter, rad, both solutions, and which of them is to be taken.

        Each in the setup that serves its sample; arrays as `Kinematics.positions` gives them, (n, 2, axes) and (n,), and where
        linear travel is judged as that takes them.

        Raises
        ------
        ValueError
            The machine has no rotary axes (`kinematics` is None).
        """
        if self.kinematics is None:
            raise ValueError("rotary positions need a machine of rotary axes")
        axis = self.reaches[cutter].axis
        which = self.served_in.get(cutter, np.zeros(len(axis), np.int32))
        angles, taken, _ = positions([each.kinematics for each in self.ready.setups], axis, which)
        if cutter in self.travels:
            taken = np.where(which > 0, taken, self.travels[cutter].taken)
        return angles, taken

    @property
    def operations(self) -> Operations | None:
        """The plan of operations; None where none was requested."""
        return self.answers.operations

    def judged(self, cutter: str | None = None) -> Cutter:
        """The cutter of an id as it was judged, holder and all; default the one `shown`.

        Raises
        ------
        OptionError
            No cutter of the plan is called so.
        """
        wanted = self.shown if cutter is None else cutter
        match = next((each for each in self.ready.cutters if each.id == wanted), None)
        if match is None:
            raise OptionError(f"cutter {wanted!r} is none of this plan's: {', '.join(c.id for c in self.cutters)}")
        return match

    def face(self, which: Any, cutter: str | None = None, *, stick_out: bool = False) -> OnFace:
        """Tell how much of one face a cutter reaches, why not the rest, and where the worst place is.

        Parameters
        ----------
        which : int, str or object
            A number, `F12`, the face's name, or a face of the kernel, CadQuery or build123d.
        cutter : str, optional
            Id; default the one `shown`.
        stick_out : bool
            Look for the least stick-out for this face, too, where it was not requested with the plan.

        Raises
        ------
        OptionError
            It is no face of the part, or more than one.

        Examples
        --------
        >>> from plan_cutters import plan
        >>> result = plan("samples/v_groove.step", cutters=["R6L80", "R2L30"], grid=9, area_budget=0)
        >>> result.face("F1", "R6L80").reached
        1.0
        """
        numbers = face_numbers(self.part, which)
        if len(numbers) != 1:
            raise OptionError(
                f"{len(numbers)} faces were given, {', '.join(f'F{n}' for n in numbers[:5])}: ask for one, or use faces(...)"
            )
        return self._on_face(numbers[0], cutter, stick_out)

    def faces(self, which: Any = None, cutter: str | None = None, *, stick_out: bool = False) -> tuple[OnFace, ...]:
        """The same for several faces; default all targets.

        `which` is given in the words of `Options.faces`, as numbers, or as objects of the kernel or a CAD host.
        """
        numbers = self.ready.chosen.targets if which is None else face_numbers(self.part, which)
        return tuple(self._on_face(number, cutter, stick_out) for number in numbers)

    def _on_face(self, number: int, cutter: str | None, stick_out: bool) -> OnFace:
        tool = self.judged(cutter)
        entry = next(each for each in self.cutters if each.id == tool.id)
        verdicts, known = self.reaches[tool.id], self.answers.stick_outs.get(tool.id)
        mine = self.samples.face == number
        if known is not None and known.why != "no holder":
            known = None  # it is about all faces together
        if known is None and stick_out and (verdicts.reached & mine).any():
            from plan_cutters.answers.stick_out import least_stick_out

            known = least_stick_out(
                self.ready, tool, replace(verdicts, verdict=np.where(mine, verdicts.verdict, UNJUDGED).astype(np.uint8))
            )
        doubtful = self.conditions.surroundings.doubtful
        return on_face(
            self.plan.faces[number - 1], entry, self.samples, verdicts, known, doubtful=doubtful, inside=self.inside_bodies
        )

    def summary(self) -> str:
        """The plan in words, as many lines: `print(result.summary())`.

        It says which cutter to take, or that none finishes; a line for each cutter; what is not reached and why; what makes it
        unsure.

        Examples
        --------
        >>> from plan_cutters import plan
        >>> result = plan("samples/v_groove.step", cutters=["R6L80", "R2L30"], grid=9, area_budget=0)
        >>> print(result.summary().splitlines()[0])
        Take flat end D12 x 80: it finishes all 13,300 mm².
        """
        from plan_cutters.report.notebook import text_of

        return text_of(self.plan)

    def show(self, *, height: int = 640, card: Literal["full", "small"] = "full") -> Path | None:
        """Show the review page: in a notebook below the cell, `height` pixels high, else in a browser.

        `card="small"` shows in a notebook headline, table and a small picture, at most 50 kB.

        Returns
        -------
        Path or None
            The file that the browser shows, in the folder for temporary files, where it stays; None in a notebook.

        Raises
        ------
        CadIoError
            The kernel cannot mesh the part.
        PlanError
            No browser is found; the message names the file.
        """
        from plan_cutters.report.notebook import show

        return show(self, height, card)

    def _repr_html_(self) -> str:
        """What a notebook shows of a result: a small card, with headline, table and picture (`PLAN_CUTTERS_CARD`)."""
        from plan_cutters.report.notebook import card, chosen_size

        return card(self, size=chosen_size())

    def to_dataframe(self, of: Literal["samples", "faces", "cutters"] = "samples", cutter: str | None = None) -> "DataFrame":
        """A table of pandas, with units at the end of names; what is not known is nan or None.

        Parameters
        ----------
        of : str
            `samples`: the columns of `axes.csv`, a row for each sample. `faces`: a row for each face of the part, with counts and
            shares of area by verdict, the main reason and the deepest collision. `cutters`: a row for each cutter.
        cutter : str, optional
            Id of the cutter that samples and faces are about; default the one `shown`.

        Raises
        ------
        OptionError
            There is no such table or cutter.
        PlanError
            Pandas is not installed.
        """
        from plan_cutters.report.arrays import frame

        return frame(self, of, cutter)

    def to_json(self, path: str | Path) -> None:
        """Write the plan alone."""
        from plan_cutters.report.to_json import write_plan

        write_plan(self.plan, Path(path))

    def write(
        self, out: str | Path, formats: Sequence[str] = ("json", "html", "step", "glb", "npz"), *, step_schema: str = "ap242"
    ) -> Plan:
        """Write files into the folder `out`, each whole or not at all, the plan and the samples first.

        What cannot be written behind these is named in the plan's `not_written`; the other files are there. Files that an
        earlier run wrote there are removed if its plan lists them as they are.

        Parameters
        ----------
        out : path-like
        formats : sequence of str
            Of `json`, `html` (the review page), `step`, `glb`, `npz`, `merged` (a GLB of one mesh, for parts of thousands of
            faces), `png` (the part with its verdicts, four views), and `csv` and `vtk` (tool axes for CAM:
            `docs/cam_outputs.md`).
        step_schema : str
            Application protocol of the STEP file: `ap242`, `ap214` or `ap203`.

        Returns
        -------
        Plan
            The plan as written, with its `files`, `split` and `not_written`.
        """
        from plan_cutters.report.folder import write_all

        chosen = formats.split(",") if isinstance(formats, str) else formats
        return write_all(self, Path(out), chosen, step_schema=step_schema)
