"""How a change is said on the command line, exactly: what is said there gives what was judged."""

import shlex
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.dimensions import is_spec, spelled, written
from plan_cutters.domain.figures import ranges
from plan_cutters.errors import PlanError
from plan_cutters.options import Options
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.faces import select_faces
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.setups import places

Axis = tuple[float, float, float]


def option(
    ready: Prepared, cutter: Cutter, *, cutters: Sequence[Cutter], setups: Sequence[Axis] | None = None,
    conditions: Conditions | None = None, tolerance: float | None = None, faces: Sequence[int] | None = None,
) -> str | None:  # fmt: skip
    """Write the command-line options that differ from now, so that a plan has these cutters, setups and so on.

    The result is None where no option can say it. `--cutter` is added to the options of now; every other option replaces the same
    option. Cutters that the options name now are not repeated. Those of the default tool set are written, because a plan leaves
    them out as soon as other cutters are given.
    """
    options = ready.options
    words = [] if tuple(cutters) == (cutter,) else _more(ready, cutters)
    if words is None:
        return None
    auto = proposed(ready)
    if auto and (setups is not None or not _nameable(ready)):
        return None
    if setups is not None:
        if options.placement is not None or any(options.other_placements):
            return None
        words += [word for axis in setups for word in ("--setup", ",".join(f"{each:.6g}" for each in axis))]
    if conditions is not None:
        words += _within(ready.conditions, conditions)
    if tolerance is not None:
        words += ["--tolerance", f"{tolerance:.6g}"]
    if auto and (words or faces is not None):
        # Another cutter might make `auto` choose otherwise.
        words += _pinned(ready, ready.chosen.targets if faces is None else faces)
    elif faces is not None:
        words += ["--faces", ",".join(f"F{number}" for number in faces)]
    return " ".join(words) or None


def proposed(ready: Prepared) -> bool:
    """Whether its setups were proposed."""
    place = ready.options.placement
    return place is not None and place.proposed


def _files(ready: Prepared) -> list[str]:
    """The files in which its setups will be; empty where they will be in none."""
    each = [place.file if place else "" for place in places(ready.options)]
    return each if all(each) else []


def _nameable(ready: Prepared) -> bool:
    """Whether options name the proposed setups, and a plan that is given them finds the sides that faces have now."""
    return bool(_files(ready) or not ready.options.other_setups) and ready.scene.same_sides(ready.scene.setup)


def _pinned(ready: Prepared, faces: Sequence[int]) -> list[str]:
    """Name the proposed setups, what holds the part there, and the faces to be finished."""
    part = ready.scene.part
    words = [word for file in _files(ready) for word in ("--setup", shlex.quote(file))]
    if not words:
        fixtures = [word for each in ready.options.fixtures for word in ("--fixture", each.text)]
        words = ["--setup", ",".join(f"{each:.12g}" for each in ready.scene.setup), *fixtures]
    scene = ready.scene
    selected = select_faces(
        part.faces, ready.chosen.asked, tree=part.tree, ignored=scene.ignored, blends=part.blends, repeated=scene.repeated
    )
    return words if tuple(selected) == tuple(faces) else [*words, "--faces", ranges(faces)]


def _more(ready: Prepared, cutters: Sequence[Cutter]) -> list[str] | None:
    """Name the cutters that the options do not name now; None where one has no word."""
    words, options = list[str](), ready.options
    known = {each.id for each in ready.cutters} if options.cutters or options.libraries else set()
    for each in cutters:
        if each.id in known:
            continue
        text = spoken(each, options)
        if text is None and each.id not in options.sources:
            return None
        words += [] if text is None else ["--cutter", text]
    return words


def _within(now: Conditions, then: Conditions) -> list[str]:
    words = []
    if then.machine != now.machine:
        words += ["--machine", then.machine.name]
    if then.postures.tilt != now.postures.tilt:
        words += ["--tilt", ":".join(f"{round(float(np.degrees(tilt)), 6):g}" for tilt in then.postures.tilt)]
    return words


def spoken(cutter: Cutter, options: Options) -> str | None:
    """A cutter in a word that reads as itself in a plan with these options; None if no word does.

    It is in the notation in which the cutter was given, without a holder that the options say.
    """
    bare = replace(cutter, allowance=None, clearance=None)
    head = spelled(replace(bare, holder=None))
    # A holder of the table by its word.
    named = f"{head}H{cutter.holder.name.lower()}" if cutter.holder and is_spec(f"{head}H{cutter.holder.name}") else head
    for text in (head, named, spelled(bare), written(bare)):
        try:
            again = Cutter.parse(text).asked(options.allowance, options.holder_clearance, options.holder)
        except PlanError:
            continue
        if again.id == cutter.id:
            return text
    return None
