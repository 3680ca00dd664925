"""Say in sentences how much of the surface lies inside other bodies of the part."""

from collections.abc import Sequence

from plan_cutters.domain.figures import area as size
from plan_cutters.domain.figures import listed, percent
from plan_cutters.plan_file.inside import CoveringBody
from plan_cutters.plan_file.model import Plan


def inside(plan: Plan, most: int = 5) -> list[str]:
    """Say how much lies inside other bodies of the part, then name the bodies that a planner must look at."""
    entry = plan.inside_other_bodies
    if not entry.samples:
        return []
    share = percent(entry.share, some=True, whole=entry.samples == plan.samples.count)
    lines = [
        f"{share} of the target area ({entry.samples:,} of {plan.samples.count:,} samples) lies inside other bodies of the "
        "part: it is no surface of the finished part, and what follows is about the rest."
    ]
    covering_bodies = sorted((each for each in entry.bodies if each.how != "overlaps"), key=lambda each: each.largest)
    lines += [_body_text(each) for each in covering_bodies[:most]]
    lines += _more(covering_bodies[most:], "body covers", "bodies cover")
    over = [each for each in entry.bodies if each.how == "overlaps"]
    if over:
        each = "; ".join(f"{_called(b)} covers {size(b.area_mm2)} of {listed(b.faces, 4)}" for b in over[: most - 2])
        rest = len(over) - (most - 2)
        lines.append(f"Bodies overlap: {each}{f'; {rest} more in plan.json' if rest > 0 else ''}.")
    if entry.sheets is not None:
        sheets, area = entry.sheets, size(entry.sheets.area_mm2)
        what = "is a construction sheet" if len(sheets.faces) == 1 else "are construction sheets"
        lines.append(
            f"{listed(sheets.faces)} {what} on the skin of a body: {area} face into it. {sheets.option} leaves such sheets out."
        )
    return lines


def _body_text(body: CoveringBody) -> str:
    on, area = listed(body.faces, 4), size(body.area_mm2)
    verb = "stands on" if body.how == "stands_on" else "touches or overlaps"
    if body.largest:
        touch = "touches" if len(body.faces) == 1 else "touch"
        return f"{_called(body, first=True)} covers {area} of {on}, which {touch} it."
    return (
        f"{_called(body, first=True)} {verb} {on} and covers {area} there. It stays in the way, and what lies under "
        f"it is not planned. To plan that, as for another clamping, leave the body out (nothing is then checked against it): "
        f"{body.option}."
    )


def _called(body: CoveringBody, *, first: bool = False) -> str:
    """A body as it is told: its number, its name, its faces."""
    name = f' "{body.name}"' if body.name else ""
    return f"{'Body' if first else 'body'} {body.number}{name} ({listed(body.own_faces, 2)})"


def _more(bodies: Sequence[CoveringBody], one: str, many: str) -> list[str]:
    if not bodies:
        return []
    area = size(sum(each.area_mm2 for each in bodies))
    return [f"{len(bodies)} more {one if len(bodies) == 1 else many} {area}: see plan.json."]
