"""Draw docs/pictures/linkage-*.png from the shipped recipes: `python tools/docs/make_linkage_pictures.py`."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import matplotlib as mpl
import numpy as np

from camgeo.recipe.loading import load
from camgeo.synthesis.design import designed
from kin.linkage.four_bar import InvertedSliderCrank, SliderCrank

mpl.use("Agg")
import matplotlib.pyplot as plt  # the backend must be chosen first
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Arc, Polygon
from PIL import Image

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from kin.law.support_function import Lift
    from kin.linkage.dyad import RRR
    from kin.linkage.four_bar import FourBar
    from kin.linkage.mechanism import LinkageMotion, Mechanism

    Array = NDArray[np.float64]

ROOT = Path(__file__).parents[2]
INK, METAL, ACCENT, FRAME, QUIET = "#26323f", "#cfd8e3", "#c8442c", "#2f6fa8", "#8a97a6"
# the paper calls the curve of cam 2a the black one
COLOURS = {"1": "#c8442c", "2a": "#000000", "2b": "#2f6fa8", "2c": "#3a8f4d", "2d": "#8e5aa8"}
TURN = 2.0 * np.pi
QUARTERS = np.arange(5) * np.pi / 2
QUARTER_NAMES = ["0", "π/2", "π", "3π/2", "2π"]
BAND = np.radians(0.1)
DASHED: dict[str, Any] = {"color": QUIET, "lw": 0.8, "ls": (0, (8, 3, 1, 3)), "zorder": 3.5}


@dataclass(frozen=True)
class Scene:
    """A shipped recipe with its exact motion."""

    lift: Lift
    mechanism: Mechanism | None

    @classmethod
    def of(cls, name: str) -> Scene:
        """Load and design."""
        recipe = load(ROOT / "recipes" / f"{name}.yaml")
        design = designed(recipe)
        return cls(cast("Lift", design.exact.law), None if design.driven is None else design.driven.mechanism)

    @property
    def driven(self) -> Mechanism:
        """The mechanism, where there is one."""
        if self.mechanism is None:
            raise ValueError("the recipe has no linkage")
        return self.mechanism

    def shaft_of(self, theta: Array) -> Array:
        """Shaft angle at relative angles."""
        return cast("Array", self.driven.at(theta, 0).shaft[0])


def main() -> None:
    """Draw them all."""
    plt.rcParams.update({"font.size": 9, "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": INK})
    plt.rcParams.update({"xtick.color": INK, "ytick.color": INK, "axes.linewidth": 0.7, "axes.titlesize": 10})
    save(mechanisms(), "mechanisms")
    save(figure_6(), "figure-6")
    save(positions("as-figure-8", (0, 100, 280)), "figure-8")
    four = {"a": ("1", "2a"), "b": ("2c", "2d")}
    save(motions("as-figure-9", four, (9, 10, 11)), "figures-9-10-11")
    save(positions("as-figure-12", (55, 120, 230)), "figure-12")
    slider = {"a": ("1", "2a"), "b": ("2b", "2d")}
    save(motions("as-figure-13", slider, (13, 14, 15)), "figures-13-14-15")
    save(two_angles(), "dwells")
    save(others(), "others")


def save(figure: Figure, name: str) -> None:
    """Write one picture in as few colours as it needs."""
    path = ROOT / "docs" / "pictures" / f"linkage-{name}.png"
    figure.set_dpi(110)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[:, :, :3])
    picture.quantize(64, dither=Image.Dither.NONE).save(path, optimize=True)
    plt.close(figure)
    print(f"{path.name}: {path.stat().st_size} bytes")


# Mechanisms to scale


def turned(points: Array, angle: float) -> Array:
    """Points (n, 2) turned about the shaft."""
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def outline(lift: Lift) -> Array:
    """The cam's contour (n, 2), p u + p' n."""
    t = np.linspace(0.0, TURN, 1441)
    p, slope = lift.derivatives(t, 1)
    return np.column_stack([p * np.cos(t) - slope * np.sin(t), p * np.sin(t) + slope * np.cos(t)])


@dataclass(frozen=True)
class Pose:
    """Where everything stands at one relative angle, mm in the fixed frame."""

    theta: float
    shaft: float
    frame: float  # theta_3
    output: float
    cam: float  # what the cam's own axes are turned by
    joint: Array
    left: float  # sides of the square in its own axes, u to the right and n upward
    right: float
    low: float
    high: float

    @classmethod
    def of(cls, scene: Scene, theta: float) -> Pose:
        """One pose; the face of lift S has the normal n(theta_3), that of S1 has -u(theta_3)."""
        mechanism = scene.driven
        motion: LinkageMotion = mechanism.at(np.array([theta]), 0)
        s, s1 = scene.lift.derivatives(np.array([theta, theta + np.pi / 2]), 0)[0]
        three, width = float(motion.frame[0, 0]), mechanism.breadth
        return cls(
            theta,
            float(motion.shaft[0, 0]),
            three,
            float(motion.outputs[0][0, 0]),
            three + np.pi / 2 - theta,
            motion.joint[:, 0, 0],
            -s1,
            width - s1,
            s - width,
            s,
        )

    def at(self, along: float, across: float) -> Array:
        """A point of the square's axes in the fixed frame."""
        return turned(np.array([[along, across]]), self.frame)[0]

    @property
    def square(self) -> Array:
        """Corners of the frame (4, 2)."""
        corners = np.array(
            [[self.left, self.low], [self.right, self.low], [self.right, self.high], [self.left, self.high]]
        )
        return turned(corners, self.frame)


