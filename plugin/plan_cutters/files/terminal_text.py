"""Texts that are safe to show in a terminal, whatever names in files hold."""

import unicodedata

#: Categories of characters that a terminal may obey, or that have no form of their own: controls, lone surrogates, breaks.
_OBEYED = frozenset({"Cc", "Cs", "Zl", "Zp"})
#: Those that turn the direction of what follows.
_TURNING = frozenset("\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")


def clean(text: str) -> str:
    r"""A text with what a terminal would obey written out; names in files may hold anything.

    Examples
    --------
    >>> clean("rim\n\x1b[2Jgone")
    'rim\\n\\x1b[2Jgone'
    """
    return "".join(
        c.encode("unicode_escape").decode() if unicodedata.category(c) in _OBEYED or c in _TURNING else c for c in text
    )
