"""Worked drums: each figure was also found by brute force that knows positions alone (mpmath, 30 digits).

The groove, in the worked cases lift 0 at z = 0: roller 10 from 38 to 50, rise 40 over 120 degrees cycloidal, dwell 60,
return over 120 by 3-4-5, dwell 60.
"""

import math

import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import Drum, Groove, Motion, Rib, replace
from capabilities.cylindrical.kin.figures import (
    forces,
    least_regularity,
    lost_alone,
    outer_contact,
    plays,
    pressure_angles,
    rib_thickness,
    slopes,
    undercut,
)
from capabilities.cylindrical.kin.meshing import contact_angles, regularity, relative_curvature

from kin.cylindrical.follower import DrumFollower
from kin.cylindrical.frame import flank_points, on_cylinder
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.intent import End
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Power

DRUM = Drum(level=0.0)
SHARP = Motion(((15.0, 60.0, "cycloidal"), (0.0, 120.0, ""), (-15.0, 60.0, "cycloidal"), (0.0, 120.0, "")))
UNDERCUT = Drum(SHARP, 12.0, 20.0, 40.0, 0.0, Groove(20.0), 40.0, 60.0, 8.0)


def close(found, wanted):
    np.testing.assert_allclose(found, wanted, rtol=1e-10, atol=1e-10)


@pytest.fixture(scope="module")
def follower():
    return DRUM.intent().follower


@pytest.fixture(scope="module")
def undercut_drum():
    return UNDERCUT.intent()


@pytest.mark.parametrize(
    ("side", "polar", "height"),
    [
        (-1, [34.4042478546, 36.7397038281, 67.3913817939, 70.567709167, 243.153774157, 240.071780202],
         [-5.65771805946, -5.30117748016, 12.1752101417, 12.9472546161, 5.69234746199, 6.39754450401]),
        (1, [25.5957521454, 23.2602961719, 52.6086182061, 49.432290833, 256.846225843, 259.928219798],
         [12.9253226121, 12.5687820328, 27.8247898583, 27.0527453839, 22.0372050072, 21.3320079651]),
    ],
)  # fmt: skip
def test_the_flanks_of_a_groove(follower, side, polar, height):
    theta, rho = np.radians([30.0, 30.0, 60.0, 60.0, 250.0, 250.0]), np.array([48.0, 38.0] * 3)
    points = flank_points(follower, theta, rho, side)
    angles = [21.696983972, 26.68385345, 38.511887254, 45.148272141, -35.190259992, -41.692679285]
    close(np.degrees(contact_angles(follower, theta, rho)), angles)
    r = [48.1421608349, 38.2644239046, 48.4021968889, 38.6556436054, 48.3447143746, 38.5777196097]
    close(np.hypot(points[:, 0], points[:, 1]), r)
    close(np.degrees(np.arctan2(points[:, 1], points[:, 0])) % 360.0, polar)
    np.testing.assert_allclose(points[:, 2], height, rtol=0.0, atol=2e-9)


def test_pressure_angles_and_where_the_blank_ends_the_contact(follower):
    found = [math.degrees(pressure_angles(follower, rho).greatest.value) for rho in (50.0, 44.0, 38.0)]
    close(found, [37.3777916118, 40.9618320715, 45.1482721410])
    end = outer_contact(follower, 50.0)
    assert end.value == pytest.approx(49.63, abs=0.005)
    assert math.degrees(pressure_angles(follower, end.value).greatest.value) == pytest.approx(37.59, abs=0.005)
    assert math.degrees(end.at) == pytest.approx(60.0, abs=1e-6)


def test_a_flank_on_the_cylinder_of_the_blank(follower):
    rho, phi, z = on_cylinder(follower, np.radians([30.0, 60.0]), 50.0)
    close(50.0 * phi, [29.7592556974, 58.4745116351])
    close(z, [-5.70484645319, 12.0755272731])
    points = flank_points(follower, np.radians([30.0, 60.0]), rho)
    close(np.hypot(points[:, 0], points[:, 1]), 50.0)
    with pytest.raises(ValueError, match="touches nothing on a cylinder of 9 mm"):
        on_cylinder(follower, np.zeros(1), 9.0)


def helix(radius, roller, angle):
    """A roller over a lift of constant slope, `angle` degrees at a radius, lift 0 at the angle 0."""
    slope = radius * math.tan(math.radians(angle))
    line = AffineStretch(Power((0.0, 1.0)), offset=-slope, scale=2.0 * slope, start=-1.0, width=2.0)
    return DrumFollower(roller, 0.5 * radius, radius, 0.0, Piecewise(np.array([-1.0, 1.0]), (line,)))


