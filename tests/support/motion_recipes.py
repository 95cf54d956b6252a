"""Motions of recipes: their text, the table beside it, and the lift of the cam that is made of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from camgeo.motions.inputs import TURN
from camgeo.motions.motion import check_whole_turn, motion_field
from camgeo.output import pipeline
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.fields import Kind
from camgeo.schema.reader import Reader
from camgeo.schema.readers import READERS
from camgeo.schema.yaml_source import entries, read_source
from kin.law.sources.laws import named
from kin.law.sources.programme import Dwell, Move, programme

rad = math.radians
BREADTH = "kind: constant-breadth, base_radius: 40"
HALF = np.arange(0.0, 181.0, 2.0)
RISE = programme([Move(rad(120), named("modified-sine"), by=20.0), Dwell(rad(60))], math.pi, around=-1)
ROLLER = "kind: double-roller, ratio: 2, arm: 60, roller_radius: 8"
FLAT = "kind: disc, base_radius: 30, follower: {kind: flat}"


def recipe(motion, folder, head=BREADTH, key="motion", units="mm"):
    files = "export: {files: [{dxf: {tolerance: 0.01}}]}\nverify: {angles: 360}\n"
    return load_text(f"units: {units}\ncam: {{{head}, {key}: {motion}}}\n{files}", folder / "case.yaml")


def lift(made, degrees, order=0):
    intent = made.cam.exact().law
    found = intent.derivatives(np.radians(degrees), order)
    found[0] -= intent.datum
    return found


def written(folder, angles, values, form="{:g},{:.3f}", *, head=""):
    rows = [form.format(a, s) for a, s in zip(angles, values, strict=True)]
    (folder / "lift.csv").write_text("\n".join([*([head] if head else []), *rows, ""]), encoding="utf-8")
    return rows


def sampled(degrees):
    return RISE.derivatives(np.radians(degrees), 0)[0]


def fault(motion, folder, **of):
    """The one error of reading or making a motion."""
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe(motion, folder, **of))
    (error,) = caught.value.errors
    return error


def reader_of(text):
    source = read_source(f"motion: {text}\n".encode(), "case.yaml")
    reader = Reader(source, READERS, recipe_table())
    reader.survey(source.root, "")
    return reader, entries(source.root)["motion"]


def read_motion(text):
    reader, node = reader_of(text)
    asked = reader.field(motion_field("motion", Kind.LENGTH, "a turn", over=TURN), node, "motion")
    if asked is not None:
        check_whole_turn(asked, "motion", reader)
    if reader.errors:
        raise RecipeErrors(reader.errors)
    return asked
