"""A result where people work: as text in a terminal of Python, as a card in a notebook, as a page in a browser."""

import base64
import io
import os
import sys
import tempfile
import webbrowser
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Literal, NamedTuple, get_args

from plan_cutters.domain.checks import shown
from plan_cutters.domain.figures import reporting
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.files.markup import plain, template
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.shares import VERDICTS
from plan_cutters.plan_file.words.cutters import FEASIBLE
from plan_cutters.plan_file.words.names import typed
from plan_cutters.plan_file.words.text import Story, further, of_the_plan, story_of
from plan_cutters.report.page.write import page
from plan_cutters.report.protocol import Judged

#: Height of the page in a notebook, pixels.
HEIGHT = 640
Size = Literal["full", "small"]
#: Where the size of cards that end a cell is set; what a small one has at most: bytes, and cutters that are listed.
VARIABLE, SMALL, _LISTED = "PLAN_CUTTERS_CARD", 50_000, 12
#: Widths of the picture of a small card, pixels: the first that leaves it small enough is taken.
_WIDTHS = (720, 560, 440, 320)
#: Verdicts as a column calls them.
_COLUMNS = {word: "free" if word == "interference_free" else word for word in VERDICTS}
#: Narrowest column of the table of text: room for `>99.9 %`.
_NARROWEST = 8
_TEMPLATE = template(Path(__file__).parent / "notebook.html.jinja")


class _Chip(NamedTuple):
    """How the headline stands out: a sign, for those who see no colour, and the colours of paper and ink."""

    sign: str
    paper: str
    ink: str


_CHIPS = {True: _Chip("✓", "#00664b", "#ffffff"), False: _Chip("✗", "#a33c00", "#ffffff"), None: _Chip("?", "#f0e442", "#000000")}


@reporting(lambda plan: plan.effective.units)
def text_of(plan: Plan) -> str:
    """The plan in words: what to take and why, what makes it unsure, a line for each cutter, what is not reached."""
    story = story_of(plan)
    lines = [plan.text.headline, *plan.text.lines, "", *story.inside, *of_the_plan(story), "", *_table(story), ""]
    lines += [each.left for each in story.cutters if each.left]
    lines += further(story)
    return "\n".join(plain(typed(line)).rstrip() for line in lines).strip() + "\n"


def chosen_size() -> Size:
    """The size of cards that end a cell: small, which git can hold, unless `PLAN_CUTTERS_CARD=full`."""
    return "full" if os.environ.get(VARIABLE) == "full" else "small"


@reporting(lambda result: result.plan.effective.units)
def card(result: Judged, *, height: int = HEIGHT, size: Size = "full") -> str:
    """The result as HTML for a notebook: headline, what makes it unsure, table, picture, and the review page to be opened.

    The page stands in a frame of its own, whose script reaches nothing of the notebook. What cannot be made is named. A small
    card has no page, a smaller picture, and the first cutters alone: a notebook that is kept in git grows by at most `SMALL`.
    """
    story, missing = story_of(result.plan), list[str]()

    def made(what: str, make: Callable[[], str]) -> str:
        try:
            return make()
        except Exception as error:  # whatever fails in the kernel or on the disk must not hide the verdicts
            missing.append(f"The {what} could not be made: {error or type(error).__name__}")
            return ""

    picture = made("picture", lambda: _picture(result))
    if size == "small":
        rest = partial(_rendered, result, story, height, page="", missing=missing, most=_LISTED)
        small = made("small picture", lambda: _small(picture, SMALL - len(rest().encode()))) if picture else ""
        return rest(picture=small, kind="webp")
    framed = made("review page", lambda: page(result).decode())
    return _rendered(result, story, height, picture=picture, page=framed, missing=missing)


