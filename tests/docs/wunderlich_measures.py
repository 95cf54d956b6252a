"""What Wunderlich 1984 (W) says of his cams, measured on the recipes: residuals of his equations, by numpy and kin."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from support.pages import along, origin, overlaid
from support.places import RECIPES

import camgeo
from kin.linkage.dyad import RRR
from kin.numeric.elementary import Jet

if TYPE_CHECKING:
    from camgeo.api.design import Design

PI, TURN = np.pi, 2 * np.pi
FINE = np.linspace(0.0, TURN, 7201)
SOME = np.linspace(0.013, TURN, 97)
POLAR = np.linspace(0.02, 6.3, 83)


@dataclass(frozen=True, eq=False)
class Pair:
    """A recipe's cam with what W calls its parts."""

    design: Design
    arm: float
    lam: int
    mu: int
    roller: float

    @property
    def alpha(self):
        return PI * self.mu / self.lam

    @property
    def delta(self):
        return PI / self.lam

    def psi(self, phi):
        """psi over the shaft angle; the motion of a flat pair is half of it."""
        return self.design.motion(np.asarray(phi)) * (1.0 if self.roller else 2.0)

    def polar(self, phi):
        """t and r of A's place on the pitch curve (W 4.10)."""
        half = 0.5 * (self.psi(phi) + self.alpha)
        return phi - half, 2 * self.arm * np.cos(half)

    def radius(self, t):
        """r over the polar angle t, by Newton's method on the shaft angle."""
        phi = np.asarray(t) + 0.5 * self.alpha
        for _ in range(30):
            here, r = self.polar(phi)
            if np.abs(here - t).max() < 1e-13:
                return r
            slope = 1 - 0.5 * self.design.motion(phi, derivative=1) * (1.0 if self.roller else 2.0)
            phi = phi - (here - t) / slope
        assert np.abs(here - t).max() < 1e-12
        return self.polar(phi)[1]

    def end(self, phi, side):
        """A (side -1) or B (1) from the pivot's place and the arm's direction, (n, 2)."""
        return self.arm * (unit(phi) + unit(phi - self.psi(phi) + side * self.alpha))

    def chain(self, phi, count):
        """Shaft angles of adjacent positions, (count, n): W 4.6."""
        found = [np.asarray(phi)]
        while len(found) < count:
            found.append(found[-1] - self.psi(found[-1]) + self.alpha)
        return np.array(found)


