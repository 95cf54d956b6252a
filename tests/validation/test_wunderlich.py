"""W. Wunderlich, Single-disk cam mechanisms with oscillating double roller follower, Mech. Mach. Theory 19, 1984 (W).

The pitch curve is rebuilt from the exported file: points of its arcs moved outward by the roller's radius. On it the
closing equation (7.1), the closing chord polygon (section 6) and Booth's lemniscate (6.3) are measured; on the flat
pairs' files the isoptic circle (section 5). The limits are found by bisection through the product's own checks.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from support import followers
from support.page_tables import Row

from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.law.normalised import IntentError

PI = np.pi
DOUBLE_ROLLERS = ("w-booth", "w-figure-5", "w-figure-9", "w-law", "w-rosette")
CONVEX = {"4/3": (0.0558, 5e-5), "5/3": (0.0619, 5e-5), "3": (0.575, 5e-4), "4": (0.423, 5e-4)}
ARM = 60.0


@dataclass(frozen=True)
class Pitch:
    """r over the polar angle from points of the pitch curve; alpha and the chord 2 l sin(alpha) with it."""

    t: np.ndarray
    r: np.ndarray
    alpha: float
    arm: float
    steps: int

    @classmethod
    def of(cls, made):
        cam = made.recipe.cam
        point, normal = made.normal_samples
        point = point + cam.roller_radius * normal
        t = np.mod(np.arctan2(point[:, 1], point[:, 0]), 2 * PI)
        order = np.argsort(t)
        return cls(t[order], np.hypot(*point.T)[order], PI * cam.mu / cam.lam, cam.arm, 2 * cam.lam)

    def radius(self, t):
        return np.interp(t, self.t, self.r, period=2 * PI)

    def point(self, t):
        return self.radius(t)[:, None] * np.column_stack([np.cos(t), np.sin(t)])

    def closing(self, t):
        """Chord from t to t + alpha less 2 l sin(alpha), mm: equation 7.1 as a length."""
        r, other = self.radius(t), self.radius(t + self.alpha)
        chord = np.sqrt(r**2 + other**2 - 2 * r * other * np.cos(self.alpha))
        return chord - 2 * self.arm * np.sin(self.alpha)

    def stepped(self, t):
        """Polar angle of the next corner of the chord polygon: where a chord of 2 l sin(alpha) ends, by bisection."""
        start, length = self.point(t), 2 * self.arm * np.sin(self.alpha)
        low, high = t + self.alpha - 0.005, t + self.alpha + 0.005
        grows = np.hypot(*(self.point(high) - start).T) > np.hypot(*(self.point(low) - start).T)
        for _ in range(45):
            middle = (low + high) / 2
            before = (np.hypot(*(self.point(middle) - start).T) < length) == grows
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return low

    def slant(self, t):
        """How fast a chord grows as its end moves along the curve: cosine of the angle between the two."""
        start, step = self.point(t), 1e-3
        back, ahead = (self.point(t + self.alpha + h) for h in (-step, step))
        growth = np.hypot(*(ahead - start).T) - np.hypot(*(back - start).T)
        return np.abs(growth) / np.hypot(*(ahead - back).T)

    def gaps(self, count=301):
        """Distance between start and end of the polygon after 2 lambda chords, mm, for starts all round.

        Left out are starts from which some chord meets the curve at more than 75 degrees: there its end is ill defined,
        as two ends lie close together.
        """
        start = np.linspace(0, 2 * PI, count, endpoint=False)
        clear = [self.slant(start + k * self.alpha) > np.cos(np.radians(75)) for k in range(self.steps)]
        start = start[np.all(clear, axis=0)]
        assert start.size >= count / 4
        t = start
        for _ in range(self.steps):
            t = self.stepped(t)
        return np.hypot(*(self.point(t) - self.point(start)).T)


def flat_pair(ratio, share):
    return read(
        f"cam: {{kind: flat-pair, ratio: {ratio}, arm: {ARM}, delta: {{cos: {{1: {share * ARM**2!r}}}}}}}\n".encode(),
        "pair.yaml",
    )


def convex(ratio, share):
    """Whether the product calls the flat pair's cam with D = share l^2 cos(lambda t) sound."""
    checks = designed(flat_pair(ratio, share)).checks
    return next(c.ok for c in checks if c.name == "radius-of-curvature")


def turns(ratio, share):
    """Whether the product accepts the double roller's law with D = share l^2 cos(lambda t)."""
    route = f"delta: {{cos: {{1: {share * ARM**2!r}}}}}"
    cam = f"{{kind: double-roller, ratio: {ratio}, arm: {ARM}, roller_radius: 1, {route}}}"
    try:
        read(f"cam: {cam}\n".encode(), "law.yaml").cam.exact()
    except IntentError:
        return False
    return True


