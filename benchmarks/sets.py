# needs: mechanism
"""The bodies round every shipped cam, turned once round: the table in docs/mechanism.md.

`python benchmarks/sets.py [recipe ...]` prints its rows; three minutes for all; `--small` takes one.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from camgeo.capabilities.mechanism.interference import collision_checks
from camgeo.capabilities.mechanism.making import build_assembly
from camgeo.output.job import Job
from camgeo.recipe.loading import load
from camgeo.synthesis.design import designed

RECIPES = Path(__file__).parents[1] / "recipes"
TOLERANCE = 0.001  # mm


def main(names: list[str], *, small: bool = False) -> None:
    """Print a row for each recipe."""
    print("| recipe | follower | bodies | pairs | least, mm | least beyond the fits, mm | s |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    chosen = ["fourier"] if small else names or sorted(path.stem for path in RECIPES.glob("*.yaml"))
    for name in chosen:
        print(row(name), flush=True)


def row(name: str) -> str:
    """Build and turn one."""
    recipe = load(RECIPES / f"{name}.yaml")
    design = designed(recipe)
    if not design.contours:
        return f"| {name} | | | | no contour | | |"
    contours = [fit.within("arcs", TOLERANCE) for fit in Job.of(recipe, design).fits]
    begin = time.process_time()
    assembly = build_assembly(recipe, design, *contours)
    checks = [check for check in collision_checks(assembly) if check.name == "collision"]
    spent = time.process_time() - begin
    told = sorted((check.value, check.detail) for check in checks)
    # what is no fit, and not the sink about the shaft's retainer, which is wider by its own rule
    free = next((one for one in told if one[0] > assembly.sizes.clearance and "retainer-shaft" not in one[1]), told[-1])
    kind = design.follower.name if recipe.linkage is None else recipe.linkage.kind
    fine = "" if all(check.ok for check in checks) else " **meets**"
    return (
        f"| {name} | {kind} | {len(assembly.members)} | {len(checks)} | {told[0][0]:.3f} {told[0][1]}{fine} | "
        f"{free[0]:.1f} {free[1]} | {spent:.1f} |"
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipes", nargs="*", metavar="RECIPE", help="name of a shipped recipe (default: all)")
    parser.add_argument("--small", action="store_true", help="a small size, to see that it works")
    arguments = parser.parse_args()
    main(arguments.recipes, small=arguments.small)
