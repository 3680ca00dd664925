r"""Formulas become MathML when the site is built: no script and no network is needed to read them.

`pymdownx.arithmatex` marks them: `$x^2$` in a line, `$$ ... $$` on lines of their own. Without the site they read as they stand.
"""

import html
import re
from typing import Any

from latex2mathml.converter import convert

_MARKED = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', re.DOTALL)


def on_page_content(content: str, **_: Any) -> str:
    return _MARKED.sub(_mathml, content)


def _mathml(found: re.Match[str]) -> str:
    formula = html.unescape(found[3]).strip()
    made: str = convert(formula, display="inline" if found[2] == "(" else "block")
    if "\\" in made:
        raise ValueError(f"not understood in {formula!r}")
    return made
