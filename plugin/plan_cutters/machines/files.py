"""Files that are machine files, or should be; and what whoever gives one adds where it leaves something open."""

from typing import ClassVar, NamedTuple

from plan_cutters.domain.checks import shown
from plan_cutters.errors import MachineError, PlanError
from plan_cutters.files import content

#: How the two senses of an axis that carries the part are called after `FILE#`.
TABLE, TOOL = "table", "tool-relative"


class Content(content.Content):
    """A file that may be a machine file."""

    noun: ClassVar[str] = "machine file"
    error: ClassVar[type[PlanError]] = MachineError


class Added(NamedTuple):
    """The user adds these facts to a machine's file, where the file leaves them open."""

    #: Names of rotary axes: those that carry the part, the one next to the part first; those that carry the tool, the one next
    #: to the tool last.
    part: tuple[str, ...] = ()
    tool: tuple[str, ...] = ()
    #: `table`: positive angles of axes that carry the part are those of the table's own motion; `tool-relative`: of the tool
    #: relative to the part, as in ISO 841; empty where nothing is said.
    sign: str = ""

    @property
    def order(self) -> tuple[str, ...]:
        """Names of rotary axes from the part to the tool."""
        return self.part + self.tool

    @property
    def text(self) -> str:
        """How it was said."""
        order = ",".join(self.part) + ("/" + ",".join(self.tool) if self.tool else "")
        return ",".join(word for word in (order, self.sign) if word)

    @classmethod
    def parse(cls, text: str) -> "Added":
        """Read what stands after `FILE#`, as `C,A`, `C/B`, `table` or `C,A,table`.

        >>> Added.parse("C/B,table")
        Added(part=('C',), tool=('B',), sign='table')
        """
        words, sign = [], ""
        for word in text.split(","):
            if word.strip().lower() in (TABLE, TOOL):
                sign = word.strip().lower()
            else:
                words.append(word.strip())
        part, _, tool = ",".join(words).partition("/")
        sides = [tuple(word.strip().upper() for word in side.split(",") if word.strip()) for side in (part, tool)]
        names = sides[0] + sides[1]
        if not (names or sign) or len(set(names)) < len(names) or not all(name.isalnum() for name in names):
            raise MachineError(
                f"{shown('#' + text)} says nothing of a machine: give its rotary axes from the part to the tool, as #C,A, or "
                f"#C/B where C carries the part and B the tool; or how angles of a table are counted, #{TABLE} or #{TOOL}"
            )
        return cls(sides[0], sides[1], sign)

    def refuse(self, name: str, *, order: bool = False, sign: bool = False) -> None:
        """An error where something is said that the file says itself."""
        if (order and self.order) or (sign and self.sign):
            what = "the order of its axes" if order and self.order else "how its angles are counted"
            raise MachineError(f"it says {what} itself: leave out #{self.text}", file=name)
