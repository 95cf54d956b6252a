# needs: dynamics
"""Forces of a cam in a square frame under a linkage: worked cases, equilibrium in the plane, virtual work, refusals.

The cases are f06 to f09 of the sheet on forces, cam 2a of Aygahoglu and Saka 2023. What they are held against shares
nothing with the maker: positions by root finding at given shaft angles, accelerations by differences of these, and the
equilibrium of frame and output link as four equations.
"""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.page_tables import Row
from support.square_frame import Bars, axes, solve

from camgeo.capabilities.dynamics.force_figures import extremes_of, forces_section
from camgeo.capabilities.dynamics.frame_forces import REACTIONS
from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.measures.figures import design_figures
from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.linkage.mechanism import Mechanism
from kin.linkage.statics import Coupler, frame_forces

CAM = "cam: {{kind: support, p: sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25, shaft: [{}, 8.5]}}\n"
BREADTH = 50.0
FOUR_BAR = CAM.format(18) + "linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}\n"
INVERTED = CAM.format(18.5) + "linkage: {kind: inverted-slider-crank, ground: 130, rocker: 70}\n"
SLIDER = CAM.format(18) + "linkage: {kind: slider-crank, coupler: 70, offset: 0}\n"
F06, F08, F09 = "mass: 0.02, rpm: 120, load: 12", "mass: 0.03, rpm: 100, load: 9", "mass: 1.5, rpm: 120, load: 200"
F07 = F06 + ", coupler: {mass: 0.8, inertia: 6.0e-4}"
BARS = {
    FOUR_BAR: (18.0, Bars("four-bar", ground=80, coupler=70, rocker=105)),
    INVERTED: (18.5, Bars("inverted", ground=130, rocker=70)),
    SLIDER: (18.0, Bars("slider", coupler=70, offset=0)),
}
WORKED = [(FOUR_BAR, F06), (FOUR_BAR, F07), (INVERTED, F08), (SLIDER, F09)]


def running(text, dynamics):
    recipe = read(f"{text}dynamics: {{{dynamics}}}\n".encode(), Path("case.yaml"))
    return running_of(recipe, designed(recipe))


def at(text, dynamics, *theta_deg):
    return running(text, dynamics).at(np.radians(np.array(theta_deg, dtype=float)))


SOURCES = {
    "f06": (FOUR_BAR, F06, "AS Figure 9, cam 2a; 12 N m, 0.02 kg m², 120 rpm"),
    "f07": (FOUR_BAR, F07, "the same, its coupler 0.8 kg, 6e-4 kg m²"),
    "f08": (INVERTED, F08, "AS Figure 13, cam 2a; 9 N m, 0.03 kg m², 100 rpm"),
    "f09": (SLIDER, F09, "slider-crank, cam 2a; 200 N, 1.5 kg, 120 rpm"),
}
TURN = {  # greatest and least over the turn of f06, as its report has them
    "across": (9.691172009, -10.134931131),
    "along": (226.068193330, 132.737274408),
    "torque": (3.032448252, -4.775890654),
}
AT = (  # case, theta, what, value
    ("f06", 60, "across", 3.635095377),
    ("f06", 60, "along", 222.464669181),
    ("f06", 60, "torque", -3.938699874),
    ("f06", 60, "joint", 222.494366113),
    ("f07", 60, "across", 8.645901014),
    ("f07", 60, "along", 228.108336195),
    ("f07", 60, "torque", -3.991212461),
    ("f07", 290, "torque", 0.020466756),
    ("f08", 100, "across", 72.211346842),
    ("f08", 300, "torque", -2.136467633),
    ("f09", 60, "across", 3.439611483),
    ("f09", 60, "along", 210.501225245),
    ("f09", 60, "guide", -44.452328318),
    ("f09", 60, "torque", -3.726889093),
)


def rows(workshop):
    """Forces over the turn from reports, and at relative angles, by equilibrium in the plane and virtual work."""
    report = workshop.written("forces-f06", f"name: forces-f06\n{FOUR_BAR}dynamics: {{{F06}}}\n").report["forces"]
    found = []
    for what, values in TURN.items():
        one = report["torque"] if what == "torque" else next(r for r in report["reactions"] if r["reaction"] == what)
        for word, key, value in zip(("greatest", "least"), ("max", "min"), values, strict=True):
            found.append(_row(f"{word} {_named(what)}", "f06", what, value, one[key]))
    runs = {case: running(text, dynamics) for case, (text, dynamics, _) in SOURCES.items()}
    for case, theta, what, value in AT:
        state = runs[case].at(np.radians([float(theta)]))
        ours = state.torque if what == "torque" else state.reactions[what]
        found.append(_row(f"{_named(what)} at θ = {theta}°", case, what, value, float(ours[0])))
    return found


