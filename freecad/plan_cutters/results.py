"""What the program answered, read from its files."""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from . import arrays, model, tool
from .words import fine, tr

#: The question, beside the folder of its plan.
JOB = "job.json"
FORMAT, VERSION = "plan-cutters-plan", 1
#: A face or sample of several verdicts has the first of these.
WORST_FIRST = ("inaccessible", "undecided", "unjudged", "accessible", "interference_free", "drilled")
#: Verdicts by their number in samples.npz.
VERDICTS = {0: "inaccessible", 1: "accessible", 2: "interference_free", 3: "undecided", 4: "drilled", 255: "unjudged"}


class CutterText(NamedTuple):
    """A cutter in the words of the plan.

    The tone of its verdict is `good`, `bad` or `unsure`; the sentence says what it reaches, or what not and why; `shares` are of
    the area, by verdict.
    """

    tone: str
    verdict: str
    sentence: str
    shares: dict[str, str]


@dataclass(frozen=True)
class Spot:
    """A worst spot: a sample that a cutter does not reach.

    Parameters
    ----------
    cutter : str
        Id of the cutter.
    number : int
        Its place in the cutter's list of witnesses.
    face : str
        `F3`.
    point : tuple of float
        mm, in the document's coordinates.
    axis, tip : tuple of float, optional
        Unit tool axis of the nearest posture tried, and where the tip is then, mm; None where the tool cannot be shown.
    reason : str
        Code of the reason.
    obstacle : str
        What is in the way, as `F7` or `fixture:vise`; empty where nothing is named.
    depth_mm : float, optional
        How deep the obstacle reaches into the tool; None where it was not tried.
    text : str
        One line for people.
    """

    cutter: str
    number: int
    face: str
    point: tuple[float, float, float]
    axis: tuple[float, float, float] | None
    tip: tuple[float, float, float] | None
    reason: str
    obstacle: str
    depth_mm: float | None
    text: str


@dataclass(frozen=True)
class Sample:
    """What the plan knows of the sample nearest to a picked point, for one cutter; vectors as in `Spot`.

    `angles` are the machine's rotary angles in degrees by their axes: of the solution that is taken, then of the other one; empty
    where the machine has none or no posture is known.
    """

    cutter: str
    face: str
    point: tuple[float, float, float]
    away_mm: float
    verdict: str
    reason: str
    axis: tuple[float, float, float] | None
    tip: tuple[float, float, float] | None
    angles: tuple[dict[str, float], ...]


