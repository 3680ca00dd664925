"""Say what was judged: which faces and samples, what is undecided, what is odd about faces, and which setups were proposed."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence

from plan_cutters.domain.figures import area as mm2
from plan_cutters.domain.figures import capital, count, joined, listed, mm, percent, ranges, reported, size, some
from plan_cutters.domain.placement import axis_words
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.nearest import nearest
from plan_cutters.plan_file.part_info import CoveringBody, PatternEntry, Scope
from plan_cutters.plan_file.setups import ProposedSetup
from plan_cutters.plan_file.shares import part_of

#: Choices that name kinds of faces, not faces.
_BY_KIND = frozenset({"sculptured", "blends", "all"})


def judged(plan: Plan) -> str:
    """The part with its size, or what of it was judged: `the 6 fillets of part.step, 40 x 40 x 20 mm (23 % of the area)`."""
    part, scope = sized(plan, plan.part.file or "the part"), plan.scope
    if scope is None or not scope.not_judged:
        return part
    return f"{_requested(plan, scope)} of {part} ({_share(scope)} of the area)"


def requested(plan: Plan) -> str:
    """Name what of the part was judged, below a line with its name: `the 6 fillets (23 % of the area)`."""
    return f"{_requested(plan, plan.scope)} ({_share(plan.scope)} of the area)" if plan.scope else "the part"


def sized(plan: Plan, part: str) -> str:
    """The name of the part, and its size, which shows a wrong unit at a glance."""
    return f"{part}, {size(plan.part.size_mm)}"


def headline_cutter(plan: Plan) -> CutterEntry:
    """The cutter that the headline is about: the one to take, else the one that leaves the least area."""
    taken = plan.selected or plan.selected_over_setups or plan.selected_for_setup
    return next((c for c in plan.cutters if c.id == taken), None) or nearest(plan.cutters)


def shown_cutter(plan: Plan) -> CutterEntry:
    """The cutter that models and pictures show."""
    return next((c for c in plan.cutters if c.id == plan.shown), None) or nearest(plan.cutters)


def not_judged(plan: Plan) -> list[str]:
    """Say in a sentence which faces were not judged, and which option requests them."""
    scope = plan.scope
    if scope is None or not scope.not_judged:
        return []
    many = scope.not_judged > 1
    what = _listed(scope.not_judged_by_kind)
    return [f"{what} {'were' if many else 'was'} not judged, only {'obstacles' if many else 'an obstacle'}: --faces all."]


def _requested(plan: Plan, scope: Scope) -> str:
    words = {word.strip() for word in plan.effective.faces.split(",")}
    if words <= _BY_KIND:
        return f"the {_listed(scope.judged_by_kind).removeprefix('1 ')}"
    return f"the {scope.judged} faces asked for" if scope.judged > 1 else "the face asked for"


def _listed(kinds: dict[str, int]) -> str:
    """Faces by their kinds: `6 free-form faces, 39 plane and round faces and 12 fillets`."""
    free, blends = kinds.get("sculptured", 0), kinds.get("blend", 0)
    plane = kinds.get("plane", 0)
    others = sum(kinds.values()) - free - blends
    simple = "plane and round" if 0 < plane < others else "plane" if plane else "round"
    each = [_counted(free, "free-form face"), _counted(others, f"{simple} face"), _counted(blends, "fillet")]
    return joined([text for text in each if text])


def _counted(number: int, word: str) -> str:
    return f"{number:,} {word}{'' if number == 1 else 's'}" if number else ""


def _share(scope: Scope) -> str:
    whole = scope.judged_mm2 + scope.not_judged_mm2
    return percent(scope.judged_mm2 / whole if whole > 0.0 else 0.0, some=scope.judged > 0, whole=False)


def unseen(plan: Plan) -> bool:
    """Whether a cutter of the process may miss what lies between the samples; who says how densely to sample asked for that."""
    if plan.effective.sampled_by != "default":
        return False
    used = {step.cutter for step in plan.process.steps} if plan.process else set()
    taken = plan.selected or plan.selected_over_setups
    return any(not c.seen for c in plan.cutters if c.id == taken or (taken is None and c.id in used))


def not_seen(plan: Plan, names: Mapping[str, str]) -> list[str]:
    """Whether more lies between the samples than the cutter to take, or the one that comes nearest, is wide; in a sentence."""
    entry = headline_cutter(plan)
    if entry.seen:
        return []
    widest = max(plan.faces, key=lambda f: f.gap_mm or 0.0)
    on = f" on {widest.id}" if widest.gap_mm else ""
    return [
        f"What lies between the samples was not seen: they are up to {mm(plan.samples.max_gap_mm)} apart{on}, more than the "
        f"radius of {names[entry.id]}, {mm(entry.radius, 4)}. --spacing {entry.radius:.4g} looks more closely."
    ]


#: Faces that are named one by one.
_FACES = 3
#: A tolerance that is finer by this is the next to try.
_FINER = 2.0


def undecided(plan: Plan, names: Mapping[str, str]) -> list[str]:
    """Two sentences, how much and where, and why with what would decide it; none where no sample is undecided."""
    entry = headline_cutter(plan)
    if not entry.undecided:
        return []
    share = part_of(entry, entry.area_share, ["undecided"])
    where = (
        f"{capital(names[entry.id])} leaves {share} of the area undecided ({count(entry.undecided, 'sample')}): "
        f"{_where(plan, entry)}."
    )
    return [where, " ".join(_causes(plan, entry))]


def _where(plan: Plan, entry: CutterEntry) -> str:
    """Faces with their own undecided shares, the largest undecided area first."""

    def area(name: str) -> float:
        face_entry = entry.faces[name]
        mm2 = face_entry.area_share.undecided * (1.0 - face_entry.inside_share) * sizes[name]
        return mm2 if math.isfinite(mm2) else 0.0

    sizes = {face.id: face.area_mm2 for face in plan.faces}
    faces = sorted((name for name, face_entry in entry.faces.items() if face_entry.undecided), key=lambda name: -area(name))
    each = [f"{part_of(entry.faces[f], entry.faces[f].area_share, ['undecided'])} of {f}" for f in faces]
    return listed(each, _FACES)


def _causes(plan: Plan, entry: CutterEntry) -> Iterator[str]:
    """Say each cause that there may be. Which of several left a sample undecided is known only for the tolerance."""
    tolerance, raised = plan.effective.tolerance_mm, "tolerance_raised" in plan.note_codes
    # Of a cutter that is too small, all samples; else those on faces that triangles do not follow.
    coarse = entry.undecided_by_reason.get("tolerance", 0)
    if coarse and coarse >= plan.samples.judged:
        way = (
            "No smaller --tolerance can be kept: rebuild in CAD what triangles cannot follow, or judge a larger cutter"
            if raised
            else "A smaller --tolerance decides it"
        )
        yield f"The tolerance, {mm(tolerance)}, is too coarse for this cutter. {way}."
        return
    loose, missing = plan.effective.local_tolerance, plan.missing
    if loose:
        names, it = listed([each.face for each in loose], _FACES), "it" if len(loose) == 1 else "they"
        share = sum(each.share for each in loose)
        of = f", {percent(share)} of the area to be machined" if share > 0.0 else ""
        yield (
            f"Triangles follow {names} only within {mm(loose[0].chord_error_mm)}{of}: what only {it} may forbid stays "
            "undecided until the model is rebuilt there in CAD."
        )
    if missing:
        unread = list(dict.fromkeys(each.face or each.name or "a face" for each in missing))
        yield (
            f"Obstacles are missing or only guessed ({listed(unread, _FACES)}): what they may forbid stays undecided until "
            "the file is repaired."
        )
    if coarse == entry.undecided:
        return
    finer = f"--tolerance {tolerance / _FINER:.3g}"
    if raised:
        yield f"The tolerance had to be raised to {mm(tolerance)}: what is this narrow stays undecided."
    elif loose or missing:
        yield f"What is left is too narrow for the tolerance; {finer} looks more closely."
    else:
        yield (
            f"The cutter is so near to an obstacle there that the tolerance, {mm(tolerance)}, does not decide; {finer} looks "
            "more closely."
        )


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
        each = "; ".join(f"{_called(b)} covers {mm2(b.area_mm2)} of {listed(b.faces, 4)}" for b in over[: most - 2])
        rest = len(over) - (most - 2)
        lines.append(f"Bodies overlap: {each}{f'; {rest} more in plan.json' if rest > 0 else ''}.")
    if entry.sheets is not None:
        sheets, area = entry.sheets, mm2(entry.sheets.area_mm2)
        what = "is a construction sheet" if len(sheets.faces) == 1 else "are construction sheets"
        lines.append(
            f"{listed(sheets.faces)} {what} on the skin of a body: {area} face into it. {sheets.option} leaves such sheets out."
        )
    return lines


def _body_text(body: CoveringBody) -> str:
    on, area = listed(body.faces, 4), mm2(body.area_mm2)
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
    area = mm2(sum(each.area_mm2 for each in bodies))
    return [f"{len(bodies)} more {one if len(bodies) == 1 else many} {area}: see plan.json."]


def inside_radii(plan: Plan, names: Mapping[str, str]) -> Iterator[str]:
    """One sentence on all of them; nothing where no face bends more than the cutter shown."""
    faces = plan.inside_radii
    if not faces or plan.shown is None:
        return
    smallest = faces[0]
    fits = f"the largest usual size that fits is D{smallest.fits_mm:g}" if smallest.fits_mm else "no usual size is that small"
    yield (
        f"The smallest inside radius of {listed([each.face for each in faces], _FACES)} is {mm(smallest.radius_mm)}, and "
        f"{names[plan.shown]} has R{smallest.cutter_radius_mm:.4g}: {fits}."
    )


#: Pairs of faces that are named.
_PAIRS = 3


def sharp_edges(plan: Plan, names: Mapping[str, str]) -> Iterator[str]:
    """One sentence on all of them; nothing where the cutter shown leaves nothing at such edges."""
    edges = plan.sharp_edges
    if not edges or plan.shown is None:
        return
    pairs = [f"{one} meets {other}" for one, other in (each.faces for each in edges[:_PAIRS])]
    more = len(edges) - len(pairs)
    others = f" and at {count(more, 'more pair')} of faces" if more else ""
    yield (
        f"The model has sharp inside edges where {', '.join(pairs)}{others}: {names[plan.shown]} leaves a fillet of "
        f"R{reported(edges[0].radius_mm):.4g} there, {mm2(sum(each.area_mm2 for each in edges))}."
    )


#: Copies from which on a pattern stands in the summary; faces that are named; patterns that are listed.
_COPIES, _NAMED, _LISTED = 3, 24, 3


def patterns(plan: Plan) -> Iterator[str]:
    """Sentences on the patterns of a plan, those with most faces first."""
    largest = sorted(plan.patterns, key=lambda each: (not each.whole, -sum(map(len, each.faces))))[:_LISTED]
    # The same faces may be equal in two mirrors.
    yield from dict.fromkeys(map(_sentence, largest))
    if len(plan.patterns) > len(largest):
        yield f"{len(plan.patterns) - len(largest)} more patterns of equal faces are in plan.json."


def in_summary(plan: Plan) -> str:
    """The sentence on what was judged once or is repeated; empty where that is not worth a line."""
    whole = [each for each in plan.patterns if each.whole and each.kind == "rotation" and each.order >= _COPIES and each.faces]
    if whole:
        return _sentence(max(whole, key=lambda each: each.order))
    targets = set(plan.effective.target_faces)
    shares = [(len(targets.intersection(_names(each))), each) for each in plan.patterns if not each.whole]
    best = max(shares, key=lambda each: each[0], default=None)
    return _sentence(best[1]) if best is not None and 2 * best[0] >= len(targets) else ""


def _names(each: PatternEntry) -> list[str]:
    """Its faces, one after the other: some may be in several copies."""
    return list(dict.fromkeys(name for copy in each.faces for name in copy))


def _sentence(each: PatternEntry) -> str:
    """One pattern, and what was done with it."""
    names = _names(each)
    few = names if len(names) <= _NAMED else names[:1]
    # A file may have any words there.
    numbered = all(re.fullmatch(r"F\d{1,9}", name) for name in few)
    listed = ranges(int(name[1:]) for name in few) if numbered else ", ".join(few)
    more = f" and {len(names) - 1} more" if len(names) > _NAMED else ""
    per = len(each.faces[0]) if each.faces else 0
    what = "equal faces" if per <= 1 else f"equal groups of {per} faces"
    if each.kind == "mirror":
        text = f"{listed}{more} are equal in a mirror" if names else "The part is its own mirror image"
    elif each.kind == "rotation":
        text = f"{listed}{more} are {each.order} {what}, {360.0 / each.order:.4g} deg apart"
    else:
        text = f"{listed}{more} are {each.order} {what}, shifted"
    return f"{text}{_judged(each)}."


def _judged(each: PatternEntry) -> str:
    if each.moved or each.followed:
        return ": judged once" + (f", verified at {count(each.verified, 'sample')}" if each.verified else "")
    return ""


def proposal(plan: Plan) -> tuple[str, ...]:
    """Which setups were proposed, and whether their plan holds what was promised; nothing where none was requested."""
    entry = plan.setup_proposal
    if entry is None:
        return ()
    one = len(entry.setups) == 1
    where = [f"{_stands(each)}, with {axis_words(each.axis)}" for each in entry.setups]
    where[0] += " of the part along the spindle"
    text = where[0] if one else "; ".join(f"{k} {each}" for k, each in enumerate(where, 1))
    share = percent(entry.found)
    among = "Over a table and nothing else that holds the part, " + ("it reaches" if one else "they reach")
    if any(each.clamping != "table" for each in entry.setups):
        among = "So held, it reaches" if one else "So held, they reach"
    lines = [f"Proposed {'setup' if one else 'setups'}: {text}. {among} {share} of the area to machine."]
    for k, each in enumerate(entry.setups, 1):
        texts = [each.why_held] * bool(each.why_held)
        texts += [f"what it hides of {listed(left.faces)} is machined in setup {left.setup + 1}" for left in each.left_for]
        if texts:
            lines.append(f"{'Compared' if one else f'Setup {k}'}: {'; '.join(texts)}.")
    if not entry.held:
        lines.append(
            f"The proposal does not hold: the plan reaches {some(entry.kept)} of what the search promised, and no other "
            "proposal did better. Name a setup with its fixtures."
        )
    return tuple(lines)


def _stands(each: ProposedSetup) -> str:
    if each.clamping != "table":
        return f"in a {each.clamping} that grips {', '.join(each.grips)}"
    return f"on {', '.join(each.stands_on)}" if each.stands_on else "on no plane (something must hold it)"
