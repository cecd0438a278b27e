"""A model that is a program, with a folder for each run, or a server that is asked over HTTP."""

import contextlib
import csv
import json
import os
import re
import reprlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from lithobrake.campaign.single_run import CappedLog, last_words, run_key
from lithobrake.files.reading import content_hash, unique
from lithobrake.vocabulary.extra_library import extra_library
from lithobrake.vocabulary.plain_text import closest
from lithobrake.vocabulary.quantities import Row

ANSWER = "outputs.json"
# How long to wait for the last of what a program printed, where something that it left running may print on [s].
_LINGER = 1.0
# Names have dots; blanks inside the braces are the author's taste.
PLACE = re.compile(r"\{\{\s*([\w.\-]+)\s*\}\}")
PREFIX = "umbridge:"
FORM = "umbridge:http://HOST:PORT/MODEL"


def read_answer(path: Path) -> dict[str, Any]:
    """What a program wrote into a file whose ending DECODERS has.

    Raises ValueError when there is none, it is not of its format, or a value is not finite.
    """
    if not path.is_file():
        raise ValueError(f"the program wrote no {path.name}; it has to write one into the folder that it is started in")
    content = DECODERS[path.suffix.lower()](path)
    if not isinstance(content, dict) or not isinstance(content.get("outputs", {}), dict):
        raise ValueError(f"{path.name} is no JSON object of numbers by name; mend what the program writes")
    answer = content if "outputs" in content or "outcome" in content else {"outputs": content}
    beside = [name for name in answer if name not in ("outcome", "outputs", "draws")]
    if beside and "outputs" not in answer:
        raise ValueError(
            f"{path.name} has {', '.join(map(str, beside))} beside the outcome; allowed: "
            '{"outcome": a word, "outputs": numbers by name}; put the numbers into outputs'
        )
    outputs = answer.setdefault("outputs", {})
    for name, value in outputs.items():
        if not _is_number(value):
            raise ValueError(
                f"{path.name} has {reprlib.repr(value)} for {name}; allowed: a finite number; leave out what has none"
            )
    for name, kind, words in (("outcome", str, "a word"), ("draws", dict, "a JSON object")):
        if not isinstance(answer.get(name, kind()), kind):
            raise ValueError(
                f"{path.name} has {reprlib.repr(answer[name])} for {name}; allowed: {words}; mend it or leave it out"
            )
    return answer


def _json(path: Path) -> Any:
    try:
        # Some editors and languages begin a text with a mark of its encoding.
        return json.loads(path.read_text(encoding="utf-8-sig"), object_pairs_hook=unique)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path.name} is not JSON ({error}); the program has to write one JSON object") from error


def _csv(path: Path) -> dict[str, Any]:
    """The last row under the names of the first; an empty cell has no value, and outcome is a column like others."""
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            names, *rows = [row for row in csv.reader(file, skipinitialspace=True) if row]
        last = unique((name.strip(), cell.strip()) for name, cell in zip(names, rows[-1], strict=True))
        outcome = {"outcome": last.pop("outcome")} if "outcome" in last else {}
        outputs = {name: float(cell) for name, cell in last.items() if cell}
    except (ValueError, IndexError, csv.Error) as error:
        raise ValueError(
            f"{path.name} is no CSV of numbers ({error}); the program has to write names, and below them numbers"
        ) from error
    return {**outcome, "outputs": outputs}


def _yaml(path: Path) -> Any:
    yaml = extra_library("yaml", f"PyYAML, which reads {path.name},", "yaml")
    try:
        text = path.read_text(encoding="utf-8-sig")
        top = yaml.compose(text, yaml.SafeLoader)
        # Of a name that stands twice PyYAML keeps the last. What lies deeper is no answer.
        tables = [node for node in (top, *_values(top)) if isinstance(node, yaml.MappingNode)]
        for table in tables:
            unique((key.value, None) for key, _ in table.value)
        return yaml.safe_load(text)
    except (ValueError, yaml.YAMLError) as error:
        words = " ".join(str(error).split())
        raise ValueError(f"{path.name} is not YAML ({words}); the program has to write names with numbers") from error


