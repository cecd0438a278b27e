"""Compilation of numerical kernels, with a disk cache that is never stale.

Numba's own cache looks only at the file a function stands in, so an edited function in another file would go unnoticed.
Here the cache folder is named by a hash of all sources of the part that it belongs to, and the compiler's version.
Numba would also read what anybody wrote, fail on what is damaged, and write beside the sources where its folder cannot
be written: see disk_cache.py.
"""

import hashlib
import logging
import pickle
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, cached_property
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba import types
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.registry import CPUDispatcher
from numba.core.runtime import rtsys
from numba.core.serialize import dumps

from lithobrake.compilation import lighter_compilation
from lithobrake.compilation.disk_cache import DiskCache

log = logging.getLogger(__name__)
Function = TypeVar("Function", bound=Callable[..., Any])

# Parts that take long to compile, by what they are to a user, and how long.
_WHAT = {"dem": ("the soft-surface engine", "half a minute"), "smallbody": ("gravity and flights", "ten seconds")}


@cache
def disk_cache(part: str) -> DiskCache:
    """What is kept of one part (say "dem"), for exactly its sources and this compiler.

    A kernel calls only kernels of its own part, so the sources of that part, and those that compile, are all that
    matters.
    """
    package = Path(__file__).parents[1]
    digest = hashlib.sha256(f"{numba.__version__} {sys.implementation.cache_tag}".encode())
    for source in [*sorted((package / "compilation").rglob("*.py")), *sorted((package / part).rglob("*.py"))]:
        digest.update(str(source.relative_to(package)).encode() + b"\0" + source.read_bytes())
    return DiskCache(f"{part}-{digest.hexdigest()[:16]}")


def compiled(function: Function) -> Function:
    """Compile a function on its first call (IEEE arithmetic, no reassociation) and keep it on disk."""
    return _compile(function, {})


def kernel(function: Function) -> Function:
    """Compile a function that allocates nothing into its callers.

    Arrays then travel without reference counts and without copies of their descriptions: a step is 20 times faster.
    """
    return _compile(function, {"_nrt": False, "forceinline": True})


def large_kernel(function: Function) -> Function:
    """Compile a function that allocates nothing and is too large to be copied into each caller."""
    return _compile(function, {"_nrt": False, "forceinline": False})


