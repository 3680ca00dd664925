"""Progress over all parts."""

from plan_cutters.batch.row import PartRow


class Board:
    """A stand-in until the board of progress is there."""

    def __init__(self, quiet: bool, total: int | None) -> None:
        self.quiet, self.total = quiet, total

    def row(self, row: PartRow) -> None:
        """A part is done."""

    def told(self, done: int, running: int, total: int | None) -> None:
        """So many parts are done and so many are with workers, of all."""

    def say(self, text: str) -> None:
        """A line for people."""

    def close(self) -> None:
        """Leave the line to others."""
