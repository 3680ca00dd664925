"""Two decorators, one cache folder for each folder of sources: everything that is known of the compiler.

The compiler's own cache looks at one file at a time and misses edits in a module that a kernel calls, so the cache folder's
name carries a hash of every source in the folder that makes the decorators, and in the folders below it. The compiler asks for
the cache folder when a function is decorated: it is set for that moment alone, so that neither the host's own compiled
functions nor the environment of its processes change, whoever imports the compiler first.
"""

import functools
import hashlib
import os
import struct
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numba
from llvmlite import binding as llvm
from numba.core import caching
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.types import unliteral  # type: ignore[attr-defined]

VERSION: str = numba.__version__

#: What the compiler is told of every function. Nothing calls one as C does.
_ENTRY: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
#: What the names of the compiler's notes begin with: the environments of functions, and addresses that hold in one process
#: only, where there are any: what names one is not kept on disk.
_NOTES = ("_ZN08NumbaEnv", "numba.dynamic.globals")

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


def _user() -> str:
    """Tells users of one temporary folder apart; on Windows each has one of their own."""
    return str(os.getuid()) if hasattr(os, "getuid") else "user"


@functools.cache
def cache_folder(sources: Path) -> str:
    """Folder of the machine code of just the sources in a folder and those below it; made if need be."""
    digest = hashlib.sha256()
    for source in sorted(sources.rglob("*.py")):
        digest.update(source.relative_to(sources).as_posix().encode())
        digest.update(source.read_bytes())
    name = f"kernels-{digest.hexdigest()[:16]}"
    asked, home = os.environ.get("NUMBA_CACHE_DIR"), Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    first = Path(asked) if asked else home
    for root in (first / "plan-cutters", Path(tempfile.gettempdir()) / f"plan-cutters-{_user()}"):
        folder = root / name
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if os.access(folder, os.W_OK):
                return str(folder)
        except OSError:
            continue
    return tempfile.mkdtemp(prefix="plan-cutters-")


#: In newer versions of the compiler they have names without a line in front.
_Impl: Any = getattr(caching, "CacheImpl", None) or caching._CacheImpl
_Asked: Any = getattr(caching, "UserProvidedCacheLocator", None) or caching._UserProvidedCacheLocator


class _BesideContent(_Asked):
    """Machine code lies by what it was made of, which its folder's name says, and not by where the sources are or how old.

    So another environment with the same sources, or another checkout, takes what is there.
    """

    @classmethod
    def get_suitable_cache_subpath(cls, file: str) -> str:
        return Path(file).parent.name

    def get_source_stamp(self) -> str:
        return "by content"


@contextmanager
def _our_cache(sources: Path, *beneath: str) -> Iterator[None]:
    before = numba.config.CACHE_DIR, _Impl._locator_classes
    numba.config.CACHE_DIR = str(Path(cache_folder(sources), *beneath))
    _Impl._locator_classes = [_BesideContent, *before[1]]
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
    asked = compiled.get_call_template

    def plainly(args: Any, kws: Any) -> Any:
        return asked(tuple(map(unliteral, args)), {name: unliteral(kind) for name, kind in kws.items()})

    compiled.get_call_template = plainly
    return compiled


def _also_from_python(kernel: Any, sources: Path) -> Any:
    """Let Python call a kernel too, as tests and benchmarks do: that compiles it as an entry, beside the others in the cache."""

    @functools.cache
    def compiled() -> Any:
        with _our_cache(sources, "called"):
            return numba.njit(**_ENTRY, _nrt=False)(kernel.py_func)

    kernel._insert = lambda *overload: None
    kernel._compile_for_args = lambda *args, **kws: compiled()
    return kernel


def decorators(file: str) -> tuple[Decorator, Decorator]:
    """`entry` and `kernel` for the sources in the folder of a file, and in the rooms below it.

    An entry is called by Python, and may make arrays. It is compiled on its first call, its machine code is kept on disk, and
    it releases the GIL. A kernel is called by entries, and makes no array itself: it works without the counting of references,
    two atomic instructions for every array at every call, which took a third of all time. The entry keeps the arrays alive. A
    kernel has no machine code of its own.
    """
    sources = Path(file).parent

    def entry(function: Callable[..., Any]) -> Callable[..., Any]:
        with _our_cache(sources):
            return _once(numba.njit(**_ENTRY)(function))

    def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
        with _our_cache(sources):
            made = numba.njit(**_ENTRY, _nrt=False, no_cpython_wrapper=True, pipeline_class=_KernelCompiler)(function)
        return _also_from_python(_once(made), sources)

    return entry, kernel
