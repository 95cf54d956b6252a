# needs: dynamics
"""Two contacts under preload on a stem whose guide rubs, against equilibrium of the stem as a body.

It has formulas of its own: the follower's motion in closed form, contacts and normals from where the cam's points go,
springs at the contacts, and the stem as it yields until the forces on it balance, found by bisection.
"""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import optimize

from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.output.pipeline import check
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

GUIDE = "guide: {{overhang: {overhang!r}, length: {length!r}, friction: {friction!r}}}"
MOTIONS = {
    "discs": "kind: disc, base_radius: 28, follower: {kind: roller, radius: 8, offset: 5},"
    " conjugate: {radius: 9, distance: 92}, motion: {formula: 6*(1 - cos(t)) + sin(t)**2}",
    "flat discs": "kind: disc, base_radius: 60, follower: {kind: flat, offset: 5},"
    " conjugate: {distance: 150}, motion: {formula: 6*(1 - cos(t)) + sin(t)**2}",
    "yoke": "kind: support, p: 25 + 2*cos(3*t)",
    "roller frame": "kind: constant-diameter, base_radius: 30, roller_radius: 10,"
    " motion: [{rise: 12, over: 180, law: cycloidal}]",
}
INTERFERENCE = 0.012


def _wave(t):
    return np.array(
        [
            6.0 * (1.0 - math.cos(t)) + math.sin(t) ** 2,
            6.0 * math.sin(t) + math.sin(2.0 * t),
            6.0 * math.cos(t) + 2.0 * math.cos(2.0 * t),
        ]
    )


def _cycloidal(t):
    """12 mm up over the first half turn, and so far down over the second that diameters stay."""
    sign, u = (1.0, t) if t < math.pi else (-1.0, t - math.pi)
    rise = 12.0 / math.pi * np.array([u - 0.5 * math.sin(2.0 * u), 1.0 - math.cos(2.0 * u), 2.0 * math.sin(2.0 * u)])
    return sign * rise + np.array([0.0 if sign > 0.0 else 12.0, 0.0, 0.0])


def _trefoil(t):
    return np.array([25.0 + 2.0 * math.cos(3.0 * t), -6.0 * math.sin(3.0 * t), -18.0 * math.cos(3.0 * t)])


# motion, place of the first touch beyond it, of the second before that, line of the stem, flat, growth of each side
SHAPES = {
    "discs": (_wave, math.sqrt(36.0**2 - 5.0**2), 92.0, 5.0, False, (0.0, INTERFERENCE)),
    "flat discs": (_wave, 60.0, 150.0, 5.0, True, (0.0, INTERFERENCE)),
    "yoke": (_trefoil, 0.0, 50.0, 0.0, True, (0.5 * INTERFERENCE, 0.5 * INTERFERENCE)),
    "roller frame": (_cycloidal, 40.0, 92.0, 0.0, False, (0.5 * INTERFERENCE, 0.5 * INTERFERENCE)),
}


class Stem:
    """A stem on two springs, its axis along x: what bears at a shaft angle, N and mm."""

    def __init__(self, name, stiffness, guide):
        self.law, self.datum, self.apart, self.axis, self.flat, self.growth = SHAPES[name]
        self.stiffness = [1e-3 * k for k in stiffness]
        self.overhang, self.length, self.friction = guide
        lowest = min(self.law(t)[0] for t in np.linspace(0.0, 2.0 * math.pi, 361))
        self.end = self.datum + lowest + self.overhang

    def touches(self, t):
        """Place and normal from the cam of both contacts; the cam turns clockwise under the stem."""
        s, speed, _ = self.law(t)
        for place, way in ((self.datum + s, 1.0), (self.datum + s - self.apart, -1.0)):
            if self.flat:  # touched where the cam's point keeps up with the face: y is its speed
                yield (place, speed), (way, 0.0)
            else:  # the centre moves over the cam by its own speed less that of the cam's point there
                over = speed - self.axis, place
                normal = np.array([over[1], -over[0]]) / math.hypot(*over)
                yield (place, self.axis), tuple(normal * np.sign(normal[0]) * way)

    def bears(self, t, force):
        """Normal forces and the guide's near and far reactions on the stem, at what acts against its travel, N."""
        q = float(np.sign(self.law(t)[1]))
        touches = list(self.touches(t))

        def forces(moved):
            """Of the stem `moved` out: the metal is pressed in by its growth less what the touch gives way."""
            pressed = [
                k * max(grown - normal[0] * moved, 0.0)
                for k, grown, (_, normal) in zip(self.stiffness, self.growth, touches, strict=True)
            ]
            across = sum(n * normal[1] for n, (_, normal) in zip(pressed, touches, strict=True))
            turning = sum(  # about the near end of the guide
                n * ((at[0] - self.end) * normal[1] - (at[1] - self.axis) * normal[0])
                for n, (at, normal) in zip(pressed, touches, strict=True)
            )
            far = -turning / self.length
            return pressed, -across - far, far

        def along(moved):
            pressed, near, far = forces(moved)
            push = sum(n * normal[0] for n, (_, normal) in zip(pressed, touches, strict=True))
            return push - q * self.friction * (abs(near) + abs(far)) - force

        return forces(optimize.brentq(along, -5.0, 5.0, xtol=1e-15, rtol=1e-14))