def pin(axis: Axes, point: Array, name: str = "", offset: tuple[float, float] = (6, 6)) -> None:
    """A revolute joint with its letter; the offset is in points of the page."""
    axis.plot(*point, "o", ms=5.5, mfc="white", mec=INK, mew=1.2, zorder=6)
    if name:
        axis.annotate(name, point, offset, textcoords="offset points", zorder=7, ha="center", va="center")


def earth(axis: Axes, point: Array, size: float) -> None:
    """Hatching below a fixed pivot."""
    x, y = point
    foot = np.array([[x, y], [x - 0.6 * size, y - size], [x + 0.6 * size, y - size]])
    axis.add_patch(Polygon(foot, closed=True, fc="white", ec=INK, lw=0.9, zorder=4))
    for k in range(5):
        left = x - 0.8 * size + 0.4 * size * k
        axis.plot([left, left - 0.3 * size], [y - size, y - 1.4 * size], color=INK, lw=0.7, zorder=4)
    axis.plot([x - size, x + size], [y - size, y - size], color=INK, lw=0.9, zorder=4)


def block(axis: Axes, centre: Array, angle: float, size: float) -> None:
    """A sliding block."""
    corners = np.array([[-1.0, -0.6], [1.0, -0.6], [1.0, 0.6], [-1.0, 0.6]]) * size
    axis.add_patch(Polygon(turned(corners, angle) + centre, closed=True, fc="#f3d6cf", ec=ACCENT, lw=1.3, zorder=5))