@dataclass(frozen=True)
class Result:
    """A plan with its files.

    Parameters
    ----------
    plan : dict
        `plan.json`.
    job : model.Job
        What was asked.
    fingerprints : dict of str
        Of the body and the fixtures as they were planned, by their names.
    paths : dict of str
        Where its files are, by the word in `files` of the plan: `npz`, `html`, `step`, `operations_step`, and `json`.
    folder : str
        The temporary folder that holds them; empty where a document does.
    """

    plan: dict[str, Any]
    job: model.Job
    fingerprints: dict[str, str] = field(default_factory=dict)
    paths: dict[str, str] = field(default_factory=dict)
    folder: str = ""

    @property
    def document(self) -> str:
        """Name of the document."""
        return self.job.document

    @property
    def body(self) -> str:
        """Name of what was planned."""
        return self.job.body

    def shown(self, cutter: str = "") -> dict[str, Any]:
        """A cutter of the plan; by default the one that the program shows: the selected one, else the one that comes nearest."""
        wanted = cutter or self.plan.get("shown") or self.plan["selected"]
        if wanted:
            found = next((each for each in self.plan["cutters"] if each["id"] == wanted), None)
            if found is None:
                raise model.Refused(tr("the plan has no cutter {wanted}").format(wanted=wanted))
            return found
        # A plan of an older program, from a document that was saved with it, does not say which one it shows.
        return min(self.plan["cutters"], key=lambda each: each["area_share"]["inaccessible"] + each["area_share"]["undecided"])

    def cutters(self) -> list[str]:
        """Ids of the cutters, in the order of the plan."""
        return [each["id"] for each in self.plan["cutters"]]

    def headline(self) -> str:
        """The verdict in one line: that of the plan."""
        if self._text:
            return self._text["headline"]
        verdict = (
            tr("take {cutter}").format(cutter=self.plan["selected"]) if self.plan["selected"] else tr("no cutter is selected")
        )
        shown = self.shown()["id"]
        return tr("An older program made this plan, without text ({verdict}; the colours show {shown}): plan again.").format(
            verdict=verdict, shown=shown
        )

    def summary(self) -> list[str]:
        """What the plan says, line by line: the headline, then the rest of its text."""
        return [self.headline(), *self._text.get("lines", ())]

    def cutter_text(self, cutter: str) -> CutterText:
        """What the plan says of a cutter; a plan of an older program has no words for it."""
        text = self._text
        if not text:
            tones = {True: "good", False: "bad", None: "unsure"}
            return CutterText(tones[self.shown(cutter)["feasible"]], "", "", {})
        verdict = text["verdicts"][cutter]
        return CutterText(verdict["tone"], verdict["word"], text["cutters"][cutter], text["shares"][cutter])

    @property
    def _text(self) -> dict[str, Any]:
        """The plan in words; empty where an older program made it."""
        return self.plan.get("text") or {}

    def reason(self, code: str) -> str:
        """A reason in the words of the plan; a plan of an older program has none."""
        return self.plan.get("reason_words", {}).get(code, code.replace("_", " "))

    def verdicts(self, cutter: str = "") -> list[str]:
        """Of each face the worst verdict on it, `check` or `ignored`."""
        counts, words = self.shown(cutter)["faces"], []
        for face in self.plan["faces"]:
            mine = counts.get(face["id"], {})
            if not face["target"]:
                words.append("ignored" if face["ignored"] else "check")
            else:
                words.append(next((word for word in WORST_FIRST if mine.get(word)), "unjudged"))
        return words

    def legend(self) -> list[tuple[str, str, tuple[float, float, float]]]:
        """Code, words and colour (0 to 1) of each verdict."""
        words = self.plan.get("legend_words", {})
        return [(code, words.get(code, code), colour(text)) for code, text in self.plan["legend"].items()]

    def spots(self, cutter: str = "") -> list[Spot]:
        """Worst spots of a cutter, by default of the one shown: deepest first, those that were not tried last."""
        shown = self.shown(cutter)
        found = [self._spot(shown, number, each) for number, each in enumerate(shown["witnesses"])]
        return sorted(found, key=lambda spot: -1.0 if spot.depth_mm is None else spot.depth_mm, reverse=True)

    def sentence(self, sample: Sample) -> str:
        """What is known of a sample, with the angles of the machine: of the solution taken, then of the other one."""
        verdict = self.plan.get("legend_words", {}).get(sample.verdict, sample.verdict)
        words = [
            tr("{face}, {away} from the click: {verdict}").format(face=sample.face, away=fine(sample.away_mm), verdict=verdict)
        ]
        if sample.reason:
            words.append(tr("for {reason}").format(reason=self.reason(sample.reason)))
        angles = [" ".join(f"{name} {value:g}°" for name, value in each.items()) for each in sample.angles]
        return " ".join(words) + ("; " + tr(", or ").join(angles) if angles else "")

    def _spot(self, cutter: dict[str, Any], number: int, entry: dict[str, Any]) -> Spot:
        posture, axis, tip = entry["best_posture"], None, None
        samples, row = self._arrays, entry.get("sample")
        if posture and samples is not None and row is not None and 0 <= row < len(samples["normal"]):
            normal, direction = samples["normal"][row], samples["direction_max"][row]
            axis = tuple(posture["axis"])
            tip = tool.tip(cutter, entry["point"], normal, axis, direction)
        depth = entry["depth_mm"]
        words = [entry["face"], self.reason(entry["reason"]), entry["obstacle_face"] or ""]
        text = " ".join(filter(None, words)) + (", " + tr("{depth} deep").format(depth=fine(depth)) if depth is not None else "")
        if entry["verdict"] == "undecided":
            text += " " + tr("(undecided)")
        point, obstacle = tuple(entry["point"]), entry["obstacle_face"] or ""
        return Spot(cutter["id"], number, entry["face"], point, axis, tip, entry["reason"], obstacle, depth, text)

    @functools.cached_property
    def _arrays(self) -> dict[str, Any] | None:
        """Arrays of samples.npz; None where this FreeCAD has no numpy, or the file is missing or torn."""
        try:
            found = arrays.read(self.paths["npz"])
        except (ImportError, KeyError, OSError, ValueError):
            return None
        words = [f"{word}_{each}" for each in self.cutters() for word in ("verdict", "axis", "lean", "reason")]
        whole = {len(found.get(word, ())) for word in ("point", "normal", "direction_max", "face", *words)}
        return found if whole == {self.plan["samples"]["count"]} else None

    def nearest(self, point, cutter: str = "") -> Sample:
        """The sample nearest to a point (mm), and its posture for a cutter."""
        samples, entry = self._arrays, self.shown(cutter)
        if samples is None:
            raise model.Refused(tr("the samples of this plan cannot be read: plan again"))
        apart = ((samples["point"] - tuple(point)) ** 2).sum(axis=1)
        row, mine = int(apart.argmin()), entry["id"]
        verdict = VERDICTS.get(int(samples[f"verdict_{mine}"][row]), "unjudged")
        axis = _three(samples[f"axis_{mine}"][row])
        known = all(value == value for value in axis)  # not a number is none
        at = _three(samples["point"][row])
        lean = samples[f"lean_{mine}"][row]
        tip = tool.tip(entry, at, samples["normal"][row], axis, lean) if known else None
        reached = verdict in ("accessible", "interference_free")
        named = not reached and verdict not in ("unjudged", "drilled")
        reason = self.plan["reasons"][int(samples[f"reason_{mine}"][row])] if named else ""
        return Sample(
            mine, f"F{int(samples['face'][row])}", at, float(apart[row]) ** 0.5, verdict, reason, axis if known else None, tip,
            self._angles(mine, row),
        )  # fmt: skip

    def _angles(self, cutter: str, row: int) -> tuple[dict[str, float], ...]:
        arrays = self._arrays or {}
        both, taken = arrays.get(f"rotary_{cutter}"), arrays.get(f"rotary_taken_{cutter}")
        machine = self.plan.get("machine")
        if both is None or taken is None or not machine or int(taken[row]) < 0:
            return ()
        names = [each["name"] for each in machine["rotary"]]
        first = int(taken[row])
        rows = [both[row][first], *(each for place, each in enumerate(both[row]) if place != first)]
        return tuple(
            {name: round(float(value), 6) + 0.0 for name, value in zip(names, each)} for each in rows if all(each == each)
        )

    def review(self) -> str:
        """Path of the review page; empty where there is none."""
        return self.paths.get("html", "")

    def discard(self) -> None:
        """Take the temporary folder away."""
        if self.folder:
            from . import runner

            runner.removed(self.folder)