def unit(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


@cache
def pair(name) -> Pair:
    source = RECIPES / f"{name}.yaml" if name != "three-faced" else THREE
    design = camgeo.design(camgeo.load(source))
    cam: Any = design.recipe.cam
    flat = cam.kind == "flat-pair"
    return Pair(design, cam.arm, cam.lam, cam.mu, 0.0 if flat else cam.roller_radius)


THREE = "name: three-faced\ncam: {kind: flat-pair, ratio: 3, arm: 30, delta: {cos: {1: 450}}}\n"
ROLLERS = ("w-booth", "w-figure-5", "w-figure-9", "w-law", "w-rosette")


def most(values):
    return float(np.abs(values).max())


def pole_ratio(name="w-figure-9"):
    """OI:PI of the contour's normals, less dpsi:dphi, at many angles."""
    cam = pair(name)
    contour = cam.design.contour(12_000)
    tangent = np.roll(contour, -1, axis=0) - np.roll(contour, 1, axis=0)
    off = []
    for phi in np.linspace(0.1, 6.1, 25):
        a = cam.end(np.array([phi]), -1)[0]
        k = int(np.hypot(*(contour - a).T).argmin())
        # the tangent where a normal passes A, between the points about the nearest one
        lean = [float((a - contour[j % 12_000]) @ tangent[j % 12_000]) for j in (k - 1, k + 1)]
        share = lean[0] / (lean[0] - lean[1])
        across = (1 - share) * tangent[k - 1] + share * tangent[(k + 1) % 12_000]
        # I = s u(phi) on the normal through A; signed OI:PI = s/(s - l)
        s = (a @ across) / (unit(phi) @ across)
        off.append(s / (s - cam.arm) - cam.design.motion(phi, derivative=1))
    return most(np.array(off))


def parallel_off(name):
    """Distances of A and B from the contour less the roller's radius, mm; the contour is sampled."""
    cam = pair(name)
    contour = cam.design.contour(12_000)
    ends = np.concatenate([cam.end(np.linspace(0.05, 6.2, 25), side) for side in (-1, 1)])
    return most(np.array([np.hypot(*(contour - a).T).min() - cam.roller for a in ends]))


@cache
def made_pitch(name):
    """Polar angle and distance of points of the pitch curve, rebuilt from the contour and its normals, by angle."""
    cam = pair(name)
    contour = cam.design.contour(12_000)
    tangent = np.roll(contour, -1, axis=0) - np.roll(contour, 1, axis=0)
    tangent /= np.hypot(*tangent.T)[:, None]
    points = contour + cam.roller * np.column_stack([tangent[:, 1], -tangent[:, 0]])
    if cam.design.recipe.rotation == "ccw":  # drawn as the mirror image
        points = points * [1.0, -1.0]
    t = np.mod(np.arctan2(points[:, 1], points[:, 0]), TURN)
    by_angle = np.argsort(t)
    return t[by_angle], np.hypot(*points.T)[by_angle]


def made_radius(name, t):
    return np.interp(t, *made_pitch(name), period=TURN)


def chord_off(name):
    """Distance between points of the made pitch curve that O sees alpha apart, less 2 l sin(alpha), mm."""
    cam = pair(name)
    r, other = made_radius(name, POLAR), made_radius(name, POLAR + cam.alpha)
    chord = np.sqrt(r**2 + other**2 - 2 * r * other * np.cos(cam.alpha))
    return most(chord - 2 * cam.arm * np.sin(cam.alpha))


def made_law_off(name):
    """psi of the made pitch curve by W 4.4, less the motion, rad."""
    cam = pair(name)
    half = np.arccos(made_radius(name, POLAR) / (2 * cam.arm))
    return most(2 * half - cam.alpha - cam.psi(POLAR + half))


def adjacent_off(name):
    """B of a position, and A of the next one, mm; psi + psi' there, rad."""
    cam = pair(name)
    one, two = cam.chain(SOME, 2)
    return most(cam.end(one, 1) - cam.end(two, -1)), most(cam.psi(one) + cam.psi(two))


def rotation_off(name):
    """r, phi and psi after two steps: as before, 2 alpha on (W 4.2, 4.7)."""
    cam = pair(name)
    phi = cam.chain(SOME, 3)[2]
    return max(most(phi - SOME - 2 * cam.alpha), most(cam.psi(phi) - cam.psi(SOME)))


def chain_off(name):
    """Gap of the chord polygon after 2 lambda steps, mm."""
    cam = pair(name)
    phi = cam.chain(SOME, 2 * cam.lam + 1)
    return most(cam.end(phi[-1], -1) - cam.end(phi[0], -1))


def closing_off(name):
    """Left side of W 7.1 less its right one, over l^2, with r read off at t and t + alpha."""
    cam = pair(name)
    t = POLAR
    r, other = cam.radius(t), cam.radius(t + cam.alpha)
    left = r**2 + other**2 - 2 * r * other * np.cos(cam.alpha)
    return most(left / cam.arm**2 - 4 * np.sin(cam.alpha) ** 2)


def image_off(name):
    """r at t + alpha less W 4.3 with the sine outside of the root, mm."""
    cam = pair(name)
    t = POLAR
    r = cam.radius(t)
    root = np.sqrt(4 * cam.arm**2 - r**2)
    return most(cam.radius(t + cam.alpha) - r * np.cos(cam.alpha) - root * np.sin(cam.alpha))


def law_image_off(name):
    """psi(phi - psi + delta) + psi(phi), and psi(phi + 2 delta) - psi(phi), rad (W 4.8, 4.9, 7.2)."""
    cam = pair(name)
    psi = cam.psi(SOME)
    return most(cam.psi(SOME - psi + cam.delta) + psi), most(cam.psi(SOME + 2 * cam.delta) - psi)


def xy(name):
    """X and Y of the pivot in the auxiliary frame, at t and t + alpha, mm (W 5.5)."""
    cam = pair(name)
    t = POLAR
    a, b = slants(cam.alpha)

    def both(at):
        r, other = cam.radius(at), cam.radius(at + cam.alpha)
        under = 2 * np.sin(cam.alpha)
        return (a * r - b * other) / under, (a * other - b * r) / under

    return t, both(t), both(t + cam.alpha)


def slants(alpha):
    sigma = PI / 4 - alpha / 2
    return np.cos(sigma), np.sin(sigma)


def frame_off(name):
    """X and Y by W 5.5 less the pivot's coordinates in the frame of Figure 7, mm."""
    cam = pair(name)
    t, r = cam.polar(SOME)
    a, b = slants(cam.alpha)
    other = 2 * cam.arm * np.cos(0.5 * (cam.alpha - cam.psi(SOME)))
    axis = t + cam.alpha / 2 - PI / 4
    p = cam.arm * unit(SOME)
    x, y = (p * unit(axis)).sum(axis=1), (p * unit(axis + PI / 2)).sum(axis=1)
    return max(most(r - 2 * (a * x + b * y)), most(other - 2 * (b * x + a * y)))


def delta_off(name, series):
    """r less W 5.10 of a series of D over t, mm."""
    cam = pair(name)
    t = POLAR
    d = sum(c * np.cos(j * cam.lam * t) for j, c in series.items())
    a, b = slants(cam.alpha)
    closed = np.sqrt(2) * (a * np.sqrt(cam.arm**2 + d) + b * np.sqrt(cam.arm**2 - d))
    return most(cam.radius(t) - closed)


def swing_off(name):
    """D = X^2 - Y^2 less -l^2 sin(psi), over l^2; D(t + alpha) + D, D(t + delta) + D."""
    cam = pair(name)
    t, (x, y), (x1, y1) = xy(name)
    d = x**2 - y**2
    a, b = slants(cam.alpha)
    r, other = cam.radius(t + cam.delta), cam.radius(t + cam.delta + cam.alpha)
    under = 2 * np.sin(cam.alpha)
    later = ((a * r - b * other) / under) ** 2 - ((a * other - b * r) / under) ** 2
    psi = 2 * np.arccos(cam.radius(t) / (2 * cam.arm)) - cam.alpha
    scale = cam.arm**2
    return most(d / scale + np.sin(psi)), most((x1**2 - y1**2 + d) / scale), most((later + d) / scale)


# --- the overconstrained linkage --------------------------------------------------------------------------------------


def counted(name):
    """Kutzbach's count for 2 lambda triangles and two lambda-gons, and a binary joint in each point of the linkage."""
    joints, bodies = len(linkage_points(name, 0.2)), 2 * pair(name).lam + 2
    return 3 * (bodies - 1) - 2 * joints


def linkage_points(name, phi):
    """O, the A_i and the P_i of the linkage at one shaft angle, (4 lambda + 1, 2)."""
    cam = pair(name)
    chain = cam.chain(np.array([phi]), 2 * cam.lam)[:, 0]
    return np.concatenate([[[0.0, 0.0]], cam.end(chain, -1), cam.arm * unit(chain)])


def mobility(name, phi, *, polygons=True):
    """Freedoms of the linkage less those of a rigid body, by the rank of its lengths' derivatives."""
    cam = pair(name)
    points, count = linkage_points(name, phi), 2 * cam.lam
    a, p = np.arange(1, count + 1), np.arange(count + 1, 2 * count + 1)
    following = np.roll(a, -1)
    bars = [*zip(a, p, strict=True), *zip(following, p, strict=True), *zip(a, following, strict=True)]
    bars += [(np.intp(0), k) for k in p]
    if polygons:  # spokes of one kind are one body
        bars += [(p[k], p[(k + 2) % count]) for k in range(count)]
    rows = np.zeros((len(bars), 2 * len(points)))
    for row, (i, j) in zip(rows, bars, strict=True):
        along = (points[i] - points[j]) / cam.arm
        row[2 * i : 2 * i + 2], row[2 * j : 2 * j + 2] = along, -along
    values = np.linalg.svd(rows, compute_uv=False)
    rank = int((values > 1e-9 * values[0]).sum())
    return 2 * len(points) - rank - 3


def dyads_close(name):
    """Gap, mm, of the linkage built of kin's RRR dyads, triangle by triangle, with two derivatives by OA.

    Spoke and arm are a dyad from O to A; the triangle carries the next A. What closes the last one is the theorem.
    """
    cam = pair(name)
    t, r = cam.polar(np.linspace(0.0, TURN, 400))
    order = 2
    c = np.zeros((order + 1, len(r)))
    c[0], c[1] = r, 1.0
    # A_1 on the x axis, so that OA is the freedom; the whole is turned back by nothing
    zero = np.zeros_like(c)
    x, y = Jet(c), Jet(zero)
    first = x, y
    cosine, sine = np.cos(2 * cam.alpha), np.sin(2 * cam.alpha)
    dyad = RRR("output", (0.0, 0.0), (0.0, 0.0), (cam.arm, cam.arm), "open")
    about = 0.0
    for _ in range(2 * cam.lam):
        px, py = dyad.solve(x, y, about).joint
        dx, dy = x - px, y - py
        x, y = px + dx * cosine - dy * sine, py + dx * sine + dy * cosine
        about += cam.alpha
    assert t.size == r.size
    gap = np.stack([x.c - first[0].c, y.c - first[1].c])
    return most(gap[:, 0]), most(gap[:, 1:])


# --- curves -----------------------------------------------------------------------------------------------------------


def arc_radius(name):
    """Radius and centre's direction, deg, of the circle through the first arc of the pitch curve."""
    cam = pair(name)
    t = np.linspace(0.0, cam.delta, 50)
    points = cam.radius(t)[:, None] * unit(t)
    matrix = np.column_stack([2 * points, np.ones(len(t))])
    x, y, rest = np.linalg.lstsq(matrix, (points**2).sum(axis=1), rcond=None)[0]
    return float(np.sqrt(rest + x * x + y * y)), float(np.degrees(np.arctan2(y, x)))


def order(lam, mu, share=0.1736):
    """Order of the pitch curve with D = m^2 cos(lambda t): points in common with a line, by the degree of its equation.

    With x, y = r cos t, r sin t in A x + B y = C and w = A cos t + B sin t, squaring the two roots away leaves
    (C^2 - 2 w^2 (1 + k D))^2 = 4 b'^2 w^4 (1 - D^2), k = cos of twice sigma, b' = its sine. In e^(it) its degree counts
    each point twice where t + pi gives the same curve.
    """
    alpha = PI * mu / lam
    k, both = np.cos(PI / 2 - alpha), np.sin(PI / 2 - alpha)
    size = 4 * (lam + 2)
    n = 4 * size
    t = np.arange(n) * TURN / n
    w, d, c = 0.7 * np.cos(t) + 0.9 * np.sin(t), share * np.cos(lam * t), 0.31
    if abs(both) < 1e-12:
        f = c**2 - 2 * w**2 * (1 + k * d)
    else:
        f = (c**2 - 2 * w**2 * (1 + k * d)) ** 2 - 4 * both**2 * w**4 * (1 - d**2)
    wave = np.abs(np.fft.rfft(f)) / n
    degree = 2 * int(np.flatnonzero(wave > 1e-12).max())
    return degree // 2 if lam % 2 == 0 else degree


def rhombus_off():
    """Sides of Booth's rhombus less 2 l, and P's distance from the middle of its side, mm."""
    cam = pair("w-booth")
    chain = cam.chain(SOME, 5)
    a = np.stack([cam.end(phi, -1) for phi in chain])
    side = np.hypot(*np.moveaxis(a[1:] - a[:-1], -1, 0))
    middle = 0.5 * (cam.end(SOME, -1) + cam.end(SOME, 1)) - cam.arm * unit(SOME)
    return most(side - 2 * cam.arm), most(middle), most(a[4] - a[0])


def booth_off():
    """(x^2 + y^2)^2 - 2 (l^2 + m^2) x^2 - 2 (l^2 - m^2) y^2 over l^4, along the pitch curve; the quartic of W 6.3."""
    cam = pair("w-booth")
    x, y = cam.end(SOME, -1).T
    square, m = cam.arm**2, 400.0
    return most(((x * x + y * y) ** 2 - 2 * (square + m) * x * x - 2 * (square - m) * y * y) / square**2)


def isoptic_off(name):
    """Distance from O of the corner of two faces that touch the contour with normals alpha apart, less 2 l, mm."""
    cam = pair(name)
    contour = cam.design.contour(8_000)
    t = np.linspace(0.0, TURN, 40)
    p, q = ((contour @ unit(at).T).max(axis=0) for at in (t, t + cam.alpha))
    return most(np.sqrt(p**2 + q**2 - 2 * p * q * np.cos(cam.alpha)) / np.sin(cam.alpha) - 2 * cam.arm)


def pedal_off(name):
    """Support function of the flat pair's contour less r of the pitch curve of W 5.10, mm."""
    cam = pair(name)
    contour = cam.design.contour(8_000)
    t = np.linspace(0.0, TURN, 40)
    return most((contour @ unit(t).T).max(axis=0) - cam.radius(t))


def rosette_off():
    """|OQ| less the recipe's leaf 8 sin(pi x) over the first delta; Q at the ends; a leaf turned by delta + pi; mm."""
    cam = pair("w-rosette")

    def tip(phi):
        return cam.arm * (unit(phi) - unit(phi - cam.psi(phi)))

    phi = np.linspace(0.0, cam.delta, 200)
    x = (phi - 0.5 * cam.psi(phi)) / cam.delta
    leaf = most(np.hypot(*tip(phi).T) - 8 * np.sin(PI * x))
    image = phi - cam.psi(phi) + cam.delta
    c, s = np.cos(cam.delta + PI), np.sin(cam.delta + PI)
    return leaf, most(tip(image) - tip(phi) @ np.array([[c, s], [-s, c]]))


def affinity():
    """Corners of Figure 6's rectangle under W 4.9, less the parallelogram's, in delta and epsilon of w-figure-5."""
    cam = pair("w-figure-5")
    d, e = cam.delta, float(cam.psi(FINE).max())
    before = np.array([(0, 0), (d, 0), (d, e), (0, e)])
    after = np.column_stack([before[:, 0] - before[:, 1] + d, -before[:, 1]])
    return most(after - np.array([(d, 0), (2 * d, 0), (2 * d - e, -e), (d - e, -e)]))


def swing_of_arc():
    """Greatest psi of Figure 5, deg: where its arc is farthest from O, on the bisector, by elementary geometry."""
    alpha, arm, radius = PI / 3, 60.0, 75.0
    mean = 2 * arm * np.cos(alpha / 2)
    half, height = mean * np.sin(PI / 6), mean * np.cos(PI / 6)
    far = height - np.sqrt(radius**2 - half**2) + radius
    return float(abs(np.degrees(2 * np.arccos(far / (2 * arm)) - alpha)))


def bisected_off(name):
    """phi + phi' less 2 (t + alpha), with t of A."""
    cam = pair(name)
    one, two = cam.chain(SOME, 2)
    return most(one + two - 2 * (cam.polar(one)[0] + cam.alpha))


def drawn_off():
    """Distance of the pitch curve of the law, made by W 4.10 here, from the contour made, less the roller, mm.

    The recipe's shaft turns counter-clockwise, so what is drawn is the mirror image.
    """
    cam = pair("w-law")
    contour = cam.design.contour(12_000) * [1.0, -1.0]
    return most(np.array([np.hypot(*(contour - a).T).min() - cam.roller for a in cam.end(np.linspace(0, 6, 25), -1)]))


def third_off():
    """r of a recipe with two harmonics less W 5.10, mm."""
    text = (
        "name: two-harmonics\ncam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 4, "
        "delta: {cos: {1: 500, 3: 40}}}\n"
    )
    design = camgeo.design(camgeo.load(text))
    cam = Pair(design, 60.0, 4, 3, 4.0)
    t = POLAR
    d = 500 * np.cos(4 * t) + 40 * np.cos(12 * t)
    a, b = slants(cam.alpha)
    closed = np.sqrt(2) * (a * np.sqrt(3600.0 + d) + b * np.sqrt(3600.0 - d))
    return most(cam.radius(t) - closed)


def rim():
    """Least distance from O to the contour of Figure 5, less the pivot's l, mm."""
    return float(np.hypot(*pair("w-figure-5").design.contour(7_200).T).min()) - 60.0


def rim_closed():
    """The same where the image arc is nearest to O: r' of the arc's middle, W 4.3, less roller and l, mm."""
    half = 60.0 * np.sqrt(3.0)
    far = half * np.cos(PI / 6) - np.sqrt(75.0**2 - (half * np.sin(PI / 6)) ** 2) + 75.0
    near = far * 0.5 + np.sqrt(14_400.0 - far**2) * np.sqrt(0.75)
    return float(near - 8.0 - 60.0)


def wanted_off():
    """Greatest distance of w-wanted-law's swing from w-law's, deg, at fine shaft angles over the law's period; and how
    many of its extremes come within a thousandth of that, a place and its image by W 4.9 once."""
    made, wanted = pair("w-wanted-law"), pair("w-law")
    phi = np.linspace(0.0, 2.0 * wanted.delta, 18_001)[:-1]
    size = np.degrees(np.abs(made.psi(phi) - wanted.psi(phi)))
    tops = np.flatnonzero((size > np.roll(size, 1)) & (size >= np.roll(size, -1)) & (size > 0.999 * size.max()))
    places = np.sort(made.polar(phi[tops])[0] % wanted.delta)
    apart = np.diff(places, append=places[0] + wanted.delta) > 2e-3
    return float(size.max()), int(apart.sum())


def law_error(name):
    """What the product's check of that name proves, deg."""
    checks = pair(name).design.checks
    return next(check.value for check in checks if check.name == "law-error")


def shown_off():
    """Of the page's overlays at every step of the turn, mm: where a chord ends less where the next begins, and how far
    a face leaves the curve c* that it should touch."""
    gaps, faces = [0.0], []
    for name in ("w-figure-5", "w-booth", "w-figure-9"):
        chords = list(overlaid(name, "chord-polygon").values())
        length = 2 * pair(name).arm * np.sin(pair(name).alpha)
        after = [*chords[1:], chords[0]]
        gaps += [most(origin(a) + length * along(a) - origin(b)) for a, b in zip(chords, after, strict=True)]
    found = overlaid("w-figure-5", "isoptic, pedal")
    x, y = found["curve of the faces"].shapes[0].rings[0].points.T
    ring = x + 1j * y
    for step in range(0, 720, 40):
        turned = np.exp(1j * found["pedal"].pose[step, 2])
        for end in "AB":
            ray = along(found[f"perpendicular to the face through {end}"])[step]
            foot = origin(found[f"foot {end}"])[step]
            faces.append(((ring * turned - foot) / ray).real.max())
    return max(gaps), most(faces)
