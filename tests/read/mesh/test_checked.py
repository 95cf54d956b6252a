"""Meshes of parts that are no prisms, as STL, PLY and 3MF: sound ones, and faults planted one at a time.

A part is a block of 4 by 3 by 2 mm with a pyramid of height 1.5 on its top, turned so that no wall is upright.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.meshfiles import binary, in_3mf, text

from kin.read.errors import ReadError
from kin.read.files import read_mesh, read_solid
from kin.read.mesh.mesh import welded

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from kin.read.mesh.checked import CheckedMesh

WIDE, DEEP, HIGH, TIP = 4.0, 3.0, 2.0, 1.5
VOLUME = WIDE * DEEP * HIGH + WIDE * DEEP * TIP / 3.0
POINTS = np.array([[x, y, z] for z in (0.0, HIGH) for x, y in ((0.0, 0.0), (WIDE, 0.0), (WIDE, DEEP), (0.0, DEEP))])
POINTS = np.vstack([POINTS, [WIDE / 2.0, DEEP / 2.0, HIGH + TIP]])
CORNERS = [[0, 2, 1], [0, 3, 2]]
CORNERS += [t for k in range(4) for j in [(k + 1) % 4] for t in ([k, j, j + 4], [k, j + 4, k + 4], [k + 4, j + 4, 8])]


def turned(points: np.ndarray) -> np.ndarray:
    """Points turned by 30 degrees about x and by 20 about y, in single precision."""
    a, b = np.radians([30.0, 20.0])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(a), np.sin(a)], [0.0, -np.sin(a), np.cos(a)]])
    about_y = np.array([[np.cos(b), 0.0, -np.sin(b)], [0.0, 1.0, 0.0], [np.sin(b), 0.0, np.cos(b)]])
    return (points @ about_x @ about_y).astype(np.float32).astype(float)


PART = turned(POINTS)[np.array(CORNERS)]


def ply(path: Path, triangles: np.ndarray, *, split: bool = False) -> Path:
    """A PLY in text form; with `split` each triangle has three vertices of its own."""
    points, corners = triangles.reshape(-1, 3), np.arange(3 * len(triangles))
    if not split:
        points, corners = np.unique(points, axis=0, return_inverse=True)
    lines = ["ply", "format ascii 1.0", f"element vertex {len(points)}"]
    lines += [f"property double {axis}" for axis in "xyz"]
    lines += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(repr, point)) for point in points.tolist()]
    lines += [" ".join(map(str, [3, *row])) for row in corners.reshape(-1, 3).tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


def split_ply(path: Path, triangles: np.ndarray) -> Path:
    return ply(path, triangles, split=True)


WRITERS: dict[str, list[Callable[..., Path]]] = {"stl": [binary, text], "ply": [ply, split_ply], "3mf": [in_3mf]}
FORMS = [(word, write) for word in WRITERS for write in WRITERS[word]]


def mesh_of(tmp_path: Path, triangles: np.ndarray, word: str = "stl") -> CheckedMesh:
    return read_mesh(WRITERS[word][-1](tmp_path / f"part.{word}", triangles))


@pytest.mark.parametrize(("word", "write"), FORMS)
def test_a_sound_part_of_any_shape(tmp_path: Path, word: str, write: Callable[..., Path]) -> None:
    """Each triangle of an STL, and of a PLY, may have three corners of its own: equal places are one corner."""
    found = read_mesh(write(tmp_path / f"part.{word}", PART))
    assert found.faults == ()
    assert found.mesh.volume == pytest.approx(VOLUME, rel=1e-6)
    assert (len(found.mesh.points), len(found.mesh.corners)) == (9, 14)
    assert set(found.mesh.shells) == {0}
    assert found.units_mm == (1.0 if word == "3mf" else None)
    # of single precision in each file, by the docstring of `kin.read.mesh.prism.rounding`
    assert found.rounding == pytest.approx((1.0 + 3.0 * np.sqrt(2.0)) * 2.0**-24 * np.abs(PART).max(), rel=1e-12)


FAULTS: dict[str, tuple[Callable[[np.ndarray], np.ndarray], tuple[str, ...]]] = {
    "flipped": (
        lambda c: np.concatenate([c[:1, ::-1], c[1:]]),
        ("3 edges between triangles that face opposite sides",),
    ),
    "missing": (lambda c: c[1:], ("3 edges with one triangle",)),
    "doubled": (
        lambda c: np.concatenate([c, c[:1]]),
        ("3 edges with more than two triangles", "1 triangles drawn twice"),
    ),
    "leaf": (
        lambda c: np.concatenate([c, c[:1, ::-1]]),
        ("3 edges with more than two triangles", "1 triangles drawn twice"),
    ),
    "crack": (lambda c: moved(c, 0, 2.0**-20), ("4 edges with one triangle",)),
    "no area": (
        lambda c: np.concatenate([c, [[c[0, 0], c[0, 0], c[0, 1]]]]),
        ("1 edges with more than two triangles", "1 triangles without area"),
    ),
    "inside out": (lambda c: c[:, ::-1], ("the triangles face inward",)),
}


def moved(corners: np.ndarray, triangle: int, by: float) -> np.ndarray:
    """Triangles, of which one has its first corner moved: its two edges there come apart from their neighbours'."""
    new = corners.copy()
    new[triangle, 0, 0] += by
    return new


