"""Shares are written in percent by one function: what is not all is nowhere rounded to 100 %, what is something not to 0 %."""

import re

from tests.support.places import ROOT

#: Where a share becomes a text.
PLACES = {"plugin/plan_cutters/domain/figures.py"}
#: A number with a form of its own before the sign, in braces or as `%` writes it, and Python's own form of a percentage.
FORMATTED = re.compile(r":[^{}\"']*%\}|:[^{}\"']*[defg]\} ?%|%\.?\d*[defg] ?%%")


def texts():
    for folder, pattern in (("plugin", "*.py"), ("cad_io", "*.py"), ("freecad", "*.py"), ("freecad", "*.FCMacro")):
        for path in (ROOT / folder).rglob(pattern):
            yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")


def test_the_search_knows_a_share_by_its_form():
    for line in ('f"{share:.1%} of"', 'f"{100.0 * share:.3g} % of"', '"%.3g %% of" % share', 'f"{100 * held:.1f}%"'):
        assert FORMATTED.search(line), line
    for line in ('f"{percent(share)} of"', 'f"{length:.3g} mm"', '"%d of %s"', 'f"{number % 7:d}"', "a % b"):
        assert not FORMATTED.search(line), line


def test_shares_have_one_form():
    found = dict(texts())
    assert [
        f"{path}: {line.strip()}"
        for path, text in found.items()
        if path not in PLACES
        for line in text.splitlines()
        if FORMATTED.search(line)
    ] == []
