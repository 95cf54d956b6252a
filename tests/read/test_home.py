"""A folder in place of a home that cannot be written: it is there for the process, and gone after it alone."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import os
from pathlib import Path
from kin.read.home import prepare_home

prepare_home()
folder = Path(os.environ["MPLCONFIGDIR"])
child = os.fork()
if child == 0:
    raise SystemExit  # with all that a process does at its end
os.waitpid(child, 0)
print(folder, folder.is_dir(), os.environ["XDG_CACHE_HOME"] == os.environ["XDG_CONFIG_HOME"] == str(folder))
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs processes that inherit")
def test_the_folder_outlives_what_a_process_forks_and_not_the_process(tmp_path: Path) -> None:
    nowhere = tmp_path / "file"
    nowhere.write_text("")
    homes = {"HOME": str(nowhere), "XDG_CACHE_HOME": str(nowhere / "a"), "XDG_CONFIG_HOME": str(nowhere / "b")}
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT], env={**os.environ, **homes}, capture_output=True, text=True, check=True
    )
    folder, was_there, alike = run.stdout.split()
    assert (was_there, alike) == ("True", "True")
    assert folder.startswith(str(Path(folder).parent / "camgeo-home-"))
    assert not Path(folder).exists()


FONTS = """
import sys
from kin.read.home import prepare_home

prepare_home()
finders = list(sys.meta_path)
import ezdxf.document
from ezdxf.fonts import fonts

print("fontTools" in sys.modules, len(finders) - len(sys.meta_path))
print(fonts.make_font("any.ttf", 2.5).text_width("cam") > 1.0, "fontTools" in sys.modules)
"""


def test_fonts_are_loaded_when_they_are_asked_for() -> None:
    """And nothing is left of what waits for them."""
    run = subprocess.run([sys.executable, "-c", FONTS], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["False", "1", "True", "True"]
