"""Double rollers at their edges: D next to l^2, necks, rollers as large as the tightest bend or as small as nothing."""

import re
from functools import partial

import mpmath as mp
import numpy as np
import pytest
from accuracy import Row, in_time, made, names, off_profile, recipe, refused, shown_as_measured
from extreme_oracle import Pitch, worst
from support import followers

from camgeo.curve.curvature import least_radius
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.curve.undercut.bottleneck import narrowest_necks
from camgeo.curve.undercut.causes import causes
from camgeo.curve.undercut.pairs import Pitch as PitchCurve
from camgeo.curve.undercut.trim import remains
from camgeo.curve.undercut.undercut import undercuts
from camgeo.curve.wunderlich import PitchShape
from camgeo.synthesis.design import designed
from kin.contour.contour import Contour
from kin.follower.envelope import RollerEnvelope, TransmissionPitch
from kin.law.transmission import from_delta

ARCS = "{dxf: {as: arcs}}"
ANGLES = 2.0 * np.pi * np.mod(0.1234 + 0.6180339887498949 * np.arange(12), 1.0)


def roller(ratio, arm, radius, cos):
    return f"kind: double-roller\nratio: {ratio}\narm: {arm}\nroller_radius: {radius!r}\ndelta: {{cos: {{1: {cos!r}}}}}"


SLOW = (
    "square-less-1e-12",
    "lobes-99-1",
    "lobes-97-3",
    "flat-pair-99/97",
    "square-less-0.01",
    "undercut-by-a-small-rise-20",
)


def cases():
    """What finds the rows of each case, by name, in the order of the page."""
    rises = (("7/5", 1e-5, 0.01, 1.0), ("4/3", 1e-3, 0.01, 0.005), ("99/97", 1e-6, 0.01, 0.05))
    pairs = (("3/1", 1.0, 20.0), ("7/5", 1e-5, 0.5), ("99/97", 1e-6, 0.5))
    squares = (0.9, 0.99, 0.999999, 1.0 - 1e-12)
    lobes = ((99, 97, 1e-4), (99, 1, 1e-6), (97, 3, 1e-4), (199, 197, 1e-6))
    return {
        **{f"square-less-{1 - share:.1g}": partial(near_the_square, share) for share in squares},
        "past-the-square": past_the_square,
        **{f"small-rise-{one[0]}": partial(small_rise, *one) for one in rises},
        **{f"undercut-by-a-small-rise-{radius:g}": partial(undercut_by_small_rise, radius) for radius in (0.5, 20.0)},
        "crosses-itself": crosses_itself,
        **{f"flat-pair-{one[0]}": partial(flat_pair, *one) for one in pairs},
        **{f"needle-{thin:g}": partial(needle, thin) for thin in (1e-3, 1e-6, 1e-9, 1e-12)},
        "needle-too-thin": too_thin,
        **{f"lobes-{one[0]}-{one[1]}": partial(many_lobes, *one) for one in lobes},
        "tightest": tightest,
        **{f"roller-{radius:g}": partial(small_roller, radius) for radius in (1e-3, 1e-6, 1e-9)},
        "concave-arcs": arcs,
    }


def motion_off(law, oracle, angles):
    """Greatest error of psi at a polar angle; and of the shaft angle that is exact where phi was solved for; rad."""
    exact = [oracle.motion(t) for t in angles]
    phi, psi = law.at(angles, 0)
    at = law.parameter(np.array([float(one[0]) for one in exact]))
    back = max(abs(float(oracle.motion(t)[0] - mp.mpf(float(one[0])))) for t, one in zip(at, exact, strict=True))
    return max(worst(phi[0], [[one[0]] for one in exact]), worst(psi[0], [[one[1]] for one in exact])), back


