"""Least radius of curvature from a thousandth of the breadth to nothing, and below; corners rounded by a nanometre."""

import math
from functools import partial

import numpy as np
import pytest
from accuracy import Row, made, names, off_file, off_motion, off_profile, recipe, shown_as_measured
from extreme_oracle import fourier, reuleaux
from support import followers

from camgeo.synthesis.design import designed
from kin.follower.support import bearing_of
from kin.law.support_function import lift_reuleaux

FORMS = "{dxf: {as: arcs}}, {dxf: {as: polyline}}, stl"


def tricorn(share):
    """Coefficient of cos 3t, of mean 25, whose least radius of curvature is a share of the breadth of 50."""
    return (25.0 - 50.0 * share) / 8.0


def harmonic(k, a, trim=False):
    return f"kind: support\nfourier: {{mean: 25, cos: {{{k}: {a!r}}}}}\nundercut: {'trim' if trim else 'refuse'}"


SLOW = (
    "swallowtails-199",
    "undercut-1e-09",
    "undercut-1e-06",
    "free-1e-06",
)


def cases():
    """What finds the rows of each case, by name, in the order of the page."""
    shares = (1e-3, 1e-6, 1e-9, 1e-12)
    return {
        **{f"free-{share:g}": partial(free, share) for share in shares},
        **{f"undercut-{share:g}": partial(undercut, share) for share in shares},
        **{f"swallowtails-{k}": partial(many, k) for k in (99, 199)},
        **{f"corners-{sides}": partial(corners, sides, r) for sides, r in ((3, 1e-6), (5, 1e-7), (99, 1e-7))},
        "corners-of-a-nanometre": sharpest,
    }


def free(share):
    a = tricorn(share)
    asked, oracle = recipe(harmonic(3, a), files=FORMS, thickness=10), fourier(25, {3: a}, {})
    what = f"p = 25 + a cos 3t, least radius {share:g} of the breadth"
    files = made(asked)
    profile = max(off_profile(asked, oracle), off_motion(designed(asked).exact.law, oracle))
    yield Row(what, "profile, p to p'''", profile, 2e-15, "trigonometric sums, no quotient: nothing cancels")
    most = max(off_file(contour, oracle, 1e-3) for contour in files.contours.values())
    yield Row(what, "files within 0.001 mm", max(most, files.used()), 1.0, "share of the tolerance, proved and judged")


def undercut(share):
    a = tricorn(-share)
    what = f"the same, least radius {-share:g} of the breadth"
    found = made(recipe(harmonic(3, a)))
    radius, cut = found.check("radius-of-curvature"), found.check("undercut-local")
    assert not radius["ok"]
    assert not cut["ok"]
    exact = 25.0 - 8.0 * a  # the doubles' own value: both factors are exact, the difference is (Sterbenz)
    text = cut["detail"].split(" would")[0].rsplit(" ", 1)[1]
    start, end = (float(cut["detail"].split(word)[1].split()[0]) for word in ("from ", "to "))
    off = max(abs(radius["value"] / exact - 1.0), abs(float(text) / -exact - 1.0))
    why = "the rounding of 25, as a share of the radius; reported with six digits"
    yield Row(what, "radius, and the base radius that would be free", off, 1e-6 + 1e-14 / share, why)
    # rho = 36 a x^2 - |rho_min| about its least value, and a swallowtail reaches sqrt 3 times its half width
    width = 2.0 * math.sqrt(3.0) * math.degrees(math.sqrt(-exact / (36.0 * a)))
    if share > 1e-7:  # below, the two angles are reported with fewer digits than they differ by
        off = abs(((end - start) % 360.0) / width - 1.0)
        yield Row(what, "extent of the undercut", off, 20.0 * share + 5e-4 / width, "to first order in the radius")
    left = made(recipe(harmonic(3, a, trim=True)))
    yield Row(what, "trimmed, within 0.001 mm", left.used(), 1.0, "integrals of speed times tangent, not points")


def many(k):
    a = 25.0 * (1.0 + 1e-9) / (k * k - 1.0)
    found = made(recipe(harmonic(k, a)))
    what = f"p = 25 + a cos {k}t, least radius -1e-9 of the mean"
    text = found.check("undercut-local")["detail"].split(" would")[0].rsplit(" ", 1)[1]
    why = f"{k} equal swallowtails, each cut off by a crossing of its own"
    yield Row(what, "the base radius that would be free", abs(float(text) / 2.5e-8 - 1.0), 1e-5, why)


def corners(sides, rounding):
    cam = f"kind: support\nreuleaux: {{sides: {sides}, breadth: 50, rounding: {rounding!r}}}"
    asked, oracle = recipe(cam, files=FORMS, thickness=10), reuleaux(sides, 50, rounding)
    what = f"Reuleaux polygon of {sides} sides, breadth 50, rounded by {rounding:g} mm"
    profile = max(off_profile(asked, oracle), off_motion(designed(asked).exact.law, oracle))
    yield Row(what, "profile, p to p'''", profile, 1e-15 * sides, "circles; p' is small beside p")
    files = made(asked)
    most = max(off_file(contour, oracle, 1e-3) for contour in files.contours.values())
    yield Row(what, "files within 0.001 mm", max(most, files.used()), 1.0, "share of the tolerance")


def sharpest():
    cam = "kind: support\nreuleaux: {sides: 3, breadth: 50, rounding: 1.0e-9}"
    files = made(recipe(cam, files="dxf"))
    off = max(f["measured_error"] for f in files.report["files"])
    why = "mm; the corner's arc is 1e-9 mm long, and its ends point anywhere within 1e-5 rad"
    yield Row("Reuleaux triangle rounded by 1e-9 mm", "the arcs of the file as judged", off, 1e-12, why)


@pytest.mark.slow
@pytest.mark.thin(5)
@pytest.mark.parametrize("name", names(cases(), SLOW))
def test_it_holds_and_the_page_shows_it(name):
    shown_as_measured(__name__, name)


def test_short_arcs_do_not_bear_beyond_their_neighbours():
    """A corner's arc whose ends point 1e-5 rad too far back once took the place of the side before it: 4.5e-9 mm."""
    contour = made(recipe("kind: support\nreuleaux: {sides: 3, breadth: 50, rounding: 1.0e-9}")).contours["case.dxf"]
    lift = lift_reuleaux(3, 50.0, 1e-9)
    assert contour.is_convex
    assert (contour.joints < -1e-6).any()
    reach = followers.flat_face(lift).judge(contour, np.zeros(1)).reach
    assert reach.worst[0] < 1e-13
    assert np.abs(bearing_of(contour).breaks).size >= 6
