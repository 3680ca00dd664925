"""The key of a part: two runs that have the same one give the same files."""

import functools
import platform
from dataclasses import fields
from pathlib import Path

from cad_io.files import checksum
from plan_cutters.batch.job import Handed, Settings
from plan_cutters.files.digest import digest, sources
from plan_cutters.files.stage_cache import PACKAGES, installed

#: Packages whose results may differ from version to version: they count in a key, and must be the same on all machines.
COMPARED = {"plan-cutters": "plan_cutters", "python": "python", "numba": "numba", "dask": "dask"}


@functools.cache
def version() -> str:
    """Version of this program with a checksum of its sources: an edit counts, whoever forgot to raise the number."""
    import cad_io
    import plan_cutters

    digest = sources(*(Path(str(module.__file__)).parent for module in (cad_io, plan_cutters)))
    return f"{plan_cutters.__version__}+{digest}"


def versions() -> dict[str, str]:
    """The versions that must be the same on all machines of a batch."""
    return {
        "plan-cutters": version(),
        "python": platform.python_version(),
        **{name: installed(name) for name in ("numba", "dask", "distributed", "cadquery-ocp-proxy")},
    }


def settings_key(settings: Settings, there: Handed) -> str:
    """Checksum of all but the part: effective options with tools, machine and fixtures, every file that was read for them, what
    is written, versions.

    The number of threads and the limits of time change no result and do not count.
    """
    options = {each.name: getattr(settings.options, each.name) for each in fields(settings.options)}
    del options["jobs"]
    parts = [
        options,
        sorted(settings.formats),
        sorted(settings.read),
        settings.step_schema,
        version(),
        [installed(name) for name in PACKAGES],
    ]
    return digest([parts, there.outside, *there.files]).hex()


def key(content: str, settings: str) -> str:
    """The key of a part from the checksum of its file and that of its settings."""
    return checksum(f"{content} {settings}".encode())
