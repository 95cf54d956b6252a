"""Contours from SVG drawings at true size: paths of lines, circular arcs and cubics, circles, under transforms.

The unit of the drawing comes from the width of the page and its viewBox. y runs up, as in every other drawing: what SVG
draws downwards is turned over.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from typing import TYPE_CHECKING, NamedTuple
from xml.etree import ElementTree as ET

from kin.read.drawing.about_shaft import drawing_about_shaft
from kin.read.drawing.drawing import BESIDE, CUT, ENGRAVED, REFERENCE, CutEntities
from kin.read.drawing.shapes import Affine, Shape, UnfitError, shape
from kin.read.drawing.svg_path import NUMBER, path_of
from kin.read.errors import ReadError, short, xml_fault
from kin.read.formats import contents
from kin.read.nesting import MOST_PIECES

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path
    from xml.etree.ElementTree import Element

    from kin.read.drawing.drawing import Drawing
    from kin.read.formats import DrawingOptions

SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
LAYERS = frozenset({CUT, ENGRAVED, *BESIDE, *REFERENCE})
# Mm in each unit of CSS, which has 96 pixels to the inch.
UNIT_MM = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72.0, "pc": 25.4 / 6.0, "q": 0.25, "px": 25.4 / 96.0}
UNIT_MM |= {"": UNIT_MM["px"]}
LENGTH = re.compile(rf"({NUMBER})\s*([A-Za-z]*)")
STEP = re.compile(r"\s*([A-Za-z]+)\s*\(([^()]*)\)[\s,]*")
VALUE = re.compile(NUMBER)
DECLARED = re.compile(r"(?:^|;)\s*([-\w]+)\s*:\s*([^;!]*)")
# What a style sheet could move, hide or draw otherwise than the elements say.
MOVING = re.compile(r"(?<![-\w])(transform|translate|scale|rotate|display|visibility|offset-path|cx|cy|r|d)\s*:")
# Scales along the width and the height of the page may differ by so much.
SQUARE = 1e-6
# Least and greatest unit, mm, and number of groups within groups: bounds against nonsense.
UNITS = (1e-6, 1e4)
DEEPEST = 100
MOST_STEPS = 1000  # of one transform
LEANING = 1e-6  # least cosine of an angle of skew
DRAWN = frozenset({"path", "circle"})
# Elements whose content may be seen where they are hidden themselves.
HOLDERS = frozenset({"g", "a", "switch", "svg", "use", "symbol", "foreignObject"})
# Elements that draw nothing themselves, and whose content draws nothing where it stands.
SILENT = frozenset({"title", "desc", "metadata", "defs", "style", "text", "namedview", "script"})
TURNED_OVER = Affine(d=-1.0)


class _Drawn(NamedTuple):
    """An element that draws, the layer it stands on ("" for none), and the map to the page's user space."""

    element: Element
    layer: str
    to: Affine


def read_svg(path: Path, options: DrawingOptions) -> Drawing:
    """Read the outer contour and the holes that an SVG file gives to cut.

    A group is a layer if its id, or Inkscape's label, is the name of a layer of a DXF file. Cut are CUT, BORE, HOLES,
    MARK, GROOVE, GROOVE_INNER, GROOVE_OUTER and what stands on no layer; where nothing stands on CUT, all but reference
    geometry. Elements that no viewer shows are left out: those with display none, and those with visibility hidden or
    collapse, which the elements of a group have from it unless they state their own.

    Raises OSError where the file cannot be read; ReadError for a damaged or too large file, elements, transforms and
    units that are not read, and a contour that is not one closed chain of lines, arcs of circles and cubics.
    """
    root = _parsed(contents(path, "svg"), path)
    unit = unit_of(root, path)
    elements = list(_elements(root, "", TURNED_OVER, path, hidden=_hidden(root, inherited=False)))
    by_name = any(element.layer == CUT for element in elements)
    # what stands on no layer is seen, and cut, all the same
    wanted = {CUT, *BESIDE, ""} if by_name else {element.layer for element in elements} - REFERENCE
    entities = _gathered(elements, wanted, path)
    if not entities.shapes:
        listing = ", ".join(f"{n} {kind} on {on or 'no layer'}" for (on, kind), n in sorted(entities.aside.items()))
        raise ReadError("empty", f"nothing to cut; the file holds {listing or 'nothing at all'}", path)
    marks = _gathered(elements, {ENGRAVED} if by_name else set(), path) if options.engraved else None
    return drawing_about_shaft(entities, marks, unit, path, options, version="SVG")


