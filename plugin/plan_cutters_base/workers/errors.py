"""How a child that did the job did not end by itself."""

from pathlib import Path


class Supervised(Exception):
    """The child did not end by itself: `str` says what happened, in words for the user."""


class Stuck(Supervised):
    """So it was, at a face: without it, there may be a plan.

    Attributes
    ----------
    part : str
    face : int
        Its number.
    why : str
        What happened there.
    before : int
        Parts that were done.
    code : int
        The exit code that these ask for.
    since : float
        When this part began (`time.monotonic`).
    """

    def __init__(self, text: str, part: str, face: int, why: str, before: int, code: int, since: float) -> None:
        super().__init__(text)
        self.part, self.face, self.why, self.before, self.code, self.since = part, face, why, before, code, since


class OutOfTime(Supervised):
    """A part was not done within the time for the whole of it.

    Attributes
    ----------
    before, code : int
        Parts that were done, and the exit code that these ask for.
    out : Path, optional
        The output where the plan was in it already, so that only models are missing.
    summarised : bool
        Whether its summary was shown.
    """

    def __init__(self, before: int, code: int, out: Path | None, summarised: bool = False) -> None:
        super().__init__("not done in time")
        self.before, self.code, self.out, self.summarised = before, code, out, summarised


class Unfinished(Supervised):
    """So it was, but the plan was in the output already: what is missing are models.

    Attributes
    ----------
    code : int
        The exit code that the plans so far ask for.
    out : Path
        The output.
    parts : int
        Parts that were begun.
    summarised : bool
        Whether the summary of the plan was shown.
    """

    def __init__(self, text: str, code: int, out: Path, parts: int, summarised: bool = False) -> None:
        super().__init__(text)
        self.code, self.out, self.parts, self.summarised = code, out, parts, summarised
