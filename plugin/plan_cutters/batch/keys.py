"""The key of a part: two runs that have the same one give the same files."""

import functools
import hashlib
import pickle
import platform
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from plan_cutters.batch.job import Handed, Settings

#: Packages whose results may differ from version to version: they count in a key, and must be the same on all machines.
COMPARED = {"plan-cutters": "plan_cutters", "python": "python", "numba": "numba", "dask": "dask"}
_COUNTED = ("cadquery-ocp", "numba", "numpy", "scipy", "shapely")


@functools.cache
def version() -> str:
    """Version of this program with a checksum of its sources: an edit counts, whoever forgot to raise the number."""
    import cad_io
    import plan_cutters

    found = sources(*(Path(str(module.__file__)).parent for module in (cad_io, plan_cutters)))
    return f"{plan_cutters.__version__}+{found}"


def sources(*folders: Path) -> str:
    """A short checksum of all Python sources in some folders, with their names."""
    found = hashlib.sha256()
    for home in folders:
        for source in sorted(home.rglob("*.py")):
            found.update(_framed(f"{home.name}/{source.relative_to(home).as_posix()}".encode()))
            found.update(_framed(source.read_bytes()))
    return found.hexdigest()[:12]


def versions() -> dict[str, str]:
    """The versions that must be the same on all machines of a batch."""
    return {"plan-cutters": version(), "python": platform.python_version(),
            **{name: _installed(name) for name in ("numba", "dask", "distributed", "cadquery-ocp")}}  # fmt: skip


def _installed(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "none"


def settings_key(settings: Settings, there: Handed) -> str:
    """Checksum of all but the part: effective options with tools, machine and fixtures, what is written, versions.

    The number of threads and the limits of time change no result and do not count.
    """
    options = {each.name: getattr(settings.options, each.name) for each in fields(settings.options)}
    del options["jobs"]
    asked = [
        options,
        sorted(settings.formats),
        settings.step_schema,
        version(),
        [_installed(name) for name in _COUNTED],
    ]
    found = hashlib.sha256(_plain(asked))
    for name, data in there.files:
        found.update(_framed(name.encode()) + _framed(data))
    return found.hexdigest()


def key(content: str, settings: str) -> str:
    """The key of a part from the checksum of its file and that of its settings."""
    return hashlib.sha256(f"{content} {settings}".encode()).hexdigest()


def checksum(data: bytes) -> str:
    """SHA-256 of the content of a file."""
    return hashlib.sha256(data).hexdigest()


def _framed(data: bytes) -> bytes:
    return b"%d:" % len(data) + data


def _plain(value: Any) -> bytes:
    """Write a value in one way: equal values give equal bytes, in every process."""
    match value:
        case None | bool() | int() | str() | float():
            return _framed(f"{type(value).__name__} {value!r}".encode())
        case np.ndarray():
            return _framed(f"array {value.shape} {value.dtype.str}".encode() + np.ascontiguousarray(value).tobytes())
        case Mapping():
            return _framed(b"".join(sorted(_framed(_plain(k) + _plain(v)) for k, v in value.items())))
        case tuple() | list():
            return _framed(b"[" + b"".join(map(_plain, value)) + b"]")
        case set() | frozenset():
            return _framed(b"{" + b"".join(sorted(map(_plain, value))) + b"}")
        case _ if is_dataclass(value) and not isinstance(value, type):
            named = [[each.name, getattr(value, each.name)] for each in fields(value)]
            return _framed(type(value).__qualname__.encode() + _plain(named))
    # An object of another program: where its pickle differs from run to run, the part is planned again, which is safe.
    return _framed(pickle.dumps(value, protocol=5))
