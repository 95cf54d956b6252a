"""Arguments of the library's functions, checked where they come in.

A wrong Python type is a TypeError, which names the argument, what it must be and what it is; a value of the right type
that makes no sense is a CallError.
"""

from __future__ import annotations

import math
import operator
import os
from numbers import Real
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array

_SHOWN = 60  # characters of a value that a message repeats


def is_a(name: str, value: object, kind: type | tuple[type, ...], must: str, remedy: str = "") -> None:
    """Raise TypeError for an argument that is none of the types `kind`, which `must` names."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be {must}, not {type(value).__name__}{f'; {remedy}' if remedy else ''}")


def path_of(name: str, value: object) -> Path:
    """Give the path that an argument names; raises CallError for one that no file can have."""
    is_a(name, value, (str, PathLike), "a str or a path")
    text = os.fspath(value)  # type: ignore[call-overload]
    is_a(name, text, str, "a str or a path of a str")
    if not text:
        raise CallError(f"{name} is no path: it is empty")
    if "\0" in text:
        raise CallError(f"{name} is no path: {escaped(text)} has a null character in it")
    try:
        text.encode("utf-8", "surrogateescape")  # as names of files that are no UTF-8 come from the system
    except UnicodeEncodeError:
        raise CallError(f"{name} is no path: {escaped(text)} has half a character in it") from None
    return Path(text)


def number_of(name: str, value: object) -> float:
    """Give an argument that is a number as a float; one beyond all floats is infinite."""
    if isinstance(value, bool):
        raise TypeError(f"{name} must be a number, not bool")
    is_a(name, value, Real, "a number")
    try:
        return float(value)  # type: ignore[arg-type]
    except OverflowError:
        return math.inf if value > 0 else -math.inf  # type: ignore[operator]


def numbers_of(name: str, value: object) -> Array:
    """Give an argument that is a number or an array of numbers as floats, in its shape; raises as `number_of` does."""
    import numpy as np

    try:
        found = np.asarray(value)
    except ValueError:
        raise CallError(f"{name} is no array: its rows differ in length") from None
    if found.dtype.kind in "iuf":
        return found.astype(np.float64)
    if found.dtype.kind == "O":  # whole numbers of many digits and fractions, or what is no number
        return np.array([number_of(name, one) for one in found.ravel()], dtype=np.float64).reshape(found.shape)
    held = type(value) if found.ndim == 0 else type(found.ravel().tolist()[0]) if found.size else found.dtype.type
    raise TypeError(f"{name} must be a number or an array of numbers, not {held.__name__}")


def spelled(value: object) -> str:
    """Write a value that an argument has, for a message: shortened, and not failing for want of digits."""
    try:
        text = repr(value)
    except ValueError:
        return "a number of thousands of digits"
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


def whole_of(name: str, value: object) -> int:
    """Give an argument that is a whole number, of numpy too, as an int."""
    try:
        if not isinstance(value, bool):
            return operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        pass
    raise TypeError(f"{name} must be an int, not {type(value).__name__}")


def text_of(name: str, value: object, choices: Sequence[str], what: str) -> str:
    """Give an argument that is one of several words; `what` begins the sentence that lists them."""
    is_a(name, value, str, "a str")
    if value not in choices:
        raise CallError(f"{what} is one of {', '.join(choices)}, not {spelled(value)}")
    return str(value)


def texts_of(name: str, value: object) -> tuple[str, ...]:
    """Give an argument that is a text or several."""
    if isinstance(value, str):
        return (value,)
    try:
        found: tuple[object, ...] = tuple(value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name} must be a str or a sequence of str, not {type(value).__name__}") from None
    for i, text in enumerate(found):
        is_a(f"{name}[{i}]", text, str, "a str")
    return tuple(map(str, found))


def called(name: str, value: object) -> None:
    """Raise TypeError for an argument that is neither a function nor None."""
    if value is not None and not callable(value):
        raise TypeError(f"{name} must be a function or None, not {type(value).__name__}")