def _values(node: Any) -> list[Any]:
    """The values of a table of YAML; none of another node."""
    return [pair[1] for pair in getattr(node, "value", ()) if isinstance(pair, tuple)]


def _hdf5(path: Path) -> dict[str, Any]:
    """Data sets of one number at the top or in the group `outputs`; the outcome is an attribute of the file."""
    import h5py

    try:
        with h5py.File(path, "r") as file:
            group = file["outputs"] if isinstance(file.get("outputs"), h5py.Group) else file
            sets = {str(name): entry for name, entry in group.items() if isinstance(entry, h5py.Dataset)}
            outputs = {name: entry[()].item() for name, entry in sets.items() if entry.size == 1}
            outcome = {"outcome": str(file.attrs["outcome"])} if "outcome" in file.attrs else {}
    except (OSError, AttributeError) as error:
        raise ValueError(f"{path.name} is not HDF5 ({error}); the program has to write data sets by name") from error
    return {**outcome, "outputs": outputs}


DECODERS: dict[str, Callable[[Path], Any]] = {
    ".json": _json,
    ".csv": _csv,
    **dict.fromkeys((".yaml", ".yml"), _yaml),
    **dict.fromkeys((".h5", ".hdf5"), _hdf5),
}


def _is_number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= sys.float_info.max


