"""Compilation of a kernel with all that it calls at once, and lowering that takes apart no tuple it has just made."""

import gc
from collections.abc import Callable
from functools import cache
from threading import Lock
from types import CodeType
from typing import Any

import llvmlite
import numba
from llvmlite import ir
from llvmlite.ir.instructions import ExtractValue, InsertValue, PhiInstr
from numba.core import compiler, dispatcher
from numba.core import ir as numba_ir
from numba.core.analysis import compute_cfg_from_blocks, compute_use_defs, must_use_alloca
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import register_pass
from numba.core.environment import lookup_environment
from numba.core.lowering import Lower
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature
from numba.core.targetconfig import ConfigStack
from numba.core.typed_passes import NativeLowering, NopythonRewrites
from numba.core.untyped_passes import InlineClosureLikes

# Releases that tests/compilation ran with.
KNOWN = {"Numba 0.68 with llvmlite 0.50"}
# What some twenty kernels leave behind.
NEW_OBJECTS = 200_000


class FoldingBuilder(ir.IRBuilder):
    """Writes instructions, but none that would read a member which was put into a tuple before."""

    def extract_value(self, agg: Any, idx: Any, name: str = "") -> Any:
        """Give the member of an aggregate, by its number or by those of a path into it."""
        path = list(idx) if isinstance(idx, tuple | list) else [idx]
        while len(path) == 1 and isinstance(agg, InsertValue) and len(agg.indices) == 1:
            if agg.indices == path:
                return agg.value
            agg = agg.aggregate
        return super().extract_value(agg, path, name)


class KernelLower(Lower):
    """Lowers a kernel, in which nothing is counted."""

    def setup_function(self, fndesc: Any) -> None:
        super().setup_function(fndesc)
        self.builder = FoldingBuilder(self.entry_block)
        self.call_helper = self.call_conv.init_call_helper(self.builder)

    def _find_singly_assigned_variable(self) -> None:
        """Find the variables that need no memory: those set once, in a block before all that use them."""
        if self.context.enable_nrt or self.func_ir.func_id.is_generator:
            super()._find_singly_assigned_variable()
            return
        self._singly_assigned_vars = _set_before_use(self.func_ir.blocks)
        self._blk_local_varmap: dict[str, Any] = {}

    def lower_normal_function(self, fndesc: Any) -> None:
        """Lower, and leave out what was put together for nobody."""
        super().lower_normal_function(fndesc)
        _leave_out_unused(self.function)


def _set_before_use(blocks: dict[int, Any]) -> set[str]:
    """The variables with one assignment that stands before each use, on every path and in the order of blocks."""
    uses, in_memory = compute_use_defs(blocks), must_use_alloca(blocks)
    before = compute_cfg_from_blocks(blocks).dominators()
    set_in: dict[str, list[int]] = {}
    for offset, block in blocks.items():
        for statement in block.find_insts(numba_ir.Assign):
            set_in.setdefault(statement.target.name, []).append(offset)
    used_in: dict[str, list[int]] = {}
    for offset, names in uses.usemap.items():
        for name in names:
            used_in.setdefault(name, []).append(offset)
    return {
        name
        for name, offsets in set_in.items()
        if len(offsets) == 1
        and name not in in_memory
        and all(offsets[0] < use and offsets[0] in before.get(use, ()) for use in used_in.get(name, ()))
    }


def _leave_out_unused(function: ir.Function) -> None:
    """Remove instructions on members of tuples whose result nothing reads."""
    pending = [one for block in function.blocks for one in block.instructions if not _is_on_members(one)]
    used: set[int] = set()
    while pending:
        one = pending.pop()
        operands = [value for value, _ in one.incomings] if isinstance(one, PhiInstr) else one.operands
        for operand in operands:
            if _is_on_members(operand) and id(operand) not in used:
                used.add(id(operand))
                pending.append(operand)
    for block in function.blocks:
        block.instructions[:] = [one for one in block.instructions if not _is_on_members(one) or id(one) in used]


def _is_on_members(value: Any) -> bool:
    return isinstance(value, InsertValue | ExtractValue)


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(NativeLowering):
    _name = "kernel_lowering"

    @property
    def lowering_class(self) -> type[Lower]:
        return KernelLower


class KernelPipeline(Compiler):
    """Numba's passes with this one in the place of its own, and without those that find nothing in a kernel."""

    def define_pipelines(self) -> list[Any]:
        without: set[type] = set()
        if not self.state.flags.nrt:
            # It joins expressions that make arrays, which takes counting.
            without.add(NopythonRewrites)
        # A closure stands as code among the constants of its function; without any there is nothing to inline.
        if not any(isinstance(constant, CodeType) for constant in self.state.func_id.code.co_consts):
            without.add(InlineClosureLikes)
        found = super().define_pipelines()
        for passes in found:
            passes.passes = [
                (KernelLowering if one is NativeLowering else one, what)
                for one, what in passes.passes
                if one not in without
            ]
            passes.finalize()
        return found


@cache
def is_known() -> bool:
    """Whether the lighter compilation is known to work with this Numba; another one compiles as it always does."""
    return releases() in KNOWN


def releases() -> str:
    """The releases of Numba and llvmlite in words, without their patches: "0.68" of "0.68.1"."""
    numba_release, llvmlite_release = (
        ".".join(version.split(".")[:2]) for version in (numba.__version__, llvmlite.__version__)
    )
    return f"Numba {numba_release} with llvmlite {llvmlite_release}"


class KernelFlags(compiler.Flags):
    """Options of one compilation, compared by what was set; Numba compares a dictionary of all options each time."""

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
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


class RareGarbageCollection:
    """Collects garbage once so many objects are new: often, the collector would look through all that is compiled again
    and again; never, what each kernel leaves behind would take 300 MB.

    The threshold is that of the process: the first of several threads that compile sets it, the last one puts it back.
    A collector that is off, or as rare, is left as it is.
    """

    def __init__(self) -> None:
        self._lock, self._inside, self._usual = Lock(), 0, gc.get_threshold()

    def __enter__(self) -> None:
        with self._lock:
            if self._inside == 0:
                self._usual = gc.get_threshold()
                if 0 < self._usual[0] < NEW_OBJECTS:
                    gc.set_threshold(NEW_OBJECTS, *self._usual[1:])
            self._inside += 1

    def __exit__(self, *error: object) -> None:
        with self._lock:
            self._inside -= 1
            if self._inside == 0:
                gc.set_threshold(*self._usual)


RARE_GARBAGE_COLLECTION = RareGarbageCollection()