def _named(what):
    return REACTIONS.get(what, what)


def _row(quantity, case, what, value, ours):
    named = f"{quantity}, {'N m' if what == 'torque' else 'N'}, {case}"
    return Row(named, SOURCES[case][2], f"{value:.9g}", value, ours, 1e-8 * max(1.0, abs(value)), ".10g")


# --- worked cases -----------------------------------------------------------------------------------------------------


def test_a_four_bar():
    """f06: derivatives by the shaft angle, M, V, H, torque and joint force, to all printed digits."""
    state = at(FOUR_BAR, F06, 0, 60, 115, 200, 290)
    assert np.degrees(state.rows[0]) == pytest.approx(
        [67.750606336, 51.771476923, 46.531447894, 59.850323396, 74.230044141], abs=1e-9
    )
    assert state.rows[1] == pytest.approx(
        [-0.299696106, -0.284353496, -0.002251520, 0.223359728, -0.000938544], abs=1e-9
    )
    assert state.rows[2] == pytest.approx([-0.147387710, 0.586212895, 0.061118891, 0.077312107, 0.046225913], abs=1e-9)
    assert state.force == pytest.approx(
        [11.534509316, 13.851420597, 12.193030168, 12.244172771, 12.145994072], abs=1e-9
    )
    across, along, joint = (state.reactions[name] for name in ("across", "along", "joint"))
    assert across == pytest.approx([0.0, 3.635095377, -0.064711820, -2.558325141, 3.106043340], abs=1e-9)
    assert along == pytest.approx([192.047084640, 222.464669181, 153.510833934, 135.845463377, 170.461924050], abs=1e-9)
    assert joint == pytest.approx([192.047084640, 222.494366113, 153.510847573, 135.869551216, 170.490219825], abs=1e-9)
    assert state.torque == pytest.approx(
        [-3.456847524, -3.938699874, -0.027452847, 2.734855103, -0.011399549], abs=1e-9
    )
    assert "guide" not in state.reactions


@pytest.mark.slow
def test_the_extremes_of_a_four_bar():
    """f06: greatest and least V, H and torque over the turn, the faces that bear, and where V changes its face."""
    run = running(FOUR_BAR, F06)
    section = json.loads(json.dumps(forces_section(run, extremes_of(run))))
    across, along, _ = section["reactions"]
    relative = {}
    for name, one in (("across", across), ("along", along), ("torque", section["torque"])):
        places = run.turn.parameter(np.radians([one["max_at_deg"], one["min_at_deg"]]))
        relative[name] = [one["max"], one["min"], *np.degrees(places)]
    assert relative["along"] == pytest.approx([226.068193330, 132.737274408, 54.280150, 242.444164], abs=2e-6)
    assert relative["across"] == pytest.approx([9.691172009, -10.134931131, 44.588043, 87.906085], abs=2e-6)
    assert relative["torque"] == pytest.approx([3.032448252, -4.775890654, 219.797736, 46.507853], abs=2e-6)
    faces = {one["contact"]: one["max"] for one in section["contacts"]}
    assert faces == pytest.approx(
        {"face 1": 9.691172009, "face 2": 0.0, "face 3": 10.134931131, "face 4": 226.068193330}, abs=1e-9
    )
    pairs = {one["pair"]: one for one in section["pairs"]}
    changes = np.degrees(run.turn.parameter(np.radians(pairs["across"]["changes_at_deg"])))
    expected = [0.0, 64.873961006, 115.126038994, 180.0, 244.873961006, 295.126038994]
    assert changes == pytest.approx(expected, abs=1e-8)
    assert pairs["across"]["faces"] == ["face 1", "face 3"]
    assert pairs["along"]["changes_at_deg"] == []


