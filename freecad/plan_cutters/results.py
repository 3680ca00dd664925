"""What the program answered, read from its files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Spot:
    """A worst spot: a sample that a cutter does not reach.

    Parameters
    ----------
    cutter : str
        Id of the cutter.
    number : int
        Its place in the cutter's list of witnesses, worst first.
    face : str
        `F3`.
    point : tuple of float
        mm, in the document's coordinates.
    axis : tuple of float, optional
        Unit tool axis of the nearest posture tried; None where none can be shown.
    tip : tuple of float, optional
        Where the tip of the tool is then, mm.
    reason : str
        Code of the reason.
    obstacle : str
        What is in the way, as `F7` or `fixture:vise`; empty where nothing is named.
    depth_mm : float
        How deep the tool is in it.
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
    depth_mm: float
    text: str


@dataclass(frozen=True)
class Result:
    """A plan with its files.

    Parameters
    ----------
    plan : dict
        `plan.json`.
    folder : str
        Where its files are.
    body, document : str
        Names of what was planned.
    """

    plan: dict[str, Any]
    folder: str
    document: str = ""
    body: str = ""

    def shown(self) -> dict[str, Any]:
        """The cutter that is shown: the selected one, else the one that reaches most."""
        if self.plan["selected"]:
            return next(each for each in self.plan["cutters"] if each["id"] == self.plan["selected"])
        return max(self.plan["cutters"], key=lambda each: each["interference_free"] + each["accessible"])

    def cutters(self) -> list[str]:
        """Ids of the cutters, in the order of the plan."""
        return [each["id"] for each in self.plan["cutters"]]

    def headline(self) -> str:
        """The verdict in one line."""
        return self.summary()[0]

    def summary(self) -> list[str]:
        """What the plan says, line by line."""
        return ["no plan"]

    def legend(self) -> list[tuple[str, str, tuple[float, float, float]]]:
        """Code, words and colour (0 to 1) of each verdict that is shown."""
        return []

    def spots(self, cutter: str = "") -> list[Spot]:
        """Worst spots of a cutter, by default of the one shown; worst first."""
        return []

    def review(self) -> str:
        """Path of the review page; empty where there is none."""
        return ""
