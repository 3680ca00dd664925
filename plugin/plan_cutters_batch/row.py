"""A line of the table of all parts: what came of one of them."""

from typing import Literal

from pydantic import BaseModel, ConfigDict

from plan_cutters_batch.part_tools import PartTools

#: `planned` in this run, `kept` from an earlier one, or `failed`: then `error` says why.
Status = Literal["planned", "kept", "failed"]


class PartRow(BaseModel):
    """What came of one part.

    Attributes
    ----------
    name : str
        Of the part among all, and of its folder.
    file : str
        Path or URL, as it was given.
    key : str
        Of the content of the file, the effective options, tools, machine and version: SHA-256; empty where it is not known.
    status : str
    code : int
        Exit code, as of a single plan (`docs/command.md`).
    verdict : str
        The headline of the plan: one sentence.
    cutter : str, optional
        The cutter selected, or the one that leaves the least area.
    share : float, optional
        Of the area to machine that this cutter reaches, 0 to 1.
    reason : str, optional
        The reason, a code of the plan's, by which it loses most.
    cutters, samples, faces : int, optional
        How many were judged.
    seconds : float
        By the clock, of the run that made it.
    folder : str, optional
        With the files of a single plan, below the output.
    page, picture : str, optional
        The review page and the picture, below the output, where they were written.
    error : str, optional
        One line: file, face, cause, what to try.
    coarser : str, optional
        The part was sampled more coarsely than requested: what was requested, and what was done in its place.
    tools : PartTools, optional
        Which tools finish the part, alone or together; in no table.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str
    file: str
    key: str = ""
    status: Status
    code: int
    verdict: str = ""
    cutter: str | None = None
    share: float | None = None
    reason: str | None = None
    cutters: int | None = None
    samples: int | None = None
    faces: int | None = None
    seconds: float = 0.0
    folder: str | None = None
    page: str | None = None
    picture: str | None = None
    error: str | None = None
    coarser: str | None = None
    tools: PartTools | None = None
