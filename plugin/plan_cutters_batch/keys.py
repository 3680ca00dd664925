"""The key of a part: two runs that have the same one give the same files."""

import functools
import platform
from dataclasses import fields
from pathlib import Path

import plan_cutters
from plan_cutters_base.digest import digest, sources
from plan_cutters_base.stage_cache import PACKAGES, installed, made_by
from plan_cutters_base.user_files import checksum
from plan_cutters_batch.job import Handed, Settings


@functools.cache
def _own() -> bytes | None:
    return sources(Path(__file__).parent)


def program() -> bytes:
    """A checksum of what makes plans, and of this package, which makes rows of them."""
    return digest([made_by(), _own()])


def versions() -> dict[str, str]:
    """The versions that must be the same on all machines of a batch: of this program with its checksum, for an edit counts."""
    return {
        "python": platform.python_version(),
        **{name: installed(name) for name in (*PACKAGES, "dask", "distributed")},
        "plan-cutters": f"{plan_cutters.__version__}+{program().hex()[:12]}",
    }


def settings_key(settings: Settings, there: Handed) -> str:
    """Checksum of all but the part: effective options with tools, machine and fixtures, every file that was read for them, what
    is written, versions.

    The number of threads and the limits of time change no result and do not count.
    """
    options = {each.name: getattr(settings.options, each.name) for each in fields(settings.options)}
    del options["jobs"]
    parts = [options, sorted(settings.formats), sorted(settings.read), settings.step_schema, program()]
    return digest([parts, there.outside, *there.files]).hex()


def key(content: str, settings: str) -> str:
    """The key of a part from the checksum of its file and that of its settings."""
    return checksum(f"{content} {settings}".encode())