@pytest.mark.parametrize("word", WRITERS)
@pytest.mark.parametrize("fault", FAULTS)
def test_planted_faults(tmp_path: Path, word: str, fault: str) -> None:
    """Counts are by hand: a triangle has three edges, and two at each of its corners."""
    spoil, wanted = FAULTS[fault]
    found = mesh_of(tmp_path, spoil(PART), word).faults
    assert len(found) == len(wanted)
    assert all(words in one for one, words in zip(found, wanted, strict=True))


def test_a_prism_has_the_same_faults_by_either_reader(tmp_path: Path) -> None:
    upright = POINTS[np.array(CORNERS)]
    upright = upright[(upright[:, :, 2] <= HIGH).all(axis=1)]
    lid = POINTS[np.array([[4, 5, 6], [4, 6, 7]])]
    block = np.concatenate([upright, lid])
    for corners in (block, np.concatenate([block, block[:1]]), np.concatenate([block, [[lid[0, 0]] * 3]])):
        path = binary(tmp_path / "block.stl", corners)
        assert read_mesh(path).faults == read_solid(path).faults


def test_a_file_without_a_unit_is_read_in_the_one_that_is_given(tmp_path: Path) -> None:
    found = read_mesh(binary(tmp_path / "part.stl", PART / 25.4), 25.4)
    assert found.mesh.volume == pytest.approx(VOLUME, rel=1e-6)
    assert found.faults == ()
    in_file = read_mesh(tmp_path / "part.stl")
    assert found.rounding == pytest.approx(25.4 * in_file.rounding)
    stated = read_mesh(in_3mf(tmp_path / "part.3mf", PART), 25.4)
    assert stated.mesh.volume == pytest.approx(VOLUME, rel=1e-6)


@pytest.mark.parametrize(("axes", "share"), [((1.0, 1.0, 1.0), 1.0), ((2.0, 2.0, 2.0), 8.0), ((-1.0, 1.0, 1.0), 1.0)])
def test_a_place_on_the_plate(tmp_path: Path, axes: tuple[float, float, float], share: float) -> None:
    """A shift is passed over; a scale counts, and a mirrored part still faces outward."""
    place = np.vstack([np.diag(axes), [70.0, 80.0, 0.0]])
    found = read_mesh(in_3mf(tmp_path / "part.3mf", PART, place=place))
    assert found.faults == ()
    assert found.mesh.volume == pytest.approx(share * VOLUME, rel=1e-6)
    assert bool((np.abs(found.mesh.points).max() > 70.0) == (axes != (1.0, 1.0, 1.0)))


CORNER_TO_CORNER = np.concatenate([PART, 2.0 * PART[0, 0] - PART[:, ::-1]])


@pytest.mark.parametrize(
    ("others", "words"),
    [
        (np.concatenate([PART, PART + 16.0]), "it holds 2 bodies, where one is expected"),
        (np.concatenate([PART, 0.25 * PART + PART.mean(axis=(0, 1))]), "it holds 2 bodies"),
        (CORNER_TO_CORNER, "it holds 2 bodies"),
        (PART * [1.0, 0.0, 1.0], "the part is flat: all corners lie at y = 0"),
        (np.zeros((1, 3, 3)), "the part is flat: all corners lie at x = 0"),
        (np.where(PART[0, 0, 0] == PART, np.nan, PART), "a coordinate is not finite or out of range"),
    ],
)
def test_what_is_not_one_part(tmp_path: Path, others: np.ndarray, words: str) -> None:
    with pytest.raises(ReadError, match=words):
        read_mesh(binary(tmp_path / "part.stl", others))


def test_bodies_that_touch_at_a_corner_are_two_shells_whichever_way_they_face() -> None:
    assert set(welded(CORNER_TO_CORNER).bodies) == {0}
    assert np.bincount(welded(CORNER_TO_CORNER).shells).tolist() == [14, 14]


def test_a_file_of_no_mesh(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"part.step holds no mesh"):
        read_mesh(tmp_path / "part.step")