def draw_pose(axis: Axes, scene: Scene, pose: Pose, size: float, *, marked: bool) -> None:
    """Cam, square frame, coupler's arm, output link and joints; `size` is that of the small parts, mm.

    `marked` draws a line from the cam's middle along its own x axis, which shows how it has turned.
    """
    cam = turned(outline(scene.lift), pose.cam)
    axis.fill(cam[:, 0], cam[:, 1], facecolor=METAL, edgecolor=INK, lw=1.1, zorder=2)
    if marked:
        middle = cam[:-1].mean(axis=0)
        mark = middle + turned(np.array([[0.0, 0.0], [3.2 * size, 0.0]]), pose.cam)
        axis.plot(mark[:, 0], mark[:, 1], color=QUIET, lw=1.2, zorder=3)
        axis.plot(*middle, "o", color=QUIET, ms=3, zorder=3)
    faces = pose.theta + np.arange(4) * np.pi / 2
    p, slope = scene.lift.derivatives(faces, 1)
    contact = np.column_stack([p * np.cos(faces) - slope * np.sin(faces), p * np.sin(faces) + slope * np.cos(faces)])
    axis.plot(*turned(contact, pose.cam).T, "o", color=INK, ms=2.6, zorder=4)
    axis.add_patch(Polygon(pose.square, closed=True, fill=False, ec=FRAME, lw=1.8, zorder=3))
    middle = pose.at(pose.right, (pose.low + pose.high) / 2)
    linkage = scene.driven.linkage
    origin, named_apart = np.zeros(2), True
    earth(axis, origin, size)
    if isinstance(linkage, SliderCrank):
        reach = np.array([pose.joint[0] - 6 * size, pose.joint[0] + 6 * size])
        axis.plot(reach, np.full(2, linkage.offset - 0.6 * size), color=INK, lw=0.9, zorder=1)
        axis.plot(reach, np.full(2, linkage.offset + 0.6 * size), color=INK, lw=0.9, zorder=1)
        block(axis, pose.joint, 0.0, size)
        axis.plot(*np.column_stack([middle, pose.joint]), color=FRAME, lw=1.8, zorder=5.5)
    else:
        pivot = np.array([linkage.ground, 0.0])
        earth(axis, pivot, size)
        if isinstance(linkage, InvertedSliderCrank):
            tip = pose.joint + 2.6 * size * np.array([np.cos(pose.frame), np.sin(pose.frame)])
            axis.plot(*np.column_stack([pivot, pose.joint]), color=ACCENT, lw=1.8, zorder=4.5)
            block(axis, pose.joint, pose.frame, size)
            axis.plot(*np.column_stack([middle, tip]), color=FRAME, lw=1.8, zorder=5.5)
        else:
            axis.plot(*np.column_stack([middle, pose.joint]), color=FRAME, lw=1.8, zorder=4)
            axis.plot(*np.column_stack([pivot, pose.joint]), color=ACCENT, lw=1.8, zorder=4.5)
        named_apart = bool(np.hypot(*(pivot - pose.joint)) > size)
        pin(axis, pivot, "B" if named_apart else "", (12, 2))
    pin(axis, origin)
    if not isinstance(linkage, InvertedSliderCrank):
        pin(axis, pose.joint)
    axis.annotate(
        "D" if named_apart else "B = D",
        pose.joint,
        (1, 13),
        textcoords="offset points",
        ha="center",
        va="center",
        zorder=7,
    )
    axis.set_aspect("equal")
    axis.axis("off")


def positions(name: str, degrees: tuple[int, ...]) -> Figure:
    """AS Figures 8 and 12: the mechanism at the paper's relative angles, to one scale."""
    scene = Scene.of(name)
    poses = [Pose.of(scene, np.radians(angle)) for angle in degrees]
    corners = np.concatenate([np.vstack([pose.square, pose.joint]) for pose in poses])
    ground = cast("FourBar | InvertedSliderCrank", scene.driven.linkage).ground
    low, high = corners.min(axis=0) - 6.0, np.maximum(corners.max(axis=0), [ground, 0.0]) + 12.0
    wide, tall = high - low
    figure, axes = plt.subplots(1, len(poses), figsize=(10.5, 10.5 / 3 * tall / wide + 0.45), constrained_layout=True)
    for axis, pose, angle in zip(axes, poses, degrees, strict=True):
        draw_pose(axis, scene, pose, 5.0, marked=True)
        inward = float(np.sign(turned(outline(scene.lift), pose.cam)[:, 0].mean()))
        axis.annotate("A", (0, 0), (12 * inward, 3), textcoords="offset points", ha="center", va="center", zorder=7)
        axis.set_xlim(low[0], high[0])
        axis.set_ylim(low[1], high[1])
        axis.set_title(f"θ = {angle}°, shaft turned {np.degrees(pose.shaft):.1f}°")
    return figure


