"""The decorators of all kernels of cutters; see `plan_cutters_base.jit`."""

from pathlib import Path

from plan_cutters_base.jit import VERSION, cache_folder, entry, kernel, maker

__all__ = ["VERSION", "at_hand", "entry", "kernel", "maker"]


def at_hand(name: str) -> bool | None:
    """Whether there is machine code of an entry, `room.module.function`, made by an earlier run or by another process.

    None where it is kept for this process alone, since no folder can be written to.
    """
    module, _, function = name.rpartition(".")
    *folders, stem = module.split(".")
    package = ".".join([__name__.rpartition(".")[0], *folders])
    folder, lasts = cache_folder(f"{package}.{stem}", package, str(Path(__file__).parent.joinpath(*folders, f"{stem}.py")))
    return any(Path(folder).glob(f"{stem}.{function}-*.nbc")) if lasts else None
