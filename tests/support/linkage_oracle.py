"""Linkages and dyads in 50 digits, straight from the loop equations, for motions given by double derivatives.

A lift is a polynomial in a parameter t with the given derivatives at t = 0; positions are found by intersecting circles
and lines, and differentiated by central differences in 140 digits. The condition number of a figure is the sum, over
all inputs, of its change per relative change of the input.
"""

from __future__ import annotations

import mpmath as mp

DIGITS = 50
ROUNDING = mp.mpf(2) ** -53
STEP = mp.mpf(10) ** -45
CHANGE = mp.mpf(10) ** -30
NAMES = ("output", "velocity", "acceleration", "shaft velocity", "shaft acceleration", "frame", "frame'", "frame''")


def polynomial(derivatives):
    return lambda t: sum(mp.mpf(c) * t**k / mp.factorial(k) for k, c in enumerate(derivatives))


def three(path):
    """Value, first and second derivative of a vector-valued path(t) at 0, each a list."""
    before, here, after = path(-STEP), path(mp.mpf(0)), path(STEP)
    before, after = (
        [v - 2 * mp.pi * mp.nint((v - at) / (2 * mp.pi)) for v, at in zip(end, here, strict=True)]
        for end in (before, after)
    )  # an angle may pass its cut; nothing else moves so far in a step
    triples = list(zip(before, here, after, strict=True))
    return here, [(c - a) / (2 * STEP) for a, _, c in triples], [(a - 2 * b + c) / STEP**2 for a, b, c in triples]


def linkage_path(kind, sense, lengths, frame, lifts):
    """Return t -> (theta_3, output) from |D| known and D on the rocker's circle or the slide's line."""

    s, s1 = (polynomial(lift) for lift in lifts)
    w, offset = frame  # its breadth, and how far the joint is off its mid-line

    def path(t):
        y = s(t) - w / 2 + offset
        if kind == "inverted":
            r1, r4 = lengths
            theta4 = sense * mp.acos((r4 - y) / r1)
            return mp.pi / 2 - theta4, theta4
        x = w + lengths[-2 if kind == "four" else 0] - s1(t)
        q = x**2 + y**2
        if kind == "slider":
            dy = lengths[1]
            dx = sense * mp.sqrt(q - dy**2)
            return mp.atan2(dy, dx) - mp.atan2(y, x), dx
        r1, _, r4 = lengths
        dx = (q + r1**2 - r4**2) / (2 * r1)
        dy = sense * mp.sqrt(r4**2 - (r1 - dx) ** 2)
        return mp.atan2(dy, dx) - mp.atan2(y, x), mp.atan2(dy, r1 - dx)

    return path


def linkage_figures(kind, sense, lengths, frame, lifts):
    """Return the figures of NAMES."""
    with mp.workdps(140):
        (frame, out), (frame1, out1), (frame2, out2) = three(linkage_path(kind, sense, lengths, frame, lifts))
        rate = 1 - frame1
        return [out, out1, out2, out1 / rate, (out2 * rate + out1 * frame2) / rate**3, frame, frame1, frame2]


def discriminant(kind, lengths, w, lifts):
    """Least of what stands under the roots, of its scale."""
    with mp.workdps(140):
        lengths, w, s, s1 = [mp.mpf(v) for v in lengths], mp.mpf(w), *(mp.mpf(lift[0]) for lift in lifts)
        y = s - w / 2
        if kind == "inverted":
            r1, r4 = lengths
            return min(r1 - r4 + y, r1 + r4 - y) / r1
        q = (w + lengths[-2 if kind == "four" else 0] - s1) ** 2 + y**2
        if kind == "slider":
            return (q - lengths[1] ** 2) / (q + lengths[1] ** 2 or 1)
        r1, _, r4 = lengths
        return min(q - (r1 - r4) ** 2, (r1 + r4) ** 2 - q) / (r1 + r4) ** 2


def dyad_path(kind, sense, lengths, ground, driven):
    """Return t -> (output, Q_x, Q_y); rrr: lengths PQ, GQ; rrp: PQ, direction; rpr: offset."""

    gx, gy = ground
    px, py = (polynomial(coordinate) for coordinate in driven)

    def path(t):
        x, y = px(t) - gx, py(t) - gy
        if kind == "rrp":
            link, direction = lengths
            ux, uy = mp.cos(direction), mp.sin(direction)
            # |(x, y) - z u|^2 = link^2
            half = x * ux + y * uy
            z = half + sense * mp.sqrt(half**2 - (x**2 + y**2 - link**2))
            return z, gx + z * ux, gy + z * uy
        q = x**2 + y**2
        if kind == "rpr":
            (offset,) = lengths
            slide = mp.sqrt(q - offset**2)
            # P = G + slide u + offset n
            return mp.atan2(y * slide - x * offset, x * slide + y * offset), x + gx, y + gy
        near, far = lengths
        foot = (q + far**2 - near**2) / (2 * q)
        lift = sense * mp.sqrt(far**2 / q - foot**2)
        dx, dy = x * foot - y * lift, y * foot + x * lift
        return mp.atan2(dy, dx), gx + dx, gy + dy

    return path


def dyad_figures(kind, sense, lengths, ground, driven):
    """Return the output and its derivatives, then Q_x, Q_y and theirs."""
    with mp.workdps(140):
        rows = three(dyad_path(kind, sense, lengths, ground, driven))
        return [row[i] for i in range(3) for row in rows]


def judged(figures, shape, numbers):
    """Return figures and their condition numbers; numbers are the inputs, shape makes arguments of them."""
    with mp.workdps(DIGITS):
        exact = [mp.mpf(v) for v in numbers]
        base = figures(*shape(exact))
        condition = [mp.mpf(0)] * len(base)
        for i, v in enumerate(exact):
            if v != 0:
                changed = figures(*shape([*exact[:i], v * (1 + CHANGE), *exact[i + 1 :]]))
                condition = [c + abs(a - b) / CHANGE for c, a, b in zip(condition, changed, base, strict=True)]
        return base, condition


def judged_linkage(kind, assembly, lengths, w, lifts, *, offset=0.0):
    sense, n, m = (1 if assembly == "open" else -1), len(lengths), len(lifts[0])

    def shape(v):
        return kind, sense, v[:n], v[n : n + 2], (v[n + 2 : n + 2 + m], v[n + 2 + m :])

    return judged(linkage_figures, shape, [*lengths, w, offset, *lifts[0], *lifts[1]])


def judged_dyad(kind, assembly, lengths, ground, driven):
    sense, n, m = (1 if assembly == "open" else -1), len(lengths), len(driven[0])

    def shape(v):
        return kind, sense, v[:n], v[n : n + 2], (v[n + 2 : n + 2 + m], v[n + 2 + m :])

    return judged(dyad_figures, shape, [*lengths, *ground, *driven[0], *driven[1]])


def ratio(found, exact, condition):
    """Error over the greater of 1e-10 of the figure and ten roundings times its condition number."""
    with mp.workdps(DIGITS):
        error = abs(mp.mpf(float(found)) - exact)
        allowed = max(abs(exact) * mp.mpf(10) ** -10, 10 * ROUNDING * condition)
        return float(error / allowed) if error else 0.0
