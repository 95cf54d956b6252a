"""Arguments that several commands take, read for argparse."""

from __future__ import annotations

import argparse


def name_of(text: str) -> str:
    """Give the name of a file, a folder or a place in a network; raises ArgumentTypeError for an empty one."""
    if not text:
        raise argparse.ArgumentTypeError("an empty name")
    return text


def add_out(command: argparse.ArgumentParser, holds: str = "of the results") -> None:
    """Give a command the folder it writes to or looks at; `holds` ends `folder ...` in its help."""
    text = f"folder {holds} (default: out)"
    command.add_argument("--out", type=name_of, default="out", metavar="DIR", help=text)


def processes(text: str) -> int:
    """Give a number of processes; raises ArgumentTypeError for what is no whole number from 1."""
    if not (text.isascii() and text.isdigit() and int(text[:9]) > 0):
        raise argparse.ArgumentTypeError(f"a number of processes is a whole number from 1, not {text}")
    return int(text[:9])


def decimal(text: str) -> float:
    """Give a number in decimal digits; raises ValueError for other texts that Python reads, such as 1_0 and nan."""
    from camgeo.schema.scalars import Complaint, read_number

    try:
        return read_number(text)
    except Complaint as complaint:
        raise ValueError(complaint.problem) from None
