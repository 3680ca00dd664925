"""Three decorators, one cache folder for each module as it is: everything that is known of the compiler.

The compiler's own cache looks at one file at a time and misses edits in a module that a kernel calls, so the cache folder's
name carries the fingerprint of the module and of all that it imports (`fingerprint`). The compiler asks for the cache
folder when a function is decorated: it is set for that moment alone, so that neither the host's own compiled functions nor the
environment of its processes change, whoever imports the compiler first.

The compiler runs whatever stands in its cache. Ours has a checksum in each file: machine code that a full disk or a power cut
damaged is never run, but compiled anew, and a cache that cannot be written costs time alone.
"""

import contextlib
import functools
import gc
import hashlib
import io
import os
import stat
import struct
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from types import CodeType
from typing import Any

import llvmlite
import numba
import numpy as np
from llvmlite import binding as llvm
from numba.core import caching
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.types import unliteral  # type: ignore[attr-defined]

from plan_cutters_base.fingerprint import PROGRAM, fingerprint
from plan_cutters_base.user_cache import CacheWarning, roots, writable

VERSION: str = numba.__version__

#: What lies beneath all machine code. The processor is in the compiler's own key of each entry.
_BENEATH = {
    "python": [sys.version, sys.flags.optimize],
    "libraries": [VERSION, llvmlite.__version__, np.__version__],
    "compiler": [str(getattr(numba.config, each)) for each in ("OPT", "BOUNDSCHECK", "LOOP_VECTORIZE", "SLP_VECTORIZE")],
}

#: What the compiler is told of every function. Nothing calls one as C does.
_ENTRY: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
#: Bytes of the checksum at the end of a file of the cache.
_CHECKSUM = 32
#: What the names of the compiler's notes begin with: the environments of functions, and addresses that hold in one process
#: only, where there are any: what names one is not kept on disk.
_NOTES = ("_ZN08NumbaEnv", "numba.dynamic.globals")


@functools.cache
def _of_this_process() -> str | None:
    """Folder for this process alone; None where not even that can be made."""
    try:
        return tempfile.mkdtemp(prefix="plan-cutters-")
    except OSError:
        return None


@functools.cache
def cache_folder(name: str, package: str, file: str) -> tuple[str, bool]:
    """Folder of the machine code of just a module as it is, and of all that it imports; made if need be; whether it lasts.

    It is that of the module's name and of its fingerprint, whose arguments these are. A folder for this process alone does not
    last: no other one can be written, or the source cannot be read. Where not even that can be written, it is not there.
    """
    ours = frozenset({name.partition(".")[0], *PROGRAM})
    folders = [each for each in roots() if writable(each)]
    made_of = fingerprint(name, package, file, ours, folders[0] / "sources" if folders else None)
    if made_of is not None:
        last = hashlib.sha256(f"{_BENEATH} {made_of}".encode()).hexdigest()[:16]
        for root in folders:
            if writable(folder := root / name / last):
                return str(folder), True
    return _of_this_process() or os.path.join(os.devnull, "plan-cutters"), False


#: What was warned of already.
_warned: set[str] = set()


def _warn(place: str, fault: str, cause: str) -> None:
    """Warn of the cache, once in each process for each fault: the first file stands for all."""
    if fault not in _warned:
        _warned.add(fault)
        warnings.warn(f"{place}: {fault} ({cause}); it is compiled anew", CacheWarning, stacklevel=2)


#: In newer versions of the compiler they have names without a line in front.
_Impl: Any = getattr(caching, "CacheImpl", None) or caching._CacheImpl
_Locator: Any = getattr(caching, "UserProvidedCacheLocator", None) or caching._UserProvidedCacheLocator


def _meaning(code: CodeType, doc: str | None) -> list[Any]:
    """What a function does: its code, without its docstring and without places."""
    constants = [_meaning(each, None) if isinstance(each, CodeType) else each for each in code.co_consts if each != doc]
    return [code.co_code, code.co_names, code.co_varnames, constants]


class _ByContent(_Locator):
    """Machine code lies by what it was made of, which its folder's name says, and not by where the sources are or how old.

    So another environment with the same sources, or another checkout, takes what is there.
    """

    def __init__(self, function: Callable[..., Any], file: str) -> None:
        super().__init__(function, file)
        self._own = hashlib.sha256(repr(_meaning(function.__code__, function.__doc__)).encode()).hexdigest()[:8]

    @classmethod
    def from_function(cls, function: Callable[..., Any], file: str) -> Any:
        """Sources may lie in an archive, where the compiler looks for none."""
        return cls(function, file)

    @classmethod
    def get_suitable_cache_subpath(cls, file: str) -> str:
        return ""

    def get_disambiguator(self) -> str:
        """Tell functions apart by their code, not by their lines: one module may define two under one name."""
        return self._own

    def get_source_stamp(self) -> str:
        return "by content"

    def ensure_cache_path(self) -> None:
        """Make the folder if that can be done; saving warns where it is not there."""
        with contextlib.suppress(OSError):
            os.makedirs(self.get_cache_path(), exist_ok=True)


