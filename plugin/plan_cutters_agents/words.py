"""Questions as words of the command: every file that one names lies in a root, and is no larger than is allowed."""

from pathlib import Path

from plan_cutters.errors import PlanError
from plan_cutters_agents.limits import CallError, Limits
from plan_cutters_agents.requests import Conditions, MapQuestion, PartQuestion, Sampling
from plan_cutters_agents.roots import Roots


class Permissions:
    """A call may read and write here, and cost so much.

    Parameters
    ----------
    roots : Roots
    limits : Limits
    """

    def __init__(self, roots: Roots, limits: Limits) -> None:
        self.roots, self.limits = roots, limits

    def file(self, text: str) -> str:
        """The path of a file that may be read."""
        return str(self.roots.file(text, self.limits.file_mb))

    def conditions(self, question: Conditions) -> list[str]:
        """Words for what cutters are judged under, without the cutters."""
        options = [
            f"--tolerance={question.tolerance_mm!r}",
            f"--allowance={question.allowance_mm!r}",
            f"--holder-clearance={question.holder_clearance_mm!r}",
            f"--machine={self._machine(question.machine)}",
        ]
        options += [f"--cutters={self.file(question.library)}"] if question.library is not None else []
        options += [f"--holder={self._holder(question.holder)}"] if question.holder is not None else []
        options += [f"--fixture={self._fixture(each)}" for each in question.fixtures]
        options += [f"--ignore={each}" for each in question.ignore]
        options += [f"--unit={question.unit}"] if question.unit is not None else []
        return options + ["--flip"] * question.flip

    def sampling(self, question: Sampling) -> list[str]:
        """Words for how densely a surface is looked at; the area between the samples is not."""
        options = ["--area-budget=0"]
        options += [f"--grid={question.grid}"] if question.grid is not None else []
        return options + ([f"--spacing={question.spacing_mm!r}"] if question.spacing_mm is not None else [])

    def part(self, question: PartQuestion) -> list[str]:
        """Words for a part, its cutters and their conditions."""
        if len(question.cutters) > self.limits.cutters:
            raise CallError(
                f"cutters: {len(question.cutters)} are given, and this server judges at most {self.limits.cutters} in a call"
            )
        options = [self.file(question.part), *self.conditions(question), *self.sampling(question), f"--faces={question.faces}"]
        options += [f"--cutter={each}" for each in question.cutters]
        return options + [f"--setup={each}" for each in question.setup]

    def map(self, question: MapQuestion) -> list[str]:
        """Words for a posture map."""
        at = ",".join(repr(x) for x in question.point)
        words = [self.file(question.part), *self.conditions(question), f"--at={at}", f"--within={question.within_mm!r}",
                 f"--cutter={question.cutter}", f"--setup={question.setup}",
                 f"--rotation-step={question.rotation_step_deg!r}"]  # fmt: skip
        return words if question.tilt_deg is None else [*words, "--tilt={!r}:{!r}".format(*question.tilt_deg)]

    def _machine(self, text: str) -> str:
        from plan_cutters.domain.machine import builtin_machines

        if text == "unlimited" or text.startswith("tilt:") or text in builtin_machines():
            return text
        return self._marked(text)

    def _holder(self, text: str) -> str:
        from plan_cutters.domain.holder import Holder

        if text.strip().lower() == "none":
            return "none"
        try:
            Holder.parse(text)
        except PlanError as error:
            if not _is_path(text):
                raise CallError(str(error)) from None
            return self._marked(text)
        # A word that is a holder is read as one, whatever file there is.
        return text

    def _marked(self, text: str) -> str:
        """A file, or `FILE#MORE` where no file has the whole name."""
        file, mark, more = text.rpartition("#")
        if mark and not self.roots.confined(text).exists():
            return f"{self.file(file)}#{more}"
        return self.file(text)

    def _fixture(self, text: str) -> str:
        from dataclasses import replace

        from plan_cutters.domain.fixture import Fixture

        fixture = Fixture.parse(text)
        if fixture.kind:
            return text
        placed = replace(fixture, source=self.file(fixture.source), placement=fixture.placement)
        # Placement and unit are said, so that nothing in the path of a root is taken for them.
        where = ",".join(repr(x) for x in placed.placement)
        return f"{placed.source}@{where}{f':{placed.unit}' if placed.unit else ''}"


def _is_path(text: str) -> bool:
    return "/" in text or "\\" in text or "#" in text or Path(text).suffix != ""
