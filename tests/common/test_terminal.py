"""What reaches a terminal: any text on a stream of any encoding, full or closed, with nothing that it would obey."""

from __future__ import annotations

import builtins
import io
import json
import logging
import os
import subprocess
import sys
from pathlib import Path

import pytest
from support.cases import few

from camgeo.cli.main import main
from camgeo.common import terminal
from camgeo.common.terminal import escaped, say_json
from camgeo.registry import registry
from kin.read.home import prepare_home

RECIPE = "about: 日本 😀\ncam: {kind: support, p: 25 + 2*cos(3*t)}\n"
ADDED = [command for label in registry.labels().values() for command in label.commands]
FULL = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")


@pytest.fixture
def recipe(tmp_path: Path) -> Path:
    path = tmp_path / "cam.yaml"
    path.write_text(RECIPE, encoding="utf-8")
    return path


def run(*arguments: str | bytes, **options: object) -> subprocess.CompletedProcess[bytes]:
    given = {"capture_output": True} | options
    return subprocess.run([sys.executable, "-m", "camgeo", *arguments], check=False, **given)


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
@pytest.mark.parametrize("what", ["schema", "check"])
def test_a_narrow_encoding(recipe: Path, encoding: str, what: str) -> None:
    arguments = ["schema"] if what == "schema" else ["check", str(recipe), "--json"]
    done = run(*arguments, env=os.environ | {"PYTHONIOENCODING": encoding})
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"\r" not in done.stdout
    found = json.loads(done.stdout.decode(encoding))
    if what == "check":
        assert found[0]["about"] == "日本 😀"


def test_a_name_that_the_encoding_has_not() -> None:
    given = {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "1"}  # words of a call are UTF-8 in any locale
    done = run("check", "日本.yaml".encode(), env=os.environ | given)
    assert (done.returncode, done.stderr) == (2, b"\\u65e5\\u672c.yaml: the file does not exist\n")


@pytest.mark.thin(4)
@FULL
@pytest.mark.parametrize("call", [["check", "nofile"], ["dance"], ["new", "nothing"], []])
def test_a_full_standard_error_changes_no_status(call: list[str]) -> None:
    with Path("/dev/full").open("wb") as full:
        assert run(*call, capture_output=False, stderr=full).returncode == 2


@pytest.mark.slow
@FULL
@pytest.mark.parametrize("buffered", [True, False])
@pytest.mark.parametrize("call", [["schema"], ["--help"], ["new"], ["--version"], ["laws"]])
def test_a_full_standard_output_is_told(call: list[str], buffered: bool) -> None:
    environment = {**os.environ, "PYTHONUNBUFFERED": "" if buffered else "1"}
    with Path("/dev/full").open("wb") as full:
        done = run(*call, capture_output=False, stdout=full, stderr=subprocess.PIPE, env=environment)
    assert done.returncode == 3
    assert done.stderr.count(b"\n") == 1
    assert b"No space left" in done.stderr


@pytest.mark.slow
def test_a_reader_that_went_away(recipe: Path) -> None:
    read, write = os.pipe()
    os.close(read)
    done = run("check", str(recipe), "--json", capture_output=False, stdout=write, stderr=subprocess.PIPE)
    os.close(write)
    assert (done.returncode, done.stderr) == (3, b"")


@pytest.mark.slow
def test_closed_streams() -> None:
    code = (
        "import sys; sys.stdout = sys.stderr = None; "
        "from camgeo.cli.main import main; sys.exit(main(['check', 'none']))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 2


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("plain name.yaml", "plain name.yaml"),
        ("\x1b[31mred", "\\x1b[31mred"),
        ("a\nb\rc\td", "a\\nb\\rc\\td"),
        ("\x9b2J\x7f", "\\x9b2J\\x7f"),
        ("left\u202eright", "left\\u202eright"),
        ("not text \udcff", "not text \\udcff"),
        ("日本 é", "日本 é"),
    ],
)
def test_nothing_that_a_terminal_obeys(text: str, shown: str) -> None:
    assert escaped(text) == shown


def test_what_a_call_says_reaches_the_terminal_escaped() -> None:
    done = run("check", "none", "--\x1b[31mred")
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.startswith(b"usage: camgeo check ")
    assert done.stderr.endswith(b"camgeo check: error: unrecognized arguments: --\\x1b[31mred\n")


def test_json_stays_json_where_it_is_escaped(monkeypatch: pytest.MonkeyPatch) -> None:
    data = {"path": "\udcff \x9b \x7f \u202e 😀 日本"}
    for encoding in ("utf-8", "ascii", "cp1252"):
        stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
        monkeypatch.setattr(sys, "stdout", stream)
        say_json(json.dumps(data, ensure_ascii=False, indent=2) + "\n")
        stream.flush()
        text = stream.buffer.getvalue().decode(encoding)
        assert json.loads(text) == data
        assert "\x9b" not in text
        assert "\x7f" not in text


