"""Verdicts that are kept, cutter by cutter: what was judged before, on the same ground, is not judged again."""

import functools
import hashlib
import hmac
import json
import zlib
from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.posture import PostureRange
from plan_cutters.domain.verdicts import NO_REASON, REASONS, UNJUDGED, WORDS, Verdicts
from plan_cutters.errors import PlanError
from plan_cutters.files.digest import digest, sources
from plan_cutters.files.folder import Folder, cause
from plan_cutters.files.seal import stamp
from plan_cutters.kernels.codes import BEYOND
from plan_cutters.scene.ground import GroundDigests
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.work import Work
from plan_cutters.stages.judge import Judge, judge

#: The first line of an entry.
_MAGIC = b"plan-cutters verdicts 2\n"
#: Columns as they are written, one after the other, by their types and numbers a sample.
_COLUMNS = {"verdict": ("u1", ()), "axis": ("<f8", (3,)), "tilt_direction": ("<f8", (3,)), "tilt": ("<f8", ()),
            "rotation": ("<i4", ()), "shift": ("<f8", (3,)), "reason": ("u1", ())}  # fmt: skip
_A_SAMPLE = sum(np.dtype(kind).itemsize * (shape or (1,))[0] for kind, shape in _COLUMNS.values())
#: Rooms on whose sources verdicts depend, and the packages.
_ROOMS, _PACKAGES = ("domain", "kernels", "scene", "stages"), ("numba", "numpy", "scipy")
#: Unit vectors and angles of postures agree to this.
_SLACK = 1e-9
#: Most bytes of an entry, some ten million samples.
_MOST = 1 << 30
#: What is said of an entry that its place refuses, and the verb of it.
_DOING = {"cannot be read": "read", "cannot be written": "written"}
#: The end of an entry's name.
_SUFFIX = ".verdicts"


