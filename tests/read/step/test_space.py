"""Where a STEP file puts its solid: placements, assemblies and units, held against what Open CASCADE makes of them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.kernel import kernel, made, step_recipe
from support.parts import failures, intended
from support.stepfiles import stadium

from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.read.errors import ReadError
from kin.read.step.step import read_step

PLACED = "ADVANCED_BREP_SHAPE_REPRESENTATION('',("
AXES = "AXIS2_PLACEMENT_3D('',#{0},#{1},#{2})"


def axes(first, origin=(0, 0, 0), z=(0, 0, 1), x=(1, 0, 0)):
    """Lines of a placement whose number is `first`."""
    point, *directions = (",".join(f"{float(v)!r}" for v in one) for one in (origin, z, x))
    lines = [
        f"#{first}={AXES.format(first + 1, first + 2, first + 3)};",
        f"#{first + 1}=CARTESIAN_POINT('',({point}));",
    ]
    return "\n".join(lines + [f"#{first + 2 + k}=DIRECTION('',({one}));" for k, one in enumerate(directions)])


def with_lines(text, lines):
    """Add instances, the parts of a product among them: Open CASCADE reads nothing that belongs to no product."""
    product = (
        "#800=APPLICATION_CONTEXT('');#801=PRODUCT_CONTEXT('',#800,'');#802=PRODUCT('p','p','',(#801));"
        "#803=PRODUCT_DEFINITION_FORMATION('','',#802);#804=PRODUCT_DEFINITION_CONTEXT('',#800,'');"
        "#805=PRODUCT_DEFINITION('','',#803,#804);#806=PRODUCT_DEFINITION_SHAPE('','',#805);"
    )
    number = text[: text.index("=ADVANCED_BREP")].rpartition("#")[2]
    shown = (
        "" if "SHAPE_DEFINITION_REPRESENTATION" in lines else f"#807=SHAPE_DEFINITION_REPRESENTATION(#806,#{number});"
    )
    added = lines.replace("#REP", f"#{number}")
    return text.replace("ENDSEC;\nEND-ISO", f"{product}{shown}\n{added}\nENDSEC;\nEND-ISO")


def placed(items="#700,", more="", **given):
    """A stadium with a placement before or behind its solid."""
    text = stadium()
    if items.endswith(","):
        text = text.replace(PLACED, PLACED + items)
    else:
        head, tail = text.split(PLACED)
        text = head + PLACED + tail.replace(")", items + ")", 1)
    return with_lines(text, f"{axes(700, **given)}\n{more}")


def related(**given):
    """A solid and, related to its representation, another one that is that of the product."""
    more = (
        "#820=SHAPE_REPRESENTATION('',(#700),#900);#821=SHAPE_REPRESENTATION_RELATIONSHIP('','',#820,#REP);"
        "#822=SHAPE_DEFINITION_REPRESENTATION(#806,#820);"
    )
    return with_lines(stadium(), f"{axes(700, **given)}\n{more}")


def seen(path):
    """Volume, middle and second moments as Open CASCADE reads them."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.STEPControl import STEPControl_Reader

    reader = STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    found = GProp_GProps()
    BRepGProp.VolumeProperties_s(reader.OneShape(), found)
    middle, matrix = found.CentreOfMass(), found.MatrixOfInertia()
    return np.array([found.Mass(), middle.X(), middle.Y(), middle.Z(), matrix.Value(1, 2)])


def ours(path):
    """The same, of the section and the height."""
    solid = read_step(path)
    chain, _ = solid.contour.as_arcs()
    x, y = chain.cut(np.full(len(chain.start), 400))[0].start.T
    x2, y2 = np.roll(x, -1), np.roll(y, -1)
    k = x * y2 - x2 * y
    area = k.sum() / 2
    mx, my = ((x + x2) * k).sum() / 6 / area, ((y + y2) * k).sum() / 6 / area
    product = ((x * y2 + 2 * x * y + 2 * x2 * y2 + x2 * y) * k).sum() / 24 - area * mx * my
    high = solid.thickness
    return np.array([solid.volume, mx, my, 0.5 * (solid.z_min + solid.z_max), -product * high])