def angle_mark(axis: Axes, centre: Array, radii: tuple[float, float], angles: tuple[float, float], name: str) -> None:
    """An arc counter-clockwise between two directions, rad, with its name; radii of the arc and of the name."""
    start, end = np.degrees(angles)
    size = 2 * radii[0]
    axis.add_patch(Arc(tuple(centre), size, size, theta1=start, theta2=end, color=INK, lw=0.8, zorder=6))
    middle = np.radians((start + end) / 2)
    place = centre + radii[1] * np.array([np.cos(middle), np.sin(middle)])
    axis.text(*place, name, ha="center", va="center", zorder=7)


def measure(axis: Axes, ends: tuple[Array, Array], name: str, place: Array) -> None:
    """A double arrow with its name."""
    arrow = {"arrowstyle": "<->", "color": INK, "lw": 0.8, "shrinkA": 0, "shrinkB": 0}
    axis.annotate("", ends[1], ends[0], arrowprops=arrow, zorder=6)
    axis.text(*place, name, ha="center", va="center", zorder=7)


def mechanisms() -> Figure:
    """The three linkages with the names of their parts: AS Figures 4 and 7, and the slider-crank."""
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.5), constrained_layout=True)
    names = ("as-figure-9-2a", "as-figure-13-2a", "slider-crank")
    titles = ("four-bar", "inverted slider-crank", "slider-crank")
    widths = []
    for axis, name, title in zip(axes, names, titles, strict=True):
        scene = Scene.of(name)
        pose = Pose.of(scene, np.radians(200.0))
        unit = scene.driven.breadth / 50.0
        draw_pose(axis, scene, pose, 5.0 * unit, marked=False)
        name_parts(axis, scene, pose, unit)
        axis.set_anchor("S")
        axis.text(0.5, -0.04, title, transform=axis.transAxes, ha="center", va="top", fontsize=10)
        widths.append(axis.dataLim.width / unit)
    axes[0].get_gridspec().set_width_ratios(widths)
    return figure


def name_parts(axis: Axes, scene: Scene, pose: Pose, unit: float) -> None:
    """Letters, angles and lengths of one drawing; `unit` is a fiftieth of the breadth, mm."""
    u, n = pose.at(1.0, 0.0), pose.at(0.0, 1.0)
    linkage = scene.driven.linkage
    axis.text(*pose.at(5.5 * unit, 4.5 * unit), "A", ha="center", va="center", zorder=7)
    middle = pose.at(pose.right, (pose.low + pose.high) / 2)
    axis.text(*(middle - 4.5 * unit * u), "G", ha="center", va="center", zorder=7)
    measure(axis, (np.zeros(2), pose.high * n), "S", pose.at(-3.5 * unit, 0.6 * pose.high))
    measure(axis, (np.zeros(2), pose.left * u), "S₁", pose.at(0.6 * pose.left, 4.5 * unit))
    beyond = pose.high + 4.0 * unit
    width = (pose.at(pose.left, beyond), pose.at(pose.right, beyond))
    measure(axis, width, "w", (width[0] + width[1]) / 2 + 4.5 * unit * n)
    axis.text(*((middle + pose.joint) / 2 + 5.0 * unit * n), "r₃", ha="center", va="center")
    # theta: from the cam's own x axis, counter-clockwise, to the normal of the face with lift S
    own = 17.0 * unit * np.array([np.cos(pose.cam), np.sin(pose.cam)])
    axis.plot([0.0, own[0]], [0.0, own[1]], color=INK, lw=0.8, zorder=3.5)
    angle_mark(axis, np.zeros(2), (10.0 * unit, 14.0 * unit), (pose.cam, pose.cam + pose.theta), "θ")
    if isinstance(linkage, SliderCrank):
        axis.plot([0.0, pose.joint[0]], [0.0, 0.0], **DASHED)
        place = 0.8 * pose.joint[0]
        ends = (np.array([place, 0.0]), np.array([place, linkage.offset]))
        measure(axis, ends, "offset", np.array([place + 10.0 * unit, -4.0 * unit]))
        return
    # theta_3: from the fixed line to the coupler's
    axis.plot([middle[0], middle[0] + 26.0 * unit], [middle[1], middle[1]], **DASHED)
    angle_mark(axis, middle, (20.0 * unit, 25.5 * unit), (0.0, pose.frame), "θ₃")
    pivot = np.array([linkage.ground, 0.0])
    axis.plot([0.0, linkage.ground], [0.0, 0.0], **DASHED)
    axis.text(0.72 * pivot[0], -5.0 * unit, "r₁", ha="center", va="center")
    axis.text(*((pivot + pose.joint) / 2 + 6.0 * unit * u), "r₄", ha="center", va="center")
    angle_mark(axis, pivot, (17.0 * unit, 23.0 * unit), (np.pi - pose.output, np.pi), "θ₄")