def _compile(function: Function, options: dict[str, bool]) -> Function:
    if numba.config.DISABLE_JIT:
        return function
    # The lock of the interpreter is released, as threads work side by side on one engine and on parts of the flights;
    # in NumPy's error model a division by 0 raises nothing.
    always = {"nopython": True, "error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True}
    result: Any = Kernel(function, targetoptions={**always, **options})
    return result


class Kernel(CPUDispatcher):
    """A function compiled twice, if need be: for Python, and for other kernels.

    What Python calls has a wrapper that takes a hundred arrays from their objects, and holds a copy of all that is
    compiled into it. Most kernels are never called so, and half of the compilation would be for such wrappers.
    """

    def __init__(self, py_func: Callable[..., Any], *others: Any, **options: Any) -> None:
        super().__init__(py_func, *others, **options)
        self._cache = KernelCache(py_func, "python")
        COUNT.made(_part_of(py_func), py_func)
        if lighter_compilation.is_known():
            self._compiler: Any = lighter_compilation.KernelCompiler(self, is_inner=False)

    @cached_property
    def within(self) -> CPUDispatcher:
        """The same for kernels that call it."""
        if not lighter_compilation.is_known():
            return self.within_others
        part, function = _part_of(self.py_func), self.py_func
        return lighter_compilation.InnerKernel(
            function, targetoptions=self._inner_options, tell=lambda: COUNT.note(part, function)
        )

    @cached_property
    def within_others(self) -> CPUDispatcher:
        """The same for functions that Numba compiles in its own way, as all are for a Numba that is not known."""
        result = CPUDispatcher(self.py_func, targetoptions=self._inner_options)
        result._cache = KernelCache(self.py_func, "kernel")
        return result

    @property
    def _inner_options(self) -> dict[str, Any]:
        return {**self.targetoptions, "no_cpython_wrapper": True}

    def _for_caller(self) -> CPUDispatcher:
        return self.within if lighter_compilation.is_for_kernel() else self.within_others

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Tell a kernel what a call gives. Constants count as numbers: each would be compiled for itself otherwise."""
        return self._for_caller().get_call_template([types.unliteral(arg) for arg in args], kws)

    def get_overload(self, sig: Any) -> Any:
        return self._for_caller().get_overload(sig)

    def compile(self, sig: Any) -> Any:
        """Compile for a call from Python, where neither this process nor another one has done so yet."""
        if self._cache.has(sig, self.targetctx):
            return super().compile(sig)
        part = _part_of(self.py_func)
        what, time = _WHAT.get(part, (f"kernels of {part}", "a moment"))
        # A turn for each kernel: of two processes one compiles this kernel, and the other one that.
        turn = disk_cache(part).turn(
            f"Waiting for another process that compiles {what}: about {time}.", f"-{self._cache.name}"
        )
        with turn:
            if part in _WHAT and not self._cache.has(sig, self.targetctx):
                announce(part)
            with lighter_compilation.RARE_GARBAGE_COLLECTION:
                found = super().compile(sig)
            COUNT.note(part, self.py_func)
            return found


class KernelCount:
    """How many kernels of a part there are, and how many of them this process has compiled while it was watched."""

    def __init__(self) -> None:
        self._all: dict[str, set[Any]] = {}
        self._done: set[Any] = set()
        self._watched, self._tell = "", lambda done, total: None

    def made(self, part: str, function: Callable[..., Any]) -> None:
        self._all.setdefault(part, set()).add(function)

    def note(self, part: str, function: Callable[..., Any]) -> None:
        """Tell that one was compiled."""
        if part == self._watched:
            self._done.add(function)
            self._tell(len(self._done), len(self._all[part]))

    @contextmanager
    def watched(self, part: str, tell: Callable[[int, int], None]) -> Iterator[None]:
        """Tell, of a part, how many kernels are compiled and how many there are, each time that there is one more."""
        self._watched, self._tell = part, tell
        self._done.clear()
        try:
            yield
        finally:
            self._watched = ""


COUNT = KernelCount()
watched = COUNT.watched


class KernelCache(NullCache):
    """The compiled forms of one function on disk, in Numba's eyes."""

    def __init__(self, function: Callable[..., Any], caller: str) -> None:
        self._disk = disk_cache(_part_of(function))
        self.name = f"{function.__module__.partition('.')[2]}.{function.__qualname__}-{caller}"

    def has(self, sig: Any, target_context: Any) -> bool:
        return self._disk.has(self._file(sig, target_context.codegen()))

    def has_any(self) -> bool:
        folder = self._disk.folder
        return folder is not None and any(folder.glob(f"{self.name}-*"))

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        # Machine code needs what allocates, and not all that Numba could compile, which takes as long as the rest.
        rtsys.initialize(target_context)
        content = self._disk.read(self._file(sig, target_context.codegen()))
        return None if content is None else CompileResult._rebuild(target_context, *pickle.loads(content))

    def save_overload(self, sig: Any, data: CompileResult) -> None:
        """Keep a form, unless it has addresses of this process in it."""
        if not data.library.has_dynamic_globals:
            self._disk.write(self._file(sig, data.codegen), dumps(data._reduce()))

    def _file(self, sig: Any, codegen: Any) -> str:
        # The processor is part of the name: machine code for another may have instructions that this one lacks.
        form = hashlib.sha256(f"{sig} {codegen.magic_tuple()}".encode()).hexdigest()[:16]
        return f"{self.name}-{form}"


def lies_on_disk(function: Any) -> bool:
    return isinstance(function, Kernel) and function._cache.has_any()


@cache
def announce(part: str) -> None:
    """Say, once, that the kernels of a part are compiled now."""
    what, time = _WHAT[part]
    log.warning("Compiling %s for this processor%s: about %s.", what, ", once" if disk_cache(part).keeps else "", time)
    if not lighter_compilation.is_known():
        given, known = lighter_compilation.releases(), " or ".join(sorted(lighter_compilation.KNOWN))
        log.warning("%s compiles in its own way, which takes twice as long; to be faster, install %s.", given, known)


def _part_of(function: Callable[..., Any]) -> str:
    return function.__module__.split(".")[1]
