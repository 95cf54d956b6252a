"""Checks of the arguments of the library's functions.

A wrong Python type raises TypeError, which names the argument, the type it must have and the type it has; a value of
the right type that makes no sense raises CallError. `name` is the name of the argument in these messages.
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


def demand_type(name: str, value: object, kind: type | tuple[type, ...], must: str, remedy: str = "") -> None:
    """Raise TypeError for an argument that is of none of the types `kind`.

    In the message `must` names the types, and `remedy` follows, if it is not empty.
    """
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be {must}, not {type(value).__name__}{f'; {remedy}' if remedy else ''}")


def path_of(name: str, value: object) -> Path:
    """Argument as a path; raises TypeError for what is no str or path, CallError for a path that no file can have."""
    demand_type(name, value, (str, PathLike), "a str or a path")
    text = os.fspath(value)  # type: ignore[call-overload]
    demand_type(name, text, str, "a str or a path of a str")
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
    """Argument as a float, infinite for a number beyond all floats; raises TypeError for a bool and for no number."""
    if isinstance(value, bool):
        raise TypeError(f"{name} must be a number, not bool")
    demand_type(name, value, Real, "a number")
    try:
        return float(value)  # type: ignore[arg-type]
    except OverflowError:
        return math.inf if value > 0 else -math.inf  # type: ignore[operator]


def tuple_of(name: str, value: object) -> tuple[float, ...]:
    """Argument that is a tuple of numbers, as floats; raises TypeError for anything else."""
    demand_type(name, value, tuple, "a tuple of numbers")
    return tuple(number_of(name, item) for item in value) if isinstance(value, tuple) else ()


def numbers_of(name: str, value: object) -> Array:
    """Argument that is a number or an array of numbers, as floats in its shape.

    Raises TypeError for what is no number, CallError for rows that differ in length.
    """
    import numpy as np

    try:
        array = np.asarray(value)
    except ValueError:
        raise CallError(f"{name} is no array: its rows differ in length") from None
    if array.dtype.kind in "iuf":
        return array.astype(np.float64)
    if array.dtype.kind == "O":  # whole numbers of many digits and fractions, or what is no number
        return np.array([number_of(name, item) for item in array.ravel()], dtype=np.float64).reshape(array.shape)
    kind = type(value) if array.ndim == 0 else type(array.ravel().tolist()[0]) if array.size else array.dtype.type
    raise TypeError(f"{name} must be a number or an array of numbers, not {kind.__name__}")


def short_repr(value: object) -> str:
    """`repr` of a value for a message, shortened to 60 characters; a number of thousands of digits is described."""
    try:
        text = repr(value)
    except ValueError:
        return "a number of thousands of digits"
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


def whole_of(name: str, value: object) -> int:
    """Argument that must be a whole number, as an int: a Python or numpy integer; raises TypeError, for a bool too."""
    try:
        if not isinstance(value, bool):
            return operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        pass
    raise TypeError(f"{name} must be an int, not {type(value).__name__}")


def text_of(name: str, value: object, choices: Sequence[str], subject: str) -> str:
    """Argument that must be one of the words `choices`.

    Raises TypeError for what is no str; CallError, whose message begins with `subject`, for another word.
    """
    demand_type(name, value, str, "a str")
    if value not in choices:
        raise CallError(f"{subject} is one of {', '.join(choices)}, not {short_repr(value)}")
    return str(value)


def texts_of(name: str, value: object) -> tuple[str, ...]:
    """Argument that is a str or a sequence of str, as a tuple of str; raises TypeError for anything else."""
    if isinstance(value, str):
        return (value,)
    try:
        texts: tuple[object, ...] = tuple(value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name} must be a str or a sequence of str, not {type(value).__name__}") from None
    for i, text in enumerate(texts):
        demand_type(f"{name}[{i}]", text, str, "a str")
    return tuple(map(str, texts))


def demand_callable(name: str, value: object) -> None:
    """Raise TypeError for an argument that is neither a function nor None."""
    if value is not None and not callable(value):
        raise TypeError(f"{name} must be a function or None, not {type(value).__name__}")
