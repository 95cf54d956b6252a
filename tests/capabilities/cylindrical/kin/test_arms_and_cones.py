"""Worked drums whose roller is a cone, on an arm or beside the axis; each figure was also found from positions alone.

The groove of the worked cases, lift 0 at z = 0; the arm of 80 has its pivot at y = 78 and z = 0, and swings from -15 to
15 degrees.
"""

import math

import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import Arm, Drum, Motion, distances, replace
from capabilities.cylindrical.kin.figures import pressure_angles
from capabilities.cylindrical.kin.meshing import contact_angles, regularity, relative_curvature

from kin.cylindrical.frame import flank_points, on_cylinder

SWING = math.radians(30.0)
PARTS = ((SWING, 120.0, "cycloidal"), (0.0, 60.0, ""), (-SWING, 120.0, "polynomial-345"), (0.0, 60.0, ""))
LEVEL = -80.0 * math.sin(math.radians(15.0))
DRUM = Drum(level=0.0)
ARM = replace(DRUM, motion=Motion(PARTS), level=LEVEL, arm=Arm(80.0, 78.0, 0.0, 1))
LEADING = replace(ARM, arm=Arm(80.0, -78.0, 0.0, -1))
APEX = replace(DRUM, taper=math.atan(10.0 / 44.0))
CONE = replace(DRUM, taper=math.radians(6.0))
SIX = math.radians(6.0)


def close(found, wanted):
    np.testing.assert_allclose(found, wanted, rtol=1e-10, atol=2e-9)


@pytest.mark.parametrize(
    ("drum", "place", "wanted"),
    [
        (APEX, (60.0, 50.0, -1), (50.4440719486, 67.6081374135, 35.995477351, 10.8060978551)),
        (APEX, (60.0, 38.0, -1), (38.4656904626, 68.9245980578, 43.705916308, 13.7568089811)),
        (APEX, (60.0, 38.0, 1), (38.4656904626, 51.0754019422, 43.705916308, 26.2431910189)),
        (APEX, (250.0, 44.0, 1), (44.3943322964, 257.642351927, -36.185112414, 21.9359136980)),
        (CONE, (60.0, 50.0, -1), (50.4032960939, 67.2528746987, 36.768755708, 11.4842534376)),
        (CONE, (250.0, 38.0, 1), (38.4932718647, 259.182337569, -40.965761452, 20.9396049483)),
        (ARM, (35.0, 50.0, -1), (50.1784274964, 39.8332445771, 28.649871939, -23.8511308936)),
        (ARM, (60.0, 38.0, -1), (38.3609494216, 67.8660599927, 46.468800714, -6.88749461915)),
        (ARM, (60.0, 38.0, 1), (39.1096202387, 46.3190827031, 46.468800714, 6.88749461915)),
        (ARM, (255.0, 44.0, 1), (44.1997818658, 260.449658881, -34.362035616, -1.13948277386)),
        (LEADING, (35.0, 50.0, -1), (50.2188147693, 40.3505759912, 24.306357209, -24.1890472578)),
        (LEADING, (60.0, 38.0, -1), (39.1096202387, 73.6809172969, 46.468800714, -6.88749461915)),
        (LEADING, (255.0, 44.0, 1), (44.6802714922, 265.010907111, -39.201723515, -1.64510467340)),
        (replace(ARM, taper=SIX), (5.0, 44.0, -1), (44.0082210084, 6.10749055464, 0.74374194003, -30.6854885496)),
        (replace(ARM, taper=SIX), (60.0, 38.0, 1), (38.9798773105, 47.1258891319, 45.520786609, 6.56465656516)),
        (replace(ARM, taper=SIX), (100.0, 50.0, 1), (50.0219087247, 98.304171607, 10.309255444, 29.9955552269)),
        (replace(DRUM, offset=6.0), (60.0, 48.0, -1), (49.5327558566, 74.290722821, 38.511887254, 12.1752101417)),
        (replace(DRUM, offset=6.0), (250.0, 38.0, 1), (40.0506759541, 268.414160845, -41.692679285, 21.3320079651)),
    ],
)  # fmt: skip
def test_flanks(drum, place, wanted):
    theta, rho, side = np.radians([place[0]]), place[1], place[2]
    follower = drum.intent().follower
    ((x, y, z),) = flank_points(follower, theta, rho, side)
    (a,) = contact_angles(follower, theta, rho, side)
    close([math.hypot(x, y), math.degrees(math.atan2(y, x)) % 360.0, math.degrees(a), z], wanted)
    # on a cylinder, and by positions alone
    along, phi, up = on_cylinder(follower, theta, math.hypot(x, y), side)
    close([along[0], np.mod(math.degrees(phi[0]), 360.0), up[0]], [rho, wanted[1], wanted[3]])
    away, gives = distances(drum, np.array([[x, y, z]]), ("", side, drum.roller, drum.level))
    close([away[0], gives[0]], [0.0, 0.0])


