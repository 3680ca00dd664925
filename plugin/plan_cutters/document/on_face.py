"""Tell the results of one face: how much of it a cutter reaches, why not the rest, the worst place, the least stick-out."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import SurfaceSamples
from plan_cutters.document.shares import counts
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.domain.verdicts import NO_REASON, REASONS, WORDS, Verdicts
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, WitnessEntry
from plan_cutters.plan_file.shares import VerdictCounts


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

    `inside` (n,): samples that are no surface of the finished part.
    """
    whole_face = samples.face == int(entry.id[1:])
    verdicts = counts(reach.verdict[whole_face], inside[whole_face])
    mine = whole_face & ~inside
    area, verdict = samples.area[mine], reach.verdict[mine]
    shares, reasons = {}, {}
    whole = float(area.sum())
    if whole > 0.0:
        for code, word in _words(verdict):
            shares[word] = float(area[verdict == code].sum()) / whole
        why = reach.reason[mine]
        not_reached = {REASONS[code]: float(area[why == code].sum()) / whole for code in np.unique(why[why != NO_REASON])}
        reasons = dict(sorted(not_reached.items(), key=lambda each: (-each[1], each[0])))
    deepest = [w for w in cutter.witnesses if w.face == entry.id and not w.inside_bodies]
    least, unknown = _least(entry, mine, reach, stick_out)
    return OnFace(
        entry.id, entry.name, entry.component, entry.target, cutter.id, entry.area_mm2, int(whole_face.sum()),
        VerdictCounts(**verdicts), shares, reasons, max(deepest, key=lambda w: w.depth_mm or 0.0, default=None), least, unknown,
        doubtful, _unjudged(entry),
    )  # fmt: skip


def _words(verdict: NDArray[np.uint8]) -> list[tuple[int, str]]:
    """Codes and words of the verdicts that occur."""
    return [(code, WORDS[code]) for code in np.unique(verdict).tolist()]


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


def _unjudged(entry: FaceEntry) -> str:
    if entry.ignored:
        return "it is ignored: neither a target nor an obstacle"
    if not entry.target:
        return "it is a check face: not judged, an obstacle only"
    return entry.unjudged or ""