# Curves


def quarters(axis: Axes) -> None:
    """The relative angle in the paper's units."""
    axis.set_xlim(0.0, TURN)
    axis.set_xticks(QUARTERS, QUARTER_NAMES)
    axis.grid(color="#dfe4ea", lw=0.6)
    axis.set_axisbelow(True)


def figure_6() -> Figure:
    """AS Figure 6: lift of the yoke for the cams of Figure 2."""
    figure, axis = plt.subplots(figsize=(6.6, 3.4), constrained_layout=True)
    t = np.linspace(0.0, TURN, 721)
    for cam in ("2a", "2b", "2c", "2d"):
        axis.plot(
            t, Scene.of(f"as-figure-{cam}").lift.derivatives(t, 0)[0], color=COLOURS[cam], lw=1.3, label=f"cam {cam}"
        )
    quarters(axis)
    axis.set_xlabel("θ, rad")
    axis.set_ylabel("s, mm")
    axis.set_title("Figure 6")
    axis.legend(frameon=False)
    return figure


def motions(stem: str, cams: dict[str, tuple[str, ...]], numbers: tuple[int, int, int]) -> Figure:
    """AS Figures 9 to 11 or 13 to 15: theta_4 and its two derivatives over the relative angle, omega_2 = 1."""
    figure, axes = plt.subplots(3, 2, figsize=(9.5, 8.0), sharex=True, sharey="row", constrained_layout=True)
    t = np.linspace(0.0, TURN, 721)
    for column, (part, names) in enumerate(cams.items()):
        for cam in names:
            output = Scene.of(f"{stem}-{cam}").driven.at(t, 2).output
            for axis, row in zip(axes[:, column], (np.degrees(output[0]), output[1], output[2]), strict=True):
                axis.plot(t, row, color=COLOURS[cam], lw=1.3, label=f"cam {cam}")
        for axis, number in zip(axes[:, column], numbers, strict=True):
            quarters(axis)
            axis.set_title(f"Figure {number}{part}")
            axis.legend(frameon=False, loc="upper right", ncols=2)
    for axis, name in zip(axes[:, 0], ("θ₄, deg", "ω₄ (ω₂ = 1)", "α₄ (ω₂ = 1)"), strict=True):
        axis.set_ylabel(name)
        low, high = axis.get_ylim()
        axis.set_ylim(low, high + 0.14 * (high - low))  # room for the legend
    for axis in axes[-1]:
        axis.set_xlabel("θ, rad")
    return figure


