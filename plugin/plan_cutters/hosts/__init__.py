"""Steps inside CAD hosts. Nothing here registers itself at import."""

from typing import Any


def __getattr__(name: str) -> Any:
    if name != "holder":
        raise AttributeError(f"module 'plan_cutters.hosts' has no attribute {name!r}")
    from plan_cutters.hosts.holders import holder

    return holder
