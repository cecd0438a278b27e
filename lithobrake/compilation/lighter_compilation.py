"""Compilation of a kernel with all that it calls at once: one run of the optimiser, no machine code of inner kernels.

Numba optimises each function together with all that it calls, and turns it into machine code, before it compiles the
functions that call it; of a kernel that only kernels call none of that is ever run. Here such an inner kernel stays
what the front end made of it, and the kernel that Python calls is optimised once with all of them linked in. LLVM keeps
IEEE arithmetic at each level, so results have the same bits.

What is overridden here is no public interface of Numba, so it is used with those versions alone that it is tested with.
"""

import gc
import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import llvmlite
import numba
from numba.core import compiler, dispatcher
from numba.core.codegen import JITCodeLibrary
from numba.core.environment import lookup_environment
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature
from numba.core.targetconfig import ConfigStack

from lithobrake.compilation.lighter_lowering import KernelPipeline

log = logging.getLogger(__name__)

# Versions of Numba and llvmlite, up to their patch releases, that tests/compilation ran with.
KNOWN = {("0.68", "0.50")}


@cache
def is_known() -> bool:
    """Whether the lighter compilation is known to work with this Numba; another one compiles as it always does."""
    found = (_release(numba.__version__), _release(llvmlite.__version__))
    if found not in KNOWN:
        log.info("Numba %s with llvmlite %s compiles kernels in its own way, which takes longer", *found)
    return found in KNOWN


def _release(version: str) -> str:
    """The release of a version without its patch: "0.68" of "0.68.1"."""
    return ".".join(version.split(".")[:2])


class KernelFlags(compiler.Flags):
    """Options of one compilation, compared by what was set; Numba compares a dictionary of all options each time."""

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        """Whether the same options were set to the same values."""
        return isinstance(other, KernelFlags) and self._values == other._values

    def __hash__(self) -> int:
        """The same for all, as Numba's is: options may be set after a dictionary has them as a key."""
        return 68


def is_for_kernel() -> bool:
    """Whether what is compiled just now is compiled in this way, and so can take inner kernels in."""
    return isinstance(ConfigStack.top_or_none(), KernelFlags)


class KernelLibrary(JITCodeLibrary):
    """The code of one kernel.

    counts: whether it counts references to arrays; if not, all that Numba does about counts is left out.
    """

    def __init__(self, codegen: Any, name: str, counts: bool) -> None:
        super().__init__(codegen, name)
        self.counts = counts

    def _optimize_functions(self, ll_module: Any) -> None:
        """Optimise each function alone, to find counts that cancel; all else is done once for all together."""
        ll_module.data_layout = self._codegen._data_layout
        if self.counts:
            super()._optimize_functions(ll_module)


class InnerLibrary(KernelLibrary):
    """That of a kernel for kernels that call it: as it was lowered, and linked with nothing."""

    def finalize(self) -> None:
        """End it, with no machine code."""
        self._raise_if_finalized()
        self._finalized = True


class OuterLibrary(KernelLibrary):
    """That of a kernel that Python calls, with all kernels below it."""

    def finalize(self) -> None:
        """Link each kernel once, optimise all together, and make machine code."""
        self._linking_libraries = _all_below(self)
        super().finalize()

    def _optimize_final_module(self) -> None:
        """Optimise all together; what is for this module alone is given only those of its arguments that it reads."""
        below = [library for library in self._linking_libraries if isinstance(library, InnerLibrary)]
        for name in {function.name for library in below for function in library.get_defined_functions()}:
            self._final_module.get_function(name).linkage = "internal"
        if self.counts:
            super()._optimize_final_module()
            return
        passes, builder = self._codegen._module_pass_manager()
        passes.run(self._final_module, builder)

    def _finalize_specific(self) -> None:
        """Give each kernel that was linked in its environment, as Numba does for one."""
        super()._finalize_specific()
        for variable in self._final_module.global_variables:
            environment = lookup_environment(variable.name)
            if environment is not None:
                self._codegen.set_env(variable.name, environment)


def _all_below(library: JITCodeLibrary) -> list[JITCodeLibrary]:
    """All libraries that one needs, in the order in which they are met first."""
    found: dict[JITCodeLibrary, None] = {}
    pending = list(reversed(library._linking_libraries))
    while pending:
        one = pending.pop()
        if one not in found:
            found[one] = None
            # Others than these have linked in already what they need.
            if isinstance(one, InnerLibrary):
                pending.extend(reversed(one._linking_libraries))
    return list(found)


class KernelCompiler(dispatcher._FunctionCompiler):  # type: ignore[name-defined, misc, unused-ignore]
    """Compiles one function: for kernels that call it, or for Python."""

    def __init__(self, kernel: Any, is_inner: bool) -> None:
        """Take the place of the compiler that Numba made for a dispatcher."""
        plain = kernel._compiler
        super().__init__(plain.py_func, plain.targetdescr, plain.targetoptions, plain.locals, KernelPipeline)
        self._is_inner = is_inner

    def _compile_core(self, args: Any, return_type: Any) -> Any:
        flags, target = KernelFlags(), self.targetdescr.target_context
        self.targetdescr.options.parse_as_flags(flags, self.targetoptions)
        # An inner kernel is only lowered.
        flags.no_compile = self._is_inner
        kind = InnerLibrary if self._is_inner else OuterLibrary
        library = kind(target.codegen(), self.py_func.__qualname__, flags.nrt)
        library.enable_object_caching()
        return compiler.compile_extra(
            self.targetdescr.typing_context, target, self.py_func, args=args, return_type=return_type, flags=flags,
            locals=self.locals, library=library, pipeline_class=self.pipeline_class,
        )  # fmt: skip


class InnerKernel(CPUDispatcher):
    """A function for kernels that call it, which nothing else can call."""

    def __init__(self, py_func: Callable[..., Any], *, tell: Callable[[], None], **options: Any) -> None:
        """Prepare a function, with options as Numba's; tell: is called each time that it was lowered."""
        super().__init__(py_func, **options)
        self._compiler: Any = KernelCompiler(self, is_inner=True)
        self._tell = tell

    def compile(self, sig: Any) -> Any:
        """Lower it for arguments of these types, unless that is done; return the key that callers know it by."""
        args, return_type = normalize_signature(sig)
        if args not in self.overloads:
            lowered = self._compiler.compile(args, return_type)
            # In the place of an address, of which there is none.
            found = lowered._replace(entry_point=object())
            self.targetctx.insert_user_function(found.entry_point, found.fndesc, [found.library])
            self.overloads[args] = found
            self._tell()
        return self.overloads[args].entry_point


@contextmanager
def without_garbage_collection() -> Iterator[None]:
    """Leave what is compiled alone: the collector would look through all of it again and again, and find little."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()
