"""Values as bytes: a checksum that equal values share in every process, and a form that is read back without running code."""

import hashlib
import json
import pickle
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters_base.fingerprint import PROGRAM


def sources(*folders: Path) -> bytes | None:
    """A checksum of all files in some folders, with their names, but for what Python makes of them; None where there are none."""
    files = {
        f"{home.name}/{file.relative_to(home).as_posix()}": file.read_bytes()
        for home in folders
        for file in home.rglob("*")
        if "__pycache__" not in file.parts and file.is_file()
    }
    return digest(files) if files else None


def digest(value: Any) -> bytes:
    """SHA-256 of numbers, texts, bytes, arrays, and lists, sets, mappings and dataclasses of such.

    Anything else counts by its pickle: where that differs from run to run, something is done again, which is safe.
    """
    state = hashlib.sha256()
    _feed(state, value)
    return state.digest()


def _feed(state: Any, value: Any) -> None:
    """Write a value in one way; each piece says what it is and how long, so that no two values are written alike."""
    match value:
        case None | bool() | int() | float() | str():
            text = repr(value).encode()
            state.update(b"%s %d:" % (type(value).__name__.encode(), len(text)) + text)
        case bytes():
            state.update(b"bytes %d:" % len(value) + value)
        case np.generic():
            _feed(state, value.item())
        case np.ndarray() if not value.dtype.hasobject:
            state.update(f"array {value.dtype.str} {value.shape}:".encode())
            state.update(np.ascontiguousarray(value).data)
        case tuple() | list():
            state.update(f"list {len(value)}:".encode())
            for each in value:
                _feed(state, each)
        case set() | frozenset():
            state.update(b"set ")
            _feed(state, sorted(map(digest, value)))
        case Mapping():
            state.update(b"mapping ")
            _feed(state, sorted((digest(name), digest(each)) for name, each in value.items()))
        case _ if is_dataclass(value) and not isinstance(value, type):
            state.update(f"{type(value).__qualname__} ".encode())
            # Trees and the like are made of the fields, and not fields that compare.
            _feed(state, [(each.name, getattr(value, each.name)) for each in fields(value) if each.compare])
        case _:
            _feed(state, pickle.dumps(value, protocol=5))


#: Arrays begin at multiples of so many bytes; bytes of the length of the JSON.
_ALIGNED, _LENGTH = 64, 8
_SERIES: dict[str, type] = {each.__name__: each for each in (tuple, list, set, frozenset)}


def packed(value: object) -> Iterator[bytes | memoryview]:
    """Write a value, piece by piece; a TypeError where it holds what cannot be written.

    Numbers, texts, bytes, arrays, and tuples, lists, sets, dicts and records (dataclasses, named tuples, models of pydantic) of
    such can. What is there twice is the same object again when it is read.
    """
    packer = _Packer()
    text = json.dumps(packer.form(value)).encode()
    text += b" " * (-(_LENGTH + len(text)) % _ALIGNED)
    yield len(text).to_bytes(_LENGTH, "little") + text
    for array in packer.arrays:
        yield array.reshape(-1).view(np.uint8).data if array.size else b""
        yield bytes(-array.nbytes % _ALIGNED)


def unpacked(data: bytearray) -> Any:
    """Read what `packed` wrote; arrays share its memory.

    A ValueError, TypeError, LookupError, AttributeError or ImportError where it is something else.
    """
    begin = _LENGTH + int.from_bytes(data[:_LENGTH], "little")
    return _Unpacker(data, begin).value(json.loads(bytes(data[_LENGTH:begin])))


def _names(record: Any) -> list[str] | None:
    """Fields of a record of ours; None for anything else."""
    kind = type(record)
    if kind.__module__.partition(".")[0] not in PROGRAM:
        return None
    if is_dataclass(record):
        return [each.name for each in fields(record)]
    if hasattr(kind, "model_fields"):
        return [name for name in kind.model_fields if name in record.model_fields_set]
    return list(kind._fields) if hasattr(kind, "_fields") else None


