"""Twenty cams in a loop: the smallest whose contour is nowhere bent more sharply than a limit is made.

python examples/twenty_cams.py [FOLDER]
"""

import sys

import camgeo

RECIPE = """
name: twenty
cam:
  kind: constant-breadth
  base_radius: 20                 # changed in the loop
  motion:
    - {rise: 10, over: 120, law: modified-sine}
    - {dwell: 60}
part: {bore: 12, thickness: 8}
export: {tolerance: 0.001, files: [dxf, stl]}
"""
LEAST = 20.0  # mm, of the radius of curvature


def main(out: str = "out") -> camgeo.Report:
    recipe = camgeo.load(RECIPE)
    kept = []
    for radius in range(11, 31):
        design = camgeo.design(recipe.replace({"cam.base_radius": radius, "name": f"cam-{radius}"}))
        bent = design.figures["radius-of-curvature"].value
        if design.ok and bent is not None and bent >= LEAST:
            kept.append(design)
    best = min(kept, key=lambda design: design.figures["size"].value or 0.0)
    report = camgeo.export(best.recipe, out)
    print(f"{len(kept)} of 20 are kept, radius of curvature of the best: {best.figures['radius-of-curvature']}")
    print(report)
    if report.path is not None:
        best.recipe.save(report.path / "recipe.yaml")
    return report


if __name__ == "__main__":
    main(*sys.argv[1:2])
