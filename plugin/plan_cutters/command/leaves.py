"""Commands that other packages add, by entry points of the group `plan_cutters.commands`.

Each names a module that has the `command` of click and `main`; the first line of its text is the sentence in the help.
"""

import contextlib
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path

GROUP = "plan_cutters.commands"


@cache
def leaves() -> dict[str, str]:
    """List the modules of the commands that installed packages add, by name; of two of a name, the first on the path.

    The files are read here: `importlib.metadata` alone takes a third of the time that help may take.
    """
    modules: dict[str, str] = {}
    for folder in sys.path:
        for file in sorted(Path(folder or ".").glob("*.dist-info/entry_points.txt")):
            text = ""
            with contextlib.suppress(OSError):  # what nobody may read adds no command
                text = file.read_text(encoding="utf-8", errors="replace")
            group = text.partition(f"[{GROUP}]\n")[2].partition("\n[")[0]
            for line in filter(None, map(str.strip, group.splitlines())):
                name, equals, module = map(str.strip, line.partition("="))
                if equals and name.isidentifier():
                    modules.setdefault(name, module.partition(":")[0])
    return modules


def sentence(module: str) -> str:
    """Read the first line of a module's text, without running it."""
    try:
        spec = find_spec(module)
        code = spec.loader.get_code(module) if spec else None  # type: ignore[union-attr]
    except (ImportError, AttributeError, SyntaxError, ValueError):
        code = None
    text = code.co_consts[0] if code and code.co_consts else None
    return text.strip().splitlines()[0] if isinstance(text, str) and text.strip() else f"It cannot be loaded: {module}."