@pytest.mark.parametrize(
    ("radius", "roller", "angle", "error"),
    [
        (50.0, 10.0, 30.0, 0.00420947453635),
        (50.0, 10.0, 45.0, 0.0169479920379),
        (50.0, 10.0, 60.0, 0.0382354400011),
        (30.0, 10.0, 45.0, 0.0485605986229),
        (20.0, 15.0, 45.0, 0.474829772313),
    ],
)
def test_what_an_offset_in_the_development_costs(radius, roller, angle, error):
    a = math.radians(angle)
    _, phi, z = on_cylinder(helix(radius, roller, angle), np.zeros(1), radius)
    across = (radius * phi - roller * math.sin(a)) * -math.sin(a) + (z + roller * math.cos(a)) * math.cos(a)
    np.testing.assert_allclose(-across, error, rtol=1e-10, atol=1e-12)


def test_a_wall_that_is_radial_stands_in_the_roller():
    follower = helix(50.0, 10.0, 30.0)
    slope = 50.0 * math.tan(math.radians(30.0))
    (wall, needed) = (z - slope * phi for _, phi, z in (on_cylinder(follower, np.zeros(1), r) for r in (50.0, 38.0)))
    close([wall[0], needed[0], wall[0] - needed[0]], [-11.5518660663, -12.5781461707, 1.02628010435])


def test_undercut_at_the_inner_end_alone(undercut_drum):
    follower = undercut_drum.follower
    wanted = {40.0: 17.8819315878, 30.0: 1.63176748872, 25.0: -7.96125505181, 20.0: -19.2693524244}
    places = {40.0: 47.70907, 30.0: 48.30676, 25.0: 48.77245, 20.0: 49.41918}
    for rho, value in wanted.items():
        least = least_regularity(follower, rho)
        close(least.value, value)
        # the motion is symmetric: 240 degrees less the angle is as sharp
        assert min(abs(math.degrees(least.at) - at) for at in (places[rho], 240.0 - places[rho])) < 1e-5
        close(regularity(follower, np.array([least.at]), rho), value)
    found = undercut(undercut_drum)
    assert found.below == pytest.approx(29.100516094, abs=1e-9)
    assert undercut(undercut_drum, 1).below == pytest.approx(found.below, abs=1e-9)
    end = on_cylinder(follower, np.array([found.at]), 40.0)[0][0]
    assert found.length == pytest.approx(end - found.below, abs=1e-9)
    assert found.share == pytest.approx((end - found.below) / (end - 20.0), abs=1e-9)
    lost = [lost_alone(undercut_drum, radius, np.radians([50.0]))[0] for radius in (22.0, 40.0)]
    close(lost, [14.5674833578 - 14.1805718878, 0.0])


def test_no_undercut_leaves_the_whole_line():
    found = undercut(DRUM.intent())
    assert (found.below, found.share) == (0.0, 1.0)
    assert found.length == pytest.approx(outer_contact(DRUM.intent().follower, 50.0).value - 38.0, abs=1e-12)


def test_the_thickness_of_a_rib():
    rib = replace(DRUM, track=Rib(12.0, 50.0)).intent()
    upper, lower = gauges_of(rib)
    phi = math.radians(60.0)
    for radius, wanted in ((38.0, 21.9182951883), (50.0, 24.9094704840)):
        point = np.array([[radius * math.cos(phi), radius * math.sin(phi), 0.0]])
        close(-upper.worst(point).height - lower.worst(point).height, wanted)
    least = rib_thickness(rib)
    close([least.value, least.radius], [21.9182951883, 38.0])
    with pytest.raises(ValueError, match="no rib"):
        rib_thickness(DRUM.intent())


def test_forces_on_an_end_cam(follower):
    found = forces(follower, 200.0, 44.0)
    close([found.contact.value, found.torque.value], [264.849288363, 7639.43726841])
    assert math.degrees(found.torque.at) == pytest.approx(60.0, abs=1e-6)
    assert found.back.value == pytest.approx(200.0 * slopes(follower)[0].value, rel=1e-12)


def test_curvature_of_flank_against_roller(follower):
    rows = [(30.0, 44.0, -1), (90.0, 38.0, -1), (90.0, 38.0, 1), (250.0, 38.0, -1)]
    found = [relative_curvature(follower, np.radians([t]), rho, side)[0] for t, rho, side in rows]
    close(found, [0.0824274423323, 0.143259107194, 0.0795001577066, 0.0971588273894])


@pytest.mark.slow
def test_the_play_of_a_groove_is_least_in_its_dwells():
    found = plays(replace(DRUM, track=Groove(12.0, 0.05)).intent())
    assert found.least.value == pytest.approx(0.05, abs=1e-9)
    # square to the flank the clearance is 0.05: along z it is about that over the cosine at the outer end
    steep = pressure_angles(DRUM.intent().follower, 49.63).greatest
    assert found.most.value == pytest.approx(0.05 / math.cos(steep.value), rel=2e-3)
    assert found.most.at == pytest.approx(steep.at, abs=0.01)
    assert plays(replace(DRUM, track=End()).intent()).most.value == 0.0
