"""A model behind a server that is asked over HTTP, by the protocol of UM-Bridge."""

import json
import urllib.error
import urllib.request
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any
from urllib.parse import urlsplit

from lithobrake.files.reading import unique

PREFIX = "umbridge:"
FORM = "umbridge:http://HOST:PORT/MODEL"


@dataclass(frozen=True)
class ModelServer:
    """A model of a server: address, without a path, and name."""

    address: str
    name: str

    @classmethod
    def of(cls, words: str) -> "ModelServer":
        """The one that words of the form umbridge:http://HOST:PORT/MODEL name. Raises ValueError for others."""
        try:
            parts = urlsplit(words.removeprefix(PREFIX))
            good = words.startswith(PREFIX) and parts.scheme in ("http", "https") and parts.hostname and parts.port
        except ValueError:
            good = False
        name = parts.path.strip("/") if good else ""
        if not name or "/" in name or parts.query or parts.fragment:
            raise ValueError(f"{words!r} is no model of a server; allowed: {FORM}")
        return cls(f"{parts.scheme}://{parts.netloc}", name)

    def evaluate(
        self, inputs: Sequence[Sequence[float]], config: Mapping[str, Any], names: Sequence[str] = ()
    ) -> list[list[float]]:
        """The outputs at these vectors of inputs; names: of the numbers of a vector, for messages.

        Raises RuntimeError for what the server refuses, ConnectionError where none answers, ValueError for an answer
        that is no list of lists of numbers.
        """
        request = {"name": self.name, "input": [list(vector) for vector in inputs], "config": dict(config)}
        answer = self._post("Evaluate", request)
        output = answer.get("output")
        if not isinstance(output, list) or not all(isinstance(vector, list) for vector in output):
            raise ValueError(f"{self.address} answered {str(answer)[:200]}; allowed: an output of lists of numbers")
        for vector in output:
            for name, number in zip_longest(names[: len(vector)], vector, fillvalue="an output"):
                if isinstance(number, bool) or not isinstance(number, int | float):
                    raise ValueError(
                        f"{self.address} answered {json.dumps(number)[:200]} for {name}; allowed: a number; mend the "
                        "model of the server"
                    )
        return [[float(number) for number in vector] for vector in output]

    def _post(self, verb: str, content: Mapping[str, Any]) -> dict[str, Any]:
        body = json.dumps(content, allow_nan=False).encode()
        request = urllib.request.Request(
            f"{self.address}/{verb}", data=body, headers={"Content-Type": "application/json"}
        )
        # A proxy that the environment names is not for a server beside the campaign.
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with opener.open(request) as response:
                text = response.read()
        except urllib.error.HTTPError as error:
            # A server of UM-Bridge sends its refusal as JSON with a status of HTTP that is an error.
            text = error.read()
        except OSError as error:
            raise ConnectionError(
                f"{self.address} does not answer ({error}); start its server, then try again"
            ) from error
        try:
            answer = json.loads(text, object_pairs_hook=unique)
        except ValueError as error:
            raise ValueError(f"{self.address} answered no JSON ({error}); is it a server of UM-Bridge?") from error
        if not isinstance(answer, dict):
            raise ValueError(f"{self.address} answered {str(answer)[:200]}, which is no JSON object")
        if "error" in answer:
            raise RuntimeError(f"{self.address} refuses model {self.name}: {_said(answer['error'])}")
        return answer


def _said(error: Any) -> str:
    return f"{error.get('type')}: {error.get('message')}" if isinstance(error, dict) else str(error)
