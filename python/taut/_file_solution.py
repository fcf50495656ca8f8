"""Answers that are files, with what proves them."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any

from . import _native
from ._answers.file import FileVerdict
from ._answers.trace import Trace
from ._record import brief

Path = str | os.PathLike[str]

# For each kind, the entries of the answer by which a solution prints itself.
FACTS = {
    "sort": ("records", "width"),
    "transpose": ("rows", "columns", "width"),
    "sample": ("of", "drawn"),
}


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class FileSolution:
    """A file that was written, what proves its content, and how it came about.

    Two are equal when all that they say is. They can be pickled.

    Attributes
    ----------
    kind : str
        ``"sort"``, ``"transpose"`` or ``"sample"``.
    answer : dict
        What the file is said to be, by the names of the JSON. A fresh copy each time.
    certificate : dict
        Its proof. A fresh copy each time.
    trace : Trace
        Counters of the run.
    """

    _found: _native.FoundFile

    @property
    def trace(self) -> Trace:
        return Trace._of(self._found.parts()[2])

    @property
    def kind(self) -> str:
        return self._found.kind

    @property
    def answer(self) -> dict[str, Any]:
        return self._part("answer")

    @property
    def certificate(self) -> dict[str, Any]:
        return self._part("certificate")

    def _part(self, name: str) -> dict[str, Any]:
        part: dict[str, Any] = json.loads(self.to_json())[name]
        return part

    def check(self, output: Path, input: Path | None = None) -> FileVerdict:  # noqa: A002, the public name
        """A second opinion: reads the file that was written, and compares it with the one it was made from.

        Parameters
        ----------
        output : path
            The file that was written.
        input : path, optional
            The file that was read. Without it the content is judged by the hash of the certificate.

        Returns
        -------
        FileVerdict

        Raises
        ------
        Violation
            When the file is not what this says.
        OSError
            When a file cannot be read.
        ValueError
            When an input is named for a sample, which is made from none.
        """
        return FileVerdict._of(self._found.check(output, input))

    def to_json(self) -> str:
        """The solution as a JSON document, as the command line writes it.

        Returns
        -------
        str
        """
        return self._found.to_json()

    @staticmethod
    def from_json(text: str) -> FileSolution:
        """Reads what `to_json` or the command line wrote.

        Parameters
        ----------
        text : str
            The document. Nothing in it is believed until `check` has judged it.

        Returns
        -------
        FileSolution

        Raises
        ------
        ValueError
            When the text is not an answer about files, or of a newer schema.
        """
        return FileSolution(_native.FoundFile.from_json(text))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, FileSolution) and self._found == other._found

    def __reduce__(self) -> tuple[Any, ...]:
        return FileSolution.from_json, (self.to_json(),)

    def __repr__(self) -> str:
        answer = self.answer
        facts = ", ".join(f"{name}={brief(answer[name])}" for name in FACTS[self.kind])
        return f"FileSolution(kind={self.kind!r}, {facts})"


FileSolution.__module__ = "taut"
