"""The line of a part in the table of all, made of its plan."""

from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.shares import reached_share
from plan_cutters.plan_file.words.cutters import main_reason
from plan_cutters.plan_file.words.headline import headline
from plan_cutters.plan_file.words.names import short_names
from plan_cutters.plan_file.words.scope import headline_cutter
from plan_cutters.report.folder import file_name
from plan_cutters_batch.part_tools import part_tools
from plan_cutters_batch.row import PartRow, Status


def row_of(
    plan: Plan,
    *,
    name: str,
    file: str,
    code: int,
    key: str = "",
    status: Status = "planned",
    folder: str | None = None,
    seconds: float | None = None,
) -> PartRow:
    """Sum up a plan in a line.

    Parameters
    ----------
    plan : Plan
        As written: its `files` say which of the page and the picture there are.
    name, file, key, status
        As in `PartRow`.
    code : int
        The exit code that the plan asks for.
    folder : str, optional
        Of the part's files, below the output and with `/`; without it the row names no page and no picture.
    seconds : float, optional
        By the clock; default what the plan says of its own run.

    Returns
    -------
    PartRow
        Its cutter is the one that the headline names: the cutter to take, else the one that leaves least.
    """
    names = short_names(plan)
    cutter = headline_cutter(plan) if plan.cutters else None
    written = {form: f"{folder}/{file_name(form)}" for form in plan.files} if folder else {}
    return PartRow(
        name=name,
        file=file,
        key=key,
        status=status,
        code=code,
        verdict=headline(plan, names).title if cutter else "No cutter was judged",
        cutter=names[cutter.id] if cutter else None,
        share=reached_share(cutter, cutter.area_share) if cutter else None,
        reason=_reason(cutter) if cutter else None,
        cutters=len(plan.cutters),
        samples=plan.samples.judged,
        faces=sum(face.target and face.samples > 0 for face in plan.faces),
        seconds=plan.run.total if seconds is None else seconds,
        folder=folder,
        page=written.get("html"),
        picture=written.get("png"),
        tools=part_tools(plan, code, names),
    )


def _reason(cutter: CutterEntry) -> str | None:
    """The code by which most of the area is not reached; by samples where these stand for no area."""
    by_area = main_reason(cutter.area_share)
    if by_area or not cutter.not_reached:
        return by_area or None
    both = (cutter.by_reason, cutter.undecided_by_reason)
    samples = {code: sum(each.get(code, 0) for each in both) for each in both for code in each}
    return max(samples, key=lambda code: samples[code], default=None)
