"""What reading costs at worst: `python benchmarks/readers.py [--small] [FORMAT ...]`.

For each format files that are hard on a reader, in two sizes: many tiny entities, many loops, deep nesting, many things
that nothing refers to. Told are processor seconds per megabyte of the file, the ratio to a plain parse of these bytes
in the same run (expat, numpy, ezdxf, or a split into words), and how the cost grows from the smaller file to the larger
one: 1 is linear, 2 quadratic. A file that is refused counts as read. Nothing here passes or fails.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import math
import tempfile
import time
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING
from xml.parsers import expat

import numpy as np

from kin.read.errors import ReadError
from kin.read.files import kind_of, read_drawing, read_solid
from kin.read.gcode import read_gcode

if TYPE_CHECKING:
    from collections.abc import Callable

SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">{}</svg>'
CORE = (
    '<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>{}</model>'
)
LINK = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r" '
    'Target="/m.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
LARGE, SMALL = 8000, 500  # things of which the larger file is made


def rim(count: int) -> np.ndarray:
    """Corners (n, 2) of a contour."""
    t = np.arange(count) * 2.0 * math.pi / count
    return (40.0 + np.cos(3.0 * t))[:, None] * np.column_stack([np.cos(t), np.sin(t)]) + 50.0


def grid(count: int) -> list[tuple[float, float, float]]:
    """Centres and radius of small circles inside one large one."""
    side = math.ceil(math.sqrt(count))
    step = 50.0 / side
    return [(27.0 + step * (k % side), 27.0 + step * (k // side), 0.2 * step) for k in range(count)]


def packed(model: str) -> bytes:
    """A 3MF file of a model."""
    found = io.BytesIO()
    with zipfile.ZipFile(found, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", LINK)
        archive.writestr("m.model", model)
    return found.getvalue()


def model_of(vertices: str, triangles: str, more: str = "", name: str = "1") -> bytes:
    """A 3MF file of one mesh, and objects before its resources end."""
    mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
    return packed(
        CORE.format(f'<object id="1">{mesh}</object>{more}</resources><build><item objectid="{name}"/></build>')
    )


TETRA = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in ((0, 0, 0), (9, 0, 0), (0, 9, 0), (0, 0, 9)))
SIDES = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)))


def dxf(entities: str, blocks: str = "") -> bytes:
    """A drawing of entities and blocks."""
    head = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n"
    middle = f"0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n" if blocks else ""
    return f"{head}{middle}0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n".encode()


def dxf_lines(n: int) -> bytes:
    """Loose lines round a contour, in no order."""
    points = rim(n)
    rows = np.random.default_rng(1).permutation(np.column_stack([points, np.roll(points, -1, axis=0)])).tolist()
    return dxf("".join(f"0\nLINE\n8\n0\n10\n{a!r}\n20\n{b!r}\n11\n{c!r}\n21\n{d!r}\n" for a, b, c, d in rows))


def dxf_circles(n: int) -> bytes:
    """Many holes."""
    rows = [(50.0, 50.0, 48.0), *grid(n)]
    return dxf("".join(f"0\nCIRCLE\n8\n0\n10\n{x!r}\n20\n{y!r}\n40\n{r!r}\n" for x, y, r in rows))


def dxf_blocks(n: int) -> bytes:
    """Blocks within blocks, each twice the one before."""
    blocks = "0\nBLOCK\n2\nB0\n10\n0\n20\n0\n0\nCIRCLE\n8\n0\n10\n1\n20\n1\n40\n1\n0\nENDBLK\n"
    depth = min(15, n)
    for k in range(1, depth):
        twice = f"0\nINSERT\n8\n0\n2\nB{k - 1}\n10\n{2.0**k}\n20\n0\n" * 2
        blocks += f"0\nBLOCK\n2\nB{k}\n10\n0\n20\n0\n{twice}0\nENDBLK\n"
    return dxf(f"0\nINSERT\n8\n0\n2\nB{depth - 1}\n10\n0\n20\n0\n" * max(1, n // 400), blocks)


def svg_lines(n: int) -> bytes:
    """Every edge of a contour as a path of its own."""
    points = rim(n)
    rows = np.column_stack([points, np.roll(points, -1, axis=0)]).tolist()
    return SVG.format("".join(f'<path d="M{a!r} {b!r}L{c!r} {d!r}"/>' for a, b, c, d in rows)).encode()


def svg_circles(n: int) -> bytes:
    """Many holes."""
    return SVG.format(
        "".join(f'<circle cx="{x!r}" cy="{y!r}" r="{r!r}"/>' for x, y, r in [(50, 50, 48), *grid(n)])
    ).encode()


def svg_path(n: int) -> bytes:
    """One long path."""
    return SVG.format(f'<path d="M{"L".join(f"{x!r} {y!r}" for x, y in rim(10 * n).tolist())}Z"/>').encode()


def svg_subpaths(n: int) -> bytes:
    """One path of many closed outlines."""
    around = "M10 10H90V90H10Z"
    return SVG.format(f'<path d="{around}{"".join(f"M{x!r} {y!r}h{r!r}v{r!r}Z" for x, y, r in grid(n))}"/>').encode()


def svg_groups(n: int) -> bytes:
    """Groups within groups, over and over."""
    deep = "<g>" * 99 + "</g>" * 99
    return SVG.format(f'<circle cx="50" cy="50" r="40"/>{deep * (n // 20)}').encode()


def stl_of(triangles: np.ndarray) -> bytes:
    """A binary STL."""
    records = np.zeros(len(triangles), dtype=RECORD)
    records["corners"] = triangles
    return bytes(80) + len(triangles).to_bytes(4, "little") + records.tobytes()


def prism(points: np.ndarray, low: float, high: float) -> np.ndarray:
    """Triangles of a prism over a convex polygon."""
    a, b = np.column_stack([points, np.full(len(points), low)]), np.column_stack([points, np.full(len(points), high)])
    a2, b2 = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
    walls = np.concatenate([np.stack([a, a2, b2], axis=1), np.stack([a, b2, b], axis=1)])
    fans = [np.stack([np.broadcast_to(one[0], one.shape)[1:-1], one[1:-1], one[2:]], axis=1) for one in (a[::-1], b)]
    return np.concatenate([walls, *fans])


def stl_rim(n: int) -> bytes:
    """A prism of many sides."""
    return stl_of(prism(rim(5 * n), 0.0, 8.0))


def stl_bodies(n: int) -> bytes:
    """Many bodies beside one another."""
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    return stl_of(np.concatenate([prism(r * corners + (x, y), 0.0, 1.0 + r) for x, y, r in grid(n)]))


def stl_levels(n: int) -> bytes:
    """One body over another, each at a height of its own."""
    corners = np.array([(0, 0), (9, 0), (9, 9), (0, 9)])
    return stl_of(np.concatenate([prism(corners, 2.0 * k, 2.0 * k + 1.0) for k in range(n)]))


def mf_loose(n: int) -> bytes:
    """Vertices that no triangle has."""
    rng = np.random.default_rng(1)
    return model_of(
        TETRA + "".join(f'<vertex x="{x!r}" y="{y!r}" z="0"/>' for x, y in rng.random((4 * n, 2)).tolist()), SIDES
    )


def mf_same(n: int) -> bytes:
    """The same vertex over and over, which packs to next to nothing."""
    return model_of(TETRA + '<vertex x="0" y="0" z="0"/>' * (60 * n), SIDES)


def mf_components(n: int) -> bytes:
    """An object of loose vertices, many times over."""
    parts = "".join(f'<component objectid="1" transform="1 0 0 0 1 0 0 0 1 {20 * k} 0 0"/>' for k in range(2 * n))
    loose = '<vertex x="0" y="0" z="0"/>' * n
    return model_of(TETRA + loose, SIDES, f'<object id="2"><components>{parts}</components></object>', "2")


def mf_deep(n: int) -> bytes:
    """Objects of twice the one before, with nothing in them at last."""
    rows = "".join(
        f'<object id="{k}"><components>{f"<component objectid={chr(34)}{k - 1}{chr(34)}/>" * 2}</components></object>'
        for k in range(2, 16)
    )
    return model_of(TETRA + f'<vertex x="0" y="0" z="{n}"/>', SIDES, rows, "15")


def step_of(points: np.ndarray, loose: int = 0) -> bytes:
    """A prism with flat walls, and points that nothing refers to."""
    lines: list[str] = []

    def add(text: str) -> str:
        lines.append(text)
        return f"#{len(lines)}"

    def point(place: list[float]) -> str:
        return add(f"CARTESIAN_POINT('',({','.join(map(repr, map(float, place)))}))")

    def along(way: list[float]) -> str:
        return add(f"DIRECTION('',({','.join(map(repr, map(float, way)))}))")

    def edge(first: int, last: int, ends: np.ndarray) -> str:
        place = ends[first]
        arrow = add(f"VECTOR('',{along((ends[last] - place).tolist())},1.)")
        return add(
            f"EDGE_CURVE('',{tops[first]},{tops[last]},{add(f'LINE({chr(39)}{chr(39)},{point(place.tolist())},{arrow})')},.T.)"
        )

    def face(uses: list[str], at: np.ndarray, normal: list[float]) -> str:
        turned = [add(f"ORIENTED_EDGE('',*,*,{one.lstrip('-')},.{'F' if one[0] == '-' else 'T'}.)") for one in uses]
        ring = add(f"EDGE_LOOP('',({','.join(turned)}))")
        bound = add(f"FACE_OUTER_BOUND('',{ring},.T.)")
        axes = add(f"AXIS2_PLACEMENT_3D('',{point(at.tolist())},{along(normal)},$)")
        return add(f"ADVANCED_FACE('',({bound}),{add(f'PLANE({chr(39)}{chr(39)},{axes})')},.T.)")

    count = len(points)
    ends = np.concatenate([np.column_stack([points, np.full(count, z)]) for z in (0.0, 8.0)])
    tops = [add(f"VERTEX_POINT('',{point(one.tolist())})") for one in ends]
    low = [edge(k, (k + 1) % count, ends) for k in range(count)]
    high = [edge(count + k, count + (k + 1) % count, ends) for k in range(count)]
    ribs = [edge(k, count + k, ends) for k in range(count)]
    faces = []
    for k in range(count):
        x, y = (points[(k + 1) % count] - points[k]).tolist()
        faces.append(face([low[k], ribs[(k + 1) % count], f"-{high[k]}", f"-{ribs[k]}"], ends[k], [y, -x, 0.0]))
    faces.append(face([f"-{one}" for one in reversed(low)], ends[0], [0, 0, -1]))
    faces.append(face(high, ends[-1], [0, 0, 1]))
    solid = add(f"MANIFOLD_SOLID_BREP('',{add(f'CLOSED_SHELL({chr(39)}{chr(39)},({chr(44).join(faces)}))')})")
    unit = add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
    context = "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT(({}))REPRESENTATION_CONTEXT('',''))"
    add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',({solid}),{add(context.format(unit))})")
    for k in range(loose):
        point([k, 0.0, 0.0])
    body = "\n".join(f"#{k}={line};" for k, line in enumerate(lines, start=1))
    head = "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
    return f"{head}{body}\nENDSEC;\nEND-ISO-10303-21;\n".encode()


def step_faces(n: int) -> bytes:
    """Many walls."""
    return step_of(rim(n // 4))


def step_loose(n: int) -> bytes:
    """Many points that nothing refers to."""
    return step_of(rim(20), 10 * n)


def gcode_moves(n: int) -> bytes:
    """Many small moves."""
    head = "G21 G90 G17 G94\nM3 S9000\nG0 Z5\nG0 X0 Y0\nG1 Z-1 F100\n"
    return (head + "".join(f"G1 X{x:.4f} Y{y:.4f}\n" for x, y in rim(10 * n).tolist()) + "M5\nM30\n").encode()


def gcode_comments(n: int) -> bytes:
    """Many comments in one line."""
    return ("G21 G90 " + "(a)" * (40 * n) + "\nM30\n").encode()


def plain(path: Path, raw: bytes) -> object:
    """Parse the same bytes with nothing made of them."""
    kind = kind_of(path)
    if kind == "3mf":
        with zipfile.ZipFile(path) as archive:
            return expat.ParserCreate().Parse(archive.read("m.model"), True)
    if kind == "svg":
        return expat.ParserCreate().Parse(raw, True)
    if kind == "stl":
        return np.sort(np.frombuffer(raw, RECORD, offset=84)["corners"].reshape(-1, 3), axis=0)
    if kind == "dxf":
        from ezdxf.filemanagement import readfile

        return readfile(path)
    return raw.decode("latin-1").replace("(", " ( ").replace(",", " , ").split()


def spent(function: Callable[[], object]) -> float:
    """Least processor seconds of two runs, of one that takes long."""
    best = math.inf
    for _ in range(2):
        start = time.process_time()
        with contextlib.suppress(ReadError):
            function()
        best = min(best, time.process_time() - start)
        if best > 2.0:
            break
    return best


def read(path: Path) -> object:
    """Read a file of any format."""
    kind = kind_of(path)
    if kind == "gcode":
        return read_gcode(path)
    return read_drawing(path) if kind in {"dxf", "svg"} else read_solid(path)


CASES: dict[str, tuple[Callable[[int], bytes], ...]] = {
    "dxf": (dxf_lines, dxf_circles, dxf_blocks),
    "svg": (svg_lines, svg_circles, svg_path, svg_subpaths, svg_groups),
    "stl": (stl_rim, stl_bodies, stl_levels),
    "3mf": (mf_loose, mf_same, mf_components, mf_deep),
    "step": (step_faces, step_loose),
    "gcode": (gcode_moves, gcode_comments),
}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("formats", nargs="*", metavar="FORMAT", help=f"of {', '.join(CASES)} (default: all)")
    parser.add_argument("--small", action="store_true", help="small files, to see that all of it runs")
    arguments = parser.parse_args()
    wanted = arguments.formats or list(CASES)
    if unknown := set(wanted) - CASES.keys():
        parser.error(f"{', '.join(sorted(unknown))}: none of {', '.join(CASES)}")
    large = SMALL if arguments.small else LARGE
    print("| format | file | MB | s | s a MB | ratio to a plain parse | growth |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for kind in wanted:
            for make in CASES[kind]:
                name = (make.__doc__ or "").rstrip(".").lower()
                path = Path(folder) / f"file.{kind}"
                figures = []
                for count in (large // 4, large):
                    raw = make(count)
                    path.write_bytes(raw)
                    figures.append((len(raw) / 1e6, spent(lambda path=path: read(path))))
                base = spent(lambda path=path, raw=raw: plain(path, raw))
                (less, soon), (size, seconds) = figures
                growth = (
                    math.log(max(seconds, 1e-4) / max(soon, 1e-4)) / math.log(size / less) if size > 1.5 * less else 0.0
                )
                ratio = seconds / max(base, 1e-4)
                told = [f"{one:.3g}" for one in (size, seconds, seconds / size, ratio, growth)]
                print(f"| {kind} | {name} | {' | '.join(told)} |", flush=True)


if __name__ == "__main__":
    main()
