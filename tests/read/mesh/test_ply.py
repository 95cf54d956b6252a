"""Triangles of PLY files, text and binary, with properties beside; and files that are none."""

import struct
from pathlib import Path

import numpy as np
import pytest

from kin.read.errors import ReadError
from kin.read.mesh.ply import triangles_of

PATH = Path("part.ply")
CORNERS = [(0.0, 0.0, 0.0), (1.5, 0.0, 0.0), (0.0, 2.25, 0.0), (0.0, 0.0, 3.125)]
FACES = [(0, 2, 1), (0, 1, 3)]


def header(form, vertices=4, faces=2, kind="float"):
    lines = ["ply", f"format {form} 1.0", "comment of two faces", f"element vertex {vertices}"]
    lines += [f"property {kind} {name}" for name in ("x", "y", "z")] + ["property uchar red"]
    lines += [f"element face {faces}", "property uchar flags", "property list uchar int vertex_indices", "end_header\n"]
    return "\n".join(lines).encode()


def text(faces=FACES):
    rows = [f"{x} {y} {z} 255" for x, y, z in CORNERS]
    return "\n".join(rows + [f"7 {len(face)} {' '.join(map(str, face))}" for face in faces]).encode()


def binary(order):
    vertices = b"".join(struct.pack(f"{order}3fB", *corner, 255) for corner in CORNERS)
    return vertices + b"".join(struct.pack(f"{order}2B3i", 7, 3, *face) for face in FACES)


@pytest.mark.parametrize(
    ("raw", "form"),
    [
        (header("ascii") + text(), "text"),
        (header("binary_little_endian") + binary("<"), "binary"),
        (header("binary_big_endian") + binary(">"), "binary"),
    ],
)
def test_faces_have_their_corners(raw, form):
    triangles, read_as = triangles_of(raw, PATH)
    assert read_as == form
    assert triangles.tolist() == [[list(CORNERS[k]) for k in face] for face in FACES]
    assert triangles.dtype == (np.float64 if form == "text" else np.float32)


@pytest.mark.parametrize(
    ("raw", "message"),
    [
        (b"solid cube", r"not a PLY file: it begins with b'solid cube'"),
        (header("ascii")[:40], "the header does not end"),
        (header("ascii") + text([(0, 2, 1), (0, 1, 4)]), "face 2 has a corner that is none of the 4 vertices"),
        (header("ascii") + text([(0, 2, 1), (0, 1, 3, 2)]), "face 2 has 4 corners; triangles alone are read"),
        (header("ascii") + text().replace(b"1.5", b"1_5"), r"'1_5' is not a number"),
        (header("ascii") + text().replace(b"2.25", b"wide"), r"'wide' is not a number"),
        (header("ascii", faces=3) + text(), "4 vertices and 3 triangles have 31 numbers, and 26 follow"),
        (header("binary_little_endian") + binary("<")[:-1], "take 80 bytes, and 79 follow"),
        (header("ascii", kind="int") + text(), "a vertex has no x, y and z of type float or double"),
        (header("ascii", faces=0) + text([]), "the file holds no triangles"),
    ],
)
def test_what_is_no_mesh_is_refused(raw, message):
    with pytest.raises(ReadError, match=message):
        triangles_of(raw, PATH)
