"""The long description: the README with addresses in place of its links to files, which a package index does not have.

All else stands in `pyproject.toml`, the address of the project too.
"""

import re
import tomllib
from pathlib import Path

from setuptools import setup

_LINK = re.compile(r"(!?)\[([^\]]*)\]\((?![a-z]+:|#)([^)\s]+)\)")


def long_description(root: Path) -> str:
    """The README of a checkout; pictures are where their bytes are, and all other files where they are shown."""
    source = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]["urls"]["Source"]

    def absolute(link: re.Match[str]) -> str:
        way = "raw" if link[1] else "blob"
        return f"{link[1]}[{link[2]}]({source}/{way}/main/{link[3]})"

    return _LINK.sub(absolute, (root / "README.md").read_text(encoding="utf-8"))


if __name__ == "__main__":
    setup(long_description=long_description(Path(__file__).parent), long_description_content_type="text/markdown")
