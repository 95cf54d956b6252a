"""What a dimension does to the output at a held shaft: against mechanisms in which it is off."""

from dataclasses import replace

import numpy as np
import pytest

from kin.budget.frame_influence import frame_bearing
from kin.law.support_function import lift_hypocycloid
from kin.linkage.dyad import RRP
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.linkage.mechanism import Mechanism

LIFT, BREADTH = lift_hypocycloid(3, 1.5, 50.0, (12.0, -5.0)), 50.0
THETA = np.linspace(0.0, 2.0 * np.pi, 9)[:-1] + 0.2
STEP = 1e-5  # mm


def over_the_shaft(linkage, turned, lift=LIFT):
    """Output at shaft angles counted in the ground, not from where the frame stands at relative angle 0."""
    mechanism = Mechanism(linkage, lift, BREADTH)
    return mechanism.at(mechanism.relative(turned + mechanism.start), 0).output[0]


@pytest.mark.parametrize(
    ("linkage", "longer"),
    [
        (FourBar(80.0, 120.0, 160.0), "rocker"),
        (InvertedSliderCrank(110.0, 40.0), "rocker"),
        (SliderCrank(120.0, 10.0), "coupler"),
    ],
)
def test_a_link_that_is_longer(linkage, longer):
    mechanism = Mechanism(linkage, LIFT, BREADTH)
    bearing = frame_bearing(mechanism, THETA)
    turned = bearing.motion.shaft[0] - mechanism.start
    more, less = (replace(linkage, **{longer: getattr(linkage, longer) + by}) for by in (STEP, -STEP))
    change = (over_the_shaft(more, turned) - over_the_shaft(less, turned)) / (2.0 * STEP)
    along = {"along": 1.0} if longer == "coupler" else {"link": 1.0}  # a longer coupler puts D off along the frame
    assert bearing.output(**along) == pytest.approx(change, rel=1e-5, abs=1e-9)


def test_a_pivot_that_stands_farther_from_the_shaft():
    linkage = FourBar(80.0, 120.0, 160.0)
    mechanism = Mechanism(linkage, LIFT, BREADTH)
    bearing = frame_bearing(mechanism, THETA)
    turned = bearing.motion.shaft[0] - mechanism.start
    more, less = (over_the_shaft(replace(linkage, ground=80.0 + by), turned) for by in (STEP, -STEP))
    assert bearing.output(pivot=1.0) == pytest.approx((more - less) / (2.0 * STEP), rel=1e-5, abs=1e-9)
    assert bearing.shaft(-1.0) == pytest.approx(bearing.output(pivot=1.0), rel=1e-14)


@pytest.mark.parametrize("linkage", [FourBar(80.0, 120.0, 160.0), SliderCrank(120.0, 10.0)])
@pytest.mark.parametrize("way", [1.0, 1j])
def test_metal_that_is_displaced(linkage, way):
    """The shaft stands the other way in the cam's own axes, and stays in the ground."""
    mechanism = Mechanism(linkage, LIFT, BREADTH)
    bearing = frame_bearing(mechanism, THETA)
    turned = bearing.motion.shaft[0] - mechanism.start
    more, less = (
        over_the_shaft(linkage, turned, lift_hypocycloid(3, 1.5, 50.0, (12.0 - by * way.real, -5.0 - by * way.imag)))
        for by in (STEP, -STEP)
    )
    assert bearing.metal(way) == pytest.approx((more - less) / (2.0 * STEP), rel=1e-5, abs=1e-9)


def test_dyads_are_refused():
    mechanism = Mechanism(
        FourBar(80.0, 120.0, 160.0), LIFT, BREADTH, (RRP("output", (100.0, 0.0), 150.0, (0.0, 0.0), 0.0),)
    )
    with pytest.raises(ValueError, match="influence of dyads is not known"):
        frame_bearing(mechanism, THETA)
