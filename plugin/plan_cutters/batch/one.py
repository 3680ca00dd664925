"""One part, whose cutters are judged by the workers of a cluster, or were judged before."""

import os
from typing import Any, Unpack

from plan_cutters import pipeline
from plan_cutters.document.clock import Progress
from plan_cutters.domain.signatures import spelled_out
from plan_cutters.errors import OptionError
from plan_cutters.files.seal import key_of
from plan_cutters.option_types import PlanOptions
from plan_cutters.options import Options
from plan_cutters.result import Result
from plan_cutters.stages.judge import Judge, judge


@spelled_out(PlanOptions, Options)
def plan(
    part: Any,
    *,
    progress: Progress | None = None,
    client: Any = None,
    verdicts: str | None = None,
    verdicts_key: str | os.PathLike[str] | None = None,
    cache: bool = True,
    **options: Unpack[PlanOptions],
) -> Result:
    """Judge each cutter on the target faces of a part, as `pipeline.plan` does, which says more of parts and options.

    Parameters
    ----------
    part : Part, Scene, path, TopoDS_Shape, CadQuery or build123d object, or a list of shapes
    progress : callable, optional
        Called with the stage, the number of pieces done, and the number of all pieces.
    client : distributed.Client, optional
        Of a Dask cluster, whose workers judge the samples of a large part. The result is the same, bit for bit.
    verdicts : str, optional
        Folder or URL in which the verdicts of each cutter are kept (`batch.verdicts.VerdictCache`).
    verdicts_key : path, optional
        File with a key (`files.seal`): what nobody with this key wrote there is not taken.
    cache : bool
        Keep what stages make of a part that was read from a file, in the user's cache folder, for the next question about it.
    **options
        Every attribute of `Options`, by its name; angles in degrees, too: `tilt_deg=(0, 60)`.

    Returns
    -------
    Result

    Raises
    ------
    CadIoError
        The part cannot be read or holds no surface to judge.
    PlanError
        An option has no meaning, or the cluster cannot judge.

    Examples
    --------
    >>> result = plan("samples/v_groove.step", cutters=["R6L80", "R2L30"], grid=9, area_budget=0)
    >>> result.selected
    'R6L80'
    """
    if verdicts_key is not None and verdicts is None:
        raise OptionError("verdicts_key seals the verdicts of a folder: give it as verdicts, or leave the key out")
    key = None if verdicts_key is None else key_of(os.fspath(verdicts_key))
    return pipeline.plan(part, progress=progress, judged=judging(client, verdicts, key=key), cache=cache, **options)


def judging(client: Any = None, verdicts: str | None = None, otherwise: Judge | None = None, key: bytes | None = None) -> Judge:
    """What judges with a cluster, with kept verdicts, with both, or with neither: then `otherwise`."""
    judged: Judge = otherwise or judge
    if client is not None:
        from plan_cutters.batch.distributed_judge import DistributedJudge

        judged = DistributedJudge(client)
    if verdicts is not None:
        from plan_cutters.batch.verdicts import VerdictCache

        judged = VerdictCache(verdicts, judged, key)
    return judged