class VerdictCache:
    """Judge as `stages.judge.judge` does, but for what stands in a folder already; what is judged is put there.

    An entry belongs to the ground (samples, obstacles, machine, setup, postures, tolerance), the cutter and this program. Beside
    that, verdicts depend on those that follow from the other cutters of the plan (`nesting.handed`): the entry that was found
    with the same ones comes first, and is what judging would give, bit for bit. Where there is none, an entry of the same
    cutter that was found among other cutters serves: its postures are as safe, and need not be the same ones.

    Parameters
    ----------
    where : str
        Folder, or URL that fsspec knows.
    otherwise : Judge, optional
        Judges what is not there.
    key : bytes, optional
        Seals entries: those that nobody with this key wrote are not taken (`files.seal`).

    Attributes
    ----------
    found, judged : int
        How many verdicts were taken from there, and how many were not.
    faults : list of str
        One line for each entry that is damaged or cannot be read or written. The plan does not depend on it.

    Raises
    ------
    PlanError
        A package is missing, or the URL has no meaning.
    """

    def __init__(self, where: str, otherwise: Judge = judge, key: bytes | None = None) -> None:
        if not where:
            raise PlanError("--verdicts: the folder has no name")
        try:
            self._folder = Folder(where)
        except PlanError as error:
            raise PlanError(f"--verdicts {error}") from None
        self._where, self._otherwise, self._key = where, otherwise, key
        self._grounds = GroundDigests()
        #: Whether a place that is not on this machine has failed: it is not asked again.
        self._unreachable = False
        self.found = self.judged = 0
        self.faults: list[str] = []

    def __call__(
        self,
        ready: Prepared,
        cutter: Cutter,
        rows: NDArray[np.int64] | None = None,
        known: Verdicts | None = None,
        *,
        progress: Callable[[int, int], None] | None = None,
        work: Work | None = None,
    ) -> Verdicts:
        """Find the verdicts of a cutter; parameters and result as of `judge`. The work is that of the run that judged."""
        if rows is not None or self._unreachable:
            self.judged += rows is None
            return self._otherwise(ready, cutter, rows, known, progress=progress, work=work)
        own = hashlib.sha256(self._digest(ready) + digest(replace(cutter, name=""))).hexdigest()
        name = digest(None if known is None or (known.verdict == UNJUDGED).all() else _stated(known)).hex()[:32]
        name += self._owner
        for entry in self._entries(own, name):
            if (unpacked := self._read(own, entry, ready)) is not None:
                verdicts, looked = unpacked
                self.found += 1
                break
        else:
            counted = Work()
            verdicts = self._otherwise(ready, cutter, known=known, progress=progress, work=counted)
            looked = counted.looked
            self.judged += 1
            self._write(own, name, packed(verdicts, looked, own, self._key))
        if work is not None:
            work.add(looked)
        return verdicts

    @property
    def _owner(self) -> str:
        """The end of the names of entries with this key: those of others are neither read nor written over."""
        return "" if self._key is None else f"-{stamp(b'entries', self._key)[:16]}"

    def _digest(self, ready: Prepared) -> bytes:
        """The checksum of a ground and of this program; taken once for the cutters of a setup."""
        return digest((self._grounds.of(ready), made_by()))

    def _entries(self, own: str, name: str) -> Iterator[str]:
        """Names of the entries of a cutter: the one that was found among the same cutters first."""
        yield name
        if self._unreachable:
            return
        try:
            files = self._folder.names(f"{own[:2]}/{own}")
        except Exception as error:
            self._fault(own, "cannot be read", error)
            return
        # Those that begin with a point are being written.
        others = {each.removesuffix(_SUFFIX) for each in files if each.endswith(_SUFFIX) and not each.startswith(".")}
        yield from sorted(each for each in others - {name} if each[32:] == self._owner)

    def _read(self, own: str, name: str, ready: Prepared) -> tuple[Verdicts, int] | None:
        try:
            content = self._folder.get(_place(own, name), _MOST)
        except Exception as error:
            self._fault(own, "cannot be read", error)
            return None
        if content is None:
            return None
        try:
            verdicts = unpacked(content, len(ready.samples), own, self._key)
            require_sound(verdicts[0], ready.samples.normal, ready.options.postures)
            return verdicts
        except (ValueError, TypeError, LookupError, OverflowError, RecursionError, MemoryError, zlib.error) as error:
            self._fault(own, "is damaged and not used", error)
            return None

    def _write(self, own: str, name: str, content: bytes) -> None:
        if self._unreachable:
            return
        try:
            self._folder.put(_place(own, name), content)
        except Exception as error:
            self._fault(own, "cannot be written", error)

    def _fault(self, own: str, what: str, error: BaseException) -> None:
        if not self._folder.local and what in _DOING:
            if not self._unreachable:
                self.faults.append(f"--verdicts {self._where}: {cause(error, _DOING[what])}; verdicts are not stored")
            self._unreachable = True
            return
        why = " ".join(str(getattr(error, "strerror", None) or error).split())[:120] or type(error).__name__
        self.faults.append(f"{self._where}: stored verdicts {own[:12]}: {what} ({why})")


def packed(verdicts: Verdicts, looked: int, key: str, secret: bytes | None = None) -> bytes:
    """Write verdicts, the work that they took and the key that they belong to as one entry, stamped with a secret if any."""
    columns = b"".join(np.ascontiguousarray(getattr(verdicts, name), kind).tobytes() for name, (kind, _) in _COLUMNS.items())
    content = zlib.compress(columns, 1)
    head = {"key": key, "samples": len(verdicts.verdict), "looked": looked}
    header = json.dumps(head, sort_keys=True).encode()
    return _MAGIC + stamp(header + content, secret).encode() + b"\n" + header + b"\n" + content