@dataclass(frozen=True)
class Command:
    """A program as the model of a campaign.

    command: the words of a command line; no shell reads it, and a word that names a file becomes its absolute path.
    folder: takes a folder for each run, in which the program is started. required: outputs without which a run has
    failed. templates: files whose places are filled with the numbers of a run and that are put into its folder beside
    inputs.json. answer: name of the file that the program writes; its ending tells the format (DECODERS).

    The program reads `inputs.json`: {"inputs": numbers by name, "seed": whole number}, and writes `outputs.json`: its
    outputs by name, or {"outcome": how the run ended, "outputs": numbers by name, "draws": what it drew by chance}.
    What it prints goes to `log.txt`; of a long log, the beginning and the end.
    """

    command: str
    folder: Path
    required: tuple[str, ...] = ()
    templates: tuple[Path, ...] = ()
    answer: str = ANSWER

    def __call__(self, inputs: Row, seed: int) -> dict[str, Any]:
        """Make one run.

        Raises RuntimeError for an exit code other than 0, ValueError for outputs that are missing or not finite.
        """
        answer = self.ask({"inputs": inputs, "seed": seed})
        lacking = [name for name in self.required if name not in answer["outputs"]]
        if lacking:
            raise ValueError(f"{self.answer} lacks {', '.join(lacking)}; the program has to write all that is required")
        return answer

    def ask(self, question: Mapping[str, Any]) -> dict[str, Any]:
        """Write `inputs.json` for a program, run it, and return what it wrote."""
        with self._run_folder(run_key(question["inputs"], question["seed"], 0, {})[:16]) as folder:
            # NaN and infinity are no JSON: what Python writes for them stops the parsers of other languages.
            text = json.dumps(question, indent=2, allow_nan=False)
            (folder / "inputs.json").write_text(text + "\n", encoding="utf-8")
            for template in self.templates:
                fill_template(template, folder, question)
            code = _made(self.words(), folder)
            if code:
                how, said = f"exit code {code}" if code > 0 else f"signal {-code}", last_words(folder / "log.txt")
                raise RuntimeError(f"the program ended with {how}; its last words: {said}")
            return read_answer(folder / self.answer)

    def words(self) -> list[str]:
        """The words of the command, files by their absolute paths."""
        return absolute_words(self.command, Path())

    def identity(self) -> list[str]:
        """The words of the command, a hash of its content for each that names a file: what decides the results.

        So are templates, and the name of another answer than outputs.json. Put it into the context of a campaign, so
        that runs of a changed program count as other runs.
        """
        words = [content_hash(Path(word)) if os.path.isfile(word) else word for word in self.words()]
        words += [f"template {template.name} {content_hash(template)}" for template in self.templates]
        return words + ([f"answer {self.answer}"] if self.answer != ANSWER else [])

    @contextlib.contextmanager
    def _run_folder(self, name: str) -> Iterator[Path]:
        """A fresh folder; at the end it gets its name, and takes the place of an earlier try.

        A program that outlived its worker may still write into the folder of that try, so no try shares one.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        for left_over in self.folder.glob(f"{name}.*"):
            shutil.rmtree(left_over, ignore_errors=True)
        # Named like the run, but unique: the loop above finds what an interrupted try has left.
        draft = Path(tempfile.mkdtemp(prefix=f"{name}.", dir=self.folder))
        try:
            yield draft
        finally:
            final = self.folder / name
            if final.exists():
                shutil.rmtree(final)
            draft.rename(final)


def _made(words: list[str], folder: Path) -> int:
    """Start a program in a folder, keep what it prints in `log.txt`, and give its exit code.

    Raises OSError when it cannot be started or the log cannot be written.
    """
    # Without standard input, as a program that asks for something would wait on the terminal of the campaign;
    # unbuffered, so that the last words of a program that is killed are in its log.
    program = subprocess.Popen(
        words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, bufsize=0
    )
    copying = _Copying(program.stdout, CappedLog(folder / "log.txt"))
    copying.start()
    code = program.wait()
    copying.join(_LINGER)
    if copying.error:
        raise copying.error
    return code


class _Copying(threading.Thread):
    """Copies what a program prints into its log until nobody prints any more, and closes both.

    What a program leaves running may print for long after it; this goes on as long, and nobody waits for it.
    """

    def __init__(self, printed: Any, log: CappedLog) -> None:
        super().__init__(name="log of a program", daemon=True)
        self.printed, self.log = printed, log
        self.error: OSError | None = None

    def run(self) -> None:
        """Copy; an error is kept for who started this, and then the program cannot print any more either."""
        try:
            with self.printed, self.log:
                while piece := self.printed.read(1 << 16):
                    self.log.write(piece)
        except OSError as error:
            self.error = error


def absolute_words(command: str, folder: Path) -> list[str]:
    """The words of a command, those that name a file in or from the folder by their absolute paths.

    Raises ValueError for a command whose quotes do not match.
    """
    # A link stays one: the interpreter of a virtual environment is a link, and finds its packages from where it lies.
    return [os.path.abspath(folder / word) if os.path.isfile(folder / word) else word for word in shlex.split(command)]


def fill_template(template: Path, folder: Path, question: Mapping[str, Any]) -> None:
    """Write a template with its places filled into a folder, under its own name.

    question: inputs by name; seed; whatever else, by dotted names (setting.bed.grain_count). A number has all its
    digits, a word stands as it is. Raises ValueError for a name that there is not.
    """
    values = dict(question.get("inputs", {}))
    values |= dict(_leaves({name: value for name, value in question.items() if name != "inputs"}))

    def filled(match: re.Match[str]) -> str:
        name = match[1]
        if name not in values:
            meant = closest(name, values) or f"; there are: {', '.join(values)}"
            raise ValueError(f"{template} has a place for {name}, which is no number of a run{meant}")
        value = values[name]
        return repr(value) if isinstance(value, float) else str(value)

    text = template.read_text(encoding="utf-8")
    (folder / template.name).write_text(PLACE.sub(filled, text), encoding="utf-8")


def _leaves(table: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Numbers and words of nested tables by dotted name; lists and what is absent have no place in a text."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{above}{name}.")
        elif isinstance(value, str | int | float):
            yield f"{above}{name}", value


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
