"""Lowering of kernels that takes apart no tuple which it has just put together, and keeps variables out of memory.

Kernels are given named tuples of a hundred arrays and more, of seven numbers each. Numba lays each argument out on the
stack, reads all of it at every use, takes it apart into some thousand numbers for each call, and leaves it to LLVM to
find out that few of them are needed. Here a variable that is set once, before all of its uses, is its value itself, and
a member of a tuple that was put together is what was put in.
"""

from types import CodeType
from typing import Any

from llvmlite import ir
from llvmlite.ir.instructions import ExtractValue, InsertValue, PhiInstr
from numba.core import ir as numba_ir
from numba.core.analysis import compute_cfg_from_blocks, compute_use_defs, must_use_alloca
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import register_pass
from numba.core.lowering import Lower
from numba.core.typed_passes import NativeLowering, NopythonRewrites
from numba.core.untyped_passes import InlineClosureLikes


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
        """Begin the function."""
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
    """The pass that lowers kernels so."""

    _name = "kernel_lowering"

    @property
    def lowering_class(self) -> type[Lower]:
        """What lowers."""
        return KernelLower


class KernelPipeline(Compiler):
    """Numba's passes with this one in the place of its own, and without those that find nothing in a kernel."""

    def define_pipelines(self) -> list[Any]:
        """Give the passes."""
        without: set[type] = set()
        if not self.state.flags.nrt:
            # It joins expressions that make arrays, which takes counting.
            without.add(NopythonRewrites)
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
