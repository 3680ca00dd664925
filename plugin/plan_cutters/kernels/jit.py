"""One decorator, one cache folder: everything the kernels know of the compiler.

The compiler's own cache looks at one file at a time and misses edits in a module that a kernel calls, so the
folder's name carries a hash of every kernel source.
"""

import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any


def _cache_dir() -> str:
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    name = f"kernels-{digest.hexdigest()[:16]}"
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    for root in (home / "plan-cutters", Path(tempfile.gettempdir()) / f"plan-cutters-{os.getuid()}"):
        folder = root / name
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if os.access(folder, os.W_OK):
                return str(folder)
        except OSError:
            continue
    return tempfile.mkdtemp(prefix="plan-cutters-")


os.environ.setdefault("NUMBA_CACHE_DIR", _cache_dir())

import numba  # noqa: E402  (the cache folder is read at import)

VERSION: str = numba.__version__


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile on first call, keep the result on disk, release the GIL: what Python calls, and what makes arrays."""
    return numba.njit(cache=True, nogil=True, error_model="numpy")(function)


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile what entries call, and what makes no array itself.

    Without the counting of references, two atomic instructions for every array at every call, of which a third of all
    time went. Arrays are kept alive by the entry.
    """
    return numba.njit(cache=True, nogil=True, error_model="numpy", _nrt=False)(function)
