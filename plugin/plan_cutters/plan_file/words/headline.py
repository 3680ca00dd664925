"""The first words: which cutter to take or how much is finished, what was judged, what is undecided, how the part stands."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from plan_cutters.domain.figures import area as mm2
from plan_cutters.domain.figures import capital, count, duration, joined, listed, mm, percent, ranges, reported, size, some
from plan_cutters.domain.placement import axis_words
from plan_cutters.domain.preference import is_free_form, rank, ranks
from plan_cutters.plan_file.model import CutterEntry, Plan, nearest
from plan_cutters.plan_file.operations import NOT_PLANNED, SHORT_STEP, UNJUDGED_CAUSE, ProcessEntry
from plan_cutters.plan_file.part_info import CoveringBody, PatternEntry, ProposedSetup, Scope
from plan_cutters.plan_file.reasons import reason
from plan_cutters.plan_file.shares import part_of
from plan_cutters.plan_file.words.names import described

#: Choices that name kinds of faces, not faces.
_BY_KIND = frozenset({"sculptured", "blends", "all"})


def judged(plan: Plan) -> str:
    """The part with its size, or what of it was judged: `the 6 fillets of part.step, 40 x 40 x 20 mm (23 % of the area)`."""
    part, scope = sized(plan, plan.part.file or "the part"), plan.scope
    if not scope.not_judged:
        return part
    return f"{_requested(plan, scope)} of {part} ({_share(scope)} of the area)"


def requested(plan: Plan) -> str:
    """Name what of the part was judged, below a line with its name: `the 6 fillets (23 % of the area)`."""
    return f"{_requested(plan, plan.scope)} ({_share(plan.scope)} of the area)"


def _requested(plan: Plan, scope: Scope) -> str:
    words = {word.strip() for word in plan.effective.faces.split(",")}
    if words <= _BY_KIND:
        return f"the {_listed(scope.judged_by_kind).removeprefix('1 ')}"
    return f"the {scope.judged} faces asked for" if scope.judged > 1 else "the face asked for"


def sized(plan: Plan, part: str) -> str:
    """The name of the part, and its size, which shows a wrong unit at a glance."""
    return f"{part}, {size(plan.part.size_mm)}"


def headline_cutter(plan: Plan) -> CutterEntry:
    """The cutter that the headline is about: the one to take, else the one that leaves the least area."""
    taken = plan.selected or plan.selected_over_setups or plan.selected_for_setup
    return next((c for c in plan.cutters if c.id == taken), None) or nearest(plan.cutters)


def shown_cutter(plan: Plan) -> CutterEntry:
    """The cutter that models and pictures show."""
    return next(c for c in plan.cutters if c.id == plan.shown)


def not_judged(plan: Plan) -> list[str]:
    """Say in a sentence which faces were not judged, and which option requests them."""
    scope = plan.scope
    if not scope.not_judged:
        return []
    many = scope.not_judged > 1
    what = _listed(scope.not_judged_by_kind)
    return [f"{what} {'were' if many else 'was'} not judged, only {'obstacles' if many else 'an obstacle'}: `--faces all`."]


def _listed(kinds: dict[str, int]) -> str:
    """Faces by their kinds: `6 free-form faces, 39 plane and round faces and 12 fillets`."""
    free, blends, plane = (kinds.get(kind, 0) for kind in ("sculptured", "blend", "plane"))
    others = sum(kinds.values()) - free - blends
    simple = "plane and round" if 0 < plane < others else "plane" if plane else "round"
    each = (free, "free-form face"), (others, f"{simple} face"), (blends, "fillet")
    return joined([count(number, word) for number, word in each if number])


def _share(scope: Scope) -> str:
    whole = scope.judged_mm2 + scope.not_judged_mm2
    return percent(scope.judged_mm2 / whole if whole > 0.0 else 0.0, some=scope.judged > 0, whole=False)


def unseen(plan: Plan) -> bool:
    """Whether a cutter of the process may miss what lies between the samples; who says how densely to sample asked for that."""
    if plan.effective.sampled_by != "default":
        return False
    used = {step.cutter for step in plan.process.steps}
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
        f"radius of {names[entry.id]}, {mm(entry.radius, 4)}. `--spacing {entry.radius:.4g}` looks more closely."
    ]


#: Faces that are named one by one.
_FACES = 3
#: A tolerance that is finer by this is the next to try.
_FINER = 2.0


def undecided(plan: Plan, names: Mapping[str, str]) -> list[str]:
    """Two sentences, how much and where, and why with what would decide it; none where the process leaves none of these faces."""
    entry, left = headline_cutter(plan), {face for each in plan.process.left for face in each.faces}
    if not any(face.undecided and name in left for name, face in entry.faces.items()):
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
        mm2 = face_entry.area_share.undecided * (1.0 - face_entry.inside_share - face_entry.drilled_share) * sizes[name]
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
            "No smaller `--tolerance` can be kept: rebuild in CAD what triangles cannot follow, or judge a larger cutter"
            if raised
            else "A smaller `--tolerance` decides it"
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
    finer = f"`--tolerance {tolerance / _FINER:.3g}`"
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
    for body in covering_bodies[:most]:
        name, on, area = f"Body {_called(body)}", listed(body.faces, 4), mm2(body.area_mm2)
        verb = "stands on" if body.how == "stands_on" else "touches or overlaps"
        if body.largest:
            lines.append(f"{name} covers {area} of {on}, which {'touches' if len(body.faces) == 1 else 'touch'} it.")
        else:
            lines.append(
                f"{name} {verb} {on} and covers {area} there. It stays in the way, and what lies under it is not planned. To "
                f"plan that, as for another clamping, leave the body out (nothing is then checked against it): `{body.option}`."
            )
    if rest := covering_bodies[most:]:
        cover = "body covers" if len(rest) == 1 else "bodies cover"
        lines.append(f"{len(rest)} more {cover} {mm2(sum(each.area_mm2 for each in rest))}: see plan.json.")
    if over := [each for each in entry.bodies if each.how == "overlaps"]:
        each = "; ".join(f"body {_called(b)} covers {mm2(b.area_mm2)} of {listed(b.faces, 4)}" for b in over[: most - 2])
        unlisted = f"; {len(over) - (most - 2)} more in plan.json" if len(over) > most - 2 else ""
        lines.append(f"Bodies overlap: {each}{unlisted}.")
    if entry.sheets is not None:
        sheets, area = entry.sheets, mm2(entry.sheets.area_mm2)
        what = "is a construction sheet" if len(sheets.faces) == 1 else "are construction sheets"
        lines.append(
            f"{listed(sheets.faces)} {what} on the skin of a body: {area} face into it. `{sheets.option}` leaves such sheets out."
        )
    return lines


def _called(body: CoveringBody) -> str:
    """The number of a body, its name, its faces."""
    name = f' "{body.name}"' if body.name else ""
    return f"{body.number}{name} ({listed(body.own_faces, 2)})"


def inside_radii(plan: Plan, names: Mapping[str, str]) -> Iterator[str]:
    """One sentence on all of them; nothing where no face bends more than the cutter shown."""
    faces = plan.inside_radii
    if not faces:
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
    if not edges:
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
    verified = f", verified at {count(each.verified, 'sample')}" if each.verified else ""
    return f"{text}{f': judged once{verified}' if each.moved or each.followed else ''}."


def stands_in(setup: ProposedSetup, nothing: str) -> str:
    """Say in what a part stands in a proposed setup, or on what; `nothing` where it stands on no plane."""
    if setup.clamping != "table":
        return f"in a {setup.clamping} that grips {', '.join(setup.grips) or 'the stock'}"
    return f"on {', '.join(setup.stands_on) or nothing}"


def proposal(plan: Plan) -> tuple[str, ...]:
    """Which setups were proposed, and whether their plan holds what was promised; nothing where none was requested."""
    entry = plan.setup_proposal
    if entry is None:
        return ()
    one = len(entry.setups) == 1
    stands = [stands_in(each, "no plane (something must hold it)") for each in entry.setups]
    where = [f"{how}, with {axis_words(each.axis)}" for how, each in zip(stands, entry.setups, strict=True)]
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


_ONE = {"ball": "ball end", "bull": "bull nose", "flat": "flat end", "special": "tapered cutter, barrel, lens or lollipop",
        "last": "engraving, chamfer or form cutter"}  # fmt: skip
_MANY = {"ball": "ball ends", "bull": "bull noses", "flat": "flat ends",
         "special": "tapered cutters, barrels, lenses and lollipops", "last": "engraving, chamfer and form cutters"}  # fmt: skip

#: Cutters that a first look names.
_LOOKED = 3


def rule(free_form: float) -> str:
    """By which rule a cutter is chosen, for a share of free-form faces."""
    kinds = ", then ".join(_all(groups) for groups in ranks(free_form=free_form))
    return (
        f"kind ({_faces(free_form)}: {kinds}), then largest radius, then smaller corner radius, then shorter length, then "
        "library order, among the feasible"
    )


def why(before: Sequence[str]) -> str:
    """Why the first feasible cutter wins: ids of those that come before it."""
    if not before:
        return "no cutter that was given comes before it"
    come, are = ("comes", "is") if len(before) == 1 else ("come", "are")
    return f"{', '.join(before)} {come} before it but {are} not feasible"


def stands(cutter: str) -> str:
    """Why a cutter comes first that leaves what stands on a proposed table."""
    return f"{cutter} comes first, and leaves only what stands on the table of the proposed setup"


def first_looked(setup: Sequence[float], samples: int, of: int, shares: Sequence[tuple[str, float]], together: float) -> str:
    """Say what cutters, by name, reach at some samples of the first setup, before all are judged.

    >>> first_looked((0.0, 0.0, 1.0), 400, 56473, [("D16", 0.5), ("D6", 0.75)], 0.75)
    'First look with 0,0,1 along the spindle, at 400 of 56,473 samples: D6 reaches 75 %, D16 50 %; together 75 %'
    """
    first, *others = sorted(shares, key=lambda each: -each[1])
    each = [f"{first[0]} reaches {percent(first[1])}", *(f"{name} {percent(share)}" for name, share in others[: _LOOKED - 1])]
    rest = f", {count(len(shares) - _LOOKED, 'other cutter')} no more" if len(shares) > _LOOKED else ""
    together_too = f"; together {percent(together)}" if others else ""
    where = f"with {axis_words(setup)} along the spindle, at {samples:,} of {of:,} samples"
    return f"First look {where}: {', '.join(each)}{rest}{together_too}"


def _alone_too(plan: Plan, cutter: str, called: str) -> str:
    """A sentence on the cutter that does alone, and why the process has others."""
    if not cutter:
        return ""
    entry = next(each for each in plan.cutters if each.id == cutter)
    # Operations are chosen by their time or number: there only what comes last in any case gives way by its kind.
    timed = any(step.mode != "any" for step in plan.process.steps)
    why = "" if timed and entry.group != "last" else ", but its kind comes after that of step 1"
    return f" {capital(called)} does alone{why or ', too'}."


def first_of(plan: Plan, chosen: CutterEntry, every: str) -> str:
    """Say in sentences that a cutter is the most wanted that reaches everything, and by what; `every` names the samples.

    The kind is told only where cutters of another kind were given that come before or after it.
    """
    number = len(plan.cutters)
    if number == 1:
        return f"It reaches {every}."
    largest, share = f"It is the largest of {number} cutters that reaches {every}.", plan.selection.free_form
    mine = _rank(chosen, share)
    present = {_rank(each, share) for each in plan.cutters}
    groups = {each.group for each in plan.cutters}
    order = [[group for group in rank_ if group in groups] for rank_ in ranks(free_form=share)]
    if present == {mine}:
        return largest
    same = _any(order[mine])
    if before := [rank_ for k, rank_ in enumerate(order) if k < mine and k in present]:
        return f"No {' and no '.join(map(_any, before))} reaches {every}. Of {number} cutters it is the largest {same} that does."
    after = min(present - {mine})
    where = "" if after == len(order) - 1 else f" on {_faces(share)}"
    come = f"{_all(order[mine])} come before {_all(order[after])}"
    return f"Of {number} cutters it is the largest {same} that reaches {every}:{where} {come}."


def _rank(entry: CutterEntry, free_form: float) -> int:
    return rank(entry.group, free_form=free_form)


def _faces(free_form: float) -> str:
    return "free-form faces" if is_free_form(free_form) else "planes, cylinders and cones"


def _any(groups: Sequence[str]) -> str:
    return " or ".join(_ONE[each] for each in groups)


def _all(groups: Sequence[str]) -> str:
    return " and ".join(_MANY[each] for each in groups)


#: From this share on a process finishes the part but for some of it; below, it does not.
_MOST = 0.5


class Headline(NamedTuple):
    """Which cutter to take, or how much all finish together; for what; and why: whole sentences."""

    title: str  #: Without its stop.
    good: bool | None  #: None: not for sure, or not all.
    about: str  #: It may be empty.
    why: str


def headline(plan: Plan, names: Mapping[str, str]) -> Headline:
    """Which cutter to take, with what holder, and why; where one alone does not do, how much all do together."""
    entries = {c.id: c for c in plan.cutters}
    part, setups = judged(plan), 1 + len(plan.effective.other_setups)
    process, holes = plan.process, _holes(plan)

    def take(name: str, why: str, *, where: str = "") -> Headline:
        about = f"For {part}{where}: {described(entries[name], names[name])}."
        whole = f": it finishes all {mm2(process.asked_mm2)}{_took(process)}" if process.finished_share >= 1.0 else ""
        return Headline(f"Take {names[name]}{whole}{holes}", None if holes else True, about, why + could_not(plan))

    # The cutter that does alone, or over all setups, where the process has other cutters.
    does = plan.selected or plan.selected_over_setups
    others = does if does and {step.cutter for step in process.steps} - {does} else ""
    if process.finished:
        if plan.selected and not others:
            # Of several setups one may do by itself.
            alone = next((s.axis for s in entries[plan.selected].setups if not s.not_reached), None)
            if alone not in (None, plan.effective.setup):
                why = f"It reaches {every(plan)} there, and needs no other setup."
                return take(plan.selected, why, where=f", in setup {axis_words(alone or ())}")
            if setups == 1 or alone:
                return take(plan.selected, first_of(plan, entries[plan.selected], every(plan)))
        if plan.selected_over_setups and not others:
            why = f"It reaches {every(plan)} in {setups} setups, and in none of them alone."
            return take(plan.selected_over_setups, why, where=f", in {setups} setups")
    share, title = process.finished_share, f"{_title(process)}{holes}"
    machine = "" if plan.machine.name == "unlimited" else f", on {plan.machine.name}"
    about = f"{sized(plan, plan.part.file or 'part')}{machine}."
    if plan.scope.not_judged:
        about += f" Judged: {requested(plan)}."
    if len(used := {step.cutter for step in process.steps}) == 1:
        (only,) = used
        about += f" {capital(names[only])}: {described(entries[only], names[only])}."
    if process.finished:
        why = f"{capital(every(plan))} is reached" if every(plan).startswith("every") else f"{capital(every(plan))} are reached"
        if plan.missing:
            return Headline(title, None, about, f"{why}, but obstacles are missing that may be in the way.")
        single = _alone_too(plan, others, names.get(others, ""))
        return Headline(title, None if holes else True, about, f"{why}.{single}{could_not(plan)}")
    undecided = not any(c.blocked for c in plan.cutters)
    return Headline(title, None if undecided or share >= _MOST else False, about, could_not(plan).strip())


def _title(process: ProcessEntry) -> str:
    """In how many steps and setups how much is finished, and in what time; how much stays, and mostly why."""
    share, of = process.finished_share, mm2(process.asked_mm2) if math.isfinite(process.asked_mm2) else "the area to machine"
    much = percent(share, some=share > 0.0, whole=process.finished and share >= 1.0 and not process.left)
    if not process.steps:
        return f"No step finishes any of {of}{_stays(process)}"
    setups = count(len({step.setup for step in process.steps}), "setup")
    steps = count(len(process.steps), "step")
    finish = f"finish{'es' * (len(process.steps) == 1)} {'all' if much == '100 %' else f'{much} of'} {of}"
    return f"{steps} in {setups} {finish}{_took(process)}{_stays(process)}"


def _holes(plan: Plan) -> str:
    """How many holes lack a tool of the libraries or a setup, as the end of a sentence; empty where none does."""
    if not any(library.drills for library in plan.libraries):
        return ""
    left = sum(bool(each.missing) for each in plan.holes)
    return f"; {left} of {count(len(plan.holes), 'hole')} lack{'s' * (left == 1)} a tool or a setup" if left else ""


#: From this share of what is left on a cause is most of it.
_MOSTLY = 0.5
#: Causes that are no reasons of verdicts, as they stand in the headline.
_STAY_FOR = {UNJUDGED_CAUSE: "not judged", NOT_PLANNED: "in no step", SHORT_STEP: "hardly a step"}


def _stays(process: ProcessEntry) -> str:
    """How much stays, and mostly why, as the end of a sentence; empty where nothing does."""
    if not process.left:
        return ""
    if process.finished:
        return f"; {listed([face for each in process.left for face in each.faces], _FACES)} not judged"
    share, worst = 1.0 - process.finished_share, process.left[0]
    known = sum(each.share for each in process.left)
    how, cause = ", mostly" if worst.share >= _MOSTLY * known else ":", _STAY_FOR.get(worst.cause) or reason(worst.cause)
    if len(process.left) == 1:
        how = ":"
    elif worst.share < _MOSTLY * known:
        cause = f"{cause} ({percent(worst.share, some=True, whole=False)}) and other causes"
    much = percent(share, some=any(each.samples for each in process.left), whole=share >= 1.0)
    return f"; {much} stay{how} {cause}"


def _took(process: ProcessEntry) -> str:
    took = "" if process.seconds is None else f", {duration(process.seconds - (process.setup_seconds or 0.0))}"
    return f"{took} and {duration(process.setup_seconds)} to clamp it again" if process.setup_seconds else took


def every(plan: Plan) -> str:
    """All samples; where not all could be judged, how many could."""
    if not plan.samples.unjudged and not not_sampled(plan):
        few = ["at sharp inside edges"] * bool(plan.samples.exempt) + ["in holes for drills"] * bool(plan.samples.drilled)
        return f"every sample but those {' and '.join(few)}" if few else "every sample"
    judged = plan.samples.judged
    return f"all {judged:,} samples that could be judged" if judged != 1 else "the 1 sample that could be judged"


def could_not(plan: Plan) -> str:
    """Say what part could not be judged, in a sentence that follows others; empty where all could be judged."""
    lines, number = [], plan.samples.unjudged
    if number:
        faces = [f.id for f in plan.faces if f.target and f.unjudged and f.samples]
        on = f" on {listed(faces)}" if faces else ""
        lines.append(f"{number:,} of {count(plan.samples.count, 'sample')}{on} could not be judged")
    if empty := not_sampled(plan):
        lines.append(f"{listed(empty)} could not be sampled")
    return f" {', and '.join(lines)}." if lines else ""


def not_sampled(plan: Plan) -> list[str]:
    """Ids of target faces that have no sample."""
    return [f.id for f in plan.faces if f.target and not f.samples]


def area(plan: Plan) -> str:
    """Name the area that shares refer to: the area of faces without samples may be unknown."""
    return "the area that could be sampled" if not_sampled(plan) else "the area"


def between(plan: Plan, c: CutterEntry) -> str:
    """Say how much is known of the area between the samples, and its meaning; empty where that was not requested."""
    known, of = c.area, area(plan)
    if known is None:
        return ""
    if known.feasible:
        return "Between the samples, too, all of the area is proved safe with the tool axes found."
    if known.share == 1.0 and known.left_out:
        return (
            f"Between the samples, all area that is known is proved safe with the tool axes found; that of "
            f"{listed(known.left_out)} is not known."
        )
    nothing = known.share <= 0.0
    share = "nothing" if nothing else f"{some(known.share)} of {of}"
    rest = "area" if nothing else some(1.0 - known.share)
    return (
        f"Between the samples, {share} is proved safe with the tool axis kept as it was found. The {'other ' * (not nothing)}"
        f"{rest} is not proved, which does not mean unsafe: the tool axis has to turn there from one sample to the next, or "
        "the samples are too far apart. Check it in simulation, or ask for more (`--spacing`, `--area-budget`)."
    )
