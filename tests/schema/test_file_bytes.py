"""Bytes of a named file: what waits or is missing is refused, and no more than is wanted is read."""

import os
import sys

import pytest

from camgeo.schema.file_bytes import read_bytes
from camgeo.schema.scalars import Complaint


def test_one_byte_more_than_the_most_is_read(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"0123456789")
    assert (read_bytes(path, 4, "table"), read_bytes(path, 10, "table")) == (b"01234", b"0123456789")


def problem(path):
    with pytest.raises(Complaint) as complaint:
        read_bytes(path, 9, "table")
    return complaint.value.problem


def test_what_is_no_file_is_refused(tmp_path):
    assert problem(tmp_path / "none") == "the file does not exist"
    assert problem("a\0b") == "not the name of a file"
    assert problem(tmp_path) == "a folder"


@pytest.mark.skipif(sys.platform == "win32", reason="no pipes with names")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    assert problem(tmp_path / "pipe") == "a pipe, a socket or a device, not a file"
