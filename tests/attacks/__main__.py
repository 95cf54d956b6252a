"""`PYTHONPATH=tests python -m attacks --seed 1 --count 2000`: attacks by chance; exit status 1 with any finding."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from attacks.generator import attack_of
from attacks.runner import Told, run, summary


def main() -> int:
    """Run the attacks that are asked for, print each finding as it comes, and a summary."""
    parser = argparse.ArgumentParser(prog="attacks", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="number of the first attack")
    parser.add_argument("--every", type=int, default=1, help="take one of so many")
    parser.add_argument(
        "--keep", type=Path, help="write the files of the first attack into this folder, and do no more"
    )
    parser.add_argument("-v", action="store_true", help="a line for each attack")
    given = parser.parse_args()
    if given.keep:
        attack = attack_of(given.seed, given.first)
        given.keep.mkdir(parents=True, exist_ok=True)
        for name, raw in attack.files.items():
            path = given.keep / name
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(raw)
        print(attack.name, attack.statuses, "camgeo", *attack.words)
        return 0
    all_told: list[Told] = []

    def told(one: Told) -> None:
        all_told.append(one)
        for text in one.findings:
            print(f"{one.number} {one.name} {' '.join(one.words)!r}: {text}", flush=True)
        if given.v and not one.findings:
            print(f"{one.number} {one.name}: {one.status}, {one.seconds:.2f} s", flush=True)

    run(given.seed, range(given.first, given.first + given.count * given.every, given.every), told)
    print(summary(all_told))
    return int(any(one.findings for one in all_told))


if __name__ == "__main__":
    sys.exit(main())
