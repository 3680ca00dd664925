"""What the program said of a small part is kept beside the tests, and compared number by number.

Laws say what must hold; what is kept here says that nothing has changed by the way. A change that is meant writes the files anew
(`pytest --keep tests/ROOM`), and the difference of the text files shows what it changes. Numbers agree to six digits, for
processors round in ways of their own; texts, counts and flags agree whole.
"""

import hashlib
import json
import math
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np

#: Numbers agree to this share, or by this much beside zero.
SHARE, ZERO = 1e-6, 1e-9
#: Arrays that are longer are told by their shape and sums.
LONG = 24
#: Most columns of a line of a file.
WIDE = 160


def _array(value: np.ndarray) -> object:
    if value.size <= LONG and value.ndim <= 2:
        return [plain(each) for each in value.tolist()]
    if value.dtype.kind in "biuSU":
        digest = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()[:16]
        return {"shape": list(value.shape), "all": digest}
    flat = value.astype(float).ravel()
    known = np.isfinite(flat)
    at = np.flatnonzero(known)
    own = flat[known]
    # the second sum notices what the first does not: values that change places
    sums = [own.sum(), (own * np.cos(at * 1.0)).sum(), np.abs(own).sum()] if len(own) else []
    ends = [own.min(), own.max()] if len(own) else []
    told = {"shape": list(value.shape), "known": int(known.sum()), "sums": [plain(each) for each in sums + ends]}
    without_end = {"inf": int((flat == np.inf).sum()), "-inf": int((flat == -np.inf).sum())}
    return told | {word: count for word, count in without_end.items() if count}


def plain(value: Any) -> Any:
    """Anything of the program as what JSON can say: records by their fields, arrays by their values or sums."""
    if isinstance(value, bool | str | int | None) and not isinstance(value, Enum):
        return value
    if isinstance(value, float):
        return float(f"{value:.9g}") if math.isfinite(value) else str(value)
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, np.ndarray):
        return _array(value)
    if isinstance(value, Enum):
        return value.name
    if hasattr(value, "model_dump"):
        return plain(value.model_dump(mode="json"))
    if is_dataclass(value):
        return {each.name: plain(getattr(value, each.name)) for each in fields(value)}
    if isinstance(value, dict):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, set | frozenset):
        return sorted(plain(each) for each in value)
    if isinstance(value, Path):
        return value.name
    return [plain(each) for each in value]


def differences(kept: object, found: object, at: str = "") -> list[str]:
    """Where two of them differ, each with its place."""
    if isinstance(kept, dict) and isinstance(found, dict):
        pairs = [(f"{at}/{name}", kept.get(name, "-"), found.get(name, "-")) for name in dict.fromkeys([*kept, *found])]
        return [line for place, one, other in pairs for line in differences(one, other, place)]
    if isinstance(kept, list) and isinstance(found, list) and len(kept) == len(found):
        pairs = [(f"{at}[{i}]", *both) for i, both in enumerate(zip(kept, found, strict=True))]
        return [line for place, one, other in pairs for line in differences(one, other, place)]
    if isinstance(kept, float) and isinstance(found, float) and math.isclose(kept, found, rel_tol=SHARE, abs_tol=ZERO):
        return []
    return [] if kept == found and type(kept) is type(found) else [f"{at}: {kept!r} -> {found!r}"]


def _text(told: Any, beneath: str = "") -> str:
    """Write it as JSON: what fits into a line stands in one."""
    line = json.dumps(told, sort_keys=True)
    if len(beneath) + len(line) <= WIDE or not isinstance(told, dict | list) or not told:
        return line
    pieces = [("", each) for each in told] if isinstance(told, list) else [(f"{json.dumps(k)}: ", told[k]) for k in sorted(told)]
    lines = [f"{beneath} {name}{_text(each, beneath + ' ')}" for name, each in pieces]
    brackets = "[]" if isinstance(told, list) else "{}"
    return "\n".join([brackets[0], ",\n".join(lines), beneath + brackets[1]])


def compare(config: Any, path: Path, found: object) -> None:
    """Compare with what is kept in a file, or keep it (`--keep`)."""
    told = json.loads(json.dumps(plain(found)))
    if config.getoption("keep"):
        path.parent.mkdir(exist_ok=True)
        path.write_text(_text(told) + "\n")
        return
    assert path.exists(), f"{path.name} is not kept yet: pytest --keep"
    lines = differences(json.loads(path.read_text()), told)
    assert not lines, f"{len(lines)} differ from {path.name} (a change that is meant: pytest --keep):\n" + "\n".join(lines[:12])