def _parsed(raw: bytes, path: Path) -> Element:
    if not raw.strip():
        raise ReadError("empty", "the file is empty", path)
    if raw.count(b"<") > 2 * MOST_PIECES:
        raise ReadError("range", f"the file has more than {MOST_PIECES} elements", path)
    if b"<!ENTITY" in raw:
        raise ReadError("unsupported", "the file declares entities of its own", path)
    try:
        # entities, by which a small file could grow without bound, are refused above
        root = ET.fromstring(raw)  # noqa: S314
    except (ET.ParseError, ValueError, LookupError) as error:
        raise ReadError("syntax", f"not a sound SVG file: {xml_fault(error)}", path) from error
    if root.tag != f"{SVG}svg":
        raise ReadError("syntax", f"not an SVG file: its first element is {short(root.tag)}", path)
    if root.get("transform") or "transform" in root.get("style", ""):
        raise ReadError("unsupported", "the page itself is transformed", path)
    return root


def unit_of(root: Element, path: Path) -> float | None:
    """Mm in a unit of the drawing, by the page's width and height and its viewBox; None if neither size is stated.

    Without a viewBox a unit is a pixel of CSS. Raises ReadError for sizes that are not read, a unit out of range, and
    units that differ along width and height.
    """
    sizes = [_length(root.get(name), path) for name in ("width", "height")]
    box = root.get("viewBox")
    if box is None:
        return None if sizes == [None, None] else UNIT_MM["px"]
    numbers = _numbers(box)
    if numbers is None or len(numbers) != 4 or not (numbers[2] > 0.0 and numbers[3] > 0.0):
        raise ReadError("syntax", f"the viewBox is {short(box)!r}", path)
    scales = [size / extent for size, extent in zip(sizes, numbers[2:], strict=True) if size is not None]
    if not all(UNITS[0] <= scale <= UNITS[1] for scale in scales):
        bounds = f"{UNITS[0]:g} to {UNITS[1]:g} mm"
        raise ReadError("range", f"by width and viewBox a unit of the drawing is not {bounds} long", path)
    if len(scales) == 2 and not abs(scales[0] - scales[1]) <= SQUARE * scales[0]:
        message = f"a unit is {scales[0]:.9g} mm along the width and {scales[1]:.9g} mm along the height"
        raise ReadError("unsupported", message, path)
    return scales[0] if scales else None


def _length(text: str | None, path: Path) -> float | None:
    """Length in mm, None if it is left out, automatic or in percent; raises ReadError if it is not read."""
    if text is None or text.strip() == "auto" or text.strip().endswith("%"):
        return None
    match = LENGTH.fullmatch(text.strip())
    if match is None or match[2].lower() not in UNIT_MM or not 0.0 < float(match[1]) < math.inf:
        raise ReadError("syntax", f"the size of the page is {short(text)!r}", path)
    return float(match[1]) * UNIT_MM[match[2].lower()]


def _elements(parent: Element, layer: str, to: Affine, path: Path, depth: int = 0, *, hidden: bool) -> Iterator[_Drawn]:
    """Find all elements that may draw, in order; raises ReadError for styles and transforms that are not read.

    `hidden` says whether the parent's visibility hides what states none of its own.
    """
    for element in parent:
        tag = element.tag if isinstance(element.tag, str) else ""  # not a comment
        kind = tag.removeprefix(SVG)
        if kind == "style" and (moving := MOVING.search(element.text or "")):
            raise ReadError("unsupported", f"a style sheet sets {moving[1]}; give it to the elements", path)
        if not tag or kind.rpartition("}")[2] in SILENT:
            continue
        unseen = _hidden(element, inherited=hidden)
        if _property(element, "display") == "none" or (unseen and kind not in HOLDERS):
            continue
        if "transform" in element.get("style", ""):
            raise ReadError("unsupported", f"{kind} is transformed by its style", path)
        placing = to.after(_transform(element.get("transform", ""), path))
        if kind != "g":
            yield _Drawn(element, layer, placing)
            continue
        if depth == DEEPEST:
            raise ReadError("unsupported", f"groups within groups, {DEEPEST} deep", path)
        names = (element.get(LABEL, "").upper(), element.get("id", "").upper())
        own = next((name for name in names if name in LAYERS), layer)
        yield from _elements(element, own, placing, path, depth + 1, hidden=unseen)


