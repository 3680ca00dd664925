"""Texts that are safe to show in a terminal, whatever names in files hold."""

import re

#: What a terminal may obey, or has no form of its own: controls, lone surrogates, breaks, what turns the direction of the rest.
_OBEYED = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff\u2028\u2029\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")


def clean(text: str) -> str:
    r"""A text with what a terminal would obey written out; names in files may hold anything.

    Examples
    --------
    >>> clean("rim\n\x1b[2Jgone")
    'rim\\n\\x1b[2Jgone'
    """
    return _OBEYED.sub(lambda match: match[0].encode("unicode_escape").decode(), text)
