"""A chamfer mill where end mills go along chamfers up and down: it cuts each in one pass."""

import math
import shlex
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import product

import numpy as np

from plan_cutters.answers.steps import option
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.shapes import flute_length
from plan_cutters.errors import HolderFitError
from plan_cutters.outcome import OperationPlan
from plan_cutters.plan_file.operations import ChamferEntry
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.fixed_axis import along_flank, served_by
from plan_cutters.scene.preparation import Prepared

#: Usual chamfer mills: half of the angle of the tip, deg, and the mills, the larger one first.
_MILLS = {
    45: ("D1L30T45F6S12", "D1L20T45F2.5S6"), 30: ("D1L30T30F10S12", "D1L20T30F4.5S6"), 60: ("D1L30T60F3.4S12", "D1L20T60F1.5S6"),
}  # fmt: skip
#: What is worth another tool, s and as a share of the whole time; the mill reaches this share of the chamfers at least.
_WORTH, _SHARE, _NEARLY = 60.0, 0.1, 0.9
#: Samples that it is tried at, at most.
_TRIED = 200


def chamfer_mill(ready: Prepared, plan: OperationPlan) -> ChamferEntry | None:
    """The usual chamfer mill that saves most of the time that a plan takes for chamfers; None where none saves much.

    Chamfers are planes and cones on which all normals lean alike from the spindle, narrower than the flank of the mill.
    """
    samples, options = ready.samples, ready.options
    # The setup of each sample that goes with a fixed step of an end mill, else -1.
    of_step = [each.setup if each.axis is not None and not each.cutter.taper else -1 for each in plan.operations]
    where, time, area = np.array([*of_step, -1])[plan.label], plan.seconds + plan.link, np.nan_to_num(samples.area)
    slanted = [(face.number, rows) for face in ready.scene.part.faces if face.shape in ("plane", "cone")
               and (rows := samples.by_face().get(face.number)) is not None]  # fmt: skip
    feed = options.feed or min((options.feeds or {}).values(), default=math.nan)
    best: ChamferEntry | None = None
    for degrees, words in _MILLS.items():
        if (mill := _fitting(words, ready.cutters[0].holder)) is None:
            continue
        faces, saved, taken = list[str](), -options.change_time, 0.0
        for (number, rows), (s, conditions) in product(slanted, enumerate(ready.setups)):
            up, mine = conditions.setup, rows[where[rows] == s]
            if not len(mine) or not along_flank(samples.normal[rows], up, mill).all():
                continue
            width = float(np.ptp(samples.point[rows] @ up)) / math.cos(mill.taper)
            tried = mine[:: max(1, len(mine) // _TRIED)]
            if not 0.0 < width <= flute_length(mill) / math.cos(mill.taper) or (
                served_by(tried, up[None], samples, Context.of(mill, conditions))[0].mean() < _NEARLY
            ):
                continue
            now = float(time[mine].sum())
            once = float(area[mine].sum()) / width * 60.0 / feed + options.link_time
            if now > once:
                faces.append(f"F{number}")
                saved, taken = saved + now - once, taken + now
        if saved >= max(_WORTH, _SHARE * plan.total) and (best is None or saved > best.saves):
            argv = option(ready, mill, cutters=[*ready.cutters, mill])
            best = ChamferEntry(angle_deg=2 * degrees, faces=list(dict.fromkeys(faces)), seconds=taken, saves=saved,
                                argv=shlex.split(argv) if argv else [])  # fmt: skip
    return best


def _fitting(words: Sequence[str], holder: Holder | None) -> Cutter | None:
    """The first of some mills that fits a holder; None where none does."""
    for word in words:
        with suppress(HolderFitError):
            return replace(Cutter.parse(word), holder=holder)
    return None
