"""Which faces are to be machined: the `--faces` selection."""

import re

from cad_io.arrays import FaceInfo
from plan_cutters.errors import OptionError


def select_faces(faces: tuple[FaceInfo, ...], text: str) -> tuple[int, ...]:
    """Numbers of the target faces, ascending.

    Parameters
    ----------
    faces : tuple of FaceInfo
    text : str
        `sculptured`, `all`, numbers as `3,7-12`, `name:REGEX` or `color:#RRGGBB`.

    Raises
    ------
    OptionError
        The text is not of that form, or selects nothing.
    """
    if text == "sculptured":
        chosen = [f.number for f in faces if f.shape == "sculptured"]
        # What has no surface may have been sculptured: it is asked for, but alone it would hide all others.
        if all(faces[number - 1].unjudged for number in chosen):
            chosen = [f.number for f in faces]
    elif text == "all":
        chosen = [f.number for f in faces]
    elif text.startswith("name:"):
        try:
            pattern = re.compile(text[5:])
        except re.error as error:
            raise OptionError(f"--faces {text}: not a regular expression ({error})") from None
        chosen = [f.number for f in faces if pattern.search(f.name)]
    elif match := re.fullmatch(r"colou?r:#([0-9a-fA-F]{6})", text):
        wanted = tuple(bytes.fromhex(match[1]))
        chosen = [f.number for f in faces if f.colour and tuple(round(255 * c) for c in f.colour) == wanted]
    elif re.fullmatch(r"\d+(-\d+)?(,\d+(-\d+)?)*", text):
        numbers: set[int] = set()
        for item in text.split(","):
            first, _, last = item.partition("-")
            numbers.update(range(int(first), int(last or first) + 1))
        beyond = sorted(numbers - {f.number for f in faces})
        if beyond:
            raise OptionError(f"--faces {text}: there is no face F{beyond[0]}; the part has F1 to F{len(faces)}")
        chosen = sorted(numbers)
    else:
        raise OptionError(f"--faces {text}: give sculptured, all, numbers as 3,7-12, name:REGEX or color:#RRGGBB")
    if not chosen:
        raise OptionError(f"--faces {text} selects no face of this part")
    return tuple(chosen)
