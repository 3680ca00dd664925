"""Keep pages safe whatever names in files hold: their texts, their data and their policy."""

import base64
import hashlib
import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from plan_cutters_base.terminal_text import clean

_BETWEEN = re.compile("[^\t\n]+")
_NO_TEXT = re.compile("[\ufffe\uffff]")


def plain(value: Any) -> Any:
    r"""A text with what has no place in a page written out, as a terminal shows it: controls, halves of surrogate pairs.

    >>> plain("rim\x07"), plain("a\nb"), plain("\uffff"), plain(1)
    ('rim\\x07', 'a\nb', '\\uffff', 1)
    """
    if not isinstance(value, str) or isinstance(value, Markup):
        return value
    cleaned = _BETWEEN.sub(lambda match: clean(match[0]), value)
    return _NO_TEXT.sub(lambda match: match[0].encode("unicode_escape").decode(), cleaned)


def embedded(value: Any) -> str:
    """JSON that may stand in a page: nothing in it ends the element or begins another one.

    Texts are as by `plain`, and null stands where a number is not finite.
    """
    text = json.dumps(_texts(finite(value)), ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return re.sub("[<>&]", lambda match: f"\\u{ord(match[0]):04x}", text)


def finite(value: Any) -> Any:
    """The value for JSON: None for each number in it that is not finite."""
    if isinstance(value, Mapping):
        return {key: finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _texts(value: Any) -> Any:
    """The value with its texts as by `plain`, those by which it is found, too."""
    if isinstance(value, dict):
        return {plain(key): _texts(each) for key, each in value.items()}
    return [_texts(each) for each in value] if isinstance(value, list) else plain(value)


def policy(script: str, style: str, images: str) -> str:
    """The content security policy of a page: it runs this script, has this style, and loads nothing but such images."""
    return (
        f"default-src 'none'; script-src '{_hash(script)}'; style-src '{_hash(style)}'; img-src {images}; "
        "base-uri 'none'; form-action 'none'"
    )


def template(path: Path) -> jinja2.Template:
    """A template of a page: what is put in is escaped, and cleaned as by `plain`; an unknown name is an error."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(path.parent), autoescape=True, undefined=jinja2.StrictUndefined, finalize=plain,
        trim_blocks=True, lstrip_blocks=True,
    ).get_template(path.name)  # fmt: skip


def _hash(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def with_three(script: str) -> str:
    """The script of a page that shows the part, and before it what such pages share of three.js."""
    return Path(__file__).parents[1].joinpath("report", "page", "three.js").read_text(encoding="utf-8") + script
