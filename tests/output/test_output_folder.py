"""The output folder: sets change as a whole, whatever fails and whenever the process is killed."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress

import pytest
from support import sets
from support.sets import NAME, STEPS, export, names_of, write

from camgeo.common.errors import SurroundingsError
from camgeo.output.output_folder import RunFolder, temporary_folder


def generation_of(folder, *, size=1):
    """Generation of the set that lies in a folder; fails where the set is not complete and of one generation."""
    generation = json.loads((folder / "report.json").read_text())["generation"]
    for name in names_of(generation):
        assert (folder / name).read_text() == f"{generation} {name}\n" * size, name
    present = {path.name for path in folder.iterdir() if path.name.startswith("cam")}
    assert present == set(names_of(generation))
    return generation


def hidden(out):
    return sorted(path.name for path in out.iterdir() if path.name.startswith("."))


def users_files(out):
    (out / NAME / "notes").mkdir(parents=True)
    (out / NAME / "notes" / "cam.txt").write_text("mine")
    (out / NAME / "drawing.txt").write_text("mine")


def assert_users_files(out):
    assert (out / NAME / "notes" / "cam.txt").read_text() == "mine"
    assert (out / NAME / "drawing.txt").read_text() == "mine"


def test_sets_replace_one_another_and_leave_other_files_alone(tmp_path):
    users_files(tmp_path)
    for generation in range(4):
        assert export(tmp_path, generation) == tmp_path / NAME
        assert generation_of(tmp_path / NAME) == generation
        assert_users_files(tmp_path)
        assert hidden(tmp_path) == []


def rejected(out, generation):
    with RunFolder(out, NAME) as run:
        write(run.folder, generation)
        return run.reject()


def test_a_failed_set_goes_when_a_good_one_comes(tmp_path):
    failed = rejected(tmp_path, 2)
    assert generation_of(failed) == 2
    with RunFolder(tmp_path, NAME) as run:  # a part of the set is new: the other may be what failed
        write(run.folder, 1)
        run.commit(names_of(1), keep=("cam-other.txt",))
    assert generation_of(failed) == 2
    export(tmp_path, 3)
    assert not failed.exists()
    assert generation_of(tmp_path / NAME) == 3


def test_of_a_failed_set_goes_what_its_report_lists(tmp_path):
    failed = rejected(tmp_path, 2)
    (failed / "cam-mine.txt").write_text("mine")
    export(tmp_path, 3)
    assert [path.name for path in failed.iterdir()] == ["cam-mine.txt"]
    (failed / "report.json").write_text("mine")
    assert export(tmp_path, 4) == tmp_path / NAME
    assert sorted(path.name for path in failed.iterdir()) == ["cam-mine.txt", "report.json"]
    shutil.rmtree(failed)
    failed.symlink_to(tmp_path / NAME)
    export(tmp_path, 5)
    assert failed.is_symlink()
    assert generation_of(tmp_path / NAME) == 5


def stopped(out, error):
    with RunFolder(out, NAME) as run:
        write(run.folder, 3)
        raise error


def test_the_output_folder_is_made(tmp_path):
    assert generation_of(export(tmp_path / "a" / "b", 1)) == 1


def test_a_folder_that_is_made_for_nothing_goes(tmp_path):
    with pytest.raises(RuntimeError, match="stop"):
        stopped(tmp_path / "a" / "b", RuntimeError("stop"))
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "empty").mkdir()
    with pytest.raises(RuntimeError, match="stop"):
        stopped(tmp_path / "empty", RuntimeError("stop"))
    assert (tmp_path / "empty").is_dir()  # it was there before
    with RunFolder(tmp_path / "c", NAME) as run:
        (tmp_path / "c" / "notes.txt").write_text("mine", "utf-8")
        write(run.folder, 1)
    assert (tmp_path / "c" / "notes.txt").read_text("utf-8") == "mine"


def test_nothing_changes_without_a_commit(tmp_path):
    export(tmp_path, 1)
    with RunFolder(tmp_path, NAME) as run:
        write(run.folder, 2)
    assert generation_of(tmp_path / NAME) == 1
    with pytest.raises(RuntimeError, match="stop"):
        stopped(tmp_path, RuntimeError("stop"))
    assert generation_of(tmp_path / NAME) == 1
    assert hidden(tmp_path) == []


def test_a_rejected_set_stands_beside(tmp_path):
    export(tmp_path, 1)
    for generation in (2, 3):
        with RunFolder(tmp_path, NAME) as run:
            write(run.folder, generation)
            assert run.reject() == tmp_path / "cam.rejected"
        assert generation_of(tmp_path / NAME) == 1
        assert generation_of(tmp_path / "cam.rejected") == generation
    assert hidden(tmp_path) == []


def test_files_of_other_formats_are_kept_on_request(tmp_path):
    export(tmp_path, 1)
    with RunFolder(tmp_path, NAME) as run:
        write(run.folder, 2, ["cam.dxf"])
        kept = run.kept_names()
        assert kept == ("cam-1.stl", "cam.csv")
        report = {"files": [{"path": "cam.dxf"}, *({"path": name, "stale": True} for name in kept)]}
        (run.folder / "report.json").write_text(json.dumps(report))
        run.commit(["cam.dxf"], keep=kept)
    folder = tmp_path / NAME
    assert (folder / "cam.dxf").read_text() == "2 cam.dxf\n"
    assert (folder / "cam.csv").read_text() == "1 cam.csv\n"
    (folder / "cam.csv").unlink()  # by hand
    with RunFolder(tmp_path, NAME) as run:
        write(run.folder, 3, ["cam.dxf"])
        assert run.kept_names() == ("cam-1.stl",)
        run.commit(["cam.dxf"])
    assert sorted(path.name for path in folder.iterdir()) == ["cam.dxf", "report.json"]


def test_nothing_is_kept_of_no_set(tmp_path):
    with RunFolder(tmp_path, NAME) as run:
        assert run.kept_names() == ()


class TestSurroundings:
    def refused(self, tmp_path, message, generation=2):
        """Assert that a commit is refused with this message, and return what then lies in the folder."""
        with pytest.raises(SurroundingsError) as caught:
            export(tmp_path, generation)
        assert str(caught.value) == message
        assert hidden(tmp_path) == []

    def test_one_run_at_a_time(self, tmp_path):
        with RunFolder(tmp_path, NAME) as run:
            self_message = f"{tmp_path / NAME}: another run is at work here (it holds .cam.lock)"
            with pytest.raises(SurroundingsError) as caught, RunFolder(tmp_path, NAME):
                pass
            assert str(caught.value) == self_message
            with RunFolder(tmp_path, "cam2") as other:
                write(other.folder, 5, ["cam2.dxf"])
                other.commit(["cam2.dxf"])
            run.commit(write(run.folder, 1))
        assert generation_of(tmp_path / NAME) == 1
        export(tmp_path, 2)

    def test_a_file_of_the_users_is_in_the_way(self, tmp_path):
        (tmp_path / NAME).mkdir()
        (tmp_path / NAME / "cam.dxf").write_text("mine")
        where = tmp_path / NAME / "cam.dxf"
        self.refused(tmp_path, f"{where}: is in the way, and no report lists it as replaceable")
        assert where.read_text() == "mine"

    def test_a_folder_is_in_the_way(self, tmp_path):
        export(tmp_path, 1)
        where = tmp_path / NAME / "cam.dxf"
        where.unlink()
        where.mkdir()
        self.refused(tmp_path, f"{where}: is in the way, and no report lists it as replaceable")

    @pytest.mark.parametrize("text", ["", "[]", '{"files": 3}', '{"files": [{}]}', "\x00", "[" * 100000])
    def test_a_report_that_is_none(self, tmp_path, text):
        (tmp_path / NAME).mkdir()
        (tmp_path / NAME / "report.json").write_text(text)
        where = tmp_path / NAME / "report.json"
        self.refused(tmp_path, f"{where}: is not a report of camgeo; move it out of the way")
        assert where.read_text() == text

    def test_a_link_does_not_lead_out(self, tmp_path):
        outside = tmp_path / "outside"
        outside.mkdir()
        out = tmp_path / "out"
        out.mkdir()
        (out / NAME).symlink_to(outside)
        self.refused(out, f"{out / NAME}: is in the way: a file or a symbolic link where a folder of its own should be")
        assert not list(outside.iterdir())

    def test_a_file_where_the_folder_should_be(self, tmp_path):
        (tmp_path / NAME).write_text("mine")
        where = tmp_path / NAME
        self.refused(tmp_path, f"{where}: is in the way: a file or a symbolic link where a folder of its own should be")
        assert where.read_text() == "mine"

    def test_a_linked_file_is_replaced_and_its_target_left(self, tmp_path):
        export(tmp_path, 1)
        target = tmp_path / "elsewhere.dxf"
        target.write_text("mine")
        (tmp_path / NAME / "cam.dxf").unlink()
        (tmp_path / NAME / "cam.dxf").symlink_to(target)
        export(tmp_path, 2)
        assert target.read_text() == "mine"
        assert not (tmp_path / NAME / "cam.dxf").is_symlink()
        assert generation_of(tmp_path / NAME) == 2

    def test_a_linked_lock_is_not_followed(self, tmp_path):
        (tmp_path / ".cam.lock").symlink_to(tmp_path / "elsewhere")
        with pytest.raises(SurroundingsError), RunFolder(tmp_path, NAME):
            pass
        assert not (tmp_path / "elsewhere").exists()

    def test_a_report_changed_by_hand_reaches_no_other_file(self, tmp_path):
        export(tmp_path, 1)
        users_files_text = {"drawing.txt": "mine", "other.dxf": "mine"}
        for name, text in users_files_text.items():
            (tmp_path / NAME / name).write_text(text)
        (tmp_path / "cam-secret.dxf").write_text("mine")
        report = json.loads((tmp_path / NAME / "report.json").read_text())
        names = ("../cam-secret.dxf", "other.dxf", "..", "", ".cam", 3, None, "cam/../x")
        report["files"] += [{"path": name} for name in names]
        (tmp_path / NAME / "report.json").write_text(json.dumps(report))
        export(tmp_path, 2)
        assert (tmp_path / "cam-secret.dxf").read_text() == "mine"
        assert {name: (tmp_path / NAME / name).read_text() for name in users_files_text} == users_files_text
        assert generation_of(tmp_path / NAME) == 2

    def test_an_output_folder_that_cannot_be(self, tmp_path):
        (tmp_path / "out").write_text("a file")
        with pytest.raises(SurroundingsError) as caught, RunFolder(tmp_path / "out", NAME):
            pass
        assert caught.value.path.name == "out"
        assert isinstance(caught.value.__cause__, OSError)

    def test_a_full_disk_while_writing(self, tmp_path):
        export(tmp_path, 1)
        where = tmp_path / "cam.stl"
        with pytest.raises(SurroundingsError) as caught:
            stopped(tmp_path, OSError(28, "No space left on device", str(where)))
        assert str(caught.value) == f"{where}: No space left on device"
        assert generation_of(tmp_path / NAME) == 1
        assert hidden(tmp_path) == []

    def test_an_error_without_a_path_names_the_folder(self, tmp_path):
        with pytest.raises(SurroundingsError) as caught:
            stopped(tmp_path, OSError("3000 requested and 1000 written"))
        where = tmp_path / f".cam.partial-{os.getpid()}"
        assert str(caught.value) == f"{where}: 3000 requested and 1000 written"


@pytest.mark.parametrize(
    "name", ["", ".", "..", ".hidden", "a/b", "../a", "a\\b", "a\nb", "a:b", "a.rejected", "a.REJECTED"]
)
def test_a_name_cannot_leave_the_folder(tmp_path, name):
    with pytest.raises(ValueError, match="is not the name of an output folder"):
        RunFolder(tmp_path, name)


@pytest.mark.parametrize("name", ["../cam.dxf", "other.dxf", "cam", ".cam.dxf", "cam/../x.dxf"])
def test_a_file_has_the_name_of_its_recipe(tmp_path, name):
    with RunFolder(tmp_path, NAME) as run:
        write(run.folder, 1)
        with pytest.raises(ValueError, match="is not the name of a file of cam"):
            run.commit([name])
        with pytest.raises(ValueError, match="is not the name of a file of cam"):
            run.commit(["cam.dxf"], keep=[name])


def test_what_was_not_written_is_not_committed(tmp_path):
    with RunFolder(tmp_path, NAME) as run:
        write(run.folder, 1)
        with pytest.raises(ValueError, match=r"^cam\.step was not written into "):
            run.commit(["cam.dxf", "cam.step"])
        (run.folder / "report.json").unlink()
        with pytest.raises(ValueError, match=r"^report\.json was not written into "):
            run.commit(["cam.dxf"])


def test_left_behind_folders_are_cleared_away_but_only_our_own(tmp_path):
    ours = [".cam.partial-1", ".cam.partial-99999999"]
    others = [".cam.partial-1.partial-2", ".cam2.partial-1", ".cam.partial-x"]
    for name in ours + others:
        (tmp_path / name / ".old").mkdir(parents=True)
        (tmp_path / name / "cam.dxf").write_text("half")
    (tmp_path / ".cam.partial-1" / "link").symlink_to(tmp_path / others[0], target_is_directory=True)
    export(tmp_path, 1)
    assert hidden(tmp_path) == sorted(others)
    assert (tmp_path / others[0] / "cam.dxf").exists()


class Failing:
    """Stands in for the os functions that change folders: from call `first` on, `times` calls fail."""

    def __init__(self, monkeypatch, first, times):
        self.calls = 0
        for step in STEPS:
            monkeypatch.setattr(os, step, self.replacement(getattr(os, step), first, times))

    def replacement(self, real, first, times):
        def call(*args, **options):
            self.calls += 1
            if first <= self.calls < first + times:
                raise OSError(13, "Permission denied", str(args[0]))
            return real(*args, **options)

        return call


def steps_of_a_run(tmp_path):
    with pytest.MonkeyPatch.context() as patch:
        failing = Failing(patch, 10**9, 0)
        export(tmp_path, 2)
        return failing.calls


@pytest.mark.thin(3)
@pytest.mark.parametrize("times", [1, 2, 10**6])
def test_any_step_may_fail(tmp_path, times):
    """Step k fails, alone or with those after it: old set or new one, at once where one failure is all."""
    (tmp_path / "count").mkdir()
    export(tmp_path / "count", 1)
    count = steps_of_a_run(tmp_path / "count")
    assert count > 15
    seen = set()
    for first in range(1, count + 1):
        out = tmp_path / str(first)
        users_files(out)
        export(out, 1)
        failed = False
        with pytest.MonkeyPatch.context() as patch:
            Failing(patch, first, times)
            try:
                export(out, 2)
            except SurroundingsError:
                failed = True
        assert_users_files(out)
        if times == 1:
            assert generation_of(out / NAME) == (1 if failed else 2)
        else:
            assert_whole(out, 1, 2)
        with RunFolder(out, NAME):
            generation = generation_of(out / NAME)
        if not failed:
            assert generation == 2
        seen.add((failed, generation))
        export(out, 3)
        assert generation_of(out / NAME) == 3
        assert_users_files(out)
        assert hidden(out) == []
    assert (True, 1) in seen
    assert (False, 2) in seen


@pytest.fixture(scope="module")
def cut_off(tmp_path_factory):
    """An output folder with a swap cut off after its first file."""
    for step in range(1, 100):
        out = tmp_path_factory.mktemp("cut_off")
        users_files(out)
        export(out, 1)
        assert killed(out, 2, step)
        if (out / ".cam.swap").exists() and (out / NAME / "cam.dxf").read_text().startswith("2"):
            return out
    pytest.fail("no swap was cut off")


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("times", [1, 10**6])
def test_any_step_of_the_recovery_may_fail(tmp_path, cut_off, times):
    for first in range(1, 30):
        out = tmp_path / str(first)
        shutil.copytree(cut_off, out)
        with pytest.MonkeyPatch.context() as patch:
            Failing(patch, first, times)
            with suppress(SurroundingsError), RunFolder(out, NAME):
                pass
        assert_whole(out, 1, 2)
        with RunFolder(out, NAME):
            assert generation_of(out / NAME) in {1, 2}
        assert_users_files(out)
        assert hidden(out) == []


def test_without_hard_links_files_are_copied(tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(os, "link", refuse)
    export(tmp_path, 1)
    export(tmp_path, 2)
    assert generation_of(tmp_path / NAME) == 2


def assert_whole(out, *generations, size=1):
    """What holds at any moment: each file whole, of one of the sets, and a new report beside new files only."""
    folder = out / NAME
    current = json.loads((folder / "report.json").read_text())["generation"]
    assert current in generations
    for name in {name for generation in generations for name in names_of(generation)}:
        if (folder / name).exists():
            text = (folder / name).read_text()
            written = int(text.split()[0])
            assert written in generations
            assert text == f"{written} {name}\n" * size
    if current == generations[-1] or not ((out / ".cam.swap").exists() or (out / ".cam.undo").exists()):
        generation_of(folder, size=size)


def killed(out, generation, step):
    """Run an export in a process that ends at once, cleaning nothing, in place of its call number `step`."""
    command = [sys.executable, sets.__file__, "once", str(out), str(generation), str(step)]
    return subprocess.run(command, check=False).returncode == 9


@pytest.mark.slow
def test_killed_at_any_step(tmp_path):
    mixed = 0
    for step in range(1, 100):
        out = tmp_path / str(step)
        users_files(out)
        export(out, 1)
        ended = not killed(out, 2, step)
        assert_whole(out, 1, 2)
        mixed += (out / ".cam.swap").exists()
        with RunFolder(out, NAME):
            generation = generation_of(out / NAME)
        assert hidden(out) == []
        assert_users_files(out)
        if ended:
            assert generation == 2
            break
    assert step > 15
    assert mixed >= 5  # the moments between commit and last rename were met


def test_a_disk_that_refuses_what_is_only_tried_is_named():
    folders = []

    def tried():
        with temporary_folder() as folder:
            folders.append(folder)
            (folder / "absent" / "lift.csv").write_text("")

    with pytest.raises(SurroundingsError, match=r"absent/lift\.csv: No such file or directory"):
        tried()
    assert not folders[0].exists()


@pytest.mark.slow
def test_killed_at_random_moments(tmp_path):
    """A process that writes one set after another is killed again and again, and goes on where it was."""
    chance = random.Random(1984)
    export(tmp_path, 0, size=2000)
    last = 0
    for _ in range(35):
        command = [sys.executable, sets.__file__, "on", str(tmp_path), str(last + 1)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as writer:
            for _ in range(chance.randint(2, 3)):
                begun = time.monotonic()
                done = int(writer.stdout.readline())
            time.sleep(chance.random() * (time.monotonic() - begun))  # somewhere in the next set
            writer.send_signal(signal.SIGKILL)
            told = [int(line) for line in writer.stdout.read().split()]
        done = told[-1] if told else done
        assert_whole(tmp_path, done, done + 1, size=2000)
        with RunFolder(tmp_path, NAME):
            last = generation_of(tmp_path / NAME, size=2000)
        assert last in {done, done + 1}
        assert hidden(tmp_path) == []
    assert last > 35
