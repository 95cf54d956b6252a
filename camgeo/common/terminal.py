"""Output on the terminal: any text, on a stream of any encoding, also on a closed one.

Standard output carries results: where it cannot be written the run fails. Standard error carries faults: where it
cannot be written the texts are lost, and the exit status stays the same.
"""

from __future__ import annotations

import io
import os
import sys
import unicodedata

_UNSEEN = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})  # controls, marks of direction, halves of pairs, line separators


def open_streams() -> None:
    """Let standard output and standard error take any text.

    A closed stream (`>&-`, None in Python) drops it, a narrow encoding escapes what it lacks. Lines end with LF on
    every system.
    """
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: PTH123, SIM115 - open while we run
        elif isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace", newline="\n")


def escaped(text: str, *, keep: str = "") -> str:
    """Text in which characters that could disturb or deceive a terminal are escaped, but for those in `keep`."""
    if text.isprintable():
        return text
    return "".join(c if c in keep or _is_visible(c) else c.encode("unicode_escape").decode() for c in text)


def say(text: str, *, at_once: bool = False) -> None:
    """Print lines of a result on standard output, control characters escaped; `at_once` flushes the stream.

    Raises OSError where standard output cannot be written.
    """
    print(escaped(text, keep="\n"), flush=at_once)


def complain(text: str) -> None:
    """Print lines on standard error with control characters escaped; does nothing if it cannot be written."""
    whisper(escaped(text, keep="\n") + "\n")


def whisper(text: str) -> None:
    """Write a text unchanged to standard error; a stream that cannot be written is silenced."""
    try:
        sys.stderr.write(text)
        sys.stderr.flush()
    except (OSError, ValueError):  # full, gone, closed
        silence("stderr")


def silence(name: str) -> None:
    """Redirect a stream, `stdout` or `stderr`, that cannot be written to the null device.

    Its flush at the end of the process would fail otherwise.
    """
    stream = getattr(sys, name)
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
    except (OSError, ValueError):  # it has no file behind it
        setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: PTH123, SIM115 - open while we run


def say_json(text: str) -> None:
    """Print a JSON text; characters that the encoding lacks or a terminal would obey are escaped as JSON does.

    Raises OSError where standard output cannot be written.
    """
    try:
        text.encode(sys.stdout.encoding or "utf-8")
        narrow = False
    except UnicodeEncodeError:
        narrow = True
    if narrow or not text.replace("\n", "").isprintable():
        plain = str.isascii if narrow else _is_visible
        text = "".join(c if c == "\n" or (plain(c) and c != "\x7f") else _as_json(c) for c in text)
    print(text, end="")


def _is_visible(c: str) -> bool:
    return unicodedata.category(c) not in _UNSEEN


def _as_json(c: str) -> str:
    """Escape of a character in a string of JSON: its number, for numbers from 65536 a pair of surrogates."""
    units = c.encode("utf-16-be", "surrogatepass")
    return "".join(f"\\u{units[i]:02x}{units[i + 1]:02x}" for i in range(0, len(units), 2))
