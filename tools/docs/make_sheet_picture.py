# needs: sheet
"""Picture of docs/sheet.md, the first page of its recipe: `python tools/docs/make_sheet_picture.py` (poppler)."""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from camgeo.output import pipeline
from camgeo.recipe.loading import read

DOCS = Path(__file__).parents[2] / "docs"
DOTS = 90  # an inch


def main() -> None:
    """Export the recipe of the page, and turn the first page of its PDF into a picture."""
    program = shutil.which("pdftoppm")
    if program is None:
        raise SystemExit("pdftoppm, of poppler, is not installed")
    found = re.search(r"^```yaml\n(.*?)^```", (DOCS / "sheet.md").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    if found is None:
        raise SystemExit("docs/sheet.md has no recipe")
    with tempfile.TemporaryDirectory() as folder:
        outcome = pipeline.export(read(found[1].encode(), "cam.yaml"), Path(folder))
        assert outcome.folder is not None
        words = [program, "-r", str(DOTS), "-gray", "-png", "-singlefile", str(outcome.folder / "cam-sheet.pdf")]
        subprocess.run([*words, str(DOCS / "pictures" / "sheet")], check=True)


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