def test_a_coupler_with_mass():
    """f07: V changes by its own size, and the torque at 290 its sign."""
    state = at(FOUR_BAR, F07, 60, 200, 290)
    assert state.reactions["across"] == pytest.approx([8.645901014, -3.305675708, 1.536813995], abs=1e-9)
    assert state.reactions["along"] == pytest.approx([228.108336195, 136.589586200, 171.346898912], abs=1e-9)
    assert state.torque == pytest.approx([-3.991212461, 2.749615815, 0.020466756], abs=1e-9)


def test_an_inverted_slider_crank():
    """f08: one face bears all round, and the faces along the slide bear nothing."""
    state = at(INVERTED, F08, 0, 45, 100, 190, 300)
    assert np.degrees(state.rows[0, 1:3]) == pytest.approx([47.165507300, 54.593210572], abs=1e-9)
    assert state.rows[1] == pytest.approx([-0.031410868, 0.037595943, 0.155161138, 0.006161948, -0.254467594], abs=1e-9)
    assert state.rows[2] == pytest.approx([0.212219805, 0.186514076, 0.017197068, -0.056051875, -0.183644493], abs=1e-9)
    assert state.force == pytest.approx([9.698175175, 9.613606717, 9.056576086, 8.815596721, 8.395833835], abs=1e-9)
    expected = [105.044171109, 97.052449248, 72.211346842, 73.323671976, 97.238265599]
    assert state.reactions["across"] == pytest.approx(expected, abs=1e-9)
    assert (state.reactions["along"] == 0.0).all()
    assert (state.normal[1:] == 0.0).all()
    assert not np.signbit(state.reactions["along"]).any()
    assert state.torque == pytest.approx([-0.304628096, 0.361432610, 1.405228653, 0.054321248, -2.136467633], abs=1e-9)
    assert set(state.reactions) == {"across", "along"}


def test_a_slider_crank():
    """f09: the force on the slide, V, H, what its guide gives it, and the torque."""
    state = at(SLIDER, F09, 0, 60, 150, 240, 310)
    assert 1e3 * state.rows[0] == pytest.approx(
        [105.184921818, 83.840132441, 79.669172174, 109.006643083, 113.388808248], abs=1e-9
    )
    expected = [198.315968222, 205.782864359, 204.691139467, 192.436608812, 196.158340808]
    assert state.force == pytest.approx(expected, abs=1e-9)
    across, along, guide = (state.reactions[name] for name in ("across", "along", "guide"))
    assert across == pytest.approx([0.0, 3.439611483, 6.697961729, -2.984292857, -7.821148351], abs=1e-9)
    assert along == pytest.approx([201.285136179, 210.501225245, 206.285344569, 195.094609409, 196.009447882], abs=1e-9)
    assert guide == pytest.approx([-34.445359550, -44.452328318, 26.458335155, 32.232967801, -1.667138851], abs=1e-9)
    assert state.torque == pytest.approx([-3.623132451, -3.726889093, 2.107913659, 3.513607617, -0.189034888], abs=1e-9)


# --- equilibrium in the plane -----------------------------------------------------------------------------------------


def support(shaft_x, shaft_y=8.5):
    """Support function of cam 2a about the shaft, and its slope."""

    def p(t):
        return np.sin(3 * t) + 13 / 30 * (np.sin(5 * t) + np.sin(t)) + 25 - shaft_x * np.cos(t) - shaft_y * np.sin(t)

    def slope(t):
        own = 3 * np.cos(3 * t) + 13 / 30 * (5 * np.cos(5 * t) + np.cos(t))
        return own + shaft_x * np.sin(t) - shaft_y * np.cos(t)

    return p, slope


