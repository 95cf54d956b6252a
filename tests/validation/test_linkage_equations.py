"""AS equations 11 to 34 with Appendix 1, and what the paper says of dead centres and mobility, against our motion.

The equations are those of the paper; where one is misprinted or fails, the test says where and what is right.
"""

import linkage_page
import numpy as np
import pytest
from linkage_page import Scene
from support.linkage_reference import FIGURES, FINE, PI, Figure, apart, inverted, lift

from kin.linkage.four_bar import FourBar, InvertedSliderCrank
from kin.linkage.mechanism import Mechanism


def four_bar_parts(name):
    """s, s', s1, s1', and r1, r3, r4 of a figure, with our theta_3, theta_4 and rates over FINE."""
    figure = FIGURES[name]
    s, s1 = lift(figure.cam, FINE, figure.shaft), lift(figure.cam, FINE + PI / 2, figure.shaft)
    motion = Scene.of(name).mechanism.at(FINE, 2)
    return s, s1, figure, motion.frame, motion.output


FOUR_BARS = [name for name, figure in FIGURES.items() if figure.coupler is not None]
INVERTED = [name for name, figure in FIGURES.items() if figure.coupler is None]


@pytest.mark.slow
@pytest.mark.parametrize("name", FOUR_BARS)
def test_equations_11_to_13_hold_for_our_positions(name):
    s, s1, figure, (three, _, _), (four, _, _) = four_bar_parts(name)
    clear = np.abs(np.sin(three)) > 0.1  # CA = AF/sin(theta_3)
    assert clear.mean() > 0.9
    s, s1, three, four = s[0][clear], s1[0][clear], three[clear], four[clear]
    ca = (s - 25) / np.sin(three)
    cd = 50 + figure.coupler - s1 + ca * np.cos(three)
    r1, r4 = figure.ground, figure.rocker
    assert apart(r4 * np.cos(four) + cd * np.cos(three), r1 + ca) < 1e-10
    assert apart(r4 * np.sin(four), cd * np.sin(three)) < 1e-10
    assert apart(cd**2 + (r1 + ca) ** 2 - 2 * cd * (r1 + ca) * np.cos(three), r4**2) < 1e-11 * r4**2


@pytest.mark.thin(8)
@pytest.mark.parametrize("name", FOUR_BARS)
def test_equation_18_with_its_plus_sign_is_the_open_assembly(name):
    s, s1, figure, (three, _, _), _ = four_bar_parts(name)
    x, y = 50 + figure.coupler - s1[0], s[0] - 25
    a = (figure.ground + x) ** 2 + y**2 - figure.rocker**2
    b = 2 * figure.ground * y
    c = (figure.ground - x) ** 2 + y**2 - figure.rocker**2
    assert a.min() > 0  # so that AS 18 needs no atan2 here
    assert apart(2 * np.arctan((-b + np.sqrt(b * b - a * c)) / a), three) < 1e-12
    crossed = Mechanism(
        FourBar(figure.ground, figure.coupler, figure.rocker, "crossed"), Scene.of(name).mechanism.lift, 50.0
    )
    minus = 2 * np.arctan((-b - np.sqrt(b * b - a * c)) / a)
    off = crossed.at(FINE, 0).frame[0] - minus
    assert np.abs(np.exp(1j * off) - 1).max() < 1e-12


@pytest.mark.thin(12)
@pytest.mark.parametrize("name", FOUR_BARS)
def test_equation_20_is_right_while_the_rocker_stays_short_of_90_degrees(name):
    s, s1, figure, (three, _, _), (four, _, _) = four_bar_parts(name)
    e = (50 + figure.coupler - s1[0] + (s[0] - 25) / np.tan(three)) * np.sin(three)
    assert four.max() < PI / 2
    assert apart(2 * np.arctan((figure.rocker - np.sqrt(figure.rocker**2 - e**2)) / e), four) < 1e-9


@pytest.mark.slow
def test_equation_20_loses_the_branch_beyond_90_degrees():
    """Ground 40, coupler 70, rocker 90 with the cam of Figure 9a: AS 20 gives 180 deg less what it is."""
    lift_2a = Scene.of("as-figure-9-2a").mechanism.lift
    four = Mechanism(FourBar(40.0, 70.0, 90.0), lift_2a, 50.0).at(FINE, 0).output[0]
    height = 90.0 * np.sin(four)
    printed = 2 * np.arctan((90.0 - np.sqrt(90.0**2 - height**2)) / height)
    beyond = four > PI / 2
    assert 0.2 < beyond.mean() < 1
    assert apart(printed[beyond], PI - four[beyond]) < 1e-7
    assert apart(printed[~beyond], four[~beyond]) < 1e-7
    reference = Figure("2a", (18.0, 8.5), 40.0, 70.0, 90.0).loop(FINE)
    assert four == pytest.approx(reference.output[0], abs=1e-10)


