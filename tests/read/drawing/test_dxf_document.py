"""DXF files of plain form, read by their frames and their entities: as ezdxf reads them whole, or left to it.

Holds: kin.read.drawing.dxf_document.
"""

from __future__ import annotations

from io import StringIO
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.cases import few
from support.heavy import ezdxf

from kin.read.drawing.dxf import on_paper
from kin.read.drawing.dxf_document import FRAMES, _frame, opened, plain, whole

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

TRIALS = 40
WORDS = (
    b"0|SECTION|ENDSEC|EOF|999|nan|1e400|-1|| 67|5|330|1F|17|2|HEADER|ENTITIES|INSERT|POLYLINE|{ACAD_XDICTIONARY|102"
)
WORDS += b"|}|1001|100|AcDbEntity|AC1009|AC1014|1.5|2.5|*Model_Space|*Paper_Space|\xe9|\r| 10"


def drawing(radius: float = 10.0, version: str = "R2010") -> bytes:
    """A drawing with a curve of each plain kind, on layers of two line types; lengths of its frame go by the radius."""
    options = ezdxf.options
    before, options.write_fixed_meta_data_for_testing = options.write_fixed_meta_data_for_testing, True
    document = ezdxf.new(version)
    document.linetypes.add("CENTER", [22.0, 14.0, -3.0, 2.0, -3.0])
    document.layers.add("CUT")
    document.layers.add("1.5", linetype="CENTER")
    space, on = document.modelspace(), {"layer": "CUT"}
    space.add_lwpolyline([(radius, 0, 0.5), (0, 7, 0), (-3, -3, 0.25)], format="xyb", close=True, dxfattribs=on)
    space.add_open_spline([(0, 0), (1, 2), (3, 3), (4, 0.125), (5, 1)], dxfattribs={"layer": "1.5"})
    space.add_line((0.0, radius), (1.0, 2.0), {"layer": "1.5"})
    space.add_arc((1.0, 2.0), radius, 10.0, 200.0, dxfattribs=on)
    space.add_circle((1.0, 2.0), 0.5, on).set_xdata("ACAD", [(1000, "shaft")])
    space.add_ellipse((1.0, 2.0), (3.0, 0.0), 0.5, dxfattribs=on)
    space.add_point((radius, 0.0), on)
    document.set_modelspace_vport(radius, (1.0, 1.0))
    document.header["$EXTMAX"] = (radius, radius, 0.0)
    stream = StringIO()
    document.write(stream)
    options.write_fixed_meta_data_for_testing = before
    return stream.getvalue().encode()


def told(document: Document, space: Any) -> list[Any]:
    """All that the judge asks of a drawing, and more."""
    entities = [
        (
            entity.dxftype(),
            {name: value for name, value in entity.dxf.all_existing_dxf_attribs().items() if name != "paperspace"},
            [row.tolist() for name in ("lwpoints", "control_points") for row in np.array(getattr(entity, name, ()))],
            [float(value) for name in ("knots", "weights") for value in getattr(entity, name, ())],
        )
        for entity in space
    ]
    layers = {layer.dxf.name: layer.dxf.linetype for layer in document.layers}
    dashed = {kind.dxf.name: any(tag.code == 49 for tag in kind.pattern_tags.tags) for kind in document.linetypes}
    about = document.dxfversion, document.header.get("$INSUNITS"), on_paper(document)
    return [repr(entities), layers, dashed, about, sorted(block.name for block in document.blocks)]


def both(raw: bytes) -> bool:
    """Whether a file is plain; if so, it must be the same as whole."""
    found = plain(raw)
    if found is not None:
        document = whole(raw)
        assert told(*found) == told(document, document.modelspace())
    return found is not None


@pytest.mark.parametrize("ends", [b"\n", b"\r\n"])
def test_a_plain_file_is_read_as_it_is_whole(ends: bytes) -> None:
    assert both(drawing().replace(b"\n", ends))
    assert both(b"999\nunits: mm\n" + drawing(version="R2000"))


def test_of_a_second_file_the_frame_is_not_read_again() -> None:
    plain(drawing(10.0))
    before = _frame.cache_info()
    _, space = opened(drawing(12.5))
    after = _frame.cache_info()
    assert (after.misses - before.misses, after.hits - before.hits) == (0, 1)
    assert next(iter(space)).lwpoints[0][0] == 12.5
    assert after.maxsize == FRAMES


def spaced(raw: bytes, old: bytes, new: bytes) -> bytes:
    assert raw.count(old) > 0
    return raw.replace(old, new, 1)


