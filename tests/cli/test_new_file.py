"""New files of a command: all or none, and none in the place of another."""

import pytest

from camgeo.cli.new_file import demand_new, write_new
from camgeo.common.errors import CallError, SurroundingsError


def test_all_are_written(tmp_path):
    write_new({str(tmp_path / "a"): "1\n", str(tmp_path / "b"): "2\n"})
    assert [(tmp_path / name).read_bytes() for name in "ab"] == [b"1\n", b"2\n"]


def test_a_file_that_exists_stays_and_the_others_go(tmp_path):
    (tmp_path / "b").write_text("old", encoding="utf-8")
    names = [str(tmp_path / name) for name in "abc"]
    with pytest.raises(CallError, match="b exists already and is left as it is"):
        write_new(dict.fromkeys(names, "new"))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b"]
    assert (tmp_path / "b").read_text(encoding="utf-8") == "old"
    with pytest.raises(CallError, match="b exists already"):
        demand_new({"--page": None, "--table": names[0], "--recipe": names[1]})


def test_a_name_that_stands_twice_is_refused(tmp_path):
    with pytest.raises(CallError, match="a would be written twice, by --table and by --page: give"):
        demand_new({"--table": str(tmp_path / "a"), "--page": str(tmp_path / "." / "a")})
    demand_new({"--table": str(tmp_path / "a"), "--recipe": None, "--page": str(tmp_path / "b")})


def test_a_folder_that_is_missing_is_named(tmp_path):
    with pytest.raises(SurroundingsError, match="No such file"):
        write_new({str(tmp_path / "none" / "a"): ""})