class Bench:
    """A linkage at given shaft angles: pose by root finding, rates by differences, forces by four equations."""

    def __init__(self, text):
        shaft_x, self.bars = BARS[text]
        self.p, self.slope = support(shaft_x)
        reach = (self.p(0.0), self.p(0.5 * np.pi))
        self.start = solve(self.bars, BREADTH, lambda _: reach)[0]

    def pose(self, phi):
        """Relative angle, direction of the frame, output, middle of the frame."""

        def reach(th3):
            theta = phi + th3 - self.start
            return self.p(theta), self.p(theta + 0.5 * np.pi)

        th3, output = solve(self.bars, BREADTH, reach)
        lift, along = reach(th3)
        u, n = axes(th3)
        return phi + th3 - self.start, th3, output, (BREADTH / 2 - along) * u + (lift - BREADTH / 2) * n

    def rates(self, phi, h=4e-3):
        """First and second derivative of direction, output and middle by the shaft angle, of sixth order in h."""
        poses = [self.pose(phi + k * h) for k in range(-3, 4)]
        rows = np.array([[th3, output, *middle] for _, th3, output, middle in poses])
        first = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60.0 @ rows / h
        second = np.array([2, -27, 270, -490, 270, -27, 2]) / 180.0 @ rows / h**2
        return first, second

    def forces(self, phi, mass, rpm, load, body=(0.0, 0.0)):
        """V, H, torque (N, N m), all by equilibrium of frame and output link; SI but for mm."""
        theta, th3, _, middle = self.pose(phi)
        _, second = self.rates(phi)
        speed = rpm * np.pi / 30.0
        unit = 1e-3 if self.bars.kind == "slider" else 1.0
        demand = load + mass * speed**2 * unit * second[1]
        turning, inertia = body[1] * speed**2 * second[0] * 1e3, body[0] * speed**2 * 1e-3 * second[2:]
        u, n = axes(th3)
        lift, along = self.p(theta), self.p(theta + 0.5 * np.pi)
        slope, slope1 = self.slope(theta), self.slope(theta + 0.5 * np.pi)
        contact, contact1 = -slope * u + lift * n, (BREADTH - along) * u - slope1 * n
        joint = self.bars.length(BREADTH, along) * u + (lift - BREADTH / 2) * n

        def cross(a, b):
            return a[0] * b[1] - a[1] * b[0]

        def about(point):
            return point - middle

        ground = np.array([self.bars.ground, 0.0])
        # unknowns V, H and two of the joint: its force on the output link, or across the slot and a couple
        x, y = np.eye(2)
        if self.bars.kind == "inverted":
            held = [(n, 0.0), (np.zeros(2), 1.0)]
            driven = [-cross(joint - ground, n), -1.0]
        else:
            held = [(x, 0.0), (y, 0.0)]
            driven = [-cross(joint - ground, x), -cross(joint - ground, y)] if self.bars.kind == "four-bar" else [1, 0]
        columns = [(n, cross(about(contact), n)), (u, cross(about(contact1), u))]
        columns += [(-force, -cross(about(joint), force) - couple) for force, couple in held]
        matrix = np.array([[*force, moment] for force, moment in columns]).T
        matrix = np.vstack([matrix, [0.0, 0.0, *driven]])
        # theta4 grows clockwise: a moment of 1 N m the way it grows is -1e3 N mm
        right = [*inertia, turning, demand if self.bars.kind == "slider" else 1e3 * demand]
        across, flat, *_ = np.linalg.solve(matrix, right)
        torque = cross(contact, across * n) + cross(contact1, flat * u)  # on the frame, anticlockwise
        return across, flat, -1e-3 * torque


NUMBERS = {F06: (0.02, 120, 12), F07: (0.02, 120, 12, (0.8, 6e-4)), F08: (0.03, 100, 9), F09: (1.5, 120, 200)}


@pytest.mark.slow
@pytest.mark.parametrize(("text", "dynamics"), WORKED)
def test_equilibrium_in_the_plane(text, dynamics):
    """Four equations for frame and output link at positions found by bisection, to what differences leave of them."""
    bench, phi = Bench(text), np.radians([3.0, 77.0, 151.0, 243.0, 318.0])
    state = running(text, dynamics).state(phi)
    brute = np.array([bench.forces(float(x), *NUMBERS[dynamics]) for x in phi]).T
    for given_, expected in zip(
        (state.reactions["across"], state.reactions["along"], state.torque), brute, strict=True
    ):
        assert given_ == pytest.approx(expected, abs=2e-7 * np.abs(brute).max())


def test_faults_that_the_equilibrium_sees():
    """A coupler left out, derivatives over the relative angle, and a load of the other sense are no rounding."""
    bench, phi = Bench(FOUR_BAR), math.radians(77.0)
    right = np.array(bench.forces(phi, *NUMBERS[F07]))
    run = running(FOUR_BAR, F07)
    for wrong in (F06, F07.replace("12,", "-12,"), F07.replace("120", "60")):
        state = running(FOUR_BAR, wrong).state(np.array([phi]))
        assert abs(state.reactions["across"][0] - right[0]) > 0.1
    motion = run.mechanism.at(run.turn.parameter(np.array([phi])), 2)
    assert abs(motion.output[2, 0] - run.turn.rows(motion.theta)[2, 0]) > 0.05


