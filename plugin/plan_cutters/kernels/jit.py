"""Two decorators, one cache folder: everything the kernels know of the compiler.

The compiler's own cache looks at one file at a time and misses edits in a module that a kernel calls, so the
folder's name carries a hash of every kernel source. The compiler asks for the folder when a function is decorated: it is
set for that moment alone, so that neither the host's own compiled functions nor the environment of its processes change,
whoever imports the compiler first.
"""

import functools
import hashlib
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numba

VERSION: str = numba.__version__


def _user() -> str:
    """Tells users of one temporary folder apart; on Windows each has one of their own."""
    return str(os.getuid()) if hasattr(os, "getuid") else "user"


@functools.cache
def cache_folder() -> str:
    """Folder of the machine code of just these sources; made if need be."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    name = f"kernels-{digest.hexdigest()[:16]}"
    asked, home = os.environ.get("NUMBA_CACHE_DIR"), Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    first = Path(asked) if asked else home
    for root in (first / "plan-cutters", Path(tempfile.gettempdir()) / f"plan-cutters-{_user()}"):
        folder = root / name
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if os.access(folder, os.W_OK):
                return str(folder)
        except OSError:
            continue
    return tempfile.mkdtemp(prefix="plan-cutters-")


@contextmanager
def _our_cache() -> Iterator[None]:
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = cache_folder()
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile on first call, keep the result on disk, release the GIL: what Python calls, and what makes arrays."""
    with _our_cache():
        return numba.njit(cache=True, nogil=True, error_model="numpy")(function)


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile what entries call, and what makes no array itself.

    Without the counting of references, two atomic instructions for every array at every call, of which a third of all
    time went. Arrays are kept alive by the entry.
    """
    with _our_cache():
        return numba.njit(cache=True, nogil=True, error_model="numpy", _nrt=False)(function)