def near_the_square(share):
    """Booth's lemniscate, m^2 = share of l^2: with ever less of it the pitch curve folds into two circles."""
    cos = 1600.0 * share
    law, oracle = from_delta(2, 1, 40.0, {1: cos}, {}), Pitch(2, 1, 40.0, {1: cos}, 1.0)
    what = f"D = m^2 cos 2t, 1 - m^2/l^2 = {1 - share:.1g}"
    off, back = motion_off(law, oracle, ANGLES)
    yield Row(what, "phi and psi, rad", off, 3e-15, "l^2 - D and l^2 + D are formed without a difference")
    yield Row(
        what, "the shaft angle solved for, rad", back, 3e-15, "psi itself leaps: psi'(phi) has no bound as m nears l"
    )
    envelope = RollerEnvelope(TransmissionPitch(law), 1.0)
    frames = [oracle.frame(t) for t in ANGLES]
    points = worst(envelope.points(ANGLES), [f[0] for f in frames]) / 80.0
    yield Row(what, "the judge's contour, roller of 1 mm, share of the size", points, 1e-14, "from r, r' and r''")
    if share < 0.999:
        files = made(recipe(roller(2, 40, 1.0, cos), files=ARCS))
        yield Row(what, "file within 0.001 mm", files.used(), 1.0, "share of the tolerance")
    if 0.95 < share < 0.9999999:
        half = float(40 * mp.sqrt(2 * (1 - mp.mpf(cos) / 1600)))
        (neck,) = narrowest_necks(PitchCurve(Curve.whole(PitchShape(law))), 1.001 * half)
        yield Row(what, "half the waist, proved the narrowest", abs(neck.half / half - 1.0), 1e-10, "1e-14 of the arm")
    if share > 0.9999999:
        said = re.sub(r"[0-9.]+(e[-+]\d+)?", "#", refused(roller(2, 40, 1.0, cos), files=ARCS))
        yield Row(
            what, "file, roller of 1 mm", said, "be proved", "the fold is bent to 3e-17 mm, far below points' rounding"
        )


def small_rise(ratio, rise, over, radius):
    """A rise and a return of so many degrees over so many, at rest between; lambda to and fro in a turn."""
    cam, rest = to_and_fro("double-roller", ratio, rise, over, f"roller_radius: {radius}")
    design = designed(recipe(cam, files=ARCS))
    off = max(0.0 if check.ok else 1.0 for check in design.checks)
    what = f"law of {rise:g} degrees over {over:g}, lambda/mu = {ratio}, roller of {radius:g} mm"
    yield Row(what, "checks that fail", off, 0.0, "directions by cell: a rise hardly turns the tangent, however bent")
    yield law_row(what, design.exact.law, rise, over, rest)


def crosses_itself():
    said = refused("kind: double-roller\nratio: 99/98\narm: 60\nroller_radius: 1\ndelta: {cos: {1: 1}}", files=ARCS)
    yield Row("lambda/mu = 99/98", "file", said, "mu must be odd", "the pitch curve would cross itself")


def undercut_by_small_rise(radius):
    """A rise of a thousandth of a degree in a hundredth, on rollers that pass over it: where contact is lost."""
    cam, _ = to_and_fro("double-roller", "7/5", 1e-3, 0.01, f"roller_radius: {radius}")
    with in_time(20):
        curve = recipe(cam, files=ARCS).cam.exact().surfaces[0].curve
        lost = remains(curve, causes(curve)).lost
    corners = np.concatenate([one.corners for one in lost])
    ends = PitchCurve.of(curve).curve.sample(np.array([[one.start, one.end] for one in lost]).ravel()).point
    off = np.abs(np.hypot(*(ends - np.repeat(corners, 2, axis=0)).T) - radius).max() / radius
    yield Row(
        f"law of 0.001 degrees over 0.01, lambda/mu = 7/5, roller of {radius:g} mm",
        f"corners of all {len(lost)} lost stretches, from the rollers that make them, share of the radius",
        float(off),
        1e-12,
        "paths that swing are integrated in panels, or given by their ends",
    )


def to_and_fro(kind, ratio, rise, over, more=""):
    """Lines of a cam whose follower rises and returns over so many degrees each, and how long it rests between."""
    rest = 90.0 / int(ratio.split("/")[0]) - over
    turn = ", ".join(f"{{{way}: {rise!r}, over: {over}, law: cycloidal}}, {{dwell: {rest!r}}}" for way in DIRECTIONS)
    return f"kind: {kind}\nratio: {ratio}\narm: 60\n{more}\nlaw: [{turn}]", rest


DIRECTIONS = ("rise", "return")


def law_row(what, law, psi, over, rest):
    """Error of psi(phi) in its rises and returns as a share of its swing of psi degrees, against 50 digits (W 4.9)."""
    degree = mp.pi / 180
    width, begin = mp.mpf(over) * degree, [mp.mpf(0), (mp.mpf(over) + mp.mpf(rest)) * degree]
    swing, off = mp.mpf(psi) * degree, mp.mpf(0)
    for share in np.linspace(0.05, 0.95, 7):
        for down in (0, 1):
            phi = float(begin[down] + mp.mpf(float(share)) * width)
            u = (mp.mpf(phi) - begin[down]) / width
            s = u - mp.sin(2 * mp.pi * u) / (2 * mp.pi)
            exact = swing * (1 - s if down else s)
            image = mp.mpf(phi) - exact + mp.pi / law.lam
            for at, wanted in ((mp.mpf(phi), exact), (image, -exact)):
                shaft = float(at)
                # the angle itself is rounded: psi' times that
                slope = float(law.psi_of_shaft(shaft, 1)[1, 0])
                found = mp.mpf(float(law.psi_of_shaft(shaft, 0)[0, 0]))
                off = max(off, abs(found - wanted - slope * (mp.mpf(shaft) - at)))
    why = "angles are doubles: their rounding over the width of the rise"
    return Row(what, "psi over the shaft angle, share of the swing", float(off / swing), 1e-10, why)