# --- virtual work -----------------------------------------------------------------------------------------------------

LINKAGES = st.one_of(
    st.builds(
        FourBar,
        st.floats(75, 85),
        st.floats(66, 75),
        st.floats(98, 112),
        st.sampled_from(["open", "crossed"]),
        st.floats(-4, 4),
    ),
    st.builds(
        InvertedSliderCrank,
        st.floats(110, 200),
        st.floats(0, 80),
        st.sampled_from(["open", "crossed"]),
        st.floats(-4, 4),
    ),
    st.builds(
        SliderCrank, st.floats(55, 120), st.floats(-15, 15), st.sampled_from(["open", "crossed"]), st.floats(-4, 4)
    ),
)


@pytest.fixture(scope="module")
def lift():
    recipe = read(FOUR_BAR.encode(), Path("case.yaml"))
    return designed(recipe).driven.mechanism.lift


@given(
    linkage=LINKAGES,
    demands=st.tuples(*[st.floats(-1e4, 1e4)] * 3),
    body=st.tuples(st.floats(-60, 60), st.floats(-60, 60), st.floats(0, 5), st.floats(0, 5e3)),
)
@settings(max_examples=examples(40), deadline=None)
def test_power_of_random_linkages(lift, linkage, demands, body):
    """T = M v + m a v_c + I alpha omega, and T = S' V - S1' H, to 1e-12 of what adds up to them."""
    mechanism = Mechanism(linkage, lift, BREADTH)
    theta = np.linspace(0.1, 6.2, 7)
    if not (linkage.margins(*mechanism.at(theta, 0).faces[:, 0], BREADTH) > 1.0).all():
        return
    motion = mechanism.at(theta, 2)
    if motion.shaft[1].min() < 0.05:
        return
    demand = demands[0] + demands[1] * np.cos(theta) + demands[2] * np.sin(3 * theta)
    coupler = Coupler(body[:2], body[2], body[3])
    found = frame_forces(mechanism, motion, demand, coupler)
    centre = mechanism.chain.frame(motion.solved).point(*coupler.centre)
    x, y = (motion.over_shaft(row.derivatives()) for row in centre)
    turn, output = motion.over_shaft(motion.frame), motion.over_shaft(motion.output)
    shares = [demand * output[1], body[2] * x[2] * x[1], body[2] * y[2] * y[1], body[3] * turn[2] * turn[1]]
    levers = [motion.faces[0, 1] * found.across, -motion.faces[1, 1] * found.along]
    scale = sum(np.abs(one).max() for one in (*shares, *levers))
    assert found.torque == pytest.approx(sum(shares), abs=1e-12 * scale / min(1.0, motion.shaft[1].min()))
    assert found.torque == pytest.approx(sum(levers), abs=1e-12 * scale / min(1.0, motion.shaft[1].min()))


@pytest.mark.thin(4)
@pytest.mark.parametrize(("text", "dynamics"), WORKED)
def test_power_of_the_shaft(text, dynamics):
    """Over a turn load and inertia give back what they take: the mean torque of a constant load is 0."""
    run = running(text, dynamics)
    theta = np.linspace(0.0, 2 * math.pi, 721)[:-1]
    motion = run.mechanism.at(theta, 1)
    torque = run.at(theta).torque
    assert abs(np.mean(torque * motion.shaft[1])) < 1e-11 * np.abs(torque).max()


def test_dyads_pass_their_load_on():
    """A dyad without mass: the torque is its load times the rate of its output."""
    text = FOUR_BAR.replace(
        "rocker: 105}", "rocker: 105, dyads: [{kind: rrr, point: [80, 0], ground: [140, 80], links: [100, 30]}]}"
    )
    run = running(text, F06)
    state = run.at(np.linspace(0.1, 6.2, 50))
    assert state.torque == pytest.approx(state.force * state.rows[1], abs=1e-12 * np.abs(state.torque).max())
    assert set(state.reactions) == {"across", "along"}