class _Files(caching.IndexDataCacheFile):
    """The files of one function: an index, and machine code for each kind of arguments; a checksum ends each file.

    What is damaged counts as missing, and is written again. An entry holds its own key, for two processes that add to an index
    at a time may give two entries one name.
    """

    def save(self, key: Any, data: Any) -> None:
        try:
            super().save(key, (key, data))
        except OSError as error:
            _warn(self._cache_path, "machine code cannot be cached", error.strerror or str(error))

    def load(self, key: Any) -> Any:
        own, data = super().load(key) or (None, None)
        return data if own == key else None

    def _load_index(self) -> Any:
        return super()._load_index() if self._whole(self._index_path) else {}

    def _load_data(self, name: str) -> Any:
        path = self._data_path(name)
        return super()._load_data(name) if self._whole(path) else None

    @contextlib.contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[io.BytesIO]:
        yield (content := io.BytesIO())
        if os.path.isdir(filepath):
            # No file takes its place: left there, it would have this function compiled in each process for ever.
            os.rename(filepath, f"{filepath}.no-file-{os.urandom(4).hex()}")
        with super()._open_for_write(filepath) as file:
            # Whoever reads looks no farther than its pickles.
            file.write(content.getvalue() + hashlib.sha256(content.getvalue()).digest())

    def _whole(self, path: str) -> bool:
        """Whether a file is there, and is what was written."""
        try:
            if not stat.S_ISREG(os.stat(path).st_mode):
                raise OSError("it is no regular file")
            content = Path(path).read_bytes()
        except (FileNotFoundError, NotADirectoryError):
            return False
        except OSError as error:
            _warn(path, "cached machine code cannot be read", error.strerror or str(error))
            return False
        if hashlib.sha256(content[:-_CHECKSUM]).digest() == content[-_CHECKSUM:]:
            return True
        _warn(path, "cached machine code is damaged", "its checksum differs")
        return False


def _checked(compiled: Any) -> Any:
    """Let the cache of a function look at checksums."""
    cache = compiled._cache
    cache._cache_file = _Files(cache.cache_path, cache._impl.filename_base, cache._impl.locator.get_source_stamp())
    return compiled


@contextlib.contextmanager
def _our_cache(function: Callable[..., Any], *beneath: str) -> Iterator[None]:
    module = function.__globals__
    folder, _ = cache_folder(module["__name__"], module.get("__package__") or "", module["__file__"])
    before = numba.config.CACHE_DIR, _Impl._locator_classes
    numba.config.CACHE_DIR = os.path.join(folder, *beneath)
    _Impl._locator_classes = [_ByContent]
    try:
        yield
    finally:
        numba.config.CACHE_DIR, _Impl._locator_classes = before


class _Linked(JITCodeLibrary):
    """The code of a kernel: linked into entries, and made machine code there alone.

    Left to itself, the compiler optimises what a function calls once more for every function that calls it, and makes machine
    code of each, although only that of entries ever runs. Both together were half of all that compiling took.
    """

    def _optimize_final_module(self) -> None:
        """Leave it to the entry."""

    def _finalize_final_module(self) -> None:
        """Give the engine the places of the compiler's notes that the code names, which it looks for, and no code."""
        linked, kind = self._final_module, f"common global i{8 * struct.calcsize('P')} 0"  # type: ignore[has-type]
        names = (each.name for each in linked.global_variables)
        places = "\n".join(f'@"{name}" = {kind}' for name in names if name.startswith(_NOTES))
        self._final_module = llvm.parse_assembly(f'target triple = "{llvm.get_process_triple()}"\n{places}')
        self._final_module.name = self.name
        super()._finalize_final_module()
        # The engine's module stays alive with it.
        self._final_module = linked


class _KernelCompiler(Compiler):
    """Compiles a kernel: as ever, but for the library that its code is put into."""

    def define_pipelines(self) -> Any:
        self.state.library = _Linked(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        self.state.library.enable_object_caching()
        return super().define_pipelines()


def _once(compiled: Any) -> Any:
    """Compile a function once for all numbers that it is called with.

    The compiler takes a number that stands in a call, or that a variable begins with, for a type of its own, and compiles the
    function for it and all that it calls, then again for any number.
    """
    get_template = compiled.get_call_template

    def plainly(args: Any, kws: Any) -> Any:
        return get_template(tuple(map(unliteral, args)), {name: unliteral(kind) for name, kind in kws.items()})

    compiled.get_call_template = plainly
    return compiled


def _uncollected(entry: Any) -> Any:
    """Compile an entry with the collector of garbage at rest.

    What the compiler makes lives until it ends: looking for garbage among it, again and again, took a seventh of the time.
    """
    compile_for_args = entry._compile_for_args

    def compiled(*args: Any, **kws: Any) -> Any:
        collects = gc.isenabled()
        gc.disable()
        try:
            return compile_for_args(*args, **kws)
        finally:
            if collects:
                gc.enable()

    entry._compile_for_args = compiled
    return entry


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile what Python calls, which may make arrays: on its first call. Machine code is kept on disk; it releases the GIL."""
    with _our_cache(function):
        return _uncollected(_once(_checked(numba.njit(**_ENTRY)(function))))


def _linked(function: Callable[..., Any], nrt: bool) -> Callable[..., Any]:
    with _our_cache(function):
        made = numba.njit(**_ENTRY, _nrt=nrt, no_cpython_wrapper=True, pipeline_class=_KernelCompiler)(function)
    made = _once(_checked(made))

    # Python calls it, too, as tests and benchmarks do: that compiles it as an entry, beside the others in the cache.
    @functools.cache
    def called() -> Any:
        with _our_cache(function, "called"):
            return _uncollected(_checked(numba.njit(**_ENTRY, _nrt=nrt)(function)))

    made._insert = lambda *overload: None
    made._compile_for_args = lambda *args, **kws: called()
    return made


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile what entries call, and what makes no array: it has no machine code of its own.

    It works without the counting of references, two atomic instructions for every array at every call, which took a third of all
    time. The entry keeps the arrays alive.
    """
    return _linked(function, nrt=False)


def maker(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile what entries call, and what makes arrays for them: it has no machine code of its own, either."""
    return _linked(function, nrt=True)