def oval(share):
    """Whether the pitch curve of Booth's lemniscate with m^2 = share l^2 is convex: its tangent turns one way."""
    cam = f"{{kind: double-roller, ratio: 2, arm: {ARM}, roller_radius: 1, delta: {{cos: {{1: {share * ARM**2!r}}}}}}}"
    base = designed(read(f"cam: {cam}\n".encode(), "booth.yaml")).only_surface.surface.base
    return base.sample(np.array([PI / 2])).turn[0] > 0 and base.sample(np.linspace(0, 2 * PI, 721)).turn.min() > 0


def bisected(test, low, high, steps):
    """Share between low, where test holds, and high, where it does not."""
    assert test(low)
    assert not test(high)
    for _ in range(steps):
        middle = (low + high) / 2
        low, high = (middle, high) if test(middle) else (low, middle)
    return (low + high) / 2


def convex_limit(lam, mu):
    """m^2/l^2 at which r + r'' first touches 0: W 5.10 with D = x cos(lambda t) and l = 1, differentiated by hand."""
    alpha = PI * mu / lam
    a, b = np.cos(PI / 4 - alpha / 2), np.sin(PI / 4 - alpha / 2)
    c, s = np.cos(np.linspace(0, 2 * PI, 20_001)), np.sin(np.linspace(0, 2 * PI, 20_001))

    def least(x):
        d, d1, d2 = x * c, -lam * x * s, -lam * lam * x * c
        up, down = np.sqrt(1 + d), np.sqrt(1 - d)
        second = a * (d2 / (2 * up) - d1**2 / (4 * up**3)) + b * (-d2 / (2 * down) - d1**2 / (4 * down**3))
        return (a * up + b * down + second).min()

    return bisected(lambda x: least(x) > 0, 0.0, 0.9, 40)


def isoptic_radii(contour, alpha, count=721):
    """Distance from the shaft of the corner between two faces that touch the contour at pi - alpha, mm."""
    t = np.linspace(0, 2 * PI, count)
    p, q = contour.support(t).q, contour.support(t + alpha).q
    return np.sqrt(p**2 + q**2 - 2 * p * q * np.cos(alpha)) / np.sin(alpha)


def farthest(values, wanted):
    return values[np.abs(values - wanted).argmax()]


def three(workshop):
    return workshop.written(
        "pair-three", "cam: {kind: flat-pair, ratio: 3, arm: 30, delta: {cos: {1: 450}}}\nexport: {tolerance: 0.001}\n"
    )


