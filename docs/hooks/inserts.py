"""`<!-- help: plan-cutters -->` in a page becomes what that command prints with `--help-all`, so that the page cannot grow old.

`<!-- file: pictures/summary.txt -->` becomes the text of that file, and `<!-- notebook: notebook.ipynb -->` the cells
of that notebook.
"""

import json
import re
from pathlib import Path
from typing import Any

from click import Command
from click.testing import CliRunner

from plan_cutters.command.entry import module_of


def on_page_markdown(markdown: str, **_: Any) -> str:
    markdown = re.sub(r"<!-- help: (.+?) -->", lambda found: f"```text\n{_help(found[1])}```", markdown)
    docs = Path(__file__).parent.parent
    markdown = re.sub(r"<!-- notebook: (\S+) -->", lambda found: _cells(docs / found[1]), markdown)
    return re.sub(r"<!-- file: (\S+) -->", lambda found: _text(docs / found[1]), markdown)


def _text(file: Path) -> str:
    """A file as it stands, with the colours of its language."""
    language = {".yaml": "yaml", ".sbatch": "bash"}.get(file.suffix, "text")
    return f"```{language}\n{file.read_text('utf-8')}```"


def _cells(notebook: Path) -> str:
    """The texts of a notebook as they stand, its titles one step lower, and its code."""
    made = []
    for cell in json.loads(notebook.read_text("utf-8"))["cells"]:
        text = "".join(cell["source"])
        made.append(f"```python\n{text}\n```" if cell["cell_type"] == "code" else re.sub("^#", "##", text, flags=re.M))
    return "\n\n".join(made)


def _help(name: str) -> str:
    command: Command = module_of(name).command
    result = CliRunner(env={"COLUMNS": "100", "NO_COLOR": "1", "TERM": "dumb"}).invoke(command, ["--help-all"], prog_name=name)
    if result.exit_code:
        raise RuntimeError(f"{name} --help-all: {result.output or result.exception}")
    return result.output
