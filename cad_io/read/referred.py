"""Look at the files that a STEP file refers to, each by itself: the kernel leaves out in silence what it cannot read of them."""

import os
import pickle
from dataclasses import dataclass, field

from cad_io.arrays import LostFace
from cad_io.errors import ReadError
from cad_io.kernel import translated
from cad_io.read.references import DOCUMENTS, in_folder_of, names
from cad_io.read.sniff import sniff
from cad_io.read.step import Loaded, distinct_faces
from plan_cutters_base.forks import ChildDied, TimeLimit, limited
from plan_cutters_base.user_files import OutsideError


@dataclass
class Referred:
    """A record of this kind says what the files hold that a STEP file refers to, and those that these refer to.

    Attributes
    ----------
    faces : dict
        Path -> how many faces the file itself has.
    lost : list of LostFace
        What is missing of them: whole files, and faces.
    risky : bool
        The kernel crashes or hangs at one of them, or may do so.
    """

    faces: dict[str, int] = field(default_factory=dict)
    lost: list[LostFace] = field(default_factory=list)
    risky: bool = False

    @property
    def foreign(self) -> int:
        """Faces of all of them."""
        return sum(self.faces.values())

    def add(self, other: "Referred") -> None:
        """Take over what another one has."""
        self.faces |= other.faces
        self.lost += [each for each in other.lost if each not in self.lost]
        self.risky |= other.risky


def referred(file: str, data: bytes, timeout: float, above: tuple[str, ...] = ()) -> Referred:
    """Look at what a STEP file refers to.

    Parameters
    ----------
    file : str
    data : bytes
        Its content.
    timeout : float
        Seconds that reading one of the files may take.
    above : tuple of str
        Files that refer to this one, without links.

    Raises
    ------
    ReadError
        A file refers to itself, or to one that may not be read.
    """
    result = Referred()
    above = (*above, os.path.realpath(file))
    for name in names(data):
        path = os.path.join(os.path.dirname(file), name)
        if os.path.realpath(path) in above:
            raise ReadError(f"refers to {name}, which refers to it again: save the assembly as one file", file=file)
        try:
            content = in_folder_of(file)(name)
        except OutsideError as error:
            raise ReadError(f"refers to {name}: {error.strerror}", file=file) from None
        except ReadError as error:
            raise ReadError(error.cause, file=file) from None
        if path in result.faces:
            continue
        if content is None:
            _miss(result, name, "the file refers to it, and it cannot be read: put it into the folder of the file")
            continue
        try:
            kind = sniff(content, name)
        except ReadError:
            kind = ""
        if kind != "step":
            _miss(result, name, "the file refers to it, and it is no STEP file: only these are followed")
            continue
        below = referred(path, content, timeout, above)
        try:
            count, unread, risky = _alone(path, content, below.foreign, timeout)
        except ReadError as error:
            _miss(result, name, f"the file refers to it, and it {error.cause}")
            continue
        result.add(below)
        result.add(
            Referred({path: count}, [LostFace("", " ".join(filter(None, (name, *who))), why) for *who, why in unread], risky)
        )
    return result


def _miss(referred: Referred, name: str, why: str) -> None:
    if not name.lower().endswith(DOCUMENTS):
        referred.lost.append(LostFace("", name, why))


def _alone(file: str, data: bytes, foreign: int, timeout: float) -> tuple[int, list[tuple[str, str, str]], bool]:
    """How many faces a file itself has, what is missing there, and whether it is risky; in a copy of the process."""

    def look() -> bytes:
        try:
            with translated("reading the file", error=ReadError, file=file):
                loaded = Loaded(file, data, names=False, adopt=False, foreign=foreign)
                read = loaded.transfer()
                count = distinct_faces(read.shape) - foreign
                return pickle.dumps((count, [(each.entity, each.name, each.why) for each in read.lost], loaded.risky))
        except ReadError as error:
            return pickle.dumps(error.cause)

    try:
        answer = pickle.loads(limited(look, timeout))
    except TimeLimit:
        raise ReadError(f"is not read within {timeout:g} s", file=file) from None
    except ChildDied as died:
        raise ReadError(f"cannot be read by the CAD kernel ({died})", file=file) from None
    if isinstance(answer, str):
        raise ReadError(answer, file=file)
    return answer