@pytest.mark.thin(8)
@pytest.mark.parametrize("name", FOUR_BARS)
def test_equation_21_holds_for_our_rates(name):
    s, s1, figure, (three, w3, _), (four, w4, _) = four_bar_parts(name)
    y, cot = s[0] - 25, 1 / np.tan(three)
    right = (-s1[1] + s[1] * cot - y * w3 * (1 + cot**2)) * np.sin(three)
    right += (50 + figure.coupler - s1[0] + y * cot) * w3 * np.cos(three)
    assert apart(figure.rocker * w4 * np.cos(four), right) < 1e-8


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", FOUR_BARS)
def test_equation_34_of_appendix_1(name):
    """Right, where its denominator is not 0: theta_3 = theta_4 there, or the coupler's line passes through B."""
    s, s1, figure, (three, _, _), (four, w4, _) = four_bar_parts(name)
    x, y = 50 + figure.coupler - s1[0], s[0] - 25
    top = (x * s1[1] - y * s[1]) * np.sin(three - four)
    bottom = x * (np.sin(four) ** 2 - np.sin(three) ** 2) + 0.5 * y * (np.sin(2 * four) - np.sin(2 * three))
    bottom *= figure.rocker
    clear = np.abs(bottom) > 1e-3 * np.abs(bottom).max()
    assert clear.mean() > 0.95
    assert apart(top[clear] / bottom[clear], w4[clear]) < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("name", FOUR_BARS)
def test_equation_34_vanishes_over_itself_where_theta_3_is_theta_4_and_ours_does_not(name):
    figure, scene = FIGURES[name], Scene.of(name)
    loop = figure.loop(FINE)
    gap = loop.frame[0] - loop.output[0]
    change = np.flatnonzero(np.sign(gap[1:]) != np.sign(gap[:-1]))
    assert change.size >= 2
    for i in change:
        low, high = FINE[i], FINE[i + 1]
        for _ in range(60):
            middle = (low + high) / 2
            motion = scene.mechanism.at(np.array([low, middle]), 0)
            sign = np.sign(motion.frame[0] - motion.output[0])
            low, high = (middle, high) if sign[0] == sign[1] else (low, middle)
        at = scene.mechanism.at(np.array([low]), 2)
        s, s1 = (lift(figure.cam, np.array([t]), figure.shaft) for t in (low, low + PI / 2))
        three, four = at.frame[0, 0], at.output[0, 0]
        x, y = 50 + figure.coupler - s1[0], s[0] - 25
        top = (x * s1[1] - y * s[1]) * np.sin(three - four)
        bottom = x * (np.sin(four) ** 2 - np.sin(three) ** 2) + 0.5 * y * (np.sin(2 * four) - np.sin(2 * three))
        assert abs(top[0]) < 1e-9
        assert abs(figure.rocker * bottom[0]) < 1e-9
        assert apart(at.output[1:, 0], [loop.output[k, i] for k in (1, 2)]) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("name", INVERTED)
def test_equations_23_27_29_and_31(name):
    figure = FIGURES[name]
    s, s1 = lift(figure.cam, FINE, figure.shaft), lift(figure.cam, FINE + PI / 2, figure.shaft)
    motion = Scene.of(name).mechanism.at(FINE, 2)
    four, w4, a4 = motion.output
    f, g = figure.ground - s[0] + 25 + figure.rocker, figure.ground + s[0] - 25 - figure.rocker
    assert apart(2 * np.arctan(np.sqrt(g / f)), four) < 1e-13
    assert apart(s[1] / (figure.ground * np.sin(four)), w4) < 1e-12
    assert (s[2] - figure.ground * w4**2 * np.cos(four)) / (figure.ground * np.sin(four)) == pytest.approx(
        a4, abs=1e-11
    )
    r4 = figure.rocker
    r3 = r4 * np.sin(four) - 50 * np.cos(four) + s1[0] * np.cos(four) - s[0] * np.sin(four) + 25 * np.sin(four)
    along = np.hypot(*motion.joint[:, 0])  # AD: X and Y of D in the frame's axes
    x = np.sqrt(along**2 - (s[0] - 25) ** 2)
    assert apart(r3 / np.cos(four), x - 50 + s1[0]) < 1e-9
    assert motion.frame[0] + four == pytest.approx(PI / 2, abs=1e-13)