def flat_pair(ratio, rise, over):
    """Two faces that hold the cam: laws of small rises with many lobes."""
    cam, rest = to_and_fro("flat-pair", ratio, rise, over)
    files = made(recipe(cam, files=ARCS))
    what = f"flat pair, law of {rise:g} degrees over {over:g}, lambda/mu = {ratio}"
    yield Row(what, "file within 0.001 mm", files.used(), 1.0, "share of the tolerance")
    yield law_row(what, designed(recipe(cam, files=ARCS)).exact.law, 2.0 * rise, over, rest)


def needle(thin):
    """Two faces that hold an ellipse that is almost a needle."""
    cos = 1600.0 * (1.0 - thin)
    cam = f"kind: flat-pair\nratio: 2\narm: 40\ndelta: {{cos: {{1: {cos!r}}}}}"
    what = f"flat pair, D = m^2 cos 2t, 1 - m^2/l^2 = {thin:g}: an ellipse"
    design = designed(recipe(cam, files=ARCS))
    told = {check.name: check.value for check in design.checks}
    a2, b2 = 2 * (1600 + mp.mpf(cos)), 2 * (1600 - mp.mpf(cos))
    off = float(abs(told["radius-of-curvature"] - b2 / mp.sqrt(a2))) / 80.0
    yield Row(what, "least radius of curvature, share of the size", off, 1e-15, "r + r'', r without psi")
    closes = told["closing-equation"] / 80.0
    yield Row(
        what,
        "closing equation, share of the size",
        closes,
        2e-15,
        "at a polar angle, over which psi' stays below 2",
    )
    if thin > 1e-7:
        files = made(recipe(cam, files=ARCS))
    if thin > 1e-5:
        yield Row(what, "file within 0.001 mm", files.used(), 1.0, "share of the tolerance")
    elif thin > 1e-7:
        said = "; ".join(check["detail"] for check in files.failed)
        yield Row(what, "file", said, "extremes cannot be resolved", "psi'(phi) comes to 2e6, and rounding with it")


def too_thin():
    said = refused(f"kind: flat-pair\nratio: 2\narm: 40\ndelta: {{cos: {{1: {1600.0 * (1 - 1e-15)!r}}}}}", files=ARCS)
    yield Row(
        "flat pair, D = m^2 cos 2t, 1 - m^2/l^2 = 1e-15", "file", said, "rounding does not tell apart", "as it says"
    )


def past_the_square():
    for over in (0.0, 1e-12, 1e-9):
        said = refused(roller(2, 40, 1.0, 1600.0 * (1.0 + over)), files=ARCS)
        yield Row(
            f"D = m^2 cos 2t, m^2/l^2 - 1 = {over:g}", "file", said, "must stay below l^2 = 1600 mm^2", "no motion"
        )
    said = refused(roller("4/3", 40, 1.0, 1600.0 * (1.0 - 1e-12)), files=ARCS)
    yield Row(
        "the same with lambda/mu = 4/3, 1 - m^2/l^2 = 1e-12",
        "file",
        said,
        "below 45 is possible",
        "an arm meets the shaft first",
    )


def many_lobes(lam, mu, share):
    cos = 3600.0 * share
    radius = 0.05
    # beside so small a swing no limit follows from the tolerance
    asked = recipe(roller(f"{lam}/{mu}", 60, radius, cos), files=ARCS, motion_error=0.02)
    oracle = Pitch(lam, mu, 60.0, {1: cos}, radius)
    what = f"lambda/mu = {lam}/{mu}, m^2/l^2 = {share:g}"
    profile = off_profile(asked, oracle, ANGLES)
    yield Row(what, "profile", profile, 2e-14 * lam, "the angle lambda t is rounded, and r small beside l")
    law = designed(asked).exact.law
    yield Row(what, "phi and psi, rad", max(motion_off(law, oracle, ANGLES)), 2e-16 * lam, "the same")
    files = made(asked)
    yield Row(what, "file within 0.001 mm", files.used(), 1.0, "share of the tolerance")