TURN = {"x": (math.cos(0.3), math.sin(0.3), 0.0)}
READ = {
    "a placement that moves nothing": placed(),
    "an origin": placed(origin=(0, 1, 0)),
    "an origin above": placed(origin=(2, 1, -3)),
    "a turn": placed(**TURN),
    "both": placed(origin=(5, 1, 0), **TURN),
    "turned over": placed(z=(0, 0, -1), origin=(0, 0, 4), **TURN),
    "an x axis that is not square": placed(x=(1.0, 0.2, 0.7)),
    "axes of other lengths": placed(z=(0, 0, 7), x=(3, 1, 0)),
    "behind the solid": placed(",#700", origin=(0, 1, 0)),
    "another kind of representation": placed(origin=(0, 1, 0)).replace("ADVANCED_BREP_SHAPE_", "SHAPE_"),
    "no axes": placed(origin=(0, 1, 0)).replace(AXES.format(701, 702, 703), "AXIS2_PLACEMENT_3D('',#701,$,$)"),
    "twice the same": placed("#700,#700,", origin=(0, 1, 0)),
    "a related representation": related(),
    "metres": placed(origin=(0, 1, 0)).replace("SI_UNIT(.MILLI.,", "SI_UNIT(.CENTI.,"),
}
REFUSED = {
    "two that differ": (placed("#700,#710,", axes(710, (0, 1, 0))), "has 2 placements that differ"),
    "an x axis left out": (placed().replace("#702,#703)", "#702,$)"), "leaves out its x axis"),
    "a related one elsewhere": (related(origin=(0, 1, 0)), "has another placement than"),
    "leaning": (placed(z=(0, 0.1, 1)), "neither upright nor level"),
    "a mapped item": (placed(more="#720=MAPPED_ITEM('',$,#700);"), "MAPPED_ITEM: is not read"),
    "two units of length": (placed().replace("((#901,", "((#901,#910,"), "more than one LENGTH_UNIT"),
}
UNIT = "#910=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));"


@pytest.mark.thin(2)
@kernel
@pytest.mark.parametrize("name", READ)
def test_a_placement_is_read_as_the_kernel_does(tmp_path, name):
    path = tmp_path / "part.step"
    path.write_text(READ[name])
    assert ours(path) == pytest.approx(seen(path), rel=1e-4, abs=1e-2)


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_told_is_refused(tmp_path, name):
    text, message = REFUSED[name]
    path = tmp_path / "part.step"
    path.write_text(text.replace("ENDSEC;\nEND", f"{UNIT}\nENDSEC;\nEND"))
    with pytest.raises(ReadError, match=message):
        read_step(path)


def shape_of(path):
    from OCP.STEPControl import STEPControl_Reader

    reader = STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    return reader.OneShape()


def compound(*shapes):
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    builder, made = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(made)
    for one in shapes:
        builder.Add(made, one)
    return made


def put(shape, x, y, angle):
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
    from OCP.TopLoc import TopLoc_Location

    turn, shift = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), angle)
    shift.SetTranslation(gp_Vec(x, y, 0))
    return shape.Moved(TopLoc_Location(shift * turn))


def assembly(shape, path):
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    writer = STEPControl_Writer()
    before = Interface_Static.IVal_s("write.step.assembly")
    Interface_Static.SetIVal_s("write.step.assembly", 1)
    try:
        writer.Transfer(shape, STEPControl_AsIs)
        writer.Write(str(path))
    finally:
        Interface_Static.SetIVal_s("write.step.assembly", before)
    assert "ITEM_DEFINED_TRANSFORMATION" in path.read_text()


@kernel
def test_assemblies_written_by_the_kernel(tmp_path):
    single, path = tmp_path / "single.step", tmp_path / "assembly.step"
    single.write_text(placed())
    shape = shape_of(single)
    for whole in (
        compound(shape),
        compound(put(shape, 0, 1, 0.2)),
        compound(put(compound(put(shape, 0, 1, 0.2)), 3, 0, 0.3)),
    ):
        assembly(whole, path)
        assert ours(path) == pytest.approx(seen(path), rel=1e-4, abs=1e-2)
    text = path.read_text()
    # the inner assembly is no longer put anywhere; its place is another one; a part is there twice
    for old, new in (("NEXT_ASSEMBLY_USAGE_OCCURRENCE", "PROMISSORY_USAGE_OCCURRENCE"), ("'','',#11,#", "'','',#15,#")):
        assert old in text
        path.write_text(text.replace(old, new, 1))
        with pytest.raises(ReadError, match=r"assembly|occurrence|placement"):
            read_step(path)
    assembly(compound(put(shape, 0, 1, 0.2), put(shape, 40, 0, 0.0)), path)
    with pytest.raises(ReadError, match="more than the one part"):
        read_step(path)


@pytest.mark.slow
@kernel
def test_a_file_that_is_moved_or_turned_does_not_pass(tmp_path):
    recipe = step_recipe("{thickness: 8, bore: 10}")
    design, path = made(recipe, tmp_path)
    text = path.read_text()
    assert failures(path, recipe, design) == set()
    number = text[text.index("AXIS2_PLACEMENT_3D('',#") :].partition("#")[2].partition(",")[0]
    for at, found in (
        (int(number), "CARTESIAN_POINT('',(0.,1.,0.))"),
        (int(number) + 2, "DIRECTION('',(0.9962,0.0872,0.))"),
    ):
        head, rest = text.split(f"#{at} = ", 1)
        path.write_text(f"{head}#{at} = {found};{rest.partition(';')[2]}")
        verdict = verify(path, intended(recipe, design), 36, Limits(0.01))
        values = {check.name: check.value for check in verdict.checks if not check.ok}
        assert values["contour"] > 0.5
        assert values["motion"] > 0.5