@pytest.mark.thin(3)
@pytest.mark.parametrize("command", ["check", "export", "verify", "report", *ADDED, "new"])
def test_control_characters_of_a_path(command: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    name = str(tmp_path / "\x1b[31m\nred.yaml")
    if command == "new":
        Path(name).write_text("", encoding="utf-8")
    more = {"verify": [name], "follow": ["--roller", "5"]}.get(command, [])
    call = ["new", "support", name] if command == "new" else [command, name, *more]
    assert main(call) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "\\x1b[31m\\nred.yaml" in said
    assert "\x1b" not in said


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
@pytest.mark.parametrize("command", ["check", "verify", "report", *(name for name in ADDED if name != "follow")])
def test_a_pipe_is_refused_at_once(
    command: str, recipe: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pipe = tmp_path / "pipe.dxf"
    os.mkfifo(pipe)
    assert main([command, str(pipe), *([str(pipe)] if command == "verify" else [])]) == 2
    assert capsys.readouterr().err == f"{pipe}: a pipe, a socket or a device, not a file; save the recipe as a file\n"
    assert main(["verify", str(recipe), str(pipe)]) == 2
    assert capsys.readouterr().err == f"camgeo: {pipe}: a pipe, a socket or a device, not a file\n"


def test_a_stem_that_is_reserved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "cam.rejected.yaml"
    path.write_text(RECIPE, encoding="utf-8")
    assert main(["check", str(path)]) == 2
    assert (
        "the file's stem is reserved for the folders of failed runs, which end in .rejected" in capsys.readouterr().err
    )


@pytest.mark.slow
@pytest.mark.parametrize("home", few(["/dev/null", "/dev/null/no", None], 3))
def test_no_home_folder(recipe: Path, tmp_path: Path, home: str | None) -> None:
    surroundings = {key: value for key, value in os.environ.items() if key != "HOME" and not key.startswith("XDG_")}
    if home is not None:
        surroundings["HOME"] = home
    else:
        surroundings |= {"XDG_CACHE_HOME": "~nobody-of-this-name/x"}  # no home can be found for it: RuntimeError
    out = str(tmp_path / "out")
    recipe.write_text(RECIPE + "export: {files: [dxf]}\n", encoding="utf-8")
    for call in (["export", str(recipe), "--out", out], ["report", str(recipe), "--out", out, "--picture", "png"]):
        done = run(*call, env=surroundings)
        # a stage that a busy machine takes long for is said too
        complaints = [line for line in done.stderr.splitlines() if not line.endswith(b" ...")]
        assert (done.returncode, complaints) == (0, [])


def test_a_home_folder_of_another_s_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    for name in ("XDG_CACHE_HOME", "XDG_CONFIG_HOME", "MPLCONFIGDIR"):
        monkeypatch.setenv(name, str(tmp_path))
    prepare_home.cache_clear()
    prepare_home()
    prepare_home.cache_clear()
    assert Path(os.environ["XDG_CACHE_HOME"]).name.startswith("camgeo-home-")
    assert os.environ["XDG_CACHE_HOME"] == os.environ["MPLCONFIGDIR"] == os.environ["XDG_CONFIG_HOME"]
    assert logging.getLogger("ezdxf").handlers


@pytest.mark.slow
def test_files_have_lf_on_every_system(recipe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As Windows has it: text is written with CRLF unless the writer says otherwise."""
    real = io.open

    def as_windows(file, mode="r", *rest, newline=None, **more):
        if "b" not in mode and set(mode) & set("wx") and newline is None and len(rest) < 4:
            newline = "\r\n"
        return real(file, mode, *rest[:3], newline=rest[3] if len(rest) > 3 else newline, **more)

    monkeypatch.setattr(io, "open", as_windows)
    monkeypatch.setattr(builtins, "open", as_windows)
    recipe.write_bytes((RECIPE + "part: {thickness: 5}\nexport: {files: [dxf, svg, csv, html, stl]}\n").encode())
    for command in ("export", "report"):
        assert main([command, str(recipe), "--out", str(tmp_path / "out")]) == 0
    assert main(["study", str(recipe), "--out", str(tmp_path / "out"), "--form", "arcs", "--patience", "0.001"]) == 0
    assert main(["new", "support", str(tmp_path / "new.yaml")]) == 0
    texts = [path for path in tmp_path.rglob("*") if path.suffix in {".json", ".svg", ".dxf", ".csv", ".html", ".yaml"}]
    assert len(texts) >= 8
    assert [path.name for path in texts if b"\r" in path.read_bytes()] == []


def test_nobody_hears(monkeypatch: pytest.MonkeyPatch) -> None:
    class Gone(io.StringIO):
        def write(self, _: str) -> int:
            raise OSError(5, "Input/output error")

    monkeypatch.setattr(sys, "stderr", Gone())
    terminal.complain("said")
    terminal.complain("again")
    sys.stderr.close()