def colour(text: str) -> tuple[float, float, float]:
    """`#D55E00` as FreeCAD has colours."""
    return _three(int(text[place : place + 2], 16) / 255.0 for place in (1, 3, 5))


def _three(values: Iterable[float]) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def read(folder: str) -> Result:
    """The result of a run in its folder.

    Raises
    ------
    Refused
        There is no plan that this workbench can read.
    """
    out = os.path.join(folder, "plan")
    with open(os.path.join(folder, JOB), encoding="utf-8") as file:
        asked = json.load(file)
    fingerprints = asked.pop("fingerprints")
    plan = parsed(os.path.join(out, "plan.json"))
    paths = {word: os.path.join(out, entry["name"]) for word, entry in plan["files"].items()}
    paths = {word: path for word, path in paths.items() if os.path.isfile(path)}
    return Result(plan, model.job_of(asked), fingerprints, {**paths, "json": os.path.join(out, "plan.json")}, folder)


def parsed(path: str) -> dict[str, Any]:
    """`plan.json` as a dict."""
    try:
        with open(path, encoding="utf-8") as file:
            plan = json.load(file)
    except (OSError, ValueError):
        raise model.Refused(tr("the program wrote no plan: give options of plan-cutters alone, no files of parts")) from None
    if not isinstance(plan, dict) or plan.get("format") != FORMAT:
        raise model.Refused(tr("the program wrote no plan of plan-cutters"))
    if plan.get("format_version") != VERSION:
        version = plan.get("format_version")
        raise model.Refused(
            tr("the plan has the format {version}, this workbench reads {known}: update the add-on").format(
                version=version, known=VERSION
            )
        )
    return plan
