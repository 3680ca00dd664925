"""An interim plan can be made at any moment once verdicts stand, while the run goes on, and says what it is without."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from plan_cutters.document.clock import Clock
from plan_cutters.document.notes import noted
from plan_cutters.judged_part import Describe, Described, JudgedPart, assembled, worded
from plan_cutters.judging.judge import FirstLook, first_look, worth_a_look
from plan_cutters.outcome import Answers, Operations
from plan_cutters.plan_file.model import AreaEntry
from plan_cutters.plan_file.words.headline import first_looked
from plan_cutters.plan_file.words.names import called
from plan_cutters.plan_file.words.notes import later_stages, run_unfinished
from plan_cutters.result import Result
from plan_cutters.scene.preparation import Prepared


class Interim:
    """An interim holds the verdicts of a part, and what was found besides.

    `clock`: its seconds are those of the results.
    `stands`: given a result as soon as all verdicts have their reasons, and after each stage that another one follows.
    `begins`: called once, as soon as the verdicts stand: from then on `interrupted` has a result.
    `looks`: given what a first look at the first part that is ready says, if it is much sooner than all verdicts.
    `between`: of `JudgedPart.between`.
    """

    def __init__(
        self, clock: Clock, stands: Callable[[Result], None] | None = None, begins: Callable[[], None] | None = None,
        looks: Callable[[str], None] | None = None,
    ) -> None:  # fmt: skip
        self.answers, self.between = Answers(), dict[str, AreaEntry]()
        self._clock, self._stands, self._begins, self._looks = clock, stands, begins, looks
        self._made: Callable[[], Described] | None = None
        self._unanswered: Sequence[str] | None = None
        self._looked = self._planned = False
        self._absent: list[str] | None = None

    def prepared(self, ready: Prepared, made: Callable[[FirstLook], Described]) -> None:
        """A part is ready to be judged; setups may still be compared.

        `made`: makes a part of a first look at it, as for `verdicts`: that stands until these do.
        """
        if self._made is not None:
            return
        look, looks = None, self._looks
        if looks is not None and worth_a_look(ready):
            look = first_look(ready)
            shares = [(called(cutter), share) for cutter, share in look.shares]
            looks(first_looked(ready.scene.setup, look.samples, look.of, shares, look.together))
        self.verdicts(lambda: made(look or first_look(ready)))

    def verdicts(self, made: Callable[[], Described]) -> None:
        """The verdicts stand: what makes the part of them, with the reasons that were found by then, and describes its plan."""
        begins, self._begins = self._begins, None
        self._made = made
        if begins is not None:
            begins()

    def judged(self, part: JudgedPart, describe: Describe, answers: Answers) -> None:
        """The part is judged, with all reasons."""
        self.answers = answers
        self.verdicts(lambda: (part, describe))
        self._tell()

    def looked(self, between: dict[str, AreaEntry]) -> None:
        """The area between the samples was looked at."""
        self.between, self._looked = between, True
        self._tell()

    def answered(self, answers: Answers, unanswered: Sequence[str] = ()) -> None:
        """Some questions are answered; the words of those that are not, or not for all cutters."""
        self.answers, self._unanswered = answers, unanswered
        self._tell()

    def planned(self, operations: Operations | None) -> None:
        """The operations are planned."""
        self.answers, self._planned = replace(self.answers, operations=operations), True
        self._tell()

    def interrupted(self, work: str) -> Result | None:
        """The result of what stands, if verdicts do; `work`: what was going on, as `planning the operations`."""
        if self._made is None:
            return None
        part, describe = self._made()
        return self._result(part, describe, self._missing(part), work)

    def _tell(self) -> None:
        """Let a result stand if that is news, and something follows."""
        if self._stands is None or self._made is None:
            return
        part, describe = self._made()
        absent = self._missing(part)
        if absent and absent != self._absent:
            self._absent = absent
            self._stands(self._result(part, describe, absent))

    def _missing(self, part: JudgedPart) -> list[str]:
        options = part.ready.options
        each = later_stages(
            setups=part.later, proposal=part.proposing, samples=part.few, reasons=part.unexplained,
            witnesses=not part.witnessed, area=part.looks_between and not self._looked,
            answers=options.answers if self._unanswered is None else self._unanswered,
            operations=None if self._planned else options.operations, maps=options.posture_maps,
            process=options.process is not None and not self._planned,
        )  # fmt: skip
        return [name for name in each if name]

    def _result(self, part: JudgedPart, describe: Describe, absent: Sequence[str], work: str = "") -> Result:
        result = assembled(part, self._clock, self.answers, self.between)
        note = run_unfinished(absent, work, unexplained=bool(part.unexplained)) if absent else None
        document = result.plan if note is None else noted(result.plan, note)
        return worded(replace(result, plan=describe(document)), self._clock)
