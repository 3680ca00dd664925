"""How far the work is: a bar on a terminal, plain lines otherwise, and word to the parent process."""

import sys
from typing import Any

import click

from plan_cutters.command.supervise import report


class Progress:
    """A context that tells each stage; nothing is shown where `quiet`."""

    def __init__(self, quiet: bool) -> None:
        self.quiet = quiet
        self.bar: Any = None
        self.tasks: dict[str, Any] = {}
        self.told: set[str] = set()

    def __enter__(self) -> Any:
        if not self.quiet and sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

            self.bar = Progress(TextColumn("{task.description:>10}"), BarColumn(), TimeElapsedColumn(),
                                console=Console(stderr=True), transient=True)  # fmt: skip
            self.bar.start()
        return self.tell

    def tell(self, stage: str, done: int, total: int) -> None:
        if done == 0:
            report("stage", stage)
        if self.bar is not None:
            if stage not in self.tasks:
                self.tasks[stage] = self.bar.add_task(stage, total=total)
            self.bar.update(self.tasks[stage], completed=done, total=total)
        elif not self.quiet and stage not in self.told:
            self.told.add(stage)
            click.echo(f"{stage} ...", err=True)

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.stop()
