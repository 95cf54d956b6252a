"""Formulas in which digits cancel: held to what is left of them, or refused with the figure; roots at their edge."""

from functools import partial

import mpmath as mp
import pytest
from accuracy import ANGLES, Row, made, names, off_file, off_profile, recipe, refused, shown_as_measured
from extreme_oracle import formula, worst

from camgeo.synthesis.design import designed

# text, the same in mpmath, why
CANCELLING = (
    ("25 + (1e9 + cos(3*t)) - 1e9", lambda t: 25 + mp.cos(3 * t), "nine digits are lost to 1e9"),
    (
        "25 + (exp(1e-9*cos(3*t)) - 1)*1e9",
        lambda t: 25 + (mp.exp(mp.mpf(1e-9) * mp.cos(3 * t)) - 1) * 10**9,
        "1e-9 of an exponential is left",
    ),
    (
        "25 + (1 - cos(1e-4*cos(3*t)))*1e8",
        lambda t: 25 + (1 - mp.cos(mp.mpf(1e-4) * mp.cos(3 * t))) * 10**8,
        "1 - cos x of a small x",
    ),
    (
        "25 + (1 - cos(0.001*(2 + cos(3*t))))/(0.001*(2 + cos(3*t)))**2",
        lambda t: 25 + (1 - mp.cos(mp.mpf(0.001) * (2 + mp.cos(3 * t)))) / (mp.mpf(0.001) * (2 + mp.cos(3 * t))) ** 2,
        "(1 - cos x)/x^2 of a small x",
    ),
    ("25 + sinh(1e-8*cos(3*t))*1e8", lambda t: 25 + mp.sinh(mp.mpf(1e-8) * mp.cos(3 * t)) * 10**8, "nothing cancels"),
    (
        "25 + sqrt(1e-6 + sin(t)**2)",
        lambda t: 25 + mp.sqrt(mp.mpf(1e-6) + mp.sin(t) ** 2),
        "a corner rounded over 0.001 rad",
    ),
    ("25 + 0.001*cos(t)**199", lambda t: 25 + mp.mpf(0.001) * mp.cos(t) ** 199, "a spike of the 199th power"),
)
REFUSED = (
    ("25 + log(1 + 1e-12*cos(3*t))*1e12", "it is known to 0.000444 mm only; at least 0.00178 mm", "twelve digits lost"),
    ("25 + (1 - cos(t))/t**2", "p does not close", "not periodic"),
    (
        "25 + (1 - cos(sin(t)))/sin(t)**2",
        "division by zero; where both sides of a fraction vanish, write it out",
        "0/0",
    ),
    ("25 + sin(3*(t - 1))/sin(t - 1)", "near 57.2958 degrees", "0/0"),
    ("25 + sqrt(1 - cos(t)**2)", "derivative of sqrt at zero; a whole exponent is smooth", "a kink, |sin t|"),
    ("25 + sqrt(1 - cos(t - 1)**2)", "near 57.2958 degrees", "the same between the grid's angles"),
    (
        "25 + abs(sin(3*t))**2.5",
        "at 60 degrees: fractional power of a negative number; a whole exponent",
        "p''' unbounded",
    ),
    ("25 + abs(sin(t))**3.5", "a whole exponent is smooth where what it is put on vanishes", "p'''' unbounded"),
)


SLOW = ("25 + (1 - cos(0.001*(2 + cos(3*t))))/(0.001*(2 + cos(3*t)))**2",)


def cases():
    """What finds the rows of each case, by name, in the order of the page."""
    return {
        **{text: partial(case, text, formula(exact), why) for text, exact, why in CANCELLING},
        **{text: partial(refusal, text, words, why) for text, words, why in REFUSED},
        "below-the-noise": below_the_noise,
    }


def refusal(text, words, why):
    yield Row(f"`p: {text}`".replace("|", "\\|"), "any file", refused(f"kind: support\np: {text}"), words, why)


def case(text, oracle, why):
    asked = recipe(f"kind: support\np: {text}", files="{dxf: {as: arcs}}, {dxf: {as: polyline}}")
    what = f"`p: {text}`"
    lift = designed(asked).exact.law
    found, exact = lift.derivatives(ANGLES, 1), [oracle.derivatives(mp.mpf(float(t))) for t in ANGLES]
    off = max(worst(found[k], [[row[k]] for row in exact]) for k in (0, 1))
    yield Row(what, "p and p' as a share of the rounding that is reported", off / lift.rounding, 1.0, why)
    room = 1e-14 + lift.rounding
    yield Row(
        what,
        "profile, as a share of the size",
        off_profile(asked, oracle),
        4e-13 + 40.0 * room,
        f"stated: {room:.0e} mm",
    )
    files = made(asked)
    most = max(off_file(contour, oracle, 1e-3) for contour in files.contours.values())
    yield Row(what, "files within 0.001 mm", max(most, files.used()), 1.0, "share of the tolerance, the noise included")


def below_the_noise():
    said = refused("kind: support\np: 25 + (1e9 + cos(3*t)) - 1e9", tolerance=1e-6)
    yield Row("`p: 25 + (1e9 + cos(3*t)) - 1e9`", "a file within 1e-6 mm", said, "at least 2.74e-06 mm", "as stated")


@pytest.mark.slow
@pytest.mark.parametrize("name", names(cases(), SLOW))
def test_it_holds_and_the_page_shows_it(name):
    shown_as_measured(__name__, name)


@pytest.mark.slow
def test_without_the_formulas_rounding_the_bound_would_be_false():
    """A polygon within 4e-6 mm of a noisy p: its bound must hold against the exact one, which takes in the noise."""
    asked = recipe("kind: support\np: 25 + (1e9 + cos(3*t)) - 1e9", files="{dxf: {as: arcs}}", tolerance=4e-6)
    files = made(asked)
    (file,) = files.report["files"]
    (contour,) = files.contours.values()
    assert off_file(contour, formula(lambda t: 25 + mp.cos(3 * t)), file["geometry_error"]) < 1.0
    assert file["geometry_error"] > file["measured_error"]
    assert file["geometry_error"] <= 4e-6
