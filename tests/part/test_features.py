"""A feature is its file and its word: what goes over the records names none of them, and the docs name all."""

import re
from pathlib import Path

import pytest

from camgeo.part.features import FEATURES, NAMES, with_records
from camgeo.part.part import PART, Part, build_part
from camgeo.part.slot import Slot

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "camgeo" / "part"


def test_every_file_with_a_record_is_a_feature():
    stems = {path.stem for path in FOLDER.glob("*.py") if "\nFEATURE = Feature(" in path.read_text(encoding="utf-8")}
    assert stems == set(NAMES)
    assert [feature.name for feature in FEATURES] == list(NAMES)


@pytest.mark.parametrize("feature", FEATURES, ids=lambda feature: feature.name)
def test_its_key_is_read_and_on_both_pages(feature):
    assert PART.inner.field(feature.name) is feature.field
    assert (
        f"<!-- part.{feature.name} -->" in (ROOT / "docs" / "recipe.md").read_text("utf-8") or not feature.field.table
    )
    assert f"`{feature.name}`" in (ROOT / "docs" / "part.md").read_text(encoding="utf-8")


def test_no_other_module_knows_the_slot():
    known = {"slot.py", "features.py", "shapes.py"}
    naming = re.compile(r"part\.slot\b|of\(Slot\)|import Slot\b")
    others = [path for path in (ROOT / "camgeo").rglob("*.py") if path.parent != FOLDER or path.name not in known]
    assert [path for path in others if naming.search(path.read_text(encoding="utf-8"))] == []


def test_a_part_gives_each_feature_by_its_class():
    values = {
        "slot": {"length": 12.0, "width": 5.0, "circle": 36.0},
        "chamfer": 0.5,
        "keyway": {"width": 4.0, "depth": 2.0},
    }
    part = build_part(values | {"bore": 12.0})
    assert part.of(Slot) == Slot(12.0, 5.0, 36.0)
    assert [feature.name for feature, _ in with_records(part.features)] == ["keyway", "slot", "chamfer"]
    assert part.without(Slot).of(Slot) is None
    assert (part.holed, part.walled, part.round_bore, part.plain) == (True, True, False, False)
    assert (Part().holed, Part().walled, Part(bore=5.0).round_bore, Part(bore=5.0).plain) == (False, False, True, True)