def rows(workshop):
    found = []
    t = np.linspace(0, 2 * PI, 3601)
    for name in DOUBLE_ROLLERS:
        made = workshop.shipped(name)
        e, pitch = made.recipe.export.tolerance, Pitch.of(made)
        found += [
            Row(
                f"chord from t to t + α less 2 l sin α, {name}, mm",
                "W 7.1",
                "0",
                0.0,
                np.abs(pitch.closing(t)).max(),
                3 * e,
                ".1e",
            ),
            Row(
                f"gap of the chord polygon after {pitch.steps} steps, {name}, mm",
                "W section 6",
                "0",
                0.0,
                pitch.gaps().max(),
                4 * pitch.steps * e,
                ".1e",
            ),
        ]
    made = workshop.shipped("w-booth")
    radius = Pitch.of(made).radius(t)
    ellipse, triple = workshop.shipped("w-ellipse", "spline"), three(workshop)
    least, most = ellipse.contour.support(np.array([PI / 2, 0.0])).q
    found += [
        Row(
            "√(2(l² + m² cos 2t)) less r of the file, w-booth, mm",
            "W 6.3, Figure 8",
            "0",
            0.0,
            np.abs(np.sqrt(2 * (1600 + 400 * np.cos(2 * t))) - radius).max(),
            1.1e-3,
            ".1e",
        ),
        Row(
            "m²/l² up to which Booth's lemniscate is an oval",
            "W section 6",
            "1/3",
            1 / 3,
            bisected(oval, 0.3, 0.4, 22),
            1e-7,
        ),
        Row("semi-axes of w-ellipse: √(l² + m²), mm", "W section 5, Goldberg", "48", 48.0, most, 1e-3, ".7g"),
        Row("semi-axes of w-ellipse: √(l² - m²), mm", "W section 5, Goldberg", "36", 36.0, least, 1e-3, ".7g"),
        Row(
            "orthoptic circle of w-ellipse, √(a² + b²) = 2 l, mm",
            "Monge; W section 5",
            "60",
            60.0,
            farthest(isoptic_radii(ellipse.contour, PI / 2), 60.0),
            2e-3,
            ".8g",
        ),
        Row(
            "isoptic circle of a flat pair, λ/μ = 3, 2 l, mm",
            "W section 5",
            "60",
            60.0,
            farthest(isoptic_radii(triple.contour, PI / 3), 60.0),
            4e-3,
            ".8g",
        ),
    ]
    for ratio, (value, within) in CONVEX.items():
        ours = bisected(lambda share, ratio=ratio: convex(ratio, share), value - 2 * within, value + 2 * within, 8)
        found.append(
            Row(
                f"m²/l² up to which the flat pair's cam is convex, λ/μ = {ratio}",
                "r + r'' > 0, by hand",
                f"{value}",
                value,
                ours,
                within,
                ".4g",
            )
        )
    for ratio, lam in (("3", 3), ("4", 4), ("4/3", 4), ("5/3", 5)):
        ours = bisected(lambda share, ratio=ratio: turns(ratio, share), 1 / lam, 2.5 / lam, 22)
        found.append(
            Row(
                f"m²/l² up to which the cam can be turned through, λ/μ = {ratio}",
                "ψ' < 1: 2/λ",
                f"2/{lam}",
                2 / lam,
                ours,
                1e-6,
                ".7g",
            )
        )
    nine = workshop.shipped("w-figure-9")
    swing = np.degrees(np.arcsin(625 / 3600))
    contact = followers.resting(nine.design.exact.gauge, nine.contour, t)
    found += [
        Row(
            "swing of w-figure-9, asin(m²/l²), deg (CSV)",
            "D = -l² sin ψ",
            f"{swing:.7g}",
            swing,
            nine.motion["follower_deg"].max(),
            1e-5,
            ".7g",
        ),
        Row(
            "swing of w-figure-9 by contact with the file, deg",
            "D = -l² sin ψ",
            f"{swing:.7g}",
            swing,
            np.degrees(contact.max()),
            3e-3,
            ".7g",
        ),
    ]
    return found


@pytest.fixture(scope="module", params=DOUBLE_ROLLERS)
def pitch(request, workshop):
    return Pitch.of(workshop.shipped(request.param)), 0.001


@pytest.fixture(scope="module")
def figure_8(workshop):
    """Booth's lemniscate, l = 40, m = 20."""
    return workshop.shipped("w-booth")


@pytest.fixture(scope="module")
def goldberg(workshop):
    """The ellipse with a right-angled flat pair."""
    return workshop.shipped("w-ellipse", "spline")


@pytest.mark.slow
def test_equation_7_1_on_the_file(pitch):
    curve, e = pitch
    assert np.abs(curve.closing(np.linspace(0, 2 * PI, 3601))).max() <= 3 * e


@pytest.mark.slow
def test_section_6_chord_polygon_closes_from_any_start(pitch):
    curve, e = pitch
    # each chord may add e / cos(75 deg)
    assert curve.gaps().max() <= 4 * curve.steps * e


@pytest.mark.slow
def test_chords_of_another_length_do_not_close(figure_8):
    curve = Pitch.of(figure_8)
    longer = Pitch(curve.t, curve.r * (1 - 1e-3), curve.alpha, curve.arm, curve.steps)
    assert longer.gaps().max() > 0.05


def test_a_bump_breaks_the_closing_equation(figure_8):
    curve = Pitch.of(figure_8)
    bumped = Pitch(curve.t, curve.r + 0.02 * (np.abs(curve.t - 1.0) < 0.1), curve.alpha, curve.arm, curve.steps)
    assert np.abs(bumped.closing(np.linspace(0, 2 * PI, 3601))).max() > 5e-3


def test_equation_6_3_quartic_on_the_file(figure_8):
    """(x^2 + y^2)^2 = 2(l^2 + m^2) x^2 + 2(l^2 - m^2) y^2, as a distance to first order."""
    point, normal = figure_8.normal_samples
    x, y = (point + 8.0 * normal).T
    r2 = x * x + y * y
    f = r2**2 - 2 * 2000 * x * x - 2 * 1200 * y * y
    slope = np.hypot(4 * x * r2 - 8000 * x, 4 * y * r2 - 4800 * y)
    assert (np.abs(f) / slope).max() <= 1.01e-3


