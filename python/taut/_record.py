"""Data that cannot be altered: what all answers, certificates and verdicts are.

A class derived from `Record` lists its attributes. Each is filled from the dict that the compiled part makes of a Rust
struct, which has the names of the JSON: by default from the entry of its own name, else as one of the functions here
says. In the dict of an answer, or of a certificate, ``within`` leads to both; in that of a part, to what it is a part
of.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, NamedTuple, Self, TypeVar, dataclass_transform

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
RowNumbers = NDArray[np.int64]
Ids = NDArray[np.uint32]
SimplexIds = NDArray[np.int32]

FLOAT, ROW, ID = np.float64, np.int64, np.uint32

# Simplices, their rows and neighbors, as SciPy and matplotlib have them: a triangulation has fewer than 2**30.
SIMPLEX_ID = np.int32

# The path from a dict to itself; others are names with dots between.
ITSELF = "."

# Most numbers of an array that are shown one by one.
NUMBERS_SHOWN_MAX = 3

Said = Mapping[str, Any]

# Makes an attribute of what is said at its path (None where it leads nowhere), of all that is said, and of its name.
Make = Callable[[Any, Said, str], Any]


class Source(NamedTuple):
    """Where an attribute comes from. Without a path it is the entry of its own name, without `make` as it is."""

    path: str | None = None
    make: Make | None = None
    dtype: Any = None


def value(at: str | None = None, *, by: Callable[[Any], Any] | None = None) -> Any:
    """An attribute that is the entry at a path, such as ``"topology.genus"``, or None; `by` converts it."""
    return _field(at, None if by is None else lambda found, said, name: by(found))


def column(dtype: Any, *, at: str | None = None, optional: bool = False, zeros_like: str | None = None) -> Any:
    """An array of one axis. An empty one is None if `optional`, or zeros, as many as `zeros_like` has numbers."""

    def make(found: Any, said: Said, name: str) -> Any:
        if found is not None and len(found) > 0:
            return found
        return None if optional else np.zeros(_width(said, zeros_like) if zeros_like else 0, dtype)

    return _field(at, make, dtype)


def table(dtype: Any, width: int | str | None, *, at: str | None = None, optional: bool = False) -> Any:
    """An array of two axes, with rows as wide as `width` or as the array at that path; None is any width.

    An empty one is None if `optional`.
    """

    def make(found: Any, said: Said, name: str) -> Any:
        is_empty = found is None or len(found) == 0
        if is_empty and optional:
            return None
        if isinstance(width, str):
            expected, like = _width(said, width), "the center" if width.endswith("center") else f"a row of {width}"
        elif width is None:
            expected, like = 0 if is_empty else len(found[0]), "row 0"
        else:
            expected, like = width, "each"
        if is_empty:
            return np.empty((0, expected), dtype)
        # Rows of different lengths come as a list, of one length as an array.
        for number, row in enumerate(found if isinstance(found, list) else found[:1]):
            if len(row) != expected:
                raise ValueError(f"row {number} of the {name} has {len(row)} numbers, but {like} has {expected}")
        return found

    return _field(at, make, dtype)


def one(part: type[Record], *, at: str | None = None) -> Any:
    """A record that is a part of this one, or None."""
    return _field(at, lambda found, said, name: found and part._of({**found, "within": said}))


def each(part: type[Record], *, at: str | None = None) -> Any:
    """Records that are parts of this one, as a tuple."""
    return _field(at, lambda found, said, name: tuple(map(part._of, found)))


def _field(path: str | None, make: Make | None, dtype: Any = None) -> Any:
    return dataclasses.field(metadata={"source": Source(path, make, dtype)})


def _look(said: Said, path: tuple[str, ...]) -> Any:
    """What is said at a path; None where it leads nowhere."""
    found: Any = said
    for name in path:
        found = None if found is None else found.get(name)
    return found


def _width(said: Said, path: str) -> int:
    """The length of the last axis of the array at a path."""
    return int(np.shape(_look(said, tuple(path.split("."))))[-1])


class Record:
    """Named data. Two are equal if of one class and all their data are; they can be pickled, and nothing can be set."""

    __slots__ = ()
    __hash__: ClassVar[None]  # type: ignore[assignment]
    _paths: ClassVar[dict[str, tuple[str, ...]]]
    _makers: ClassVar[dict[str, Make]]
    _dtypes: ClassVar[dict[str, Any]]
    _shown: ClassVar[tuple[str, ...]]

    @classmethod
    def _of(cls, said: Said) -> Self:
        found = {name: _look(said, path) for name, path in cls._paths.items()}
        for name, make in cls._makers.items():
            found[name] = make(found[name], said, name)
        return cls(**found)

    def __post_init__(self) -> None:
        for name, dtype in self._dtypes.items():
            given = getattr(self, name)
            if given is not None:
                # An array that somebody can write to is copied: one that was unpickled, too.
                array = np.asarray(given, dtype)
                array = array.copy() if array.flags.writeable else array
                array.flags.writeable = False
                object.__setattr__(self, name, array)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(_same(getattr(self, name), getattr(other, name)) for name in self._paths)

    def __reduce__(self) -> tuple[Any, ...]:
        return functools.partial(type(self), **{name: getattr(self, name) for name in self._paths}), ()

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={brief(getattr(self, name))}" for name in self._shown)
        return f"{type(self).__name__}({shown})"


R = TypeVar("R", bound=Record)


@dataclass_transform(
    frozen_default=True, eq_default=False, kw_only_default=True, field_specifiers=(value, column, table, one, each)
)
def record(*shown: str) -> Callable[[type[R]], type[R]]:
    """Makes a class of its annotations; `shown` are the attributes by which it prints itself."""

    def made(listed: type[R]) -> type[R]:
        cls: Any = dataclasses.dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)(listed)
        sources = {field.name: field.metadata.get("source", Source()) for field in dataclasses.fields(cls)}
        cls._paths = {
            name: () if source.path == ITSELF else tuple((source.path or name).split("."))
            for name, source in sources.items()
        }
        cls._makers = {name: source.make for name, source in sources.items() if source.make is not None}
        cls._dtypes = {name: source.dtype for name, source in sources.items() if source.dtype is not None}
        cls._shown = shown
        # Where users find it, and where it is found again when a pickle is read.
        cls.__module__ = "taut"
        return cls  # type: ignore[no-any-return]

    return made


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return np.array_equal(a, b)
    return bool(a == b)


def brief(found: Any) -> str:
    """A few words for a value of any size."""
    if isinstance(found, np.ndarray) and found.ndim == 1 and len(found) <= NUMBERS_SHOWN_MAX:
        return repr(found.tolist())
    if isinstance(found, np.ndarray):
        return f"<{len(found)} {'numbers' if found.ndim == 1 else 'rows'}>"
    return f"<{len(found)}>" if isinstance(found, tuple) else repr(found)
