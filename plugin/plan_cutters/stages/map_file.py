"""Arrays of posture maps from anyone: compiled code, which believes them, sees none that is not checked here."""

import json
import math
import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.verdicts import NO_REASON, REASONS, UNJUDGED, WORDS
from plan_cutters.errors import OptionError
from plan_cutters.files.arrays import Archive, Header

#: Of the file: what older ones hold does not say what they answer.
FORMAT, VERSION = "plan-cutters-postures", 2
#: Unit vectors are as long as 1, and directions across a normal are so, to this; angles lie within ranges to that, rad.
_UNIT, _ANGLE = 1e-6, 1e-6
#: Samples, rotations, and intervals at one rotation, at most.
_SAMPLES, _ROTATIONS, _INTERVALS = 5_000_000, 10_000, 255
#: Characters of `about`.
_ABOUT = 4_000_000

Fault = Callable[[str], Exception]


def require(maps: Any) -> None:
    """Refuse `PostureMaps` that are none.

    Raises
    ------
    OptionError
        It names the array and the row.
    """

    def refuse(why: str) -> OptionError:
        return OptionError(f"these are no posture maps: {why}")

    if not isinstance(maps.cutter, str) or not isinstance(maps.part, str):
        raise refuse("cutter and part must be texts")
    if not isinstance(maps.about, Mapping):
        raise refuse("about must be a mapping")
    low, high = _range(maps.tilt, refuse)
    if not _real(maps.tolerance) or not 0.0 <= maps.tolerance < math.inf:
        raise refuse("tolerance must be a number of mm")
    arrays = {"rotations": maps.rotations, "offset": maps.offset, "free": maps.free, "undecided": maps.undecided,
              "normal": maps.normal, "direction_max": maps.direction_max, "verdict": maps.verdict, "reason": maps.reason,
              "inside": maps.inside}  # fmt: skip
    for word, array in arrays.items():
        if not isinstance(array, np.ndarray):
            raise refuse(f"{word} must be an array")
        if not array.flags.c_contiguous:
            raise refuse(f"{word} must be contiguous")
    _shapes({word: Header(array.dtype.str, array.shape, 0) for word, array in arrays.items()}, refuse)
    _angles(maps.rotations, refuse)
    _rows(maps, refuse)
    _intervals(maps, low, high, refuse)