def _hidden(element: Element, *, inherited: bool) -> bool:
    """Whether an element's visibility hides it: its own, or that of its parent, `inherited`."""
    own = _property(element, "visibility")
    return own != "visible" and (inherited or own in {"hidden", "collapse"})


def _property(element: Element, name: str) -> str:
    """Value of a property in small letters, by the style or else by the attribute; empty where neither states it."""
    declared = {key.lower(): value for key, value in DECLARED.findall(element.get("style", ""))}
    return str(declared.get(name, element.get(name, ""))).strip().lower()


def _gathered(elements: list[_Drawn], layers: set[str], path: Path) -> CutEntities:
    """Read the elements on these layers, and count the others; raises ReadError for an element that is not read."""
    entities = CutEntities([], [], [], Counter(), [])
    for number, (element, layer, to) in enumerate(elements, start=1):
        kind = element.tag.removeprefix(SVG)
        if layer not in layers:
            entities.aside[layer, kind] += 1
            continue
        name = f"{short(kind)} #{short(element.get('id', str(number)))}{f' on {layer}' if layer else ''}"
        if kind not in DRAWN:
            raise ReadError("unsupported", f"{name} is none of path and circle; turn it into a path", path)
        try:
            shapes = path_of(element.get("d", ""), to) if kind == "path" else [_circle(element, to)]
        except UnfitError as error:
            reason, problem = error.args
            raise ReadError(reason, f"{name}: {problem}", path) from None
        for piece in shapes:
            entities.shapes.append(piece)
            entities.names.append(name)
            entities.layers.append(layer)
    return entities


def _circle(element: Element, to: Affine) -> Shape:
    """Return a circle as two halves, counter-clockwise; raises UnfitError for unsound numbers and ellipses."""
    x, y, radius = (_plain(element.get(name, "0")) for name in ("cx", "cy", "r"))
    if not radius > 0.0:
        raise UnfitError("range", f"its radius is {radius:g}")
    scale, _ = to.scale_and_sense()
    centre = to.at(x, y)
    return shape(arcs=[(*centre, scale * radius, begin, math.pi) for begin in (0.0, math.pi)], heights=0.0)


def _plain(text: str) -> float:
    if VALUE.fullmatch(text.strip()) is None:
        raise UnfitError("syntax", f"{short(text)!r} is not a number of the drawing's own unit")
    return float(text)


def _numbers(text: str) -> list[float] | None:
    """Numbers between spaces and commas; None where anything else stands there."""
    words = text.replace(",", " ").split()
    return [float(word) for word in words] if all(VALUE.fullmatch(word) for word in words) else None


def _transform(text: str, path: Path) -> Affine:
    """Map of the attribute transform, whose last step is done first; raises ReadError for steps that are not read."""
    text = text.rstrip()
    if text.count("(") > MOST_STEPS:
        raise ReadError("range", f"a transform has more than {MOST_STEPS} steps", path)
    total, at = Affine(), 0
    while at < len(text):
        step = STEP.match(text, at)
        numbers = None if step is None else _numbers(step[2])
        if step is None or numbers is None:
            raise ReadError("syntax", f"a transform is {short(text)!r}", path)
        match step[1], numbers:
            case "matrix", [a, b, c, d, e, f]:
                move = Affine(a, b, c, d, e, f)
            case "translate", [x, *rest] if len(rest) < 2:
                move = Affine(e=x, f=rest[0] if rest else 0.0)
            case "scale", [x, *rest] if len(rest) < 2:
                move = Affine(a=x, d=rest[0] if rest else x)
            case "rotate", [angle]:
                move = Affine.rotation(angle)
            case "rotate", [angle, x, y]:
                move = Affine(e=x, f=y).after(Affine.rotation(angle)).after(Affine(e=-x, f=-y))
            case "skewX" | "skewY" as kind, [angle] if abs(math.cos(math.radians(angle))) > LEANING:
                lean = math.tan(math.radians(angle))
                move = Affine(c=lean) if kind == "skewX" else Affine(b=lean)
            case _:
                read = "matrix, translate, scale, rotate, skewX and skewY are"
                message = f"the transform {short(step[0].strip())} is not read; {read}"
                raise ReadError("unsupported", message, path)
        total = total.after(move)
        at = step.end()
    return total