# --- extremes ---------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_forces_near_the_place_where_the_shaft_turns_back():
    """They grow as 1 over the rate of the shaft; beyond it there are none, and the message says from where on."""

    def yoke(ground):
        return running(INVERTED.replace("130", ground).replace("70}", "0}"), "mass: 1.0e-9, rpm: 1.0e-3, load: 9")

    peaks, rates = [], []
    for ground in ("25", "23.77437455473983", "23.773384554739827"):
        run = yoke(ground)
        rates.append(run.mechanism.mobility().least_rate)
        peaks.append(extremes_of(run).contacts[0][1].value)
    assert rates[0] > 0.05
    assert rates[2] < 1e-6
    products = np.array(peaks) * rates
    assert products[1:] == pytest.approx(np.full(2, products[2]), rel=1e-3)
    assert products[0] == pytest.approx(products[2], rel=0.1)
    back = (
        r"dynamics: the shaft would turn back and forces grow without bound from a relative angle of 316\.\d+ degrees"
    )
    with pytest.raises(RecipeErrors, match=back):
        yoke("23.7733")
    with pytest.raises(
        RecipeErrors, match=r"dynamics: a loop of the linkage cannot be closed from a relative angle of"
    ):
        running(FOUR_BAR.replace("105", "160"), F06)


@pytest.mark.slow
def test_a_coupler_of_huge_mass_and_a_load_over_the_angle():
    """All that the coupler adds is in proportion to its mass; a load over t is that at the shaft's angle."""
    bare, light, heavy = (
        at(FOUR_BAR, F06 + more, 60, 200).reactions["across"]
        for more in ("", ", coupler: {mass: 1, centre: [3, -2]}", ", coupler: {mass: 1.0e+9, centre: [3, -2]}")
    )
    assert heavy - bare == pytest.approx(1e9 * (light - bare), rel=1e-9)
    run = running(FOUR_BAR, F06.replace("load: 12", "load: 12 + 5*sin(t)"))
    phi = np.array([1.0, 2.0])
    flat = running(FOUR_BAR, F06).state(phi)
    assert run.state(phi).force - flat.force == pytest.approx(5 * np.sin(phi), abs=1e-12)


def test_a_spring_at_the_output():
    """`preload` at the least output and `rate` beyond it add to the load."""
    plain, sprung = running(FOUR_BAR, F06), running(FOUR_BAR, F06 + ", preload: 3, rate: 7")
    theta = np.linspace(0.0, 6.2, 20)
    output = plain.at(theta).rows[0]
    least = plain.design.driven.figures.least.value
    assert sprung.at(theta).force - plain.at(theta).force == pytest.approx(3 + 7 * (output - least), abs=1e-11)


@pytest.mark.thin(5)
@pytest.mark.parametrize(
    ("text", "dynamics", "field", "words", "remedied"),
    [
        (INVERTED, F08 + ", coupler: {mass: 1}", "dynamics.coupler", "slides on the rocker", F08),
        (
            FOUR_BAR,
            F06 + ", least_force: 3",
            "dynamics.least_force",
            "no spring holds a square frame",
            F06 + ", preload: 3",
        ),
        (
            FOUR_BAR,
            F07.replace("load: 12", "stiffness: 3.0e4, preload: 8"),
            "dynamics.coupler",
            "without stiffness",
            F07,
        ),
        (CAM.format(0), F07, "dynamics.coupler", "without a linkage", F06 + ", preload: 3"),
        (FOUR_BAR, F06.replace("load: 12", "load: 1/(t - 1)"), "dynamics.load", "no bound", F06),
    ],
)
def test_what_is_refused(text, dynamics, field, words, remedied):
    with pytest.raises(RecipeErrors) as caught:
        extremes_of(running(text, dynamics))
    (error,) = caught.value.errors
    assert error.path == field
    assert words in str(error)
    extremes_of(running(text, remedied))


# --- report, page, table, figures -------------------------------------------------------------------------------------


