"""Layouts of cam tables: columns and codes are those of the vendors' pages, whose excerpts docs/controllers.md has."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.places import ROOT

from camgeo.files.controllers import CONTROLLERS, MOTION_POINT, Rows, decimal
from kin.read.drive_tables import CAM_ARRAY, MOTION_FUNCTION, read_drive

PAGE = (ROOT / "docs" / "controllers.md").read_text(encoding="utf-8")
EXCERPTS = re.findall(r"^```text\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


def test_points_of_a_motion_function_have_the_members_of_the_structure() -> None:
    members = re.findall(r"^(\w+) +: \w+;", EXCERPTS[0], re.MULTILINE)
    assert tuple(members) == MOTION_FUNCTION.columns
    codes = {
        name: int(value, 16 if base else 10)
        for name, base, value in re.findall(r"^(\w+) +:= (16#)?(\w+),", EXCERPTS[1], re.MULTILINE)
    }
    assert codes["MOTIONFUNCTYPE_POLYNOM5_MM"] == MOTION_FUNCTION.code_of("quintic")
    assert codes["MOTIONPOINTTYPE_MOTION"] == MOTION_POINT


def test_an_array_of_cam_has_its_members_and_codes() -> None:
    rows = re.findall(r"^([\w ]+?)  +(REAL|DINT)  +(.*)$", EXCERPTS[2], re.MULTILINE)
    assert [name.replace(" ", "").lower() for name, _, _ in rows] == [name.lower() for name in CAM_ARRAY.columns]
    codes = {word: int(code) for code, word in re.findall(r"(\d) = (\w+)", rows[2][2])}
    assert codes == {"linear": CAM_ARRAY.code_of("line"), "cubic": CAM_ARRAY.code_of("cubic")}
    assert CAM_ARRAY.single


def test_pairs_of_a_data_block_follow_one_another() -> None:
    addresses = re.findall(r"^(\d+) +REAL +([XY]\d)", EXCERPTS[3], re.MULTILINE)
    assert addresses == [("0", "X1"), ("4", "Y1"), ("8", "X2"), ("12", "Y2")]


@pytest.mark.parametrize("name", CONTROLLERS)
def test_a_table_is_read_back_as_it_was_rounded(name: str, tmp_path) -> None:
    """Rows of no motion at all: 32 bits where the controller has no more, else twelve digits or nine decimals."""
    controller = CONTROLLERS[name]
    degrees = controller.rounded(np.array([0.0, 360 / 7, 100.1, 360.0]))
    slave = controller.rounded(np.array([[0.0, 1 / 3, 1e-3 / 7, 2.0]] * (controller.order + 1)))
    path = tmp_path / "table.csv"
    controller.write(path, Rows(degrees, slave, "in", (0.1, -1 / 3)), ["a head", controller.joined])
    found = read_drive(path, 25.4)
    assert found.unit == 25.4
    assert np.degrees(found.rows.master) == pytest.approx(degrees, rel=1e-15)
    per = 25.4 * np.degrees(1.0) ** np.arange(len(found.rows.slave))
    assert found.rows.slave == pytest.approx(slave[: len(per)] * per[:, None], rel=1e-15)
    assert found.rows.join == controller.join
    if controller.join == "cubic":
        wanted = np.float32([0.1, -1 / 3]).astype(float) * 25.4 * np.degrees(1.0)
        assert found.rows.ends == pytest.approx(wanted, rel=1e-8)


def test_numbers_of_twelve_digits_are_those_of_their_text() -> None:
    """At all sizes, beside powers of ten and at both ends of what a double holds; the text is Python's own."""
    rng = np.random.default_rng(1)
    sizes = rng.uniform(1.0, 10.0, 4000) * 10.0 ** rng.integers(-40, 40, 4000) * rng.choice([-1.0, 1.0], 4000)
    powers = 10.0 ** np.arange(-30.0, 30.0)
    beside = np.concatenate([powers * (1.0 + eps) for eps in (-1e-11, -1e-13, -2e-16, 0.0, 3e-16, 1e-12, 1e-11)])
    plain = np.concatenate([[0.0, -0.0, 5e-324, -1e-310, 1.7e308, 360.0, 0.1, 100 / 3], np.arange(0.0, 361.0, 0.1)])
    for values in (sizes, beside, plain, sizes.reshape(2, -1)):
        rounded = decimal(values)
        assert rounded.shape == values.shape
        assert rounded.ravel().tolist() == [float(f"{value:.12g}") for value in values.ravel().tolist()]
