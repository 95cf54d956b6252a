"""Aygahoglu and Saka 2023 (AS), every figure, table, equation and claim, measured on the recipes of their figures."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from support.linkage_reference import BREADTH, CAMS, FIGURES, PI, lift
from support.page_tables import PaperRow, Section
from support.pages import SHAFT as SHAFT_ANGLES
from support.pages import along, origin, overlaid
from support.places import RECIPES

import camgeo
from kin.linkage.trace import traced

if TYPE_CHECKING:
    from camgeo.api.design import Design
    from kin.linkage.mechanism import Mechanism

TURN = 2 * PI
COUNT = 3600
PAGE = "linkages.md"
THETA = np.arange(COUNT) * TURN / COUNT
SOME = np.linspace(0.011, TURN, 181)
SHAFT = (16.0, 7.5)  # of Figure 6
FOUR, SLIDER = "as-figure-9-2a", "as-figure-13-2a"


@cache
def design(name) -> Design:
    return camgeo.design(camgeo.load(RECIPES / f"{name}.yaml"))


@cache
def mechanism(name) -> Mechanism:
    return design(name).exact.driven.mechanism


def most(values):
    return float(np.abs(values).max())


def unit(angle):
    return np.column_stack([np.cos(angle), np.sin(angle)])


def curve(cam):
    """Contour of a cam of Figures 1 and 2 in the axes of its p, by the direction of the normal, (COUNT, 2)."""
    return design(f"as-figure-{cam}").contour(COUNT) + np.array(SHAFT)


def support(cam, order=0):
    """p, or a derivative, at THETA, from the paper's formula."""
    return lift(cam, THETA, (0.0, 0.0))[order]


def outline_off(cam):
    """Contour less p u + p' n (AS 2, 3), mm."""
    closed = support(cam)[:, None] * unit(THETA) + support(cam, 1)[:, None] * unit(THETA + PI / 2)
    return most(curve(cam) - closed)


def tangents_off(cam):
    """x cos + y sin less p (AS 1), mm."""
    return most((curve(cam) * unit(THETA)).sum(axis=1) - CAMS[cam](THETA))


