"""Recipes that come to no report are in the JSON of a call too, each in its place with its errors."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from camgeo.cli import batch
from camgeo.cli.batch import folder_conflicts
from camgeo.cli.main import main

if TYPE_CHECKING:
    from pathlib import Path

SOUND = "cam: {kind: support, p: 25 + 2*cos(3*t)}\nexport: {tolerance: 0.05, files: [dxf]}\nverify: {angles: 24}\n"


@pytest.fixture
def recipes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sound.yaml").write_text(SOUND)
    (tmp_path / "kind.yaml").write_text("cam: {kind: suport}\n")
    (tmp_path / "late.yaml").write_text(SOUND.replace("25 + 2*cos(3*t)", "25 + t"))


@pytest.mark.usefixtures("recipes")
@pytest.mark.parametrize("command", ["check", "export"])
def test_every_recipe_of_a_call_is_in_its_json(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    paths = ["kind.yaml", "late.yaml", "sound.yaml", "none.yaml", ""]
    assert main([command, "--json", *paths]) == 2
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert [one["recipe"] for one in found] == ["kind.yaml", "late", "sound", "none.yaml", ""]
    assert [one["ok"] for one in found] == [False, False, True, False, False]
    (kind,) = found[0]["errors"]
    assert kind == {
        "file": "kind.yaml",
        "line": 1,
        "column": 13,
        "path": "cam.kind",
        "problem": "not one of the choices",
        "value": "'suport'",
        "remedy": "did you mean support?",
    }
    assert found[1]["errors"][0]["path"] == "cam.p"
    assert found[3]["errors"][0]["problem"] == "the file does not exist"
    assert "'': an empty name of a file; give the path of a recipe" in said.err.splitlines()


@pytest.mark.usefixtures("recipes")
def test_a_kind_that_no_file_has_is_in_the_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "--json", "--only", "stl", "sound.yaml"]) == 2
    said = capsys.readouterr()
    (found,) = json.loads(said.out)
    assert found["errors"][0]["problem"] == "lists no stl, which --only requests"
    assert said.err == "sound.yaml:2:34: export.files: lists no stl, which --only requests; add stl\n"


@pytest.mark.usefixtures("recipes")
def test_each_kind_of_a_call_is_one_that_the_recipe_lists(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "--only", "dxf", "--only", "stl", "sound.yaml"]) == 2
    assert capsys.readouterr().err == "sound.yaml:2:34: export.files: lists no stl, which --only requests; add stl\n"


@pytest.mark.parametrize("repeats", [False, True])
def test_folders_of_many_recipes_are_compared_in_proportion_to_their_number(repeats: bool) -> None:
    compared = []

    class CountedPath:
        def __init__(self, number: int) -> None:
            self.number = number

        def resolve(self) -> CountedPath:
            return self

        def __hash__(self) -> int:
            return self.number

        def __eq__(self, other: object) -> bool:
            compared.append(other)
            return isinstance(other, CountedPath) and self.number == other.number

        def __str__(self) -> str:
            return f"{self.number}.yaml"

    recipes: list[Any] = [SimpleNamespace(path=CountedPath(k), name=f"cam-{k % 2999}") for k in range(3000)]
    recipes += [SimpleNamespace(path=CountedPath(7), name="cam-7")] * repeats
    messages = folder_conflicts(recipes)
    assert [message.partition(":")[0] for message in messages] == (["7.yaml"] if repeats else ["0.yaml", "2999.yaml"])
    assert len(compared) < 10


@pytest.mark.usefixtures("recipes")
def test_one_recipe_twice_is_called_that(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "sound.yaml", "./sound.yaml"]) == 2
    said = "camgeo: sound.yaml: the same recipe is named twice in this call; name it once\n"
    assert capsys.readouterr().err == said
    assert main(["export", "sound.yaml"]) == 0


@pytest.mark.parametrize(("seconds", "alone"), [(1.8, 5), (2.0, 3)])
def test_the_rest_goes_to_processes_where_its_seconds_are_worth_them(
    seconds: float, alone: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first of five imports for 9 s; those left count the mean of the second, 0.1 s, and the third."""
    clock = iter([0.0, 0.0, 9.0, 9.0, 9.1, 9.1 + seconds, 9.1 + seconds])
    own: list[str] = []
    monkeypatch.setattr(batch, "IMPORTS", 9.0)
    monkeypatch.setattr("camgeo.cli.batch.time.process_time", lambda: next(clock))
    monkeypatch.setattr("camgeo.cli.batch.workers.may_fork", lambda: False)
    monkeypatch.setattr(batch, "PAYS", 2.0)
    monkeypatch.setattr(batch, "result", lambda recipe, *_: own.append(recipe.name))
    monkeypatch.setattr(batch, "_in_parallel", lambda rest, *_, **__: [None for _ in rest])
    recipes: Any = [SimpleNamespace(name=name) for name in "abcde"]
    assert len(list(batch.results(recipes, batch.BatchTask(None), 2))) == 5
    assert len(own) == alone
