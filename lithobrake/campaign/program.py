"""A model that is a program, with a folder for each run."""

import contextlib
import json
import os
import re
import shlex
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lithobrake.campaign.program_answer import read_answer
from lithobrake.campaign.single_run import CappedLog, last_words, run_key
from lithobrake.files.reading import content_hash
from lithobrake.vocabulary.plain_text import closest
from lithobrake.vocabulary.quantities import Row

ANSWER = "outputs.json"
# How long to wait for the last of what a program printed, where something that it left running may print on [s].
_LINGER = 1.0
# Names have dots; blanks inside the braces are the author's taste.
PLACE = re.compile(r"\{\{\s*([\w.\-]+)\s*\}\}")


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
