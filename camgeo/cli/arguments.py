"""Arguments that several commands take, read for argparse."""

from __future__ import annotations

import argparse


def name_of(text: str) -> str:
    """Name of a file or a folder, as given; raises ArgumentTypeError for an empty one."""
    if not text:
        raise argparse.ArgumentTypeError("an empty name")
    return text


def add_out(command: argparse.ArgumentParser, holds: str = "of the results") -> None:
    """Add the option --out, the folder that a command writes or reads; its help is `folder` and the words `holds`."""
    text = f"folder {holds} (default: out)"
    command.add_argument("--out", type=name_of, default="out", metavar="DIR", help=text)


def processes(text: str) -> int:
    """Number of processes; raises ArgumentTypeError for a text that is no whole number from 1."""
    if not (text.isascii() and text.isdigit() and int(text[:9]) > 0):
        raise argparse.ArgumentTypeError(f"a number of processes is a whole number from 1, not {text}")
    return int(text[:9])


def decimal(text: str) -> float:
    """Value of a decimal number, fraction or arithmetic; raises ValueError for any other text, 1_0 and nan included."""
    from camgeo.schema.scalars import Complaint, read_number

    try:
        return read_number(text)
    except Complaint as complaint:
        raise ValueError(complaint.problem) from None


def length(text: str) -> float:
    """Length of a text, mm, with a unit or in mm: 9.525 or 0.375in; raises ArgumentTypeError for what is none."""
    from camgeo.schema.quantity import read_quantity
    from camgeo.schema.scalars import Complaint

    try:
        return read_quantity(text, "mm")
    except Complaint:
        remedy = f"a length in mm or with its unit is expected, such as 9.525 or 0.375in, not {text}"
        raise argparse.ArgumentTypeError(remedy) from None


def lengths(text: str) -> tuple[float, ...]:
    """Lengths, mm, of a text such as `80,65` or `3in,2in`; raises ArgumentTypeError for another."""
    return tuple(length(part) for part in text.split(","))
