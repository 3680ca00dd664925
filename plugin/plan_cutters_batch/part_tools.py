"""Which tools finish one part, alone or together, as far as its plan states it; and what the part needs where none do."""

from collections.abc import Iterable, Sequence

from pydantic import BaseModel, ConfigDict

from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters.plan_file.shares import FaceVerdicts

#: Needs of a part that its row names.
_NEEDS = 3


class FaceTools(BaseModel):
    """The tools that reach a face whole, and those that reach some of it."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    whole: tuple[str, ...]
    partly: tuple[str, ...] = ()


class PartTools(BaseModel):
    """The part of a plan from which the tools of many parts are chosen: sets that finish the part beyond doubt.

    Attributes
    ----------
    names : dict
        How people call each tool that was judged, by its id: the same dimensions, the same id.
    finished : bool
        Whether the tools finish the part beyond doubt (exit code 0). All but `used`, `share` and `needs` is empty where not.
    alone : tuple of str
        Ids of the tools each of which reaches every judged sample.
    together : tuple of tuples of str
        Sets that the plan states to finish the part: its process, its least set.
    faces : tuple of FaceTools
        What reaches the faces: the ways that say more than others (`essential`). Empty where the part was judged in several
        setups: the plan counts the samples of a face in the first one alone.
    used : tuple of str
        Tools of the steps of the plan, whatever it finishes.
    share : float, optional
        Of what is requested, that all tools finish together, 0 to 1.
    needs : tuple of str
        What would finish more, the best first.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    names: dict[str, str]
    finished: bool = False
    alone: tuple[str, ...] = ()
    together: tuple[tuple[str, ...], ...] = ()
    faces: tuple[FaceTools, ...] = ()
    used: tuple[str, ...] = ()
    share: float | None = None
    needs: tuple[str, ...] = ()

    def finished_by(self, tools: Iterable[str]) -> bool:
        """Whether the plan states that some tools finish the part together."""
        there = set(tools)
        if not self.finished:
            return False
        if there & set(self.alone) or any(there.issuperset(each) for each in self.together):
            return True
        return bool(self.faces) and all(there & set(face.whole) for face in self.faces)


def part_tools(plan: Plan, code: int, names: dict[str, str]) -> PartTools:
    """Read from a plan which tools finish its part.

    Parameters
    ----------
    plan : Plan
    code : int
        The exit code that it asks for.
    names : dict
        How its tools are called in a line, by id.
    """
    process = plan.process
    used = {step.cutter: None for step in process.steps} if process else {}
    if not used and (taken := plan.selected or plan.selected_over_setups):
        used = {taken: None}
    made = PartTools(names=names, used=tuple(used), share=process.finished_share if process else None, needs=tuple(_needs(plan)))
    if code != 0:
        return made
    # What may lie between its samples is a doubt: such a tool finishes nothing beyond doubt.
    sure = [c for c in plan.cutters if c.seen or plan.effective.sampled_by != "default"]
    ids = {c.id for c in sure}
    sets = [tuple(used)] if used else []
    if plan.least_set is not None and not plan.least_set.left and not plan.least_set.doubtful and plan.least_set.runs:
        sets.append(tuple(dict.fromkeys(run.cutter for run in plan.least_set.runs)))
    several = bool(plan.effective.other_setups) or any(len(c.setups) > 1 for c in plan.cutters)
    return made.model_copy(
        update={
            "finished": True,
            "alone": tuple(c.id for c in sure if c.feasible or (several and c.lost_in_all == 0)),
            "together": tuple(dict.fromkeys(tuple(sorted(each)) for each in sets if ids.issuperset(each))),
            "faces": () if several else _faces(plan.faces, sure),
        }
    )


def _faces(faces: Iterable[FaceEntry], cutters: list[CutterEntry]) -> tuple[FaceTools, ...]:
    """The ways in which the tools reach the faces that are to be machined."""
    ways: dict[FaceTools, None] = {}
    for face in faces:
        counts = {c.id: c.faces[face.id] for c in cutters if face.id in c.faces}
        if not face.target or not any(map(_required, counts.values())):
            continue
        whole = tuple(name for name, each in counts.items() if each.reached and not each.not_reached and not each.unjudged)
        partly = tuple(name for name, each in counts.items() if each.reached and name not in whole)
        ways[FaceTools(whole=whole, partly=partly)] = None
    return essential(tuple(ways))


def essential(ways: Sequence[FaceTools]) -> tuple[FaceTools, ...]:
    """Keep the ways that say more than others do, so that a part of many faces has a short row.

    A way follows from another one if whatever tools do that face whole do this one, and those that do some of it as well.

    >>> essential([FaceTools(whole=("D6",)), FaceTools(whole=("D6", "D8"))])
    (FaceTools(whole=('D6',), partly=()),)
    """
    names = {name: 1 << k for k, name in enumerate(dict.fromkeys(name for way in ways for name in (*way.whole, *way.partly)))}
    masks = {way: (sum(names[name] for name in way.whole), sum(names[name] for name in way.partly)) for way in ways}
    stays: dict[FaceTools, tuple[int, int]] = {}
    for way in sorted(masks, key=lambda each: (len(each.whole), len(each.partly))):
        whole, partly = masks[way]
        if not any(not (w & ~whole) and not (p & ~(whole | partly)) for w, p in stays.values()):
            stays[way] = whole, partly
    return tuple(stays)


def _required(counts: FaceVerdicts) -> int:
    """Samples of the finished part's surface."""
    return counts.reached + counts.not_reached + counts.unjudged


def _needs(plan: Plan) -> list[str]:
    """What would finish more of a part, in words: the next things to try, then what each area left needs."""
    process = plan.process
    if process is None or not process.left:
        return []
    # To ask for more answers is nothing that the part needs.
    tries = [each.words for each in process.next if "--answers" not in each.argv]
    areas = [each.needs for each in process.left]
    return [text for text in dict.fromkeys((*tries, *areas)) if text][:_NEEDS]
