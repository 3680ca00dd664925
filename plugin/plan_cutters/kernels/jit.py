"""The decorators of all kernels of cutters; see `cad_io.jit`."""

import os
from pathlib import Path

from cad_io.jit import VERSION, cache_folder, decorators

__all__ = ["VERSION", "at_hand", "entry", "kernel"]

entry, kernel = decorators(__file__)


def at_hand(name: str) -> bool | None:
    """Whether there is machine code of an entry, `module.function`, made by an earlier run or by another process.

    None where it is kept for this process alone, since no folder can be written to.
    """
    folder = Path(cache_folder(Path(__file__).parent))
    lasting = folder.name.startswith("kernels-") and os.access(folder, os.W_OK)
    return any(folder.glob(f"**/{name}-*.nbc")) if lasting else None