@pytest.mark.slow
@pytest.mark.parametrize(("share", "is_oval"), [(0.32, True), (0.345, False)])
def test_oval_limit_on_the_file(workshop, share, is_oval):
    """The cam is the parallel curve of the lemniscate: convex with it."""
    text = f"""
cam: {{kind: double-roller, ratio: 2, arm: 40, roller_radius: 8, delta: {{cos: {{1: {1600 * share}}}}}}}
export: {{tolerance: 0.0001}}
"""
    assert workshop.written(f"booth-{share}", text).contour.is_convex is is_oval


@pytest.mark.slow
def test_ellipse_of_the_file(goldberg):
    """x^2/48^2 + y^2/36^2 = 1 within the tolerance, to first order."""
    x, y = goldberg.contour.sample(100).T
    f = (x / 48) ** 2 + (y / 36) ** 2 - 1
    assert (np.abs(f) / np.hypot(2 * x / 48**2, 2 * y / 36**2)).max() <= 1.01e-3


@pytest.mark.slow
def test_isoptic_circles(workshop, goldberg):
    assert isoptic_radii(goldberg.contour, PI / 2) == pytest.approx(np.full(721, 60.0), abs=2e-3)
    assert isoptic_radii(three(workshop).contour, PI / 3) == pytest.approx(np.full(721, 60.0), abs=4e-3)
    # another angle gives no circle
    assert np.ptp(isoptic_radii(goldberg.contour, PI / 2 + 0.05)) > 0.1


@pytest.mark.slow
@pytest.mark.parametrize("ratio", sorted(CONVEX))
def test_convexity_limit(ratio):
    value, within = CONVEX[ratio]
    lam, _, mu = ratio.partition("/")
    exact = convex_limit(int(lam), int(mu or 1))
    assert exact == pytest.approx(value, abs=within)
    assert convex(ratio, exact * (1 - 1e-4))
    assert not convex(ratio, exact * (1 + 1e-4))


def test_equation_5_10_wants_delta_below_the_arm_squared():
    with pytest.raises(RecipeErrors, match=r"\|D\| must stay below"):
        designed(
            read(
                b"cam: {kind: double-roller, ratio: 2, arm: 60, roller_radius: 1, delta: {cos: {1: 3601}}}", "wide.yaml"
            )
        )


def test_figure_9_angles():
    """n = 4/3: alpha = 135 degrees, sigma = -22.5 degrees, a = 0.924, b = -0.383 as printed in section 6."""
    alpha = PI * 3 / 4
    assert np.cos(PI / 4 - alpha / 2) == pytest.approx(0.924, abs=5e-4)
    assert np.sin(PI / 4 - alpha / 2) == pytest.approx(-0.383, abs=5e-4)


@pytest.mark.slow
def test_figure_9_curve_is_equation_5_10(workshop):
    curve = Pitch.of(workshop.shipped("w-figure-9"))
    t = np.linspace(0, 2 * PI, 3601)
    d = 625 * np.cos(4 * t)
    wanted = np.sqrt(2) * (np.cos(PI / 8) * np.sqrt(3600 + d) - np.sin(PI / 8) * np.sqrt(3600 - d))
    assert np.abs(curve.radius(t) - wanted).max() <= 1.4e-3


def test_figure_5_first_arc(workshop):
    """The first arc of the pitch curve, t in [0, 60] degrees, is a circle of radius 75 in the file."""
    made = workshop.shipped("w-figure-5")
    point, normal = made.normal_samples
    point = point + 8.0 * normal
    t = np.degrees(np.arctan2(point[:, 1], point[:, 0]))
    x, y = point[(t > 0.1) & (t < 59.9)].T
    solution, *_ = np.linalg.lstsq(np.column_stack([2 * x, 2 * y, np.ones_like(x)]), x * x + y * y, rcond=None)
    assert np.sqrt(solution[2] + solution[0] ** 2 + solution[1] ** 2) == pytest.approx(75.0, abs=1e-6)
    assert np.degrees(np.arctan2(solution[1], solution[0])) == pytest.approx(30.0, abs=1e-6)


@pytest.mark.slow
def test_equation_4_9_symmetry_of_a_law_by_contact_with_the_file(workshop):
    """(phi, psi) -> (phi - psi + delta, -psi)."""
    made = workshop.shipped("w-law")
    follower = made.design.exact.gauge
    phi = np.linspace(0, PI / 2, 181)
    psi = followers.resting(follower, made.contour, phi).mean(axis=0)
    image = followers.resting(follower, made.contour, phi - psi + PI / 2).mean(axis=0)
    assert image == pytest.approx(-psi, abs=2e-4)
    assert np.ptp(psi) > 0.1
