"""Small output sets in generations, for tests of the store; light, so that processes which use it start fast."""

import json
import os
import sys
from itertools import count
from pathlib import Path

from camgeo.output.output_folder import RunFolder

NAME = "cam"
STEPS = ("rename", "replace", "unlink", "link", "mkdir", "rmdir")


def names_of(generation):
    """Files of a generation: the second one differs from set to set, so that files both come and go."""
    return ["cam.dxf", f"cam-{generation % 3}.stl", "cam.csv"]


def write(folder, generation, names=None, size=1):
    names = names_of(generation) if names is None else names
    for name in names:
        (folder / name).write_text(f"{generation} {name}\n" * size)
    report = {"generation": generation, "files": [{"path": name} for name in names]}
    (folder / "report.json").write_text(json.dumps(report))
    return names


def export(out, generation, *, size=1):
    with RunFolder(out, NAME) as run:
        return run.commit(write(run.folder, generation, size=size))


def end_at(last):
    """Let the process end, with nothing cleaned up, in place of call number `last` of those that change folders."""
    calls = count(1)

    def ending(real):
        def call(*args, **options):
            if next(calls) == last:
                os._exit(9)
            return real(*args, **options)

        return call

    for step in STEPS:
        setattr(os, step, ending(getattr(os, step)))


if __name__ == "__main__":
    task, folder, first = sys.argv[1], Path(sys.argv[2]), int(sys.argv[3])
    if task == "once":
        end_at(int(sys.argv[4]))
        export(folder, first)
    else:
        for number in count(first):
            export(folder, number, size=2000)
            print(number, flush=True)