class _Packer:
    """Forms of values, as JSON has them, and the arrays that they name by their places."""

    def __init__(self) -> None:
        self.arrays: list[NDArray[Any]] = []
        self._end = 0
        #: By their identity, which they keep as long as they are held.
        self._known: dict[int, tuple[int, object]] = {}

    def form(self, value: object) -> Any:
        if value is None or type(value) in (bool, int, float, str):
            return value
        if (known := self._known.get(id(value))) is not None:
            return ["same", known[0]]
        result = self._form(value)
        self._known[id(value)] = len(self._known), value
        return result

    def _form(self, value: Any) -> list[Any]:
        if type(value) is bytes:
            return ["bytes", *self._array(np.frombuffer(value, np.uint8))]
        if isinstance(value, np.generic):
            return ["scalar", *self._array(np.asarray(value))]
        if type(value) is np.ndarray:
            return ["array", *self._array(value)]
        if type(value) is dict:
            return ["dict", *([self.form(key), self.form(each)] for key, each in value.items())]
        if type(value) in _SERIES.values():
            return [type(value).__name__, *map(self.form, value)]
        if (names := _names(value)) is None:
            raise TypeError(f"{type(value).__qualname__} is not stored")
        kind = type(value)
        return [f"{kind.__module__}:{kind.__qualname__}", *([name, self.form(getattr(value, name))] for name in names)]

    def _array(self, array: NDArray[Any]) -> list[Any]:
        if array.dtype.kind not in "biufcSU":
            raise TypeError(f"arrays of {array.dtype} are not stored")
        turned = array.flags.f_contiguous and not array.flags.c_contiguous
        self.arrays.append(flat := np.ascontiguousarray(array.T if turned else array))
        place, self._end = self._end, self._end + flat.nbytes + -flat.nbytes % _ALIGNED
        return [array.dtype.str, list(array.shape), place, turned, array.flags.writeable]


class _Unpacker:
    """Values of forms, with the memory in which their arrays lie."""

    def __init__(self, data: bytearray, begin: int) -> None:
        self._data, self._begin = data, begin
        self._known: list[Any] = []

    def value(self, form: Any) -> Any:
        if not isinstance(form, list):
            return form
        kind, *rest = form
        if kind == "same":
            return self._known[rest[0]]
        if kind in ("array", "scalar", "bytes"):
            array = self._array(*rest)
            made: Any = array if kind == "array" else array[()] if kind == "scalar" else array.tobytes()
        elif kind == "dict":
            made = {self.value(key): self.value(each) for key, each in rest}
        elif kind in _SERIES:
            made = _SERIES[kind](map(self.value, rest))
        else:
            made = _record(kind, {name: self.value(each) for name, each in rest})
        self._known.append(made)
        return made

    def _array(self, kind: str, shape: list[int], place: int, turned: bool, writeable: bool) -> NDArray[Any]:
        dtype, shape = np.dtype(kind), shape[::-1] if turned else shape
        count = int(np.prod(shape, dtype=np.int64))
        array = np.frombuffer(self._data, dtype, count, self._begin + place) if count else np.empty(0, dtype)
        array = array.reshape(shape)
        array = array.T if turned else array
        array.flags.writeable = writeable
        return array


def _record(kind: str, values: dict[str, Any]) -> Any:
    """Make a record of one of our classes of its fields."""
    module, _, name = kind.partition(":")
    if module.partition(".")[0] not in PROGRAM:
        raise ValueError(f"{kind} is none of ours")
    made = getattr(import_module(module), name)
    if not isinstance(made, type):
        raise TypeError(f"{kind} is no record")
    if hasattr(made, "_fields") or hasattr(made, "model_fields"):
        return made(**values)
    if not is_dataclass(made) or set(values) != {each.name for each in fields(made)}:
        raise TypeError(f"{kind} has other fields")
    record = object.__new__(made)
    for name, value in values.items():
        object.__setattr__(record, name, value)
    return record
