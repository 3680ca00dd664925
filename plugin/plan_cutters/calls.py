"""The calls of a script: what each takes, without the CAD kernel and the compiler, which are loaded as it is called."""

import math
import os
from collections.abc import Callable
from numbers import Real
from typing import TYPE_CHECKING, Any, Unpack

from plan_cutters.domain.checks import Angle, in_radians, numbers, radians, shown, spelled_out
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.posture import Heading, PostureRange, Range
from plan_cutters.domain.shapes import largest_tilt
from plan_cutters.errors import OptionError
from plan_cutters.options import Options, PlanOptions, PointOptions, machine_option

if TYPE_CHECKING:
    from plan_cutters.judging.posture_maps import PostureMap
    from plan_cutters.result import Result

#: Told the stage, how much of it is done, of how much.
Progress = Callable[[str, int, int], None]


@spelled_out(PlanOptions, Options)
def plan(part: Any, *, progress: Progress | None = None, cache: bool = True, **options: Unpack[PlanOptions]) -> "Result":
    """Judge each cutter on the target faces of a part.

    Parameters
    ----------
    part : Part, Scene, path, TopoDS_Shape, CadQuery or build123d object, or a list of shapes
        An object that holds picked faces stands for the shape that they belong to. A Scene brings its setup, flip, ignored
        faces and tolerance with it.
    progress : callable, optional
        Called with the stage, the number of pieces done, and the number of all pieces.
    cache : bool
        Keep what stages make of a part that was read from a file, for the next question (`plan_cutters_base.stage_cache`).
    **options
        Every attribute of `Options`, by its name: `cutters="R6L80"`, `grid=201`, `machine="tilt:60"`; angles in degrees, too:
        `tilt_deg=(0, 60)`.

    Returns
    -------
    Result

    Raises
    ------
    CadIoError
        The part cannot be read or holds no surface to judge.
    PlanError
        An option has no meaning.

    Notes
    -----
    Measuring and sampling have no time limit here: a face on which the CAD kernel never ends keeps this call waiting, and a
    crash of the kernel ends the process. The command bounds both (`docs/kernel_calls.md`).

    Examples
    --------
    >>> result = plan("samples/v_groove.step", cutters=["R6L80", "R2L30"], grid=9, area_budget=0)
    >>> result.selected
    'R6L80'
    """
    if progress is not None and not callable(progress):
        raise OptionError(f"progress must be a function of (stage, done, total), not {shown(progress)}")
    from plan_cutters.document.clock import Clock
    from plan_cutters.pipeline import run
    from plan_cutters.scene.scene import Scene
    from plan_cutters_base.stage_cache import StageCache

    settings = {**part.options, **options} if isinstance(part, Scene) else options
    return run(part, Options.of(settings), Clock(progress), cache=StageCache.of_user() if cache else None)


@spelled_out(PointOptions, Options)
def posture_map(
    part: Any,
    *,
    point: Range,
    cutter: Cutter | str,
    rotations: float | Range | None = None,
    tilt: Range | None = None,
    machine: Machine | str | os.PathLike[str] | None = None,
    tolerance: float | None = None,
    x: Heading | None = None,
    rotations_deg: float | Range | None = None,
    tilt_deg: Range | None = None,
    **scene: Unpack[PointOptions],
) -> "PostureMap":
    """Find the free tilt intervals of a cutter at a point of a part.

    Parameters
    ----------
    part : Part, Scene, path, TopoDS_Shape, CadQuery or build123d object
        A Scene is not tessellated again for the next point or cutter.
    point : (3,) float
        mm; projected to the nearest face.
    cutter : Cutter or str
        A text as `R6L80`.
    rotations : sequence of float
        rad, from the direction of the largest curvature; at most a full turn either way.
    tilt : tuple of float, optional
        Range, rad, within 0 to pi. Default: 0 to pi/2, or as far as the cutter touches.
    rotations_deg, tilt_deg : optional
        The same in degrees.
    machine : Machine or str, optional
        A text as `tilt:60` (degrees), the name of a built-in one, or a machine file. Default: no axis limit.
    tolerance : float, optional
        Gouge tolerance, mm; default that of the Scene, or 0.01. 0: the nominal answer, obstacles refined until the ends
        settle; not certified.
    x : (3,) float, optional
        Direction of the part along the machine's X, as `Placement` has it.
    **scene
        `setup`, `flip`, `ignore` and `fixtures`, as in `Options`; the point is not projected to ignored faces. A setup file, a
        Placement or a host's plane as the setup brings its X, unless `x` is given, and its fixtures.

    Raises
    ------
    CadIoError
        The part cannot be read; the point is farther than 1e-3 mm from it.
    OptionError
        A range or tolerance has no meaning, or a value is of the wrong kind.

    Examples
    --------
    On the bottom line of a groove, across it and along it:

    >>> import numpy as np
    >>> found = posture_map("samples/v_groove.step", point=(0, 0, 0), cutter="R8L90", rotations=[0.0, np.pi / 2], tolerance=0)
    >>> [np.degrees(tilts).round(1).tolist() for tilts in found.free]
    [[[27.6, 61.4]], []]
    """
    cutter, machine = Cutter.of(cutter), machine_option(machine)
    place = numbers(point, "point", 3)
    angles = in_radians({"rotations": rotations, "rotations_deg": rotations_deg}, {"rotations": Angle(-360.0, 360.0, "several")})
    if (wanted := angles["rotations"]) is None:
        raise OptionError("give rotations, in radians, or rotations_deg, in degrees")
    each = (wanted,) if isinstance(wanted, Real) else wanted
    turns = [radians(turn, "rotation", 2 * math.pi) for turn in numbers(each, "rotations")]
    if tilt is None and tilt_deg is None:
        tilt = (0.0, largest_tilt([cutter]))
    postures = PostureRange(tilt_deg=tilt_deg) if tilt is None else PostureRange(tilt=tilt, tilt_deg=tilt_deg)
    from plan_cutters.point import posture_map_at

    return posture_map_at(part, place, cutter, turns, postures.tilt, machine, tolerance, x, scene)