@pytest.mark.slow
def test_report_page_table_and_figures(tmp_path):
    """f07 through a recipe: the same in the report, on the page, in the CSV file and as limits."""
    text = FOUR_BAR + (
        f"part: {{thickness: 8, bore: 6}}\ndynamics: {{{F07}, material: steel}}\n"
        "limits: {contact-force-greatest: {at_most: 240}, shaft-torque: {at_most: 3}}\n"
        "export: {tolerance: 0.01, files: [{csv: {as: forces}}, html]}\nverify: {angles: 720}\n"
    )
    recipe = read(text.encode(), Path("f07.yaml"))
    outcome = pipeline.export(recipe, tmp_path)
    report = json.loads(next(tmp_path.rglob("report.json")).read_text(encoding="utf-8"))
    held = {check["name"]: check["ok"] for check in report["checks"]}
    assert held["limit:contact-force-greatest"]
    assert not held["limit:shaft-torque"]
    assert not outcome.ok
    run = running_of(recipe, designed(recipe))
    with next(tmp_path.rglob("*.csv")).open(newline="") as file:
        head, *rows = list(csv.reader(file))
    assert head[:9] == [
        *("shaft_deg", "face_1_N", "face_2_N", "face_3_N", "face_4_N", "torque_Nm", "across_N", "along_N", "joint_N")
    ]
    written = np.array(rows, dtype=float).T
    state = run.state(np.radians(written[0]))
    for column, row in zip(head[5:9], (state.torque, *state.reactions.values()), strict=True):
        assert written[head.index(column)] == pytest.approx(row, rel=1e-8, abs=1e-9)
    assert written[1] - written[3] == pytest.approx(written[6], abs=1e-9)
    assert written[4] - written[2] == pytest.approx(written[7], abs=1e-9)
    section = report["forces"]
    assert section["torque"]["max"] == pytest.approx(written[5].max(), rel=1e-4)
    figures = design_figures(
        recipe, designed(recipe), (), ["contact-force-greatest", "shaft-torque", "contact-pressure"]
    )
    assert figures["contact-force-greatest"].value == section["contacts"][3]["max"]
    assert figures["contact-force-greatest"].surface == "face 4"
    assert figures["contact-pressure"].value == max(one["max"] for one in section["pressure"])
    page = next(tmp_path.rglob("*.html")).read_text(encoding="utf-8")
    titles = ("Contact force, face 2 and face 4", "Contact pressure, face 1 and face 3", "Forces of the frame")
    for words in (*titles, "Forces at joint D", "greatest force along the frame", "greatest force in joint D"):
        assert words in page


def test_pressure_at_the_faces():
    """Hertz's line contact of a flat steel face: p = sqrt(N E*/(pi b rho)), rho = p + p'' of the face that bears."""
    recipe = read(f"{FOUR_BAR}part: {{thickness: 8}}\ndynamics: {{{F06}, material: steel}}\n".encode(), Path("x.yaml"))
    state = running_of(recipe, designed(recipe)).at(np.radians([60.0]))
    t = math.radians(60.0 + 270.0)  # face 4
    rho = 25 - 8 * math.sin(3 * t) - 13 / 30 * 24 * math.sin(5 * t)
    modulus = 206e3 / (2 * (1 - 0.3**2))
    assert state.pressure[3, 0] == pytest.approx(math.sqrt(222.464669181 * modulus / (math.pi * 8 * rho)), rel=1e-9)


@pytest.mark.slow
def test_a_slide_counts_in_newtons(tmp_path):
    """f09 at shaft angle 0, as its file has it."""
    text = SLIDER + f"dynamics: {{{F09}}}\nexport: {{files: [{{csv: {{as: forces}}}}]}}\nverify: {{angles: 360}}\n"
    outcome = pipeline.export(read(text.encode(), Path("f09.yaml")), tmp_path)
    assert outcome.ok
    with next(tmp_path.rglob("*.csv")).open(newline="") as file:
        row = next(csv.DictReader(file))
    assert float(row["along_N"]) == pytest.approx(201.285136179, rel=1e-9)
    assert float(row["guide_N"]) == pytest.approx(-34.445359550, rel=1e-9)
    assert float(row["torque_Nm"]) == pytest.approx(-3.623132451, rel=1e-9)


# --- preload of both pairs --------------------------------------------------------------------------------------------

PRESSED = FOUR_BAR.replace(
    "8.5]}",
    "8.5], preload: {interference: 0.02, stiffness: [2.0e7, 2.0e7]}}\nexport: {tolerance: 0.001, files: [dxf]}",
    1,
)
UNEVEN = PRESSED.replace("[2.0e7, 2.0e7]", "[2.0e7, 6.0e7]")


