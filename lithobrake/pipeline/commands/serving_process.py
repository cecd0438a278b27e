"""The models of a served study in a process of their own, which is ended where an evaluation takes too long."""

import pickle
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from functools import lru_cache
from types import TracebackType
from typing import Any, Self

from lithobrake.campaign.limits import Limits
from lithobrake.campaign.worker import BEGUN, Call, Worker
from lithobrake.pipeline.commands.serving import ServedStudy
from lithobrake.serve import ClientGoneError, ServedModel

# Longest evaluation [s], where neither the command nor the study's campaign.wall_limit says another.
TIME_LIMIT = 600.0
# Whether the client is still there is looked at so often [s].
_LOOK = 0.2


class EvaluationProcess:
    """Evaluates the models of a study for `model_server`, one at a time, in a process that can be ended.

    time_limit: of one evaluation [s]; the first in a process waits for compiled code to be loaded, too, and on a new
    machine for its compilation.
    """

    def __init__(self, study: ServedStudy, time_limit: float | None = None) -> None:
        """Prepare it; the process starts with the first evaluation. Raises ValueError for a limit that is none."""
        if time_limit is not None and not time_limit > 0.0:
            raise ValueError(f"the time limit is {time_limit:g} s; allowed: above 0")
        self.time_limit = time_limit or study.study.campaign.wall_limit or TIME_LIMIT
        self._content = pickle.dumps(study)
        self._worker: Worker | None = None

    def __call__(
        self, model: ServedModel, point: list[float], config: Mapping[str, Any], gone: Callable[[], bool]
    ) -> list[float]:
        """Evaluate, as lithobrake.serve.Evaluate does.

        Raises TimeoutError for one that takes too long, ClientGoneError for one that nobody waits for.
        """
        call = pickle.dumps((evaluate_served, (self._content, model.name, point, config), {}))
        worker = self._ready(Call(Future(), call, Limits()))
        since = time.monotonic()
        while True:
            try:
                said = worker.connection.recv_bytes() if worker.connection.poll(_LOOK) else b""
            except (EOFError, OSError):
                self.end()
                raise RuntimeError(f"the process of the evaluation died ({worker.ended()})") from None
            if said and said != BEGUN:
                break
            if gone():
                self.end()
                raise ClientGoneError
            if time.monotonic() - since > self.time_limit:
                self.end()
                raise TimeoutError(
                    f"the evaluation took more than {self.time_limit:g} s and was ended; ask for another point, or "
                    "raise the limit (lithobrake serve --time-limit)"
                )
        fine, found = pickle.loads(said)
        if not fine:
            raise found
        answer: list[float] = found
        return answer

    def _ready(self, call: Call) -> Worker:
        """The process, which has taken a call; another one where it has died since the last."""
        if self._worker is None or not self._worker.take(call):
            self.end()
            self._worker = Worker()
            self._worker.take(call)
        return self._worker

    def end(self) -> None:
        """End the process; the next evaluation starts another one."""
        if self._worker is not None:
            self._worker.kill()
            self._worker.connection.close()
            self._worker = None

    def __enter__(self) -> Self:
        """Give the evaluations."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the process."""
        self.end()


def evaluate_served(content: bytes, name: str, point: list[float], config: Mapping[str, Any]) -> list[float]:
    """Evaluate a model of a pickled ServedStudy in this process, which keeps the study with what it has read."""
    return _served(content)[name].evaluate(point, config)


@lru_cache(maxsize=1)
def _served(content: bytes) -> dict[str, ServedModel]:
    study: ServedStudy = pickle.loads(content)
    return {model.name: model for model in study.models()}
