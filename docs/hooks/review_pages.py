"""Review pages of the gallery go into the site where they were made, and `<!-- review: NAME -->` becomes a link there.

`python docs/gallery.py` makes them in `build/gallery`: they are too large to be kept with the sources.
"""

import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

_LINK = re.compile(r" ?<!-- review: ([\w-]+) -->")


def pages(config: Any) -> Path:
    """The folder of the review pages, which need not be there."""
    return Path(config.docs_dir).parent / "build" / "gallery"


def on_files(files: Any, config: Any, **_: Any) -> Any:
    for page in sorted(pages(config).glob("*.html")):
        files.append(File.generated(config, f"gallery/{page.name}", content=page.read_text("utf-8")))
    return files


def on_page_markdown(markdown: str, config: Any, **_: Any) -> str:
    def link(found: re.Match[str]) -> str:
        there = (pages(config) / f"{found[1]}.html").exists()
        return f" [Review page](gallery/{found[1]}.html)" if there else ""

    return _LINK.sub(link, markdown)