@pytest.mark.slow
def test_faces_under_preload():
    """f06: the frame 0.02 mm narrower both ways, 20 kN/mm each: 200 N on all four; at 60 degrees as printed."""
    run = running(PRESSED, F06)
    one, two, three, four = run.at(np.radians([60.0])).normal[:, 0]
    assert [one, three, four, two] == pytest.approx(
        [201.817547689, 198.182452311, 311.232334590, 88.767665409], abs=1e-9
    )
    bare = running(FOUR_BAR, F06).at(np.radians([60.0]))
    assert (one - three, four - two) == pytest.approx(
        (bare.reactions["across"][0], bare.reactions["along"][0]), abs=1e-11
    )


@pytest.mark.slow
def test_faces_of_unequal_stiffness():
    """N = P + V k1/(k1 + k2) on face 1, P - H k1/(k1 + k2) on face 2; a lost face bears nothing, the other all."""
    state = running(UNEVEN, F06.replace("load: 12", "load: 30")).at(np.linspace(0.0, 6.2, 60))
    across, along, preload = state.reactions["across"], state.reactions["along"], 0.02 * 2e4 * 6e4 / 8e4
    assert state.normal[0] == pytest.approx(preload + across * 0.25, abs=1e-9)
    assert state.normal[2] == pytest.approx(preload - across * 0.75, abs=1e-9)
    held = along * 0.25 < preload
    assert state.normal[1][held] == pytest.approx((preload - along * 0.25)[held], abs=1e-9)
    assert state.normal[3][held] == pytest.approx((preload + along * 0.75)[held], abs=1e-9)
    over = running(UNEVEN, F06.replace("load: 12", "load: 100")).at(np.linspace(0.0, 6.2, 60))
    lost = over.reactions["along"] * 0.25 > preload
    assert 40 < lost.sum() < 60
    assert (over.normal[1][lost] == 0.0).all()
    assert over.normal[3][lost] == pytest.approx(over.reactions["along"][lost], abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("text", [PRESSED, UNEVEN])
def test_speeds_from_which_faces_are_lost(text):
    """At that speed the least force of the face is 0, at that place; a little below it is above 0."""
    lost = running(text, F07).lost_rpm()
    assert [one.contact for one in lost] == ["face 1", "face 2", "face 3", "face 4"]
    for rank, (_, rpm, at_deg) in enumerate(lost):
        here = running(text, F07.replace("rpm: 120", f"rpm: {rpm!r}"))
        assert here.state(np.radians([at_deg])).normal[rank, 0] == pytest.approx(0.0, abs=1e-6)
        below = extremes_of(running(text, F07.replace("rpm: 120", f"rpm: {0.99 * rpm!r}")))
        assert below.contacts[rank][0].value > 0.0


@pytest.mark.slow
def test_files_of_a_preloaded_frame(tmp_path):
    """The metal is made larger and judged about that; a file of the nominal cam, and of one twice too large, fails."""
    from camgeo import verify

    def made(text, name):
        recipe = read(f"name: {name}\n{text}".encode(), Path(f"{name}.yaml"))
        outcome = pipeline.export(recipe, tmp_path)
        return recipe, outcome, tmp_path / name / f"{name}.dxf"

    recipe, outcome, drawing = made(PRESSED, "pressed")
    assert outcome.ok
    (file,) = outcome.report["linkage"]["files"]
    for way in ("backlash_across", "backlash_along"):
        assert file[way]["min"] <= -0.02 <= file[way]["max"]
        assert file[way]["max"] - file[way]["min"] < 0.004
    assert verify(recipe, drawing).ok
    bare = PRESSED.replace(", preload: {interference: 0.02, stiffness: [2.0e7, 2.0e7]}", "")
    for wrong in (bare, PRESSED.replace("0.02", "0.04")):
        _, own, other = made(wrong, f"wrong-{len(wrong)}")
        assert own.ok
        failed = {check.name for check in verify(recipe, other).checks if not check.ok}
        assert "linkage-error" in failed


@pytest.mark.slow
def test_a_spring_beside_a_preloaded_frame():
    """It acts on the output, and so goes with the preload of the faces."""
    sprung = running(PRESSED, F06 + ", preload: 3").at(np.radians([60.0]))
    assert sprung.force - running(PRESSED, F06).at(np.radians([60.0])).force == pytest.approx([3.0], abs=1e-11)