def show(result: Judged, height: int = HEIGHT, size: Size = "full") -> Path | None:
    """Show the review page: in a notebook below the cell, else in a browser, from a file in the folder for temporary files.

    A small card is for notebooks alone: it stands below the cell without the page. Returns the file, which stays there; None in
    a notebook. A PlanError, which names the file, where no browser is found.
    """
    if size not in get_args(Size):
        raise OptionError(f"card: {shown(size)} is neither full nor small")
    if _in_notebook():
        from IPython.display import HTML, display

        whole = partial(_rendered, result, story_of(result.plan), height, opened=True)
        display(HTML(card(result, size=size) if size == "small" else whole(page=page(result).decode())))
        return None
    data = page(result)
    path = Path(tempfile.mkdtemp(prefix="plan-cutters-")) / "review.html"
    path.write_bytes(data)
    if not webbrowser.open(path.as_uri()):
        raise PlanError("no browser was found to show this page: open it yourself, or name one in BROWSER", file=str(path))
    return path


def _in_notebook() -> bool:
    """Whether this process is the kernel of a notebook: a terminal of IPython shows no HTML."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return getattr(shell, "kernel", None) is not None


def _table(story: Story) -> list[str]:
    """A line for each cutter, in columns that are as wide as they must be; `>` marks the one to take."""
    rows = [["cutter", "finishes", *_COLUMNS.values()]]
    rows += [[plain(each.name), FEASIBLE[each.feasible], *(each.shares[word] for word in _COLUMNS)] for each in story.cutters]
    wide = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    marks = [" ", *(">" if each.id == story.taken else " " for each in story.cutters)]
    return [
        f"{mark} {row[0]:<{wide[0]}}  {row[1]:<{wide[1]}}  "
        + "  ".join(f"{cell:>{max(width, _NARROWEST)}}" for cell, width in zip(row[2:], wide[2:], strict=True))
        for mark, row in zip(marks, rows, strict=True)
    ]


def _picture(result: Judged) -> str:
    from plan_cutters.report.drawing.part import write_png
    from plan_cutters.report.models import split_result

    with tempfile.TemporaryDirectory(prefix="plan-cutters-") as folder:
        path = Path(folder) / "review.png"
        write_png(result, split_result(result), path)
        return base64.b64encode(path.read_bytes()).decode()


def _small(picture: str, most: int) -> str:
    """A picture, PNG in base64, as a smaller one, WebP in base64, of so many bytes; an error where it has no room."""
    from PIL import Image

    whole = Image.open(io.BytesIO(base64.b64decode(picture))).convert("RGB")
    for wide in _WIDTHS:
        stream = io.BytesIO()
        whole.resize((wide, round(whole.height * wide / whole.width)), Image.Resampling.LANCZOS).save(stream, "webp", quality=60)
        text = base64.b64encode(stream.getvalue()).decode()
        if len(text) <= most:
            return text
    raise PlanError("it is too large for a small card; show(card='full') has it")


def _rendered(
    result: Judged, story: Story, height: int, *, page: str, picture: str = "", missing: list[str] | None = None,
    opened: bool = False, kind: str = "png", most: int | None = None,
) -> str:  # fmt: skip
    cutters = [
        {"id": each.id, "name": each.name, "finishes": FEASIBLE[each.feasible], "reason": each.reason,
         "shares": [each.shares[word] for word in _COLUMNS]}
        for each in (sorted(story.cutters, key=lambda c: c.id != story.taken) if most else story.cutters)
    ]  # fmt: skip
    return _TEMPLATE.render(
        chip=_CHIPS[story.headline.good], headline=story.headline,
        text="\n".join(result.plan.text.lines),
        told=[*map(typed, (*story.inside, *of_the_plan(story)))], columns=list(_COLUMNS.values()),
        cutters=cutters[:most], unlisted=max(0, len(cutters) - most) if most else 0, kind=kind,
        taken=story.taken, shown=story.names[result.shown], picture=picture, page=page, open=opened,
        file=result.plan.part.file, height=int(height), missing=missing or [],
    )  # fmt: skip
