"""What a printable body refuses to be."""

from __future__ import annotations

import numpy as np
import pytest

from camgeo.capabilities.mechanism.assembly import Plate, PrintBody
from camgeo.fit.pieces import ArcSpline, Bound

DISC = ArcSpline(np.array([[10.0, 0.0], [-10.0, 0.0]]), np.ones(2), Bound(0.0, 0.0))
PLATE = Plate(DISC, (), 0.0, 4.0)


def test_a_body_reaches_from_its_lowest_plate_to_its_highest():
    body = PrintBody("roller-a", (PLATE, Plate(DISC, (), -1.5, 1.0)))
    assert (body.low, body.high) == (-1.5, 4.0)
    assert np.array_equal(body.pose, np.zeros((1, 3)))


@pytest.mark.parametrize("name", ["", "Roller", "roller a", "../frame", "frame.stl", "-a"])
def test_names_are_safe_in_file_names(name):
    with pytest.raises(ValueError, match="is not a name for a body"):
        PrintBody(name, (PLATE,))


def test_shapes_are_checked():
    with pytest.raises(ValueError, match="has no height"):
        Plate(DISC, (), 4.0, 4.0)
    with pytest.raises(ValueError, match="without plates"):
        PrintBody("frame", ())
    with pytest.raises(ValueError, match="pose"):
        PrintBody("frame", (PLATE,), np.zeros((0, 3)))
    with pytest.raises(ValueError, match="pose"):
        PrintBody("frame", (PLATE,), np.array([[0.0, np.nan, 0.0]]))
    with pytest.raises(ValueError, match="colour"):
        PrintBody("frame", (PLATE,), colour="red")