# What the paper says of dead centres and of mobility


def test_dead_centres_lie_where_y_vanishes():
    """Cam 2a of Figure 9a: the coupler's line passes through A at theta = 115.6 deg, where theta_3 = 84.2 deg."""
    figure, mechanism = FIGURES["as-figure-9-2a"], Scene.of("as-figure-9-2a").mechanism
    centres = np.array([place.relative for place in mechanism.figures().dead_centres])
    assert len(centres) == 2
    assert lift(figure.cam, centres, figure.shaft)[0] == pytest.approx(25.0, abs=1e-9)
    frame = np.degrees(mechanism.at(centres, 0).frame[0])
    assert np.degrees(centres)[0] == pytest.approx(115.6, abs=0.05)
    assert frame[0] == pytest.approx(84.2, abs=0.05)
    off = np.degrees(centres) - frame
    assert np.abs(off[:, None] - [0, 180, 360]).min() > 30  # not theta_3, nor theta_3 + 180 deg


@pytest.mark.thin(20)
@pytest.mark.parametrize("name", [*FIGURES, *linkage_page.OURS])
def test_no_dead_centre_is_where_the_paper_has_it(name):
    mechanism = Scene.of(name).mechanism
    centres = np.array([place.relative for place in mechanism.figures().dead_centres])
    off = np.degrees(centres - mechanism.at(centres, 0).frame[0])
    assert np.abs((off + 90) % 180 - 90).min() > 20


def test_a_mechanism_turns_back_before_its_discriminant_vanishes():
    """80/70/160 with cam 2a: no position from 73.4 to 151.5 deg, but the shaft turns back from 59.8 deg on."""
    mobility = Mechanism(FourBar(80.0, 70.0, 160.0), Scene.of("as-figure-9-2a").mechanism.lift, 50.0).mobility()
    assert not mobility.turns
    assert mobility.margin < 0
    assert np.degrees(mobility.binds) == pytest.approx(np.array([[73.4, 151.5]]), abs=0.05)
    assert np.degrees(mobility.reverses[0]) == pytest.approx(np.array([59.8, 73.4]), abs=0.05)
    # AS's sign of a full rotation: the discriminant, where the shaft already turns back and where it is said to vanish
    t = np.radians([59.79, *np.degrees(mobility.binds[0])])
    x, y = 120 - lift("2a", t + PI / 2, (18.0, 8.5))[0], lift("2a", t, (18.0, 8.5))[0] - 25
    discriminant = (160 * y) ** 2 - ((80 + x) ** 2 + y**2 - 160**2) * ((80 - x) ** 2 + y**2 - 160**2)
    assert discriminant[0] > 1e6
    assert discriminant[1:] == pytest.approx([0, 0], abs=1e-3)
    rate = 1 - Figure("2a", (18.0, 8.5), 80.0, 70.0, 160.0).loop(np.radians([59.7, 59.9])).frame[1]
    assert rate[0] > 0 > rate[1]


def test_a_mechanism_may_turn_back_without_any_limit():
    """An oscillating yoke with r1 = 20 and cam 2a about (18, 8.5): every position exists, the rate falls to -0.20."""
    mechanism = Mechanism(InvertedSliderCrank(20.0, 0.0), Scene.of("as-figure-9-2a").mechanism.lift, 50.0)
    mobility = mechanism.mobility()
    assert mobility.margin > 0
    assert not mobility.turns
    reference = 1 - inverted("2a", FINE, (18.0, 8.5), 20.0, 0.0).frame[1]
    assert mobility.least_rate == pytest.approx(reference.min(), abs=1e-6)
    assert mobility.least_rate == pytest.approx(-0.20, abs=0.005)


@pytest.mark.slow
def test_the_papers_mechanisms_turn():
    rates = {name: Scene.of(name).mechanism.mobility().least_rate for name in FIGURES}
    for name, rate in rates.items():
        assert rate == pytest.approx((1 - FIGURES[name].loop(FINE).frame[1]).min(), abs=1e-7), name
    assert min(rates.values()) == pytest.approx(0.6136, abs=1e-4)
