#!/usr/bin/env bash
# What is packed is all that is needed: `.ci/wheel_smoke.sh [PYTHON ...]`. A release is built twice, the same bytes; for
# each PYTHON the wheel is installed into a new environment and used in an empty folder, away from the repository.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- python3
version=$(sed -n 's/^__version__ = "\(.*\)"$/\1/p' camgeo/version.py)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset PYTHONPATH

"$1" -m venv "$work/build"
"$work/build/bin/pip" install --quiet --disable-pip-version-check build '.[site]'
"$work/build/bin/python" tools/release.py --out "$work/dist"
"$work/build/bin/python" tools/release.py --out "$work/again" >"$work/again.txt"
cmp "$work/dist/SHA256SUMS" "$work/again/SHA256SUMS" || { echo "a release built again has other bytes"; exit 1; }
wheel=$work/dist/camgeo-$version-py3-none-any.whl
tar -tzf "$work/dist/camgeo-$version.tar.gz" >"$work/sdist.txt"
for name in CITATION.cff CHANGELOG.md LICENSE recipes/shu-wu.yaml tests/conftest.py docs/recipe.md benchmarks/speed.py tools/docs/make_gallery.py; do
    grep -qx "camgeo-$version/$name" "$work/sdist.txt" || { echo "the sdist lacks $name"; exit 1; }
done

number=0
for python in "$@"; do
    number=$((number + 1))
    "$python" -m venv "$work/venv$number"
    bin=$work/venv$number/bin
    "$bin/pip" install --quiet --disable-pip-version-check "$wheel" pytest
    mkdir "$work/empty$number"
    (
        cd "$work/empty$number"
        [ "$("$bin/camgeo" --version)" = "camgeo $version" ]
        cat >small.yaml <<'YAML'
cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [10, 4]}
part: {thickness: 8, bore: 10, hub: {diameter: 18, height: 4}}
export: {tolerance: 0.01, files: [dxf, svg, stl, 3mf, glb, csv, html]}
verify: {angles: 360}
YAML
        "$bin/camgeo" export small.yaml
        "$bin/camgeo" verify --tolerance 0.01 small.yaml out/small/small.dxf out/small/small.svg out/small/small.stl out/small/small.3mf
        grep -q "<script" out/small/small.html
        "$bin/camgeo" report small.yaml --out page --picture svg >/dev/null
        grep -rq "<style" page
        "$bin/camgeo" new constant-breadth fresh.yaml
        "$bin/camgeo" check fresh.yaml
        "$bin/camgeo" schema | "$bin/python" -m json.tool >/dev/null
        printf '[pytest]\ncamgeo_recipes = small.yaml\n' >pytest.ini
        "$bin/python" -m pytest -q small.yaml | tail -1
        "$bin/python" - "$work" <<'PYTHON'
import sys
from importlib.metadata import files, version
from pathlib import Path

import camgeo
import kin

packed = {path.parts[0] for path in files("camgeo")}
assert version("camgeo") == camgeo.__version__
assert not packed & {"tests", "benchmarks", "recipes", "docs", "site", "tools", "web"}, packed
for package in (camgeo, kin):
    folder = Path(package.__file__).parent
    assert folder.is_relative_to(sys.argv[1]), folder
    assert (folder / "py.typed").is_file()
PYTHON
    )
    echo "the wheel works under $("$python" --version)"
done