def arrays_of(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read `postures.npz` into the names of `PostureMaps`; types and shapes are checked against each other, but no values.

    Raises
    ------
    OptionError
        The file cannot be read, is none, or was made by an earlier version.
    """
    with Archive(path, "posture maps", OptionError) as archive:
        about = _about(archive)
        cutter = about["cutter"]
        own = ("offset", "free", "undecided", "verdict", "reason")
        names = {"rotations": "rotation", "normal": "normal", "direction_max": "direction_max", "inside": "inside"}
        names |= {word: f"{word}_{cutter}" for word in own}
        if missing := [name for name in names.values() if name not in archive.headers]:
            raise archive.fault(f"array {ascii(missing[0])[1:-1][:60]} is missing")
        _shapes({word: archive.headers[name] for word, name in names.items()}, archive.fault, names)
        arrays: dict[str, Any] = {word: archive.read(name) for word, name in names.items()}
    return arrays | {"tilt": about["tilt"], "tolerance": about["tolerance"], "cutter": cutter, "part": about["part"],
                    "about": about["question"]}  # fmt: skip


def _about(archive: Archive) -> dict[str, Any]:
    """Read the description that the file has of itself."""
    header = archive.headers.get("about")
    if header is None or np.dtype(header.dtype).kind != "U" or math.prod(header.shape) != 1:
        raise archive.fault("it does not say what it is of")
    if header.bytes > 4 * _ABOUT:
        raise archive.fault("its array about is too long")
    try:
        about = json.loads(str(archive.read("about").reshape(-1)[0]))
    except (ValueError, RecursionError):
        raise archive.fault("its array about is no JSON") from None
    if not isinstance(about, dict) or about.get("format") != FORMAT:
        raise archive.fault("its array about says nothing of posture maps")
    version = about.get("version")
    if type(version) is not int:
        raise archive.fault("its array about says no version")
    if version != VERSION:
        made = "an earlier" if version < VERSION else "a later"
        raise OptionError(
            f"was made by {made} version, which did not say all that its maps depend on: plan again"
            if version < VERSION
            else f"was made by {made} version: plan again",
            file=archive.name,
        )
    for word, kind in (("cutter", str), ("part", str), ("question", dict)):
        if not isinstance(about.get(word), kind):
            raise archive.fault(f"its array about says no {word}")
    tilt = about.get("tilt")
    if not isinstance(tilt, list) or len(tilt) != 2 or not all(map(_real, (*tilt, about.get("tolerance")))):
        raise archive.fault("its array about says no tilts or no tolerance")
    return about | {"tilt": (float(tilt[0]), float(tilt[1])), "tolerance": float(about["tolerance"])}


def _real(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300


def _shapes(headers: Mapping[str, Header], refuse: Fault, names: Mapping[str, str] | None = None) -> None:
    """Whether types and shapes go together."""
    rotations, verdict, free = (headers[word].shape for word in ("rotations", "verdict", "free"))
    n, k, m = ((each or (0,))[0] for each in (verdict, rotations, free))
    if not 0 < k <= _ROTATIONS or n > _SAMPLES or m > _INTERVALS * n * k:
        raise refuse(f"{n} samples, {k} rotations and {m} free intervals cannot be")
    wanted: dict[str, tuple[str, tuple[int, ...]]] = {
        "rotations": ("<f8", (k,)), "offset": ("<i8", (n * k + 1,)), "free": ("<f8", (m, 2)), "undecided": ("<f4", (n, k)),
        "normal": ("<f8", (n, 3)), "direction_max": ("<f8", (n, 3)), "verdict": ("|u1", (n,)), "reason": ("|u1", (n,)),
        "inside": ("|b1", (n,)),
    }  # fmt: skip
    for word, (dtype, shape) in wanted.items():
        header = headers[word]
        if np.dtype(header.dtype) != np.dtype(dtype) or header.shape != shape:
            name = ascii((names or {}).get(word, word))[1:-1][:60]
            raise refuse(f"array {name} is {header.dtype} {header.shape}, not {dtype} {shape}")


def _range(tilt: Any, refuse: Fault) -> tuple[float, float]:
    if not isinstance(tilt, tuple) or len(tilt) != 2 or not all(map(_real, tilt)):
        raise refuse("tilt must be two numbers, rad")
    low, high = tilt
    if not -_ANGLE <= low <= high <= math.pi + _ANGLE:
        raise refuse(f"tilts {low:g} to {high:g} rad must run upwards within 0 and pi")
    return low, high


def _angles(rotations: Floats, refuse: Fault) -> None:
    turn = 2.0 * math.pi + _ANGLE
    for row in np.flatnonzero(~(np.abs(rotations) <= turn))[:1].tolist():
        raise refuse(f"rotations, row {row}: {rotations[row]:g} is no angle within a turn, rad")
    for row in np.flatnonzero(~(np.diff(rotations) > 0.0))[:1].tolist():
        raise refuse(f"rotations, row {row + 1}: they must ascend")


def _rows(maps: Any, refuse: Fault) -> None:
    """Check the values of each sample."""
    verdict, reason, undecided = maps.verdict, maps.reason, maps.undecided
    for row in np.flatnonzero(~np.isin(verdict, list(WORDS)))[:1].tolist():
        raise refuse(f"verdict, row {row}: {verdict[row]} is no valid code")
    for row in np.flatnonzero((reason >= len(REASONS)) & (reason != NO_REASON))[:1].tolist():
        raise refuse(f"reason, row {row}: {reason[row]} is no valid code")
    if maps.inside.size:
        for row in np.flatnonzero(maps.inside.view(np.uint8) > 1)[:1].tolist():
            raise refuse(f"inside, row {row}: it is neither true nor false")
    judged = verdict != UNJUDGED
    # Only these are looked at: the others may have no normal.
    for word, vector in (("normal", maps.normal), ("direction_max", maps.direction_max)):
        with np.errstate(all="ignore"):
            length = (vector * vector).sum(axis=1)
            wrong = judged & ~(np.abs(length - 1.0) <= 2.0 * _UNIT)
        for row in np.flatnonzero(wrong)[:1].tolist():
            raise refuse(f"{word}, row {row}: it is no unit vector to {_UNIT:g}")
    with np.errstate(all="ignore"):
        askew = judged & ~(np.abs((maps.normal * maps.direction_max).sum(axis=1)) <= _UNIT)
    for row in np.flatnonzero(askew)[:1].tolist():
        raise refuse(f"direction_max, row {row}: it is not across the normal to {_UNIT:g}")
    bad = ~((undecided >= 0.0) & (undecided <= 2.0 * math.pi))
    for row in np.flatnonzero(bad.any(axis=1))[:1].tolist():
        raise refuse(f"undecided, row {row}: no width of tilts, rad")


def _intervals(maps: Any, low: float, high: float, refuse: Fault) -> None:
    """Whether each rotation of each sample has its own ascending intervals."""
    offset, free, k = maps.offset, maps.free, len(maps.rotations)
    count = np.diff(offset)
    if offset[0] != 0 or offset[-1] != len(free):
        raise refuse(f"offset, row {0 if offset[0] else len(offset) - 1}: it must run from 0 to {len(free)}")
    # A difference of far numbers may wrap: what is within both ends and ascends is right.
    for cell in np.flatnonzero((offset[1:] < offset[:-1]) | (offset[1:] > len(free)) | (count > _INTERVALS))[:1].tolist():
        raise refuse(f"offset, row {cell + 1}: no place of an interval")
    for cell in np.flatnonzero((count > 0) & np.repeat(maps.verdict == UNJUDGED, k))[:1].tolist():
        raise refuse(f"offset, row {cell + 1}: sample {cell // k} was not judged and has free tilts")
    for row in np.flatnonzero(~((free[:, 0] >= low - _ANGLE) & (free[:, 0] <= free[:, 1]) & (free[:, 1] <= high + _ANGLE)))[
        :1
    ].tolist():
        raise refuse(f"free, row {row}: no interval of tilts within {low:g} and {high:g} rad")
    if len(free) > 1:
        first = np.zeros(len(free) + 1, bool)
        first[offset] = True
        for row in np.flatnonzero((free[1:, 0] < free[:-1, 1]) & ~first[1:-1])[:1].tolist():
            raise refuse(f"free, row {row + 1}: it does not follow the one before")