PAST = b"ENTITIES\n  0\n"
LINE = b"  0\nLINE\n  5\nFF\n330\n17\n100\nAcDbEntity\n  8\n0\n100\nAcDbLine\n 10\n0.0\n 20\n0.0\n 11\n1.0\n 21\n1.0\n"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"  0\nLINE\n", b"  0\nINSERT\n"),  # it refers to a block
        (b"  0\nLINE\n  5\n", b"  0\nLINE\n  6\n"),  # it has no handle of its own
        (b"\n330\n17\n", b"\n330\n1B\n"),  # it stands on paper
        (b"$ACADVER\n  1\nAC1024", b"$ACADVER\n  1\nAC1014"),  # ezdxf makes a later version of it
        (b"  0\nENDBLK\n", LINE + b"  0\nENDBLK\n"),  # the model space has entities as a block too
        (b"  0\nSECTION\n  2\nENTITIES\n", b"  0\nEOF\n  0\nSECTION\n  2\nENTITIES\n"),
        (b"  2\nOBJECTS\n", b"  2\nENTITIES\n  0\nENDSEC\n  0\nSECTION\n  2\nOBJECTS\n"),  # the last one counts
        (PAST, PAST + b" ENDSEC\n  0\n SECTION\n  2\nTABLES\n  0\n"),
        (PAST, b"ENTITIES\n999\nr\xe9sum\xe9\n  0\n"),
        (PAST, b"ENTITIES\n\r  0\n"),
    ],
)
def test_what_is_not_plain_is_left_to_ezdxf(old: bytes, new: bytes) -> None:
    raw = drawing()
    start = raw.index(b"ENTITIES") - 20
    where = start if old in raw[start:] else 0
    assert not both(raw[:where] + spaced(raw[where:], old, new))


@pytest.mark.parametrize("more", [b" 67\n     1\n", b"102\n{ACAD_XDICTIONARY\n360\nFFF\n102\n}\n", b"310\nabcdef\n"])
def test_plain_is_what_has_more_than_a_curve_needs(more: bytes) -> None:
    """A flag for paper, which its owner overrules, a dictionary of its own, a picture of itself."""
    assert both(spaced(drawing(), b"100\nAcDbEntity\n  8\nCUT", more + b"100\nAcDbEntity\n  8\nCUT"))


def test_handles_that_the_frame_has_are_left_to_ezdxf() -> None:
    raw = drawing()
    space = raw.index(b"ENTITIES")
    own = raw[space:].split(b"\n  5\n", 1)[1].split(b"\n", 1)[0]
    for taken in (b"1", b"17", b"18"):  # of tables, blocks and records
        assert not both(raw[:space] + spaced(raw[space:], b"\n  5\n" + own, b"\n  5\n" + taken))
    assert not both(spaced(raw, b"\nModel\n350\n1A\n", b"\nModel\n350\n" + own + b"\n"))  # a curve for a layout


def test_two_records_of_a_model_space_are_left_to_ezdxf() -> None:
    """It looks for entities by one of them, and hands out those of the other."""
    raw = drawing()
    start = raw.index(b"  0\nBLOCK_RECORD\n")
    record = raw[start : raw.index(b"  0\nBLOCK_RECORD\n", start + 1)]
    assert b"*Model_Space" in record
    assert not both(spaced(raw, b"  2\nOBJECTS\n", b"  2\nOBJECTS\n" + record))


@pytest.mark.costly("dozens of files, by both ways")
@pytest.mark.parametrize("seed", few(range(49, 52), 3))
def test_damaged_files_are_the_same_or_left_to_ezdxf(seed: int) -> None:
    rng, sources = Random(seed), [drawing(), drawing(version="R2000")]
    read = sum(both(damaged(rng, rng.choice(sources))) for _ in range(TRIALS))
    assert TRIALS / 10 < read < TRIALS


def damaged(rng: Random, raw: bytes) -> bytes:
    """A file with groups left out, doubled, moved, cut or changed, near the entities more often than elsewhere."""
    lines = raw.split(b"\n")
    for _ in range(rng.choice([1, 1, 2, 3])):
        at = rng.randrange(len(lines))
        if rng.random() < 0.4:
            at = min(len(lines) - 1, lines.index(b"ENTITIES") + rng.randrange(-30, 90)) if b"ENTITIES" in lines else at
        group, other, count = at & ~1, rng.randrange(len(lines)) & ~1, 2 * rng.randrange(1, 40)
        way = rng.randrange(8)
        if way == 0:
            del lines[at]
        elif way == 1:
            del lines[group : group + count]
        elif way == 2:
            lines[other:other] = lines[group : group + count]
        elif way == 3:
            lines[at] = rng.choice(WORDS.split(b"|"))
        elif way == 4:
            lines.insert(at, rng.choice(lines))
        elif way == 5:  # values of one code change places
            same = rng.choice([k for k in range(0, len(lines) - 1, 2) if lines[k] == lines[group]] or [0])
            if group + 1 < len(lines):
                lines[group + 1], lines[same + 1] = lines[same + 1], lines[group + 1]
        else:
            digit = rng.randrange(max(len(lines[at]), 1))
            lines[at] = lines[at][:digit] + rng.choice([b"7", b"-", b".", b" ", b"F", b"g"]) + lines[at][digit + 1 :]
    return b"\n".join(lines)
