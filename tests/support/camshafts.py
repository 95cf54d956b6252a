# needs: camshaft
"""Recipes of camshafts in a folder, with those of their lobes."""

from pathlib import Path

INTAKE = """\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat}
  motion: {lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}
part: {thickness: 14, density: 7850}
"""
EXHAUST = INTAKE.replace("lift: 8, half: 68", "lift: 7.6, half: 65")
ROLLER = """\
cam:
  kind: disc
  base_radius: 30
  follower: {kind: roller, radius: 8, offset: 4}
  motion: [{rise: 12, over: 60, law: modified-sine}, {dwell: 30}, {return: 12, over: 90, law: cycloidal}, {dwell: 180}]
part: {thickness: 10}
"""
ENGINE = "  engine: {order: [1, 3, 4, 2], intake: 110, exhaust: 114, lift: 1}\n"
SHAFT = "  shaft: {diameter: 24, to: 120, bore: 8}\n  journals: [{z: 0, length: 20, diameter: 30}]\n"


def shaft(
    folder: Path, lobes: str, engine: str = "", *, files: str = "[stl]", extra: str = "", body: str = SHAFT
) -> Path:
    for name, text in (("intake", INTAKE), ("exhaust", EXHAUST), ("roller", ROLLER)):
        (folder / f"{name}.yaml").write_text(text)
    path = folder / "shaft.yaml"
    rows = "".join(f"    - {{{row}}}\n" for row in lobes.strip().splitlines())
    text = f"{extra}camshaft:\n{body}  lobes:\n{rows}{engine}export: {{tolerance: 0.01, files: {files}}}\n"
    path.write_text(text + "verify: {angles: 360}\n")
    return path


TWO = "recipe: intake.yaml, at: 33.3, z: 30\nrecipe: roller.yaml, at: -120, z: 60"
