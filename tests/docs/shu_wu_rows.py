"""Shu and Wu 2012 (SW), every figure, equation and claim, measured on the recipe of their section 5."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from support.page_tables import PaperRow, Row, Section
from support.pages import SHAFT, origin, overlaid
from support.places import RECIPES

import camgeo

if TYPE_CHECKING:
    from camgeo.api.design import Design

PI = np.pi
BASE, STROKE, BREADTH, BETA = 40.0, 20.0, 100.0, 2 * PI / 3
COUNT = 7200
PAGE = "constant-breadth.md"
# greatest velocity, acceleration and jerk of the modified sine, unit stroke over unit angle
CV, CA, CJ = 4 * PI / (PI + 4), 4 * PI**2 / (PI + 4), 16 * PI**3 / (PI + 4)


@cache
def design() -> Design:
    return camgeo.design(camgeo.load(RECIPES / "shu-wu.yaml"))


def motion(theta):
    """S and its three derivatives at shaft angles (n,), (4, n)."""
    return np.stack([design().motion(theta, derivative=k) for k in range(4)])


def half():
    """Angles of the first half turn, clear of the jumps of the jerk."""
    theta = np.linspace(0.001, PI - 0.001, 2000)
    knots = np.radians([15.0, 105.0, 120.0])
    return theta[np.abs(theta[:, None] - knots).min(axis=1) > 1e-3]


def axes(theta):
    """u and n (n, 2)."""
    return np.column_stack([np.cos(theta), np.sin(theta)]), np.column_stack([-np.sin(theta), np.cos(theta)])


@cache
def contour():
    """Points of the exact contour by the direction of their normals, at COUNT equal steps of a turn."""
    theta = np.arange(COUNT) * 2 * PI / COUNT
    points = design().contour(COUNT)
    tangent = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    u, _ = axes(theta)
    assert np.abs((tangent * u).sum(axis=1)).max() < 1e-3  # the parameter is the normal's direction
    return theta, points


def breadths():
    theta, points = contour()
    u, _ = axes(theta)
    reach = (points * u).sum(axis=1)
    return reach[: COUNT // 2] + reach[COUNT // 2 :]


def farthest(values, wanted):
    values = np.ravel(values)
    return float(values[np.abs(values - wanted).argmax()])


def polar(theta, s, v, side):
    """Contact A (SW 14), and B (SW 17, its sign put right)."""
    u, n = axes(theta)
    along = BASE + s if side > 0 else -(BREADTH - BASE - s)
    return v[:, None] * n + along[:, None] * u


def contacts_off(side):
    """How far SW 14 or 17 lies from the contour made, mm."""
    theta, points = contour()
    first = slice(0, COUNT // 2)
    s, v = motion(theta[first])[:2]
    made = points[first] if side > 0 else points[COUNT // 2 :]
    return float(np.hypot(*(polar(theta[first], s, v, side) - made).T).max())


def normals_off():
    """How far the common normal runs from Q = (S' n), and whether it is one line: greatest offset of A and B, mm."""
    theta, points = contour()
    _, n = axes(theta)
    along = (points * n).sum(axis=1)
    q = design().motion(theta, derivative=1)
    a, b = along[: COUNT // 2], -along[COUNT // 2 :]
    return max(float(np.abs(a - q[: COUNT // 2]).max()), float(np.abs(a - b).max()))


def velocities_off():
    """|omega x O2Q| less the follower's velocity by quotients of its position, omega = 1, mm/s."""
    theta, h = half(), 1e-5
    quotient = (design().motion(theta + h) - design().motion(theta - h)) / (2 * h)
    return float(np.abs(motion(theta)[1] - quotient).max())


def curvature_off(side):
    """SW 18 of the contacts, with derivatives of SW 20 to 23 or 26 to 29 put right, less SW 24 or 30, mm."""
    theta = half()
    s, v, a, j = motion(theta)
    c, sn = np.cos(theta), np.sin(theta)
    length = BASE + s if side > 0 else BASE + s - BREADTH
    x1, y1 = -(a + length) * sn, (a + length) * c
    x2, y2 = -(j + v) * sn - (a + length) * c, (j + v) * c - (a + length) * sn
    rho = (x1**2 + y1**2) ** 1.5 / (x1 * y2 - x2 * y1)
    closed = a + BASE + s if side > 0 else BREADTH - a - BASE - s
    return float(np.abs(rho - closed).max())


def derivatives_off(side, order):
    """Derivatives of the contacts put right, SW 20 and 21 (22 and 23; 26 to 29), less quotients of the contour."""
    theta, h = half(), 1e-4

    def point(at):
        s, v = motion(at)[:2]
        return polar(at, s, v, side)

    s, v, a, j = motion(theta)
    u, n = axes(theta)
    length = (a + BASE + s if side > 0 else a + BASE + s - BREADTH)[:, None]
    if order == 1:
        return float(np.abs(length * n - (point(theta + h) - point(theta - h)) / (2 * h)).max())
    second = (j + v)[:, None] * n - length * u
    return float(np.abs(second - (point(theta + h) - 2 * point(theta) + point(theta - h)) / h**2).max())


def radii():
    """rho at COUNT equal steps of a turn (SW 24 all round), mm."""
    s, _, a, _ = motion(np.arange(COUNT) * 2 * PI / COUNT)
    return BASE + s + a


def extreme_angle(which, begin):
    """Where rho is least or greatest within a half turn, degrees, and its value there, by golden section."""
    theta = np.linspace(begin, begin + PI, 1801)
    sign = 1.0 if which == "least" else -1.0

    def value(at):
        s, _, a, _ = motion(np.atleast_1d(at))
        return sign * float((BASE + s + a)[0])

    k = int(np.argmin([value(at) for at in theta[::10]])) * 10
    low, high = theta[max(k - 10, 0)], theta[min(k + 10, 1800)]
    ratio = (5**0.5 - 1) / 2
    for _ in range(60):
        one, other = high - ratio * (high - low), low + ratio * (high - low)
        low, high = (low, other) if value(one) < value(other) else (one, high)
    return np.degrees(0.5 * (low + high)), sign * value(0.5 * (low + high))


def closed_radius():
    """rho's extremes on the rise in closed form: BASE + S + S'' where S' + S''' = 0, by bisection, mm."""

    def slope(x):  # S' + S''' of the long middle stretch of the modified sine, h = beta = 1 taken out
        wave = 4 * PI * x / 3 + PI / 3
        velocity = PI / (PI + 4) * (1 - 3 * np.cos(wave))
        jerk = 4 * PI / 3 * CA * np.cos(wave)
        return velocity / BETA + jerk / BETA**3

    low, high = 1 / 8, 1 / 2
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if slope(middle) > 0 else (low, middle)
    x = (low + high) / 2
    wave = 4 * PI * x / 3 + PI / 3
    s = 2 / (PI + 4) + PI / (PI + 4) * x - 9 / (4 * (PI + 4)) * np.sin(wave)
    return np.degrees(x * BETA), BASE + STROKE * (s + CA * np.sin(wave) / BETA**2)


def motion_extremes() -> list[Row]:
    """The first table of the page."""
    peaks = [STROKE * c / BETA**k for k, c in ((1, CV), (2, CA), (3, CJ))]
    s = design().motion(np.radians(np.linspace(120.0, 180.0, 601)))
    fine = np.radians(np.linspace(0.0, 360.0, 14_401))
    rows = [
        Row("S, upper dwell, 120° to 180°, mm", "SW section 5", "20", STROKE, farthest(s, STROKE), 1e-9),
        Row("S, lower dwell, 300° to 360°, mm", "SW 3", "0", 0.0, farthest(design().motion(fine[12_000:]), 0.0), 1e-9),
    ]
    for k, (name, figure, closed) in enumerate(
        (("S′, mm/rad", "2b", "h C_v/β"), ("S″, mm/rad²", "2c", "h C_a/β²"), ("S‴, mm/rad³", "2d", "h C_j/β³")), start=1
    ):
        # limits from both sides count: the jerk jumps where a dwell begins or ends
        sides = [design().motion(fine + shift, derivative=k) for shift in (-1e-12, 0.0, 1e-12)]
        row, peak = np.concatenate(sides), peaks[k - 1]
        published = f"curve only; {closed} = {peak:.7g}"
        for word, ours, value in (("greatest", row.max(), peak), ("least", row.min(), -peak)):
            shown = published if word == "greatest" else published.replace("h C", "-h C").replace("= ", "= -")
            where = {1: ("60°", "240°"), 2: ("15°, 285°", "105°, 195°"), 3: ("0°, 120°", "180°, 300°")}[k]
            at = where[word == "least"]
            rows.append(Row(f"{name}, {word}, at {at}", f"SW Figure {figure}", shown, value, float(ours), 1e-5, ".8g"))
    return rows


def radius_extremes() -> list[Row]:
    """The second table of the page."""
    place, most = closed_radius()
    rows = []
    for name, equation, begin in (("ρ_A", "24", 0.0), ("ρ_B", "30", PI)):
        for word, value in (("greatest", most), ("least", BREADTH - most)):
            at, ours = extreme_angle(word, begin)
            angle = {("greatest", 0.0): place, ("least", 0.0): 120.0 - place, ("greatest", PI): 300.0 - place}.get(
                (word, begin), 180.0 + place
            )
            source = f"SW {equation}, Figure 4"
            rows.append(Row(f"{name}, {word}, mm", source, f"curve only; {value:.8g}", value, ours, 1e-6, ".8g"))
            rows.append(Row("its θ, degrees", source, f"curve only; {angle:.5g}", angle, float(at), 2e-3, ".5g"))
    figure = design().figures["radius-of-curvature"].value
    rows.append(
        Row(
            "`radius-of-curvature` of `camgeo check`, mm",
            "SW 24",
            "curve only; 34.2791",
            BREADTH - most,
            figure,
            1e-6,
            ".8g",
        )
    )
    return rows


def paper() -> list[PaperRow]:
    """Every figure, numbered equation and claim."""
    one, two, three, four = (
        Section("shu-wu", f"[{name}]({PAGE}#{anchor})")
        for name, anchor in (
            ("Figure 1", "figure-1-instant-centres"),
            ("Figure 2", "figure-2-motion-of-the-follower"),
            ("Figure 3", "figure-3-the-profile"),
            ("Figure 4", "figure-4-radius-of-curvature"),
        )
    )
    theta = half()
    s, v, a, j = motion(theta)
    later, rho = motion(theta + PI), radii()
    both = rho[: COUNT // 2] + rho[COUNT // 2 :]
    peak = [STROKE * c / BETA**k for k, c in ((1, CV), (2, CA), (3, CJ))]
    top = [motion(np.array([at]))[k, 0] for k, at in ((1, PI / 3), (2, PI / 12), (3, 0.0))]
    _, most = closed_radius()
    u, _ = axes(contour()[0])
    lengths = (contour()[1] * u).sum(axis=1) - BASE - design().motion(contour()[0])
    swept = span_of_return()

    def curve(value):
        return f"curve only; {value:.7g}", value

    return [
        one.said("Figure 1", "mechanism, instant centres, normals", "drawn", "no figure", published="drawing"),
        two.number("Figure 2a", "greatest S, mm", s.max(), 1e-9, published=("20", STROKE)),
        two.number("Figure 2b", "greatest S′, mm/rad", top[0], 1e-8, published=curve(peak[0])),
        two.number("Figure 2c", "greatest S″, mm/rad²", top[1], 1e-8, published=curve(peak[1])),
        two.number("Figure 2d", "greatest S‴, mm/rad³", top[2], 1e-7, published=curve(peak[2])),
        three.zero("Figure 3", "profile: farthest from 14 and 17, mm", max(contacts_off(1), contacts_off(-1)), 1e-9),
        four.number("Figure 4", "least ρ, mm", rho.min(), 1e-4, published=curve(BREADTH - most)),
        four.number("Figure 4", "greatest ρ, mm", rho.max(), 1e-4, published=curve(most)),
        one.number("1", "d = 2 r_b + h, mm", farthest(breadths(), BREADTH), 1e-9, published=("100", BREADTH)),
        two.number("2", "S = S(θ): S(120°), mm", design().motion(np.radians(120.0)), 1e-9, published=("20", STROKE)),
        two.zero("3", "S(θ + π) = h - S(θ)", np.abs(later[0] - STROKE + s).max(), 1e-9),
        two.zero("4, 5, 6", "V, A, J half a turn later: minus", np.abs(later[1:] + np.stack([v, a, j])).max(), 1e-9),
        one.zero("7, 8", "at Q cam and follower move alike, mm/rad", velocities_off(), 1e-6),
        one.zero("9", "L = r_b + S is the tangent's distance, mm", np.abs(lengths).max(), 1e-9),
        one.zero("10", "q = S′: the normals of A and B pass Q, mm", normals_off(), 1e-9),
        three.zero("11, 12, 13, 14", "contact A lies on the contour, mm", contacts_off(1), 1e-9),
        three.zero("15, 16, 17", "contact B does, with - for the printed +, mm", contacts_off(-1), 1e-9),
        four.zero("18, 19, 24", "ρ_A = A + L, mm", curvature_off(1), 1e-9),
        four.zero("20, 21", "first derivatives of A, 21 put right, mm/rad", derivatives_off(1, 1), 1e-4),
        four.zero("22, 23", "second derivatives of A, 23 put right, mm/rad²", derivatives_off(1, 2), 1e-3),
        four.zero("25, 30", "ρ_B = d - A - L, mm", curvature_off(-1), 1e-9),
        four.zero("26, 27", "first derivatives of B, 27 put right, mm/rad", derivatives_off(-1, 1), 1e-4),
        four.zero("28, 29", "second derivatives of B, 29 put right, mm/rad²", derivatives_off(-1, 2), 1e-3),
        four.number("31, 32", "ρ(θ) + ρ(θ + π) = d, mm", farthest(both, BREADTH), 1e-9, published=("100", BREADTH)),
        two.number("section 2", "β_f = β_r, deg", swept, 0.004, published=("120", 120.0), form=".5g"),
        two.number("section 2", "β_l = β_h, deg", 180.0 - swept, 0.004, published=("60", 60.0), form=".5g"),
        one.zero("section 2", "AB stands square to the faces, mm", chord_off(), 1e-9),
        one.said("section 2", "only one I₂₃, else the faces' distance would change", "as 10", "an argument"),
        one.said("section 1", "no return spring; a preload stiffens", "none", "no figure is given of it"),
        one.said("section 6", "half a turn of the motion is free", "as 3", "a longer motion is refused"),
        one.zero("Figure 1", "turning on the page: Q less S′ on the line of I₁₂ and I₁₃, mm", shown_off(), 1e-9),
    ]


def shown_off():
    """The page's instant centre Q over the turn, less S' across the follower's line, mm."""
    found = overlaid("shu-wu", "instant-centres")["instant centre of cam and follower"]
    return float(np.abs(origin(found) - 1j * design().motion(SHAFT, derivative=1)).max())


def span_of_return():
    """Angle from the end of the upper dwell to the beginning of the lower one, deg: where S' is not 0."""
    degrees = np.arange(180.0, 360.0, 0.001)
    moving = degrees[np.abs(design().motion(np.radians(degrees), derivative=1)) > 1e-9]
    return float(moving.max() - moving.min())


def chord_off():
    """A and B along the faces: how far the chord AB leans, mm."""
    theta, points = contour()
    _, n = axes(theta[: COUNT // 2])
    return float(np.abs(((points[: COUNT // 2] - points[COUNT // 2 :]) * n).sum(axis=1)).max())
