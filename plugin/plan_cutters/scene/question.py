"""Write down beside verdicts the question that they answer, and check whether a later question is the same.

A stored answer belongs to the question for which it was found. The maps tell the effect of another machine, another setup or a
narrower range of postures. They do not tell the effect of any other change, so that change is refused by its name.
"""

import dataclasses
import json
import math
from collections.abc import Callable, Collection, Mapping
from typing import Any

import numpy as np

from cad_io import Part, files
from cad_io.part.orient import orient
from cad_io.read.references import fingerprint_of, in_folder_of
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.placement import Placement, axis_words
from plan_cutters.domain.posture import PostureRange
from plan_cutters.errors import OptionError
from plan_cutters.files.stage_cache import made_by
from plan_cutters.options import Options
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.scene import Scene

#: Options that maps answer, whatever they were made with; of the last three, what lies within theirs. An option that stands in
#: none of these sets asks for what maps do not hold: it is refused.
ANSWERED = frozenset({"machine", "setup", "placement", "tilt", "rotation", "rotation_step"})
#: Options that change nothing that maps say.
IRRELEVANT = frozenset({"jobs", "area_budget", "length_over_radius", "feed", "scallop", "stepover", "index_step",
                        "axis_accuracy", "index_time", "change_time", "setup_time", "overlap", "most_operations",
                        "max_orientations", "patterns", "sharp_edges", "units"})  # fmt: skip

_WORDS = {"libraries": "--cutters", "cutters": "--cutter", "fixtures": "--fixture", "other_setups": "a second --setup"}
_TOLERATED = 1e-9
_UNSAID = "these maps do not say what they were made for: write them again with --posture-maps"


def question(ready: Prepared, cutter: Cutter) -> dict[str, Any]:
    """Gather all that the verdicts of a cutter depend on, in the form of JSON; lengths mm, angles rad.

    Parameters
    ----------
    ready : Prepared
    cutter : Cutter
        As it was judged.
    """
    options, scene, chosen, surroundings = ready.options, ready.scene, ready.chosen, ready.conditions.surroundings
    part = scene.part
    return {
        # Another program may answer the same question otherwise.
        "method": made_by().hex(),
        "part": part.fingerprint,
        "unit": part.unit,
        "faces": chosen.asked,
        "targets": list(chosen.targets),
        "clamped": [] if options.placement is None else list(options.placement.clamped),
        "ignore": list(scene.ignore),
        "ignored": list(scene.ignored),
        "flip": scene.flip,
        "setup": list(scene.setup),
        "x": None if options.placement is None or options.placement.x is None else list(options.placement.x),
        "sides_follow_setup": _sides_follow(scene),
        "fixtures": [
            _fixture(each.requested or each.fixture, None if each.source is None else _bytes(each.source))
            for each in surroundings.fixtures
        ],
        "tolerance": scene.asked,
        "tolerance_kept": ready.conditions.tolerance,
        "chord_error": surroundings.certain.triangles.chord_error,
        "tool": json.loads(json.dumps(dataclasses.asdict(cutter))),
        "allowance": options.allowance,
        "holder_clearance": options.holder_clearance,
        "holder": None if options.holder is None else json.loads(json.dumps(dataclasses.asdict(options.holder))),
        "tilt": list(options.postures.tilt),
        "rotation": list(options.postures.rotation),
        "rotation_step": options.postures.step,
        "grid": options.grid,
        "spacing": options.spacing,
        "missing": list(surroundings.doubts),
        "unjudged_faces": [f.id for f in part.faces if f.number in chosen.targets and f.unjudged],
    }


def refuse_others(about: Mapping[str, Any], options: Options, stated: Collection[str], cutter: str) -> None:
    """Refuse what posture maps cannot answer; what is not given means what they were made with.

    Parameters
    ----------
    about : mapping
        What `question` wrote.
    options : Options
    stated : collection of str
        The options that were requested by their names: the others are left at their defaults.
    cutter : str
        Id of the one that the maps are of.

    Raises
    ------
    OptionError
        It names the option that differs.
    """
    if not about:
        raise OptionError(_UNSAID)
    if about.get("method") != made_by().hex():
        raise OptionError("these maps were made by another version, whose verdicts may differ: plan again")
    if options.propose:
        raise OptionError("posture maps do not answer the setup auto: leave it out, or plan the part with it")
    try:
        for word in sorted(stated):
            if word in ANSWERED or word in IRRELEVANT:
                continue
            if word not in _SAME:
                raise OptionError(f"posture maps do not answer {_called(word)}: leave it out, or plan the part with it")
            if fault := _SAME[word](about, options):
                raise OptionError(f"these maps are of {fault}: plan again")
        _places(about, options)
        if {"setup", "placement"} & set(stated):
            _placed_there(about, options)
        if ({"cutters", "libraries"} & set(stated)) and cutter not in (ids := _ids(about, options, stated)):
            raise OptionError(f"these maps are of cutter {cutter}, which was not requested ({', '.join(ids[:3])}): plan again")
    except (KeyError, TypeError, ValueError, AttributeError):
        # The file was checked as arrays, not as words.
        raise OptionError(_UNSAID) from None


