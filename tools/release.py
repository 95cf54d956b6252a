"""Build what a release consists of: `python tools/release.py [--out dist]`, from a clean clone.

    camgeo-X.Y.Z.tar.gz             the source: code, tests, recipes, docs
    camgeo-X.Y.Z-py3-none-any.whl   what is installed, built from that source
    camgeo-X.Y.Z-site.zip           the site of the docs
    SHA256SUMS                      their checksums

Built again, on any day and in any folder, they are the same bytes: every time in source and wheel is that of the last
commit, and the site has none. Needs git, the package `build` and the extra `site`.
"""

from __future__ import annotations

import argparse
import gzip
import hashlib
import io
import os
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def release(out: Path) -> list[Path]:
    """Build the files of a release into a folder, and give their paths, that of the checksums last.

    Raises CalledProcessError where git or the build fails.
    """
    os.umask(0o022)  # a wheel has the permissions of the files that it is built from
    moment = _run("git", "log", "-1", "--format=%ct").strip()
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _run("git", "clone", "--quiet", ".", str(folder / "clone"))
        settings = {"SOURCE_DATE_EPOCH": moment}
        _run(sys.executable, "-m", "build", "--outdir", str(folder / "dist"), str(folder / "clone"), **settings)
        (source,) = (folder / "dist").glob("*.tar.gz")
        (wheel,) = (folder / "dist").glob("*.whl")
        site = source.name.replace(".tar.gz", "-site.zip")
        made = [out.resolve() / name for name in (source.name, wheel.name, site)]
        made[0].write_bytes(_timeless(source.read_bytes(), int(moment)))
        made[1].write_bytes(wheel.read_bytes())
        script = str(folder / "clone" / "tools" / "docs" / "make_site.py")
        zipped = ("--zip", str(made[2]))
        _run(sys.executable, script, str(folder / "site"), *zipped, PYTHONPATH=str(folder / "clone"))
    sums = out / "SHA256SUMS"
    lines = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in made]
    sums.write_text("".join(lines), encoding="utf-8", newline="\n")
    return [*made, sums]


def _timeless(packed: bytes, moment: int) -> bytes:
    """An archive with the same files by name, of one time, owned by nobody: `build` writes those of its own run."""
    inner, outer = io.BytesIO(), io.BytesIO()
    with (
        tarfile.open(fileobj=io.BytesIO(packed)) as read,
        tarfile.open(fileobj=inner, mode="w", format=tarfile.PAX_FORMAT) as written,
    ):
        for member in sorted(read.getmembers(), key=lambda each: each.name):
            member.mtime, member.uid, member.gid, member.uname, member.gname = moment, 0, 0, "", ""
            member.mode = 0o755 if member.isdir() or member.mode & 0o100 else 0o644
            member.pax_headers = {}
            written.addfile(member, read.extractfile(member) if member.isreg() else None)
    with gzip.GzipFile(filename="", fileobj=outer, mode="wb", mtime=moment) as file:
        file.write(inner.getvalue())
    return outer.getvalue()


def _run(*words: str, **settings: str) -> str:
    """Output of a command in the repository; what it says on its way is shown where it fails."""
    done = subprocess.run(words, cwd=ROOT, env={**os.environ, **settings}, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.stderr.write(done.stdout + done.stderr)
        done.check_returncode()
    return done.stdout


def main() -> None:
    """Build, and print what was made."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "dist", help="folder of the files (default: dist)")
    for path in release(parser.parse_args().out):
        print(path)


if __name__ == "__main__":
    main()
