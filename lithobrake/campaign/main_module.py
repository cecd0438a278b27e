"""The script that a model stands in: worker processes import it only where a call names something that it defines."""

import os
import pickle
import pickletools
import runpy
import sys
import types

MAIN = "__main__"
# The script goes by this name in a worker process, so that what stands under `if __name__ == "__main__":` is not run.
_IMPORTED = "__mp_main__"
# How a process finds a script: "name" or "path", and which.
Source = tuple[str, str]


class MainModuleError(ValueError):
    """A model of a script that no worker process can import."""


class MainModule:
    """The script of the coordinator in a worker process, imported when it is asked for the first time."""

    importing = False

    def __init__(self, source: Source | None) -> None:
        self._source = source
        self._is_there = False

    def ensure(self) -> None:
        """Import it as `__main__`. Raises MainModuleError where there is none, or it starts a campaign itself."""
        if self._is_there:
            return
        if self._source is None:
            raise MainModuleError(_UNREACHABLE)
        kind, where = self._source
        MainModule.importing = True
        try:
            run = runpy.run_module if kind == "name" else runpy.run_path
            names = run(where, run_name=_IMPORTED)
        finally:
            MainModule.importing = False
        module = types.ModuleType(_IMPORTED)
        module.__dict__.update(names)
        sys.modules[MAIN] = sys.modules[_IMPORTED] = module
        self._is_there = True


_UNREACHABLE = (
    "the model is defined in a notebook, an interactive session or a piped script, which worker processes cannot "
    "import; write it to a file, say model.py, and import it from there"
)


def main_source() -> Source | None:
    """How a process of its own finds the script that is run here; None where it cannot, as in a notebook."""
    module = sys.modules.get(MAIN)
    spec = getattr(module, "__spec__", None)
    # Of a package that is run there is no module to import beside the program itself.
    if spec is not None:
        return None if spec.name.rpartition(".")[2] == MAIN else ("name", spec.name)
    path = getattr(module, "__file__", None)
    return ("path", os.path.abspath(path)) if path and os.path.isfile(path) else None


def refuse_unreachable(sent: bytes) -> None:
    """Raise MainModuleError for a pickle with something of the script that is run here, where none can import that."""
    if MAIN.encode() not in sent or main_source() is not None:
        return
    if any(argument == MAIN for _, argument, _ in pickletools.genops(sent)):
        raise MainModuleError(_UNREACHABLE)


def pickled(what: str, content: object) -> bytes:
    """The pickle that is sent to a process of its own; what: the content in words, as "the model".

    Raises ValueError for what cannot be sent, MainModuleError where no process can import it.
    """
    try:
        sent = pickle.dumps(content)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise ValueError(
            f"{what} cannot be sent to a process ({error}); a model may be a function of a file, outside of any other "
            "function, or an object whose attributes can be sent"
        ) from error
    refuse_unreachable(sent)
    return sent


def refuse_while_importing() -> None:
    """Raise MainModuleError where a script that a worker process imports would start a campaign of its own."""
    if MainModule.importing:
        raise MainModuleError(
            "worker processes import this script, because it defines the model, and would start the campaign again; "
            'what starts it belongs under: if __name__ == "__main__":, or the model into a file of its own'
        )