def turns_of(about: Mapping[str, Any], rotations: Any, options: Options, stated: Collection[str]) -> Any:
    """Which of the maps' rotations (k,) a plan with these options would look at; all where none of them was given.

    Raises
    ------
    OptionError
        It would look at others.
    """
    words = {"rotation", "rotation_step"} & set(stated)
    if not words:
        return np.arange(len(rotations))
    try:
        ends = options.rotation if "rotation" in words else tuple(about["rotation"])
        step = options.rotation_step if "rotation_step" in words else about["rotation_step"]
        wanted = PostureRange(rotation=ends, step=step).rotations
    except (KeyError, TypeError):
        raise OptionError(_UNSAID) from None
    matches = np.abs(np.remainder(wanted[:, None] - rotations + math.pi, 2.0 * math.pi) - math.pi) <= _TOLERATED
    if not matches.any(axis=1).all():
        missing = float(np.degrees(wanted[~matches.any(axis=1)][0]))
        raise OptionError(
            f"these maps have no rotation of {missing:.6g} deg, which was requested with "
            f"{' and '.join(_called(each) for each in sorted(words))}: plan again"
        )
    return np.flatnonzero(matches.any(axis=0))


def require_side(about: Mapping[str, Any], setup: Any) -> None:
    """Refuse a setup axis (3,) that may turn the side of open faces.

    Raises
    ------
    OptionError
    """
    if not about.get("sides_follow_setup"):
        return
    own = setup_of(about).z
    if math.dist(own, setup) > _TOLERATED:
        raise OptionError(
            "these maps are of a part with open faces, whose sides follow from the setup "
            f"{axis_words(own)}: give that as the setup, or plan again"
        )


def setup_of(about: Mapping[str, Any]) -> Placement:
    """The setup's directions that maps were made with; the part's own Z where that is not said."""
    try:
        return Placement(about.get("setup", (0.0, 0.0, 1.0)), about.get("x"))
    except (TypeError, ValueError):
        raise OptionError(_UNSAID) from None


def words_of(about: Mapping[str, Any], key: str) -> tuple[str, ...]:
    """Texts that are stored under a key; none where there is none."""
    words = about.get(key, ())
    if not isinstance(words, list | tuple) or not all(isinstance(each, str) for each in words):
        raise OptionError(_UNSAID)
    return tuple(words)


def checksum(part: Any) -> str:
    """Checksum of a part's file, with all that this refers to.

    Raises
    ------
    OptionError
        It cannot be read.
    """
    if isinstance(part, Part):
        return part.fingerprint
    try:
        return fingerprint_of(files.content(part), in_folder_of(part))
    except (OSError, ValueError, TypeError) as error:
        raise OptionError(f"cannot be read: {getattr(error, 'strerror', None) or error}", file=str(part)) from None


def _bytes(source: Any) -> str | None:
    """Checksum of what a fixture was read from; None where that is no file."""
    return (source.fingerprint if isinstance(source, Part) else getattr(source, "sha256", None)) or None


def _called(word: str) -> str:
    return _WORDS.get(word, f"--{word.replace('_', '-')}")


def _sides_follow(scene: Scene) -> bool:
    """Whether the setup decides the side of any face."""
    if scene.orientation.confident:
        return False
    ways = [(sign * x, sign * y, sign * z) for sign in (1.0, -1.0) for x, y, z in np.eye(3).tolist()]
    return any((orient(scene.part, towards=way, flip=scene.flip).sign != scene.orientation.sign).any() for way in ways)


def _fixture(fixture: Fixture, bytes_of: str | None) -> dict[str, Any]:
    """A fixture by what it is made of: its words, or the bytes of its file."""
    made: dict[str, Any] = {"placement": list(fixture.placement), "chord_error": fixture.chord_error}
    if fixture.kind:
        placed = {"placed_for_setup": True} if fixture.to_place else {}
        return made | {"kind": fixture.kind, "sizes": list(fixture.sizes), **placed}
    return made | {"sha256": bytes_of, "unit": fixture.unit}


def _requested_fixture(fixture: Fixture) -> dict[str, Any]:
    source, file = fixture.source, None
    if isinstance(source, str) and not fixture.kind:
        file = checksum(source)
    elif not isinstance(source, str):
        file = _bytes(source)
    return _fixture(fixture, file)


def _fixtures(about: Mapping[str, Any], options: Options) -> str:
    stored, requested = about["fixtures"], [_requested_fixture(each) for each in options.fixtures]
    key: Callable[[Any], str] = lambda each: json.dumps(each, sort_keys=True)  # noqa: E731
    # What has no bytes, as an object of a CAD host, is the same as nothing else.
    known = all(each.get("kind") or each.get("sha256") for each in (*stored, *requested))
    if known and sorted(map(key, stored)) == sorted(map(key, requested)):
        return ""
    return f"other fixtures ({len(stored)}, {len(requested)} requested)"