def unpacked(entry: bytes, n: int, key: str, secret: bytes | None = None) -> tuple[Verdicts, int]:
    """Read what `packed` wrote for n samples and a key, with the same secret.

    Raises
    ------
    ValueError
        It is no such entry, belongs to something else, or is damaged.
    """
    if not entry.startswith(_MAGIC):
        raise ValueError("no entry of verdicts")
    checksum, _, rest = entry[len(_MAGIC) :].partition(b"\n")
    header, _, content = rest.partition(b"\n")
    if not hmac.compare_digest(stamp(header + content, secret).encode(), checksum):
        raise ValueError("its checksum differs" if secret is None else "it is not sealed with this key")
    head = json.loads(header)
    looked = head["looked"]
    if head["key"] != key or head["samples"] != n or type(looked) is not int or looked < 0:
        raise ValueError("it belongs to something else")
    unpacker = zlib.decompressobj()
    columns = unpacker.decompress(content, n * _A_SAMPLE + 1)
    if len(columns) != n * _A_SAMPLE or not unpacker.eof:
        raise ValueError("it has another length than its samples")
    arrays, place = [], 0
    for kind, shape in _COLUMNS.values():
        size = n * np.dtype(kind).itemsize * (shape or (1,))[0]
        arrays.append(np.frombuffer(columns[place : place + size], kind).reshape(n, *shape).copy())
        place += size
    verdicts = Verdicts(*arrays)
    words, reasons = list(WORDS), [*range(len(REASONS)), NO_REASON]
    if not (np.isin(verdicts.verdict, words).all() and np.isin(verdicts.reason, reasons).all()):
        raise ValueError("it holds verdicts that there are not")
    return verdicts, looked


def require_sound(verdicts: Verdicts, normal: Floats, postures: PostureRange) -> None:
    """Refuse verdicts that cannot be of these samples: a posture has a tilt and rotation that may be searched, a loss its reason.

    Parameters
    ----------
    verdicts : Verdicts
    normal : (n, 3) float
        Of the samples.
    postures : PostureRange

    Raises
    ------
    ValueError
    """
    if not (verdicts.not_reached == (verdicts.reason != NO_REASON)).all():
        raise ValueError("its reasons do not go with its verdicts")
    at = verdicts.reached
    tilt, axis, across, normal = verdicts.tilt[at, None], verdicts.axis[at], verdicts.tilt_direction[at], normal[at]
    low, high = postures.tilt
    turned = (verdicts.rotation[at] >= 0) & (verdicts.rotation[at] < len(postures.rotations))
    with np.errstate(all="ignore"):
        stands = np.abs(axis - np.cos(tilt) * normal - np.sin(tilt) * across) <= _SLACK
        # Upright, with the contact under the flat of the tip, a tilt direction is shorter than 1.
        length = (across * across).sum(axis=1)
        unit = ((np.abs(length - 1.0) <= _SLACK) | ((tilt[:, 0] == 0.0) & (length > 0.0) & (length < 1.0))) & (
            np.abs((across * normal).sum(axis=1)) <= _SLACK
        )
        # A flank may lie along a surface that is not quite at its tilt.
        within = (tilt[:, 0] >= low - _SLACK) & (tilt[:, 0] <= high + BEYOND) & np.isfinite(verdicts.shift[at]).all(axis=1)
    if not (stands.all() and unit.all() and within.all() and turned.all()):
        raise ValueError("it holds postures that there are not")


@functools.cache
def made_by() -> str:
    """Version of what verdicts follow from: the number of the program, a checksum of the sources that judge, packages."""
    import plan_cutters

    home = Path(str(plan_cutters.__file__)).parent
    digest = sources(*(home / folder for folder in _ROOMS))
    packages = " ".join(f"{name} {metadata.version(name)}" for name in _PACKAGES)
    return f"plan-cutters {plan_cutters.__version__}, sources {digest}, {packages}"


def _place(own: str, name: str) -> str:
    return f"{own[:2]}/{own}/{name}{_SUFFIX}"


def _stated(known: Verdicts) -> dict[str, Any]:
    return {each.name: getattr(known, each.name) for each in fields(known)}