def breadth(*cams):
    """Breadth of contours where it is farthest from 50 (AS 4), mm."""
    reach = np.array([(curve(cam) * unit(THETA)).sum(axis=1) for cam in cams])
    both = (reach[:, : COUNT // 2] + reach[:, COUNT // 2 :]).ravel()
    return float(both[np.abs(both - BREADTH).argmax()])


def traced_off():
    """Curvature of the path of D, whose trace is the first of coupler-curve, less that of a circle about B, 1/mm."""
    theta = np.linspace(0.0, TURN, COUNT)
    path = traced(mechanism("coupler-curve"), "coupler", (0.0, 0.0), theta)
    moving = path.speed > 1e-3
    return most(np.abs(path.curvature[moving]) - 1.0 / 90.0)


def evolute_off(cam):
    """From the page's contact to its centre of curvature, less p + p'' of the paper's formula, mm."""
    found = overlaid(f"as-figure-{cam}", "evolute")
    normal = found["normal of the contact"]
    along_it = (origin(found["centre of curvature"]) - origin(normal)) / along(normal)
    rows = lift(cam, SHAFT_ANGLES, (0.0, 0.0))
    return max(most(along_it.real - rows[0] - rows[2]), most(along_it.imag))


def curvature_off(cam):
    """AS 5, with the contour's derivatives by its Fourier series, less p + p'' (AS 6), mm."""
    wave, k = np.fft.fft(curve(cam)[:, 0] + 1j * curve(cam)[:, 1]) / COUNT, np.fft.fftfreq(COUNT, 1 / COUNT)
    wave[np.abs(wave) < 1e-12] = 0.0
    first, second = (np.fft.ifft(wave * (1j * k) ** order) * COUNT for order in (1, 2))
    rho = np.abs(first) ** 3 / (first.conj() * second).imag
    return most(rho - support(cam) - support(cam, 2))


def foot_off(cam, *, of="AD"):
    """AS 8 to 10 put right: D's place by the slope of the tangent, less that of the face; s less the motion, mm."""
    t = SOME
    p, slope, bend = lift(cam, t, (0.0, 0.0))
    x_t, y_t = p * np.cos(t) - slope * np.sin(t), p * np.sin(t) + slope * np.cos(t)
    m = -(p + bend) * np.cos(t) / ((p + bend) * np.sin(t))
    x_n, y_n = SHAFT
    x_d = (m**2 * x_t - m * (y_t - y_n) + x_n) / (1 + m**2)
    y_d = (m**2 * y_n + m * (x_n - x_t) + y_t) / (1 + m**2)
    s = design(f"as-figure-{cam}").motion(t)
    face = np.array(SHAFT) + s[:, None] * unit(t)
    return {
        "x": most(x_d - face[:, 0]),
        "y": most(y_d - face[:, 1]),
        "AD": most(np.hypot(x_d - x_n, y_d - y_n) - np.abs(s)),
    }[of]


def lifts_off():
    """Motion of the yokes of Figure 6 less p - x cos - y sin, mm."""
    return max(
        most(design(f"as-figure-{cam}").motion(SOME) - lift(cam, SOME, SHAFT)[0]) for cam in ("2a", "2b", "2c", "2d")
    )


# --- linkages ---------------------------------------------------------------------------------------------------------


class Loop:
    """A mechanism's angles and lifts at SOME, with what AS calls them."""

    def __init__(self, name):
        figure, at = FIGURES[name], mechanism(name).at(SOME, 2)
        self.r1, self.r3, self.r4, self.w = figure.ground, figure.coupler, figure.rocker, BREADTH
        self.three, self.four = -at.shaft[0] + SOME + mechanism(name).start, at.output[0]
        self.w3, self.w4, self.a4 = 1 - at.shaft[1], at.output[1], at.output[2]
        self.s, self.v, self.a = lift(figure.cam, SOME, figure.shaft)
        self.s1, self.v1, _ = lift(figure.cam, SOME + PI / 2, figure.shaft)

    @property
    def cd(self):
        """CD and CA, with the cotangent as the paper has them."""
        ca = (self.s - self.w / 2) / np.sin(self.three)
        return self.w + self.r3 - self.s1 + ca * np.cos(self.three), ca


def equation(number, name=FOUR):
    """What an equation of the linkages leaves, mm or rad or their rates; greatest over SOME."""
    o = Loop(name)
    sine, cosine = np.sin, np.cos
    y = o.s - o.w / 2
    if number in (11, 12, 13, 14, 18, 19, 20, 21, 34):
        cd, ca = o.cd
        t = np.tan(o.three / 2)
        x = o.w + o.r3 - o.s1
        a, b, c = (o.r1 + x) ** 2 + y**2 - o.r4**2, 2 * o.r1 * y, (o.r1 - x) ** 2 + y**2 - o.r4**2
        e = (x + y / np.tan(o.three)) * sine(o.three)
        cot = 1 / np.tan(o.three)
        left21 = o.r4 * o.w4 * cosine(o.four)
        right21 = (-o.v1 + o.v * cot - y * o.w3 * (1 + cot**2)) * sine(o.three) + (x + y * cot) * o.w3 * cosine(o.three)
        top = (x * o.v1 - y * o.v) * sine(o.three - o.four)
        bottom = x * (sine(o.four) ** 2 - sine(o.three) ** 2) + 0.5 * y * (sine(2 * o.four) - sine(2 * o.three))
        clear = np.abs(bottom) > 1.0
        left = {
            11: o.r4 * cosine(o.four) + cd * cosine(o.three) - o.r1 - ca,
            12: o.r4 * sine(o.four) - cd * sine(o.three),
            13: (cd**2 + (o.r1 + ca) ** 2 - 2 * cd * (o.r1 + ca) * cosine(o.three)) / o.r4 - o.r4,
            14: (a * t * t + 2 * b * t + c) / o.r4,
            18: 2 * np.arctan2(-b + np.sqrt(b * b - a * c), a) - o.three,
            19: e - o.r4 * sine(o.four),
            20: 2 * np.arctan((o.r4 - np.sqrt(o.r4**2 - e**2)) / e) - o.four,
            21: left21 - right21,
            34: (top[clear] / (o.r4 * bottom[clear])) - o.w4[clear],
        }[number]
        return most(left)
    f, g = o.r1 - y + o.r4, o.r1 + y - o.r4
    left = {
        24: o.r1 * cosine(o.four) - o.r4 + y,
        25: (f * np.tan(o.four / 2) ** 2 - g) / o.r1,
        27: 2 * np.arctan(np.sqrt(g / f)) - o.four,
        28: -o.r1 * o.w4 * sine(o.four) + o.v,
        29: o.v / (o.r1 * sine(o.four)) - o.w4,
        30: -o.r1 * o.a4 * sine(o.four) - o.r1 * o.w4**2 * cosine(o.four) + o.a,
        31: (o.a - o.r1 * o.w4**2 * cosine(o.four)) / (o.r1 * sine(o.four)) - o.a4,
    }[number]
    return most(left)


def sliding_off():
    """r3 of AS 23, with the block's place on the coupler by kin's joint D, mm: |D - A| across the frame."""
    o, at = Loop(SLIDER), mechanism(SLIDER).at(SOME, 0)
    r3 = (o.r4 * np.sin(o.four) - (o.w - o.s1) * np.cos(o.four) - (o.s - o.w / 2) * np.sin(o.four)) / np.cos(o.four)
    along = at.joint[:, 0] * np.array([np.cos(o.three), np.sin(o.three)])
    return most(along.sum(axis=0) - (o.w + r3 - o.s1))


@cache
def outputs(name):
    """theta_4 and its derivatives over theta, of the mechanism and by the paper's equations."""
    return mechanism(name).at(THETA, 2).output, FIGURES[name].loop(THETA).output


def curves_off(stem, order):
    """theta_4, or a derivative over theta, of all cams of a figure less the paper's equations; deg or 1."""
    names = [name for name in FIGURES if name.startswith(stem)]
    off = [most((both[0] - both[1])[order]) for both in map(outputs, names)]
    assert len(names) == 4
    return max(off) * (180 / PI if order == 0 else 1.0)


def places_off(name, degrees):
    """Joint D at the paper's positions less that of the equations, mm."""
    figure, theta = FIGURES[name], np.radians(degrees)
    at, loop = mechanism(name).at(theta, 0), figure.loop(np.concatenate([[0.0], THETA[1:]]))
    k = np.round(np.degrees(theta) * COUNT / 360).astype(int)
    joint = (loop.x + 1j * loop.y) * np.exp(1j * loop.frame[0])
    return most(at.joint[0, 0] + 1j * at.joint[1, 0] - joint[k])


def dwell(name, band, over="relative"):
    """Length of the longest dwell, deg."""
    return float(np.degrees(mechanism(name).dwells(np.radians(band), over)[0].length))


def perimeter(cam):
    points = curve(cam)
    chord = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    turn = TURN / COUNT  # each chord's arc turns by this
    return float((chord * (turn / 2) / np.sin(turn / 2)).sum())


def rounded(cam):
    """Least radius of curvature by `camgeo.design`, less that of p + p'', mm."""
    fine = np.linspace(0, TURN, 60_001)
    least = float(lift(cam, fine, (0.0, 0.0))[[0, 2]].sum(axis=0).min())
    return design(f"as-figure-{cam}").figures["radius-of-curvature"].value - least


def paper() -> list[PaperRow]:
    """Every figure, table, numbered equation and claim."""
    gallery = "[gallery](gallery.md#flat-faces-and-yokes)"

    def at(recipe, name, anchor):
        return Section(recipe, f"[{name}]({PAGE}#{anchor})")

    round_cam, cams = Section("as-figure-1", gallery), Section("as-figure-2*", gallery)
    yoke = at("as-figure-2a", "Figures 3, 5", "figures-3-and-5-lift-and-breadth")
    names, six = at("as-figure-9-2a", "names", "names"), at("as-figure-2*", "Figure 6", "figure-6-the-yoke")
    bar = at("as-figure-9-2a", "Figures 8 to 11", "figures-8-to-11-four-bars")
    bars = at("as-figure-9-*", "Figures 8 to 11", "figures-8-to-11-four-bars")
    block = at("as-figure-13-2a", "Figures 12 to 15", "figures-12-to-15-inverted-slider-cranks")
    blocks = at("as-figure-13-*", "Figures 12 to 15", "figures-12-to-15-inverted-slider-cranks")
    rest, two = at("as-figure-*-2a", "dwells", "dwells"), at("as-figure-9-2a", "two angles", "two-angles")
    beyond = at("six-bar, slider-crank", "beyond", "beyond-the-paper")
    twos = ("2a", "2b", "2c", "2d")

    def motions(section, stem, first):
        return [
            section.zero(f"Figure {first + k}", f"{what} of four cams less the equations", curves_off(stem, k), 1e-8)
            for k, what in enumerate(("θ₄, deg,", "ω₄", "α₄"))
        ]

    around = 50 * PI
    rows = [
        round_cam.number(
            "Figure 1", "perimeter, mm", perimeter("1"), 1e-4, published=("drawing; πw = 157.0796", around)
        ),
        *(
            cams.number(
                f"Figure {cam}", "perimeter, mm", perimeter(cam), 1e-4, published=("drawing; πw = 157.0796", around)
            )
            for cam in twos
        ),
        yoke.zero("Figure 3", "s = AD is the lift, mm", foot_off("2a"), 1e-9),
        names.said("Figure 4", "four-bar, inverted slider-crank", "drawn", "no figure", published="drawing"),
        yoke.number("Figure 5", "p(θ) + p(θ + π), mm", breadth("2a"), 1e-9, published=("50", BREADTH)),
        six.zero("Figure 6", "lifts of cams 2a to 2d less s, mm", lifts_off(), 1e-9),
        names.said("Figure 7", "lengths and angles by name", "drawn", "no figure", published="drawing"),
        at("as-figure-8", "Figures 8 to 11", "figures-8-to-11-four-bars").zero(
            "Figure 8", "D at θ = 0, 100, 280° less 11 to 18, mm", places_off("as-figure-8", (0, 100, 280)), 1e-9
        ),
        *motions(bars, "as-figure-9", 9),
        at("as-figure-12", "Figures 12 to 15", "figures-12-to-15-inverted-slider-cranks").zero(
            "Figure 12", "D at θ = 55, 120, 230° less 24, mm", places_off("as-figure-12", (55, 120, 230)), 1e-9
        ),
        *motions(blocks, "as-figure-13", 13),
        names.said("Table 1", "nomenclature", "named", "the same letters", published="names"),
        cams.zero(
            "1", "x cos θ + y sin θ = p, all five cams, mm", max(tangents_off(cam) for cam in ("1", *twos)), 1e-9
        ),
        cams.zero("2, 3", "contour p u + p′ n, all five, mm", max(outline_off(cam) for cam in ("1", *twos)), 1e-9),
        cams.number("4", "w, farthest from 50, all five, mm", breadth("1", *twos), 1e-9, published=("50", BREADTH)),
        cams.zero(
            "5, 6", "ρ of the contour less p + p″, all five, mm", max(curvature_off(cam) for cam in ("1", *twos)), 1e-6
        ),
        cams.zero("6", "least ρ of `camgeo check`, all five, mm", max(abs(rounded(cam)) for cam in ("1", *twos)), 1e-6),
        round_cam.zero("7", "p with a = 4, k = 3, c = 23 is Figure 1, mm", tangents_off("1"), 1e-9),
        yoke.zero("8", "x_d, put right, mm ([misprint](#what-the-papers-misprint))", foot_off("2a", of="x"), 1e-9),
        yoke.zero("9", "y_d, mm", foot_off("2a", of="y"), 1e-9),
        yoke.zero("10", "s = AD where s is above 0, mm", foot_off("2a"), 1e-9),
    ]
    for source, number, what, within in (
        ("11", 11, "horizontal projections, mm", 1e-9),
        ("12", 12, "vertical projections, mm", 1e-9),
        ("13", 13, "squared and summed, over r₄, mm", 1e-9),
        ("14, 15, 16, 17", 14, "quadratic in tan(θ₃/2), over r₄, mm", 1e-9),
        ("18", 18, "θ₃ by the + sign, rad", 1e-9),
        ("19", 19, "e = r₄ sin θ₄, mm", 1e-9),
        ("20", 20, "θ₄ below 90°, rad ([beyond it fails](#what-the-papers-misprint))", 1e-9),
        ("21", 21, "velocities, mm/rad", 1e-9),
        ("34", 34, "ω₄ clear of θ₃ = θ₄", 1e-9),
    ):
        rows.append(bar.zero(source, what, equation(number), within))
    for source, number, what, within in (
        ("24", 24, "r₁ cos θ₄ - r₄ + s - w/2, mm", 1e-9),
        ("25, 26", 25, "f k² - g, over r₁", 1e-9),
        ("27", 27, "θ₄ by the + root, rad", 1e-9),
        ("28", 28, "velocities, mm/rad", 1e-9),
        ("29", 29, "ω₄", 1e-9),
        ("30", 30, "accelerations with - for the printed +, mm/rad²", 1e-9),
        ("31", 31, "α₄", 1e-9),
    ):
        rows.append(block.zero(source, what, equation(number, SLIDER), within))
    rows += [
        block.zero("22, 23", "r₃ by kin's joint D, mm", sliding_off(), 1e-9),
        names.said("32, 33", "-", "none", "the paper has no equations of these numbers", published="-"),
        rest.number(
            "3.1", "dwell about 3π/2, band 0.1°, deg", dwell(FOUR, 0.1), 0.5, published=("about 45", 45.0), form=".2f"
        ),
        rest.number(
            "3.2",
            "dwell about π, band 0.135°, deg",
            dwell(SLIDER, 0.135),
            0.5,
            published=("about 40", 40.0),
            form=".2f",
        ),
        rest.number(
            "3.1",
            "the same over the shaft, deg",
            dwell(FOUR, 0.1, "shaft"),
            1e-2,
            published=("none; 37.05", 37.05),
            form=".2f",
        ),
        yoke.said("section 3", "F of Figure 3", "1", "3·2 - 2·2 - 1: the cam pair has two freedoms", published="1"),
        names.said("section 3", "F of Figure 4", "1", "3·3 - 2·4: in the square it has one", published="1"),
        bar.said(
            "3.1", "negative discriminant: no full turn", "as `mobility`", "holds; but the shaft may turn back before"
        ),
        bar.said("3.1", "dead centres at θ = θ₃, θ₃ + π", "not so", "[misprint](#what-the-papers-misprint)"),
        two.said("3.1", "θ the cam rotation angle", "relative angle", "[misprint](#what-the-papers-misprint)"),
        bar.said("3.1", "no such dwell in a classical four-bar", "none", "nothing to compare: no figure is given"),
        # needs: sweep
        Section("sweep-four-bar", "[sweep](sweep.md)").said(
            "section 4",
            "the shaft's place changes motion and dwell",
            "searched",
            "[long-dwell](gallery.md#linkages) rests longer",
            needs="sweep",
        ),
        beyond.said("3.2, section 4", "slider-crank, and more links, alike", "two recipes", "the paper shows none"),
        at("coupler-curve", "Figures 8 to 11", "figures-8-to-11-four-bars").zero(
            "Figures 8, 12", "turning with traces: D's path, its curvature less 1/r₄, 1/mm", traced_off(), 1e-9
        ),
        yoke.zero("Figure 5", "turning on the page with its evolute: ρ less p + p″, mm", evolute_off("2a"), 1e-9),
    ]
    return rows
