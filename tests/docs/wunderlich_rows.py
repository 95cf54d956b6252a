"""Wunderlich 1984 (W), every figure, equation and claim, with what is measured of it."""

from __future__ import annotations

import numpy as np
from support.page_tables import PaperRow, Row, Section
from wunderlich_measures import (
    FINE,
    PI,
    POLAR,
    ROLLERS,
    adjacent_off,
    affinity,
    arc_radius,
    bisected_off,
    booth_off,
    chain_off,
    chord_off,
    closing_off,
    counted,
    delta_off,
    drawn_off,
    dyads_close,
    frame_off,
    image_off,
    isoptic_off,
    law_error,
    law_image_off,
    made_law_off,
    mobility,
    most,
    order,
    pair,
    parallel_off,
    pedal_off,
    pole_ratio,
    rhombus_off,
    rim,
    rim_closed,
    rosette_off,
    rotation_off,
    shown_off,
    slants,
    swing_of_arc,
    swing_off,
    third_off,
    wanted_off,
    xy,
)

PAGE = "double-roller.md"


def figures() -> list[Row]:
    """The table of the page: what each figure's numbers are."""
    five, nine, booth = pair("w-figure-5"), pair("w-figure-9"), pair("w-booth")
    radius, _ = arc_radius("w-figure-5")
    alpha = 0.75 * PI
    a, b = slants(alpha)
    sides, middles, _ = rhombus_off()
    return [
        Row("Figure 1: OI:PI less dψ:dφ, `w-figure-9`", "W section 1", "0", 0.0, pole_ratio(), 1e-4, ".1e"),
        Row(
            "Figure 3: B to the next A, `w-figure-5`, mm", "W 4.6", "0", 0.0, adjacent_off("w-figure-5")[0], 1e-9, ".1e"
        ),
        Row(
            "Figure 3: chord under ∠AOB = α less 2l sin α, mm", "W 2.1", "0", 0.0, chord_off("w-figure-5"), 1e-4, ".1e"
        ),
        Row(
            "Figure 4: freedoms of the linkage, λ = 3", "W section 3", "1", 1.0, mobility("w-figure-5", 0.2), 0.0, ".7g"
        ),
        Row(
            "Figure 4: the same with each spoke by itself",
            "W section 3",
            "1",
            1.0,
            mobility("w-figure-5", 0.2, polygons=False),
            0.0,
        ),
        Row("Figure 4: Kutzbach's count, 8 bodies, 13 joints", "by hand", "-5", -5.0, counted("w-figure-5"), 0.0),
        Row(
            "Figure 4: gap of six triangles by kin's dyads, mm",
            "W 4.7",
            "0",
            0.0,
            dyads_close("w-figure-5")[0],
            1e-9,
            ".1e",
        ),
        Row("Figure 5: radius of the first arc, mm", "recipe", "75", 75.0, radius, 1e-8),
        Row(
            "Figure 5: roller's centre to the cam less 8, mm",
            "W section 1",
            "0",
            0.0,
            parallel_off("w-figure-5"),
            1e-4,
            ".1e",
        ),
        Row(
            "Figure 5: swing to each side, deg",
            "W 4.4",
            "curve only; 15.1279",
            swing_of_arc(),
            np.degrees(five.psi(FINE).max()),
            1e-5,
        ),
        Row("Figure 6: ψ(φ - ψ + δ) + ψ(φ), rad", "W 4.9", "0", 0.0, law_image_off("w-figure-5")[0], 1e-9, ".1e"),
        Row("Figure 7: r, r′ less those of X, Y, mm", "W 5.3", "0", 0.0, frame_off("w-figure-5"), 1e-9, ".1e"),
        Row("Figure 8: sides of the rhombus less 2l, mm", "W section 6", "0", 0.0, sides, 1e-9, ".1e"),
        Row("Figure 8: P off the middle of its side, mm", "W section 6", "0", 0.0, middles, 1e-9, ".1e"),
        Row("Figure 8: m²/l², an oval below 1/3", "W section 6", "0.25", 0.25, np.sin(booth.psi(FINE)).max(), 1e-6),
        Row("Figure 9: a", "W section 6", "0.924", 0.924, a, 5e-4, ".6f"),
        Row("Figure 9: b", "W section 6", "-0.383", -0.383, b, 5e-4, ".6f"),
        Row("Figure 9: order of the pitch curve", "W 6.4", "12", 12.0, order(4, 3), 0.0),
        Row("Figure 9: gap of the star octagon, mm", "W section 6", "0", 0.0, chain_off("w-figure-9"), 1e-9, ".1e"),
        Row(
            "Figure 9: swing to each side, deg",
            "recipe",
            "curve only; 9.99784",
            np.degrees(np.arcsin(625 / 3600)),
            np.degrees(nine.psi(FINE).max()),
            1e-5,
        ),
        Row(
            "isoptic: corner from O less 2l, `w-ellipse`, mm",
            "W section 5",
            "0",
            0.0,
            isoptic_off("w-ellipse"),
            1e-5,
            ".1e",
        ),
        Row("isoptic: the same, three-faced, mm", "W section 5", "0", 0.0, isoptic_off("three-faced"), 1e-5, ".1e"),
        Row(
            "pedal: foot's distance less r, three-faced, mm",
            "W section 5",
            "0",
            0.0,
            pedal_off("three-faced"),
            1e-5,
            ".1e",
        ),
        Row("rosette: leaf less 8 sin πx, mm", "recipe", "0", 0.0, rosette_off()[0], 1e-9, ".1e"),
        Row("rosette: next leaf, turned by δ + π, mm", "W section 5", "0", 0.0, rosette_off()[1], 1e-9, ".1e"),
    ]