def _selection(word: str, numbers: str) -> Callable[[Mapping[str, Any], Options], str]:
    """Compares words for faces, and lists of their numbers."""

    def differs(about: Mapping[str, Any], options: Options) -> str:
        stored, requested = about[word], getattr(options, word)
        texts = (
            [requested] if isinstance(requested, str) else list(requested) if isinstance(requested, list | tuple) else [requested]
        )
        before = [stored] if isinstance(stored, str) else list(stored)
        if all(isinstance(each, str) for each in texts):
            if sorted(_plain(each) for each in texts) == sorted(_plain(each) for each in before):
                return ""
            listed = [_listed(each) for each in texts]
        else:
            listed = [{each} if type(each) is int else None for each in texts]
        if all(each is not None for each in listed) and set().union(*listed) == set(about[numbers]):  # type: ignore[arg-type]
            return ""
        text = ", ".join(str(each) for each in texts)
        return f"{word} {', '.join(before) or 'none'}, not {ascii(text)[1:-1][:60] or 'none'}"

    return differs


def _plain(text: str) -> str:
    return "".join(text.split())


def _listed(text: str) -> set[int] | None:
    """Numbers of a text such as F1,F3-5; None for other words."""
    numbers: set[int] = set()
    for item in _plain(text).split(","):
        ends = [end.lstrip("Ff") for end in item.split("-")]
        if not 1 <= len(ends) <= 2 or not all(end.isdecimal() and len(end) < 6 for end in ends):
            return None
        numbers.update(range(int(ends[0]), int(ends[-1]) + 1))
    return numbers


def _number(word: str, unit: str = "") -> Callable[[Mapping[str, Any], Options], str]:
    def differs(about: Mapping[str, Any], options: Options) -> str:
        stored, requested = about[word], getattr(options, word)
        if stored == requested:
            return ""
        texts = ["as stated" if each is None and word == "unit" else "by default" if each is None else
                f"{each:g}{unit}" if isinstance(each, float) else str(each) for each in (stored, requested)]  # fmt: skip
        return f"{word.replace('_', ' ')} {texts[0]}, not {texts[1]}"

    return differs


def _holder(about: Mapping[str, Any], options: Options) -> str:
    requested = None if options.holder is None else json.loads(json.dumps(dataclasses.asdict(options.holder)))
    return "" if about["holder"] == requested else "another holder"


#: By option: why an answer to it is none of these maps', or an empty text. Of cutters, see `_ids`.
_SAME: dict[str, Callable[[Mapping[str, Any], Options], str]] = {
    "cutters": lambda about, options: "",
    "libraries": lambda about, options: "",
    "holder": _holder,
    "allowance": _number("allowance"),
    "holder_clearance": _number("holder_clearance"),
    "faces": _selection("faces", "targets"),
    "ignore": _selection("ignore", "ignored"),
    "grid": _number("grid"),
    "spacing": _number("spacing"),
    "tolerance": _number("tolerance"),
    "flip": _number("flip"),
    "unit": _number("unit"),
    "fixtures": _fixtures,
}
COMPARED = frozenset(_SAME)


def _places(about: Mapping[str, Any], options: Options) -> None:
    """Of a setup file, what the maps depend on."""
    place = options.placement
    if place is not None:
        if place.clamped and sorted(map(_plain, place.clamped)) != sorted(map(_plain, about["clamped"])):
            raise OptionError(
                f"these maps are of clamped faces {', '.join(about['clamped']) or 'none'}, not "
                f"{', '.join(place.clamped)}: plan again"
            )
        if place.fixtures and (fault := _fixtures(about, options)):
            raise OptionError(f"these maps are of {fault}: plan again")


def _placed_there(about: Mapping[str, Any], options: Options) -> None:
    """Refuse another setup where a vise or chuck was placed for that of the maps: it would stand elsewhere."""
    gripping = [each["kind"] for each in about["fixtures"] if each.get("placed_for_setup")]
    if gripping and not np.allclose(options.setup, about["setup"], atol=_TOLERATED):
        raise OptionError(
            f"these maps are of a {gripping[0]} that was placed for the setup {axis_words(about['setup'])}, not "
            f"{axis_words(options.setup)}: plan again"
        )


def _ids(about: Mapping[str, Any], options: Options, stated: Collection[str]) -> list[str]:
    """Ids of the cutters asked for, with the allowance, clearance and holder that the maps were made with, where not given."""
    stored = {word: about[word] for word in ("allowance", "holder_clearance") if word not in stated}
    if "holder" not in stated and about["holder"] is not None:
        stored["holder"] = _made(about["holder"])
    return [each.id for each in dataclasses.replace(options, **stored).judged]


def _made(words: Mapping[str, Any]) -> Holder:
    """The holder that was written by its numbers."""
    from plan_cutters.domain.holder import Segment

    return Holder(**{**words, "stages": tuple(Segment(**each) for each in words["stages"])})
