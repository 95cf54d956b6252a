"""Questions of layers and answers of capabilities: no file of a question's name without answers, none by another name.

Holds: camgeo.registry.registry, camgeo.registry.label, camgeo.recipe.extension, camgeo.checks.extension,
camgeo.measures.extension, camgeo.report.extension, camgeo.output.extension, camgeo.formats.extension,
camgeo.cli.extension.
"""

from __future__ import annotations

import ast
import re
import sys
from importlib import import_module
from types import ModuleType, SimpleNamespace

import pytest
from support.places import ROOT

from camgeo.registry import registry, slot
from camgeo.registry.slot import Slot
from kin.numeric.records import dataclass

CAMGEO = ROOT / "camgeo"
FOLDERS = sorted(path.parent for path in (CAMGEO / "capabilities").glob("*/__init__.py"))


def slots():
    """Every question, by its name."""
    asking = sorted(path for path in CAMGEO.rglob("*.py") if "Slot(" in path.read_text(encoding="utf-8"))
    modules = [import_module(".".join(path.relative_to(ROOT).with_suffix("").parts)) for path in asking]
    return {one.name: one for module in modules for one in vars(module).values() if isinstance(one, Slot)}


def answers(path):
    """Whether a module states answers: whether its own code binds, or imports, the name ANSWERS."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    return any(re.search(r"^ANSWERS\b|\bimport\b.*\bANSWERS\b", ast.unparse(node)) for node in body)


@pytest.mark.parametrize(
    ("text", "stated"),
    [
        ("ANSWERS = Page()", True),
        ("ANSWERS: Page = Page()", True),
        ("from camgeo.x import ANSWERS", True),
        ("x = dict(a=ANSWERS)", False),
        ('"""ANSWERS are elsewhere."""', False),
    ],
)
def test_a_file_states_answers_however_it_is_written(tmp_path, text, stated):
    path = tmp_path / "pages.py"
    path.write_text(text, encoding="utf-8")
    assert answers(path) is stated


@pytest.mark.slow
def test_a_file_has_answers_just_if_it_bears_the_name_of_a_question():
    names = slots().keys()
    paths = [path for folder in FOLDERS for path in folder.rglob("*.py")]
    assert {path for path in paths if answers(path)} == {path for path in paths if path.stem in names}


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", slots())
def test_all_answers_are_of_the_class_that_is_asked_for(name):
    slot = slots()[name]
    assert len(slot.of(registry.labels())) == len(slot.answering())


def test_every_question_of_a_capability_stands_in_a_folder_of_its_name():
    assert {folder.name for folder in FOLDERS if (folder / "extension.py").exists()} <= slots().keys()


def test_what_a_capability_asks_is_read_in_the_file_of_its_name_alone_which_goes_with_it():
    for path in (path for folder in FOLDERS for path in folder.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        for asker in set(re.findall(r"from camgeo\.capabilities\.(\w+)\.extension import", text)):
            if asker != path.parent.name:
                assert path.stem == asker
                assert text.startswith(f"# needs: {asker}\n")


# --- a made-up question -----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Told:
    word: str = "nothing"


@pytest.fixture
def asked(monkeypatch):
    """A question that of two capabilities `early` answers, and the module of that answer."""
    module = ModuleType("told")
    monkeypatch.setitem(sys.modules, f"{registry.PACKAGE}.early.told", module)
    monkeypatch.setattr(slot, "labels", lambda: {"early": SimpleNamespace(), "late": SimpleNamespace()})
    monkeypatch.setattr(slot, "modules", lambda name: {"early": {"told", "keys"}, "late": {"keys"}}[name])
    return Slot("told", Told()), module


def test_a_capability_without_the_file_gives_the_defaults(asked):
    question, module = asked
    module.ANSWERS = Told("a word")
    assert question.loaded() == ()
    assert [question[name].word for name in ("early", "late")] == ["a word", "nothing"]
    assert (question.answering(), question.loaded()) == (("early",), ("early",))
    assert question.of(["late", "early", "gone"]) == [module.ANSWERS]
    with pytest.raises(KeyError):
        question["gone"]


@pytest.mark.parametrize("wrong", [{}, {"ANSWERS": "a word"}])
def test_answers_of_another_class_are_refused(asked, wrong):
    question, module = asked
    vars(module).update(wrong)
    with pytest.raises(TypeError, match="told: ANSWERS are no Told"):
        question["early"]