def two_angles() -> Figure:
    """The two dwells of the paper over the relative angle and over the shaft angle, band 0.1 deg."""
    figure, axes = plt.subplots(1, 2, figsize=(10.0, 3.9), constrained_layout=True)
    titles = {"as-figure-9-2a": "four-bar, Figure 9a", "as-figure-13-2a": "inverted slider-crank, Figure 13a"}
    for axis, (name, title) in zip(axes, titles.items(), strict=True):
        scene = Scene.of(name)
        mechanism = scene.driven
        theta = np.linspace(0.0, 2 * TURN, 7201)
        shaft, value = scene.shaft_of(theta), np.degrees(mechanism.at(theta, 0).output[0])
        found = (
            mechanism.dwells(BAND, "relative")[0],
            mechanism.dwells(BAND, "shaft")[0],
        )
        level = np.degrees(found[0].least)
        for one, angle, name_of, colour, height in zip(
            found, (theta, shaft), ("relative angle θ", "shaft angle"), (INK, ACCENT), (-0.2, -0.45), strict=True
        ):
            start, length = np.degrees([one.start, one.length])
            axis.plot(np.degrees(angle), value - level, color=colour, lw=1.4, label=f"over the {name_of}")
            axis.annotate(
                "",
                (start + length, height),
                (start, height),
                arrowprops={"arrowstyle": "<->", "color": colour, "lw": 1.2, "shrinkA": 0, "shrinkB": 0},
            )
            axis.text(start + length / 2, height - 0.03, f"{length:.2f}°", color=colour, ha="center", va="top")
            axis.vlines([start, start + length], height, [0.0, 0.0], color=colour, lw=0.6, ls=":")
        axis.axhspan(0.0, np.degrees(BAND), color="#f3d6cf", lw=0, zorder=0)
        centre = np.degrees(found[0].start + 0.5 * found[0].length)
        axis.set_xlim(centre - 55, centre + 75)
        axis.set_ylim(-0.7, 0.55)
        axis.set_title(f"{title}, cam 2a")
        axis.set_xlabel("degrees")
        axis.set_ylabel(f"θ₄ less {level:.2f}, deg")
        axis.legend(frameon=False, loc="upper center")
    return figure


def others() -> Figure:
    """Recipes beyond the paper: an oscillating yoke, a slider-crank and a six-bar, with their outputs over a turn."""
    figure, axes = plt.subplots(2, 3, figsize=(11, 5.6), constrained_layout=True, height_ratios=[1.5, 1.0])
    names = ("oscillating-yoke", "six-bar", "slider-crank")
    titles = ("oscillating yoke", "six-bar: a four-bar and a dyad", "slider-crank")
    shaft = np.linspace(0.0, TURN, 721)
    for column, (name, title) in enumerate(zip(names, titles, strict=True)):
        scene, axis = Scene.of(name), axes[0, column]
        mechanism = scene.driven
        pose = Pose.of(scene, np.radians(150.0))
        draw_pose(axis, scene, pose, mechanism.breadth / 10.0, marked=True)
        draw_dyad(axis, scene, pose)
        axis.margins(0.08, 0.12)
        axis.set_title(title)
        axis = axes[1, column]
        scale, unit = (1.0 / 25.4, "in") if mechanism.unit == "mm" else (np.degrees(1.0), "deg")
        outputs = mechanism.at(mechanism.relative(shaft), 0).outputs
        for row, link in zip(outputs, ("first rocker", "dyad's rocker"), strict=False):
            colour = QUIET if row is not outputs[-1] else ACCENT
            axis.plot(np.degrees(shaft), scale * row[0], color=colour, lw=1.4, label=link)
        if len(outputs) > 1:
            axis.legend(frameon=False, loc="center right", fontsize=8)
        axis.set_xlim(0.0, 360.0)
        axis.set_xticks([0, 90, 180, 270, 360])
        axis.grid(color="#dfe4ea", lw=0.6)
        axis.set_xlabel("shaft angle, degrees")
        axis.set_ylabel(f"output, {unit}")
    return figure


def draw_dyad(axis: Axes, scene: Scene, pose: Pose) -> None:
    """The RRR dyad of the six-bar, hung on the rocker."""
    mechanism = scene.driven
    if not mechanism.dyads:
        return
    bars = cast("RRR", mechanism.dyads[0])
    base = np.array([cast("FourBar", mechanism.linkage).ground, 0.0])
    hung = base + turned(np.array([bars.point]), np.pi - pose.output)[0]
    motion = mechanism.at(np.array([pose.theta]), 0)
    angle, pivot = float(motion.outputs[1][0, 0]), np.array(bars.ground)
    elbow = pivot + bars.links[1] * np.array([np.cos(angle), np.sin(angle)])
    earth(axis, pivot, 5.0)
    for ends, colour in (((hung, elbow), "#3a8f4d"), ((elbow, pivot), ACCENT)):
        axis.plot(*np.column_stack(ends), color=colour, lw=1.8, zorder=5)
    for point in (hung, elbow, pivot):
        pin(axis, point)


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