def paper() -> list[PaperRow]:
    """Every figure, numbered equation and claim."""
    place = {
        name: f"[{name}]({PAGE}#{anchor})"
        for name, anchor in (
            ("Figure 1", "figure-1-the-pole"),
            ("conditions", "three-conditions"),
            ("Figure 3", "figure-3-mirror-images"),
            ("Figure 4", "figure-4-an-overconstrained-linkage"),
            ("Figure 5", "figure-5-the-mechanism"),
            ("Figure 6", "figure-6-the-law-and-its-image"),
            ("Figure 7", "figure-7-the-closed-solution"),
            ("Figure 8", "figure-8-a-movable-rhombus"),
            ("Figure 9", "figure-9-a-star-octagon"),
            ("wanted law", "any-wanted-law"),
            ("flat pairs", "flat-pairs-isoptic-and-pedal"),
            ("rosette", "the-rosette"),
        )
    }
    on = {name: Section("w-figure-5", where) for name, where in place.items()}
    nine, booth = Section("w-figure-9", place["Figure 9"]), Section("w-booth", place["Figure 8"])
    faces = Section("w-ellipse", place["flat pairs"])
    leaf, every = Section("w-rosette", place["rosette"]), Section("w-*", place["conditions"])
    law, wanted = Section("w-law", place["Figure 6"]), Section("w-wanted-law", place["wanted law"])
    error, extremes = wanted_off()
    chords, faces_off = shown_off()
    a, b = slants(0.75 * PI)
    x_off, alpha_off, delta_off_ = swing_off("w-figure-9")
    _, (x, y), (x1, y1) = xy("w-figure-9")
    image, period = law_image_off("w-law")
    t = POLAR
    sides, middles, gap = rhombus_off()
    return [
        Section("w-figure-9", place["Figure 1"]).zero(
            "Figure 1", "OI:PI = dψ:dφ (Aronhold, Kennedy)", pole_ratio(), 1e-4
        ),
        every.said(
            "Figure 2",
            "chord polygon where L ≠ l",
            "not made",
            "no cam: it need not close; the case (2.1) excludes",
            published="drawing",
        ),
        on["Figure 3"].zero("Figure 3", "B of a position is A of the next, mm", adjacent_off("w-figure-5")[0], 1e-9),
        on["Figure 4"].number(
            "Figure 4", "freedoms of the linkage", mobility("w-figure-5", 0.2), 0.0, published=("1", 1.0)
        ),
        on["Figure 5"].zero("Figure 5", "A, B to the cam less the roller, mm", parallel_off("w-figure-5"), 1e-4),
        on["Figure 6"].zero("Figure 6", "rectangle to parallelogram, rad", affinity(), 1e-12),
        on["Figure 7"].zero("Figure 7", "r, r′ by X and Y, mm", frame_off("w-figure-5"), 1e-9),
        booth.zero("Figure 8", "sides of the rhombus less 2l, mm", sides, 1e-9),
        nine.zero("Figure 9", "gap of the star octagon, mm", chain_off("w-figure-9"), 1e-9),
        every.zero("2.1", "chords of 2l sin α under ∠AOB = α, mm", max(chord_off(name) for name in ROLLERS), 1e-4),
        every.number("2.2", "π/α = λ/μ, `w-figure-9`", PI / pair("w-figure-9").alpha, 1e-12, published=("4/3", 4 / 3)),
        every.said("section 2", "μ odd", "refused", "a recipe with μ even is refused with that reason"),
        on["Figure 3"].zero("4.1", "closing of r and r′, over l²", closing_off("w-figure-5"), 1e-9),
        on["Figure 3"].zero("4.2, 4.7", "two steps: 2α on, ψ as before", rotation_off("w-figure-5"), 1e-9),
        on["Figure 3"].zero("4.3", "r′ with sin α outside the root, mm", image_off("w-figure-5"), 1e-9),
        on["Figure 6"].zero("4.4", "ψ of the contour made, by r/2l, rad", made_law_off("w-figure-5"), 1e-5),
        on["Figure 6"].zero("4.5", "φ + φ′ = 2θ′ = 2θ + 2α, rad", bisected_off("w-figure-5"), 1e-9),
        on["Figure 6"].zero("4.6", "φ′ = φ - ψ + α, ψ′ = -ψ, rad", adjacent_off("w-figure-5")[1], 1e-9),
        law.zero("4.8", "ψ has the period 2δ, rad", period, 1e-9),
        law.zero("4.9, 7.2", "(φ - ψ + δ, -ψ) lies on the law, rad", image, 1e-9),
        law.zero("4.10", "θ, r from a law: the contour lies 8 below, mm", drawn_off(), 1e-3),
        nine.zero("5.1, 7.1", "the closing equation, over l²", closing_off("w-figure-9"), 1e-9),
        on["Figure 7"].number(
            "5.2", "σ of Figure 9, deg", np.degrees(PI / 4 - 0.375 * PI), 1e-9, published=("-22.5", -22.5)
        ),
        on["Figure 7"].zero("5.3", "r = 2(aX + bY), r′ = 2(bX + aY), mm", frame_off("w-figure-9"), 1e-9),
        on["Figure 7"].zero("5.4", "X(θ + α) = Y, Y(θ + α) = X, mm", max(most(x1 - y), most(y1 - x)), 1e-9),
        on["Figure 7"].zero(
            "5.5, 5.6", "X² + Y² = l² (printed as 5.4 again), over l²", most((x * x + y * y) / 3600.0 - 1.0), 1e-12
        ),
        nine.zero("5.7", "X² - Y² = Δ = -l² sin ψ, over l²", x_off, 1e-9),
        nine.zero("5.8", "Δ(θ + α) = -Δ(θ), over l²", alpha_off, 1e-9),
        nine.zero(
            "5.9", "X² = (l² + Δ)/2, over l²", most((x * x - 0.5 * (3600.0 + 625 * np.cos(4 * t))) / 3600.0), 1e-9
        ),
        nine.zero("5.10", "r of Δ, mm", delta_off("w-figure-9", {1: 625.0}), 1e-9),
        nine.zero("5.11", "Δ(θ + δ) = -Δ(θ), over l²", delta_off_, 1e-9),
        nine.number(
            "6.1",
            "Δ = m² cos λθ: greatest ψ, deg",
            np.degrees(pair("w-figure-9").psi(FINE).max()),
            1e-5,
            published=("curve only; 9.99784", float(np.degrees(np.arcsin(625 / 3600)))),
        ),
        booth.zero("6.2, 6.3", "the quartic, over l⁴", booth_off(), 1e-12),
        nine.number("6.4", "order for λ even: 4/3", order(4, 3), 0.0, published=("2(λ + 2) = 12", 12.0)),
        on["Figure 5"].number("6.4", "order for λ odd: 3", order(3, 1), 0.0, published=("4(λ + 2) = 20", 20.0)),
        booth.number("6.4", "order for n = 2, the exception", order(2, 1), 0.0, published=("4", 4.0)),
        nine.zero("6.5", "r of a Δ with j = 1 and 3, mm", third_off(), 1e-9),
        wanted.number(
            "6.5",
            "approximates any wanted law, with j to 15: error proved, deg",
            law_error("w-wanted-law"),
            1e-5,
            published=(f"text; at angles {error:.6f}", error),
        ),
        wanted.number(
            "6.5", "extremes of that one size, as of the best 16 terms", extremes, 0.0, published=("17 (Remez)", 17.0)
        ),
        nine.number("section 6", "a of Figure 9", a, 5e-4, published=("0.924", 0.924), form=".6f"),
        nine.number("section 6", "b of Figure 9", b, 5e-4, published=("-0.383", -0.383), form=".6f"),
        booth.said(
            "section 6",
            "an oval below m²/l² = 1/3",
            "measured",
            "[above](#oscillating-double-roller-and-flat-pair-w), by bisection",
        ),
        booth.zero("section 6", "stretched arms: P in the middle of AB, mm", max(middles, gap), 1e-9),
        nine.zero(
            "section 6, Fischer",
            "the chord polygon closes from anywhere, mm",
            max(chain_off(name) for name in ROLLERS),
            1e-8,
        ),
        nine.zero("section 6", "chords of one length, 2l sin α, mm", max(chord_off(name) for name in ROLLERS), 1e-4),
        nine.said(
            "section 6",
            "as pure geometry μ even, Δ beyond ±l² too",
            "not made",
            "no cam: curves that cross themselves, or have gaps",
        ),
        on["Figure 4"].number(
            "section 3", "Kutzbach's count, λ = 3, 4λ + 1 joints", counted("w-figure-5"), 0.0, published=("-", -5.0)
        ),
        on["Figure 4"].said(
            "section 3", "joints of the linkage", "4λ + 1", "2λ at the A, 2λ at the P, one at O", published="2λ + 1"
        ),
        on["Figure 4"].number(
            "section 3",
            "freedoms with each spoke by itself",
            mobility("w-figure-5", 0.2, polygons=False),
            0.0,
            published=("1", 1.0),
        ),
        on["Figure 4"].zero("section 3", "the triangles close by themselves, mm", dyads_close("w-figure-5")[0], 1e-9),
        on["Figure 4"].number(
            "section 3",
            "c₁ a circle: its radius, mm",
            arc_radius("w-figure-5")[0],
            1e-8,
            published=("75 (recipe)", 75.0),
        ),
        on["Figure 4"].said(
            "section 3",
            "A′ of a line: coupler quartic; of a circle: sextic",
            "c₂, drawn",
            "the orders are not counted: no recipe depends on them",
        ),
        on["Figure 3"].said(
            "section 3", "a plagiograph of Sylvester: χ² is a rotation by 2α", "as 4.2", "the same equation"
        ),
        on["Figure 5"].number(
            "section 3",
            "the pivot lies within the disc: nearest rim, mm",
            rim(),
            1e-3,
            published=(f"no figure; {rim_closed():.6g}", rim_closed()),
        ),
        faces.zero("section 5", "isoptic circle 2l of c*, mm", isoptic_off("w-ellipse"), 1e-5),
        faces.zero("section 5", "c̄ is the pedal of c*, mm", pedal_off("w-ellipse"), 1e-5),
        leaf.zero("section 5", "the rosette's leaf, mm", rosette_off()[0], 1e-9),
        leaf.zero("section 5", "the next leaf, δ + π on, mm", rosette_off()[1], 1e-9),
        leaf.said(
            "section 6",
            "an algebraic rosette, a hypotrochoid",
            "not made",
            "its equations stand in another paper; any leaf can be given as a formula",
        ),
        on["Figure 5"].said(
            "section 7(a)",
            "from a section of c̄",
            "as Figure 5",
            "printed: subtending φ; it is δ ([misprint](#what-the-papers-misprint))",
        ),
        law.said("section 7(b)", "from a law within δ", "as 4.9", "the recipe's law spans δ"),
        on["Figure 5"].said(
            "section 1", "vibration, springs, the earlier conjecture", "none", "no figure is given of them"
        ),
        Section("w-figure-*", place["Figure 5"]).zero(
            "Figures 4, 5, 8, 9", "turning on the page: chords to the next one, mm", chords, 1e-9
        ),
        on["flat pairs"].zero("section 5", "isoptic and pedal turning on the page: faces to c*, mm", faces_off, 2e-3),
    ]