def exact_least_radius():
    """Of the pitch curve D = 625 cos 4t, lambda/mu = 4/3, l = 60: in 50 digits, by golden sections."""
    oracle = Pitch(4, 3, 60.0, {1: 625.0}, 0.0)
    t = np.linspace(0.0, np.pi / 2, 201)
    rho = [oracle.frame(x)[2] for x in t]
    middle = t[min(range(201), key=lambda i: rho[i] if rho[i] > 0 else mp.inf)]
    low, high = mp.mpf(float(middle)) - mp.mpf("0.01"), mp.mpf(float(middle)) + mp.mpf("0.01")

    def f(x):
        return Exact.radius(oracle, x)

    g = (mp.sqrt(5) - 1) / 2
    for _ in range(70):
        a, b = high - g * (high - low), low + g * (high - low)
        low, high = (low, b) if f(a) < f(b) else (a, high)
    return float(f((low + high) / 2))


class Exact:
    """The radius of curvature of the pitch curve at an mpmath angle."""

    @staticmethod
    def radius(oracle, t):
        r, slope, bend = (c * mp.factorial(k) for k, c in enumerate(mp.taylor(oracle.distance, t, 2)))
        return (r * r + slope * slope) ** mp.mpf(1.5) / (r * r + 2 * slope * slope - r * bend)


def tightest():
    least = exact_least_radius()
    for off in (-1e-9, 1e-9):
        radius = least * (1.0 + off)
        what = f"roller {abs(off):g} {'smaller' if off < 0 else 'larger'} than the least radius of curvature"
        found = made(recipe(roller("4/3", 60, radius, 625.0), files=ARCS))
        if off < 0:
            yield Row(what, "file within 0.001 mm", found.used(), 1.0, "share of the tolerance; free of undercut")
            continue
        told = found.check("pitch-radius")["value"]
        yield Row(
            what,
            "least radius, undercut reported",
            abs(told / least - 1.0),
            1e-13,
            "root-found, bounded to 1e-12 of the size",
        )
        assert not found.check("undercut-local")["ok"]


def small_roller(radius):
    found = made(recipe(roller(2, 40, radius, 400.0), files=f"{ARCS}, stl", thickness=10))
    what = f"roller of {radius:g} mm on arms of 40 mm"
    yield Row(
        what, "files within 0.001 mm, judged by contact", found.used(), 1.0, "crossings asked of the smaller circle"
    )


def arcs():
    for lam, mu in (("3", "1"), ("2", "1")):
        arc = "arc: {radius: 1e6, side: concave}"
        cam = f"kind: double-roller\nratio: {lam}/{mu}\narm: 60\nroller_radius: 1\n{arc}"
        said = refused(cam, files=ARCS)
        yield Row(
            f"concave arc, {lam}/{mu}",
            "file",
            said,
            "a concave arc of any radius more",
            "a whole ratio",
        )


@pytest.mark.slow
@pytest.mark.parametrize("name", names(cases(), SLOW))
def test_it_holds_and_the_page_shows_it(name):
    shown_as_measured(__name__, name)


@pytest.mark.thin(2)
@pytest.mark.parametrize("share", [0.9, 0.99, 0.995])
def test_feet_across_a_fold(share):
    """Points of the contour itself lie on it: seen from the other side of the fold they once lay 8.6 mm outside."""
    envelope = RollerEnvelope(TransmissionPitch(from_delta(2, 1, 40.0, {1: 1600.0 * share}, {})), 1.0)
    with in_time(20):
        feet = envelope.feet(envelope.points(np.linspace(0.0, 2.0 * np.pi, 2001)))
    assert np.abs(feet.excess).max() < 1e-10


@pytest.mark.parametrize("radius", [1e-4, 1e-6, 1e-9])
def test_a_small_roller_meets_every_corner(radius):
    """A square of arcs hardly larger than rounding: at the angles at which the roller stands on a corner."""
    law = from_delta(2, 1, 40.0, {1: 400.0}, {})
    pitch = TransmissionPitch(law)
    tau = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
    contour = Contour.from_vertices(RollerEnvelope(pitch, radius).points(tau))
    phi, psi = law.at(tau, 0)
    found = followers.resting(followers.double_roller(law, radius), contour, phi[0])
    assert np.abs(found - psi[0]).max() < 1e-3
    assert np.abs(found[0] - psi[0]).max() < 1e-9 + 1e-2 * radius


@pytest.mark.slow
def test_a_hair_too_large_a_roller_on_many_lobes():
    """168 hollows and crests, each crest with a swallowtail of its own, far below what any point could show."""
    pitch = PitchShape(from_delta(8, 5, 60.0, {21: 1.408}, {}))
    least, _ = least_radius(Curve.whole(pitch))
    with in_time(40):
        found = undercuts(Curve.whole(Parallel(pitch, least * (1.0 + 1e-9))))
    assert [one.kind for one in found] == ["local"] * 168
    assert [one.free_at for one in found] == pytest.approx([least] * 168, rel=1e-12)
    assert np.diff([one.start for one in found]) == pytest.approx([2.0 * np.pi / 168] * 167, abs=1e-9)