def recipe_of(name, stiffness, guide, dynamics):
    held = f"preload: {{interference: {INTERFERENCE}, stiffness: [{stiffness[0]!r}, {stiffness[1]!r}]}}"
    led = GUIDE.format(overhang=guide[0], length=guide[1], friction=guide[2])
    text = f"cam: {{{MOTIONS[name]}, {held}}}\ndynamics: {{{dynamics}, {led}}}\nexport: {{tolerance: 1e-3}}\n"
    return read(text.encode(), Path("stem.yaml"))


def running(name, stiffness, guide, dynamics):
    recipe = recipe_of(name, stiffness, guide, dynamics)
    run = running_of(recipe, designed(recipe))
    assert run is not None
    return run


def disagreement(name, stiffness, guide, rpm, load, *, mass=1.3, friction=None, count=40):
    """Greatest difference of a force to the stem's own, as a share of the greatest; and how many bear at each place."""
    run = running(name, stiffness, guide, f"mass: {mass!r}, rpm: {rpm!r}, load: {load!r}*sin(t)")
    stem = Stem(name, stiffness, (*guide[:2], guide[2] if friction is None else friction))
    angles = np.linspace(0.003, 6.28, count)
    state = run.state(angles)
    near, far = state.reactions["guide_a"], state.reactions["guide_b"]
    omega, worst, bearing = rpm * math.pi / 30.0, 0.0, set()
    for k, t in enumerate(angles):
        force = 1e-3 * mass * omega**2 * stem.law(t)[2] + load * math.sin(t)
        pressed, at_near, at_far = stem.bears(t, force)
        ours = np.array([*state.normal[:, k], -near[k], far[k]])
        worst = max(worst, float(np.abs(ours - [*pressed, at_near, at_far]).max()))
        bearing.add(tuple(n > 0.0 for n in pressed))
    return worst / float(np.abs(state.normal).max()), bearing


STIFF, LED = (4.0e7, 6.0e7), (40.0, 50.0, 0.1)


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", SHAPES)
def test_equilibrium_while_both_bear(name):
    worst, bearing = disagreement(name, STIFF, LED, 500.0, 50.0)
    assert worst < 1e-8
    assert bearing == {(True, True)}


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", SHAPES)
def test_equilibrium_where_contacts_are_lost(name):
    worst, bearing = disagreement(name, STIFF, (25.0, 60.0, 0.2), 2500.0, 90.0, mass=3.0)
    assert worst < 1e-8
    assert bearing == {(True, True), (True, False), (False, True)}


@pytest.mark.parametrize("name", SHAPES)
def test_another_friction_is_seen(name):
    worst, _ = disagreement(name, STIFF, LED, 500.0, 50.0, friction=0.101, count=12)
    assert worst > 1e-5


@settings(max_examples=examples(20), deadline=None)
@given(
    name=st.sampled_from(sorted(SHAPES)),
    stiffness=st.tuples(st.floats(1e6, 1e8), st.floats(1e6, 1e8)),
    guide=st.tuples(st.floats(5.0, 60.0), st.floats(40.0, 90.0), st.floats(0.01, 0.2)),
    rpm=st.floats(10.0, 2000.0),
    load=st.floats(-400.0, 400.0),
)
def test_equilibrium_by_chance(name, stiffness, guide, rpm, load):
    worst, _ = disagreement(name, stiffness, guide, rpm, load, count=9)
    assert worst < 1e-7


CASE = """
cam:
  kind: disc
  base_radius: 28
  follower: {kind: roller, radius: 8, offset: 5}
  conjugate: {radius: 9, distance: 92}
  motion: [{rise: 12, over: 100, law: modified-sine}, {dwell: 50}, {return: 12, over: 130, law: polynomial-4567},
    {dwell: 80}]
  preload: {interference: 0.012, stiffness: [4.0e7, 6.0e7]}
part: {thickness: 8}
dynamics: {mass: 1.3, rpm: 500, load: 50*sin(t), guide: {overhang: 40, length: 50, friction: 0.1}}
export: {tolerance: 0.002}
"""