def test_pressure_angles():
    for arm in (ARM, LEADING):
        found = [math.degrees(pressure_angles(arm.intent().follower, rho).greatest.value) for rho in (50.0, 38.0)]
        close(found, [39.9018286077, 47.2109142786])
    (a,) = contact_angles(APEX.intent().follower, np.radians([60.0]), 44.0)
    close(math.degrees(a), 39.5389734592)


def tangents(follower, theta, rho, side, h=1e-4):
    """Regularity, and the curvature of flank against roller, by differences of points that are touched."""

    def at(t, p):
        return flank_points(follower, np.array([t]), np.array([p]), side)[0]

    def slope(way):
        return (8.0 * (way(h) - way(-h)) - (way(2.0 * h) - way(-2.0 * h))) / (12.0 * h)

    return np.linalg.norm(
        np.cross(slope(lambda x: at(theta + x, rho)), slope(lambda x: at(theta, rho + 10.0 * x)) / 10.0)
    )


@pytest.mark.parametrize("drum", [APEX, ARM, replace(ARM, taper=SIX), replace(CONE, offset=6.0)])
def test_regularity_and_curvature_by_differences(drum):
    follower = drum.intent().follower
    for t, rho, side in ((0.6, 39.0, -1), (1.4, 47.0, 1), (4.3, 41.0, -1), (4.6, 44.0, 1)):
        (found,) = regularity(follower, np.array([t]), rho, side)
        np.testing.assert_allclose(found, tangents(follower, t, rho, side), rtol=1e-7)
        # the gap between the roller and the flank, at the angle t + h, is half of that by the square of the way
        h = 1e-4
        gaps = []
        for step in (-h, h):
            (point,) = flank_points(follower, np.array([t + step]), rho, side)
            x, y = (point[:2] @ way for way in ((math.cos(t), math.sin(t)), (-math.sin(t), math.cos(t))))
            y0, z0 = drum.axis(t, drum.level)
            gaps.append((math.hypot(y - y0, point[2] - z0) - drum.size(drum.roller, x)) * math.cos(drum.taper))
        (bent,) = relative_curvature(follower, np.array([t]), rho, side)
        along = np.linalg.norm(
            np.diff(flank_points(follower, np.full(2, t), rho + np.array([-h, h]), side), axis=0)
        ) / (2.0 * h)
        np.testing.assert_allclose(sum(gaps) / 2.0, 0.5 * bent * (h * found / along) ** 2, rtol=1e-5)


def test_the_regularity_of_a_cone_in_closed_form():
    follower, rho, side, t = APEX.intent().follower, 40.0, 1, 0.7
    tan, radius = 10.0 / 44.0, 40.0 * 10.0 / 44.0
    slope, bend = (float(DRUM.motion(np.array([t]), order)[0]) for order in (1, 2))
    along, cosine = rho + radius * tan, math.cos(APEX.taper)
    w = math.hypot(along, slope)
    wanted = (
        w - radius * tan * along / w - side * radius * along * bend / w**2 - (radius * slope) ** 2 / (cosine**2 * w**3)
    )
    close(regularity(follower, np.array([t]), rho, side) * cosine, wanted)
