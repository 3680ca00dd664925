"""Whether pictures of parts can be drawn, and what is said where they cannot."""

from collections.abc import Callable, Sequence
from importlib.util import find_spec

from plan_cutters.errors import extra_hint

#: What is said where a picture was to be drawn and Matplotlib is not installed.
NO_PICTURES = f"pictures need Matplotlib: {extra_hint('pictures')}"


def draws_pictures() -> bool:
    """Whether Matplotlib is installed, which draws the part and posture maps."""
    return find_spec("matplotlib") is not None


def with_pictures(formats: Sequence[str], hint: Callable[[str], None]) -> tuple[str, ...]:
    """Some formats and the picture of the part; without it, and with a word in `hint`, where pictures cannot be drawn."""
    if draws_pictures():
        return (*formats, "png")
    hint(f"no pictures of parts: {NO_PICTURES}")
    return tuple(formats)