@pytest.mark.slow
def test_the_discs_of_the_case():
    """Forces at 195 degrees, and the speeds from which either disc is lost."""
    recipe = read(CASE.encode(), Path("case.yaml"))
    run = running_of(recipe, designed(recipe))
    assert run is not None
    state = run.state(np.radians([195.0]))
    forces = [*state.normal[:, 0], *(row[0] for row in state.reactions.values())]
    assert forces == pytest.approx([227.65, 377.72, 468.81, 297.89], abs=0.005)
    (first, low, at), (second, high, _) = run.lost_rpm()
    assert (first, second) == ("disc 1", "disc 2")
    assert (low, at, high) == pytest.approx((1539.2, 188.4, 1218.8), abs=0.05)
    for rank, (_, rpm, at_deg) in enumerate(run.lost_rpm()):
        faster = CASE.replace("rpm: 500", f"rpm: {rpm!r}")
        there = running_of(read(faster.encode(), Path("case.yaml")), designed(recipe))
        left = there.state(np.radians([at_deg - 0.2, at_deg, at_deg + 0.2])).normal[rank]
        assert left == pytest.approx([0.0] * 3, abs=0.2)
        assert left[1] == pytest.approx(0.0, abs=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("name", SHAPES)
def test_the_check_on_jamming(name):
    """Of a face by its distance from the axis, of rollers by the second, which stands further from the guide."""
    (jam,) = (
        one for one in check(recipe_of(name, STIFF, LED, "mass: 1, rpm: 60")).report["checks"] if "jam" in one["name"]
    )
    _, _, apart, _, flat, _ = SHAPES[name]
    limit = 250.0 if flat else math.degrees(math.atan(50.0 / (0.1 * (2.0 * (40.0 + apart) + 50.0))))
    assert jam["limit"] == pytest.approx(limit, rel=1e-9)
    assert jam["ok"]
    if name == "yoke":
        assert jam["value"] == pytest.approx(6.0, abs=1e-9)


@pytest.mark.slow
def test_a_stem_that_jams():
    """A stem jams by one contact alone, which the check tells; or both wedge it between them, which is refused."""
    slack = running("yoke", STIFF, (40.0, 50.0, 4.1), "mass: 1, rpm: 60")
    assert slack.jam_deg is None
    assert running("yoke", STIFF, (40.0, 50.0, 4.2), "mass: 1, rpm: 60").jam_deg is not None
    report = check(recipe_of("yoke", STIFF, (40.0, 50.0, 4.2), "mass: 1, rpm: 60")).report
    assert [one["name"] for one in report["checks"] if not one["ok"]] == ["guide-jam"]


def test_a_stem_that_is_wedged():
    """A stiff second contact on a steep flank jams nothing alone, as it does not push on there."""
    text = (
        "cam: {kind: disc, base_radius: 40, follower: {kind: roller, radius: 8}, conjugate: {radius: 8, distance: 84},"
        " preload: {interference: 0.01, stiffness: [1e6, 1e9]},"
        " motion: [{rise: 12, over: 50, law: cycloidal}, {return: 12, over: 310, law: cycloidal}]}\n"
        "dynamics: {mass: 1, rpm: 60, guide: {overhang: 10, length: 30, friction: FRICTION}}\n"
        "export: {tolerance: 1e-3}\n"
    )

    def jams(friction):
        recipe = read(text.replace("FRICTION", str(friction)).encode(), Path("stem.yaml"))
        return running_of(recipe, designed(recipe)).jam_deg

    assert jams(0.1) is None
    with pytest.raises(RecipeErrors, match=r"dynamics\.guide: the preloaded contacts wedge the stem in it at"):
        jams(0.24)


@pytest.mark.parametrize(
    "text",
    [
        "cam: {kind: double-roller, ratio: 3, arm: 60, roller_radius: 10, delta: {cos: {1: 360}}}",
        "cam: {kind: support, p: 25 + 2*cos(3*t)}\nlinkage: {kind: inverted-slider-crank, shaft: [60, 0]}",
    ],
)
def test_guides_are_those_of_stems(text):
    led = f"\ndynamics: {{mass: 1, rpm: 60, preload: 9, {GUIDE.format(overhang=9, length=9, friction=0.1)}}}\n"
    with pytest.raises(RecipeErrors) as caught:
        read((text + led).encode(), Path("stem.yaml"))
    assert "the follower has no stem of its own" in str(caught.value)
