"""Review pages of the gallery get back their script and style, and `<!-- review: NAME -->` becomes a link where the page exists.

Script and style are the same in all pages and stored once: twelve pages that open without the network take 4 MB in place of 12.
"""

import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

#: What all pages share: the file that has it, what stands before it and what behind it.
SHARED = {"page.css": ("<style>", "</style>"), "page.js": ("<script>", "</script>")}
_LINK = re.compile(r" ?<!-- review: ([\w-]+) -->")


def whole(page: Path) -> str:
    """A review page with its script and style.

    Parameters
    ----------
    page : Path
        The page without them; they stand beside it.
    """
    text = page.read_text("utf-8")
    for file in SHARED:
        before, _, after = text.rpartition(f"<!-- {file} -->")
        text = before + (page.parent / file).read_text("utf-8") + after
    return text


def on_files(files: Any, config: Any, **_: Any) -> Any:
    for page in sorted((Path(config.docs_dir) / "gallery").glob("*.page")):
        files.append(File.generated(config, f"gallery/{page.stem}.html", content=whole(page)))
    return files


def on_page_markdown(markdown: str, config: Any, **_: Any) -> str:
    def link(found: re.Match[str]) -> str:
        there = (Path(config.docs_dir) / "gallery" / f"{found[1]}.page").exists()
        return f" [Review page](gallery/{found[1]}.html)" if there else ""

    return _LINK.sub(link, markdown)
