"""Pytest plugin: each check of each recipe that a project names becomes a test item.

A project uses it by one line of its pytest configuration, `camgeo_recipes = recipes/*.yaml`. Where that line is missing
nothing is registered and nothing imported beyond this module and the labels of capabilities.

Collection reads the recipes and foresees their checks, which takes milliseconds. A recipe is made and judged when its
first item runs, once in each process.
"""

from __future__ import annotations

import fnmatch
import glob
import os
import shlex
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import pytest

from camgeo.registry import registry

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from _pytest._code.code import TerminalRepr, TracebackStyle

    from camgeo.checks.declaration import Entry
    from camgeo.recipe.recipe import Order
    from camgeo.schema.errors import RecipeErrors
    from camgeo.synthesis.expected_checks import Foreseen

INI = "camgeo_recipes"
VERIFIED = "camgeo_verify"
OPTION = "camgeo_{}"  # ini line of an option of a capability
WHOLE = "recipe"  # name of the item that stands for a recipe as a whole
TOGETHER = frozenset({"no", "loadfile", "loadscope"})  # modes of --dist of xdist that leave a recipe to one process


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the lines of the configuration, and the option --camgeo-out."""
    parser.addini(
        INI,
        "recipes of camgeo whose checks become test items: paths or glob patterns, relative to this file",
        type="args",
        default=[],
    )
    about = "lines of a recipe, files such as points measured on its part, and options such as probe_error=0.002"
    parser.addini(VERIFIED, about, type="linelist", default=[])
    for name, text in registry.options().items():
        parser.addini(OPTION.format(name), f"of camgeo's recipes: {text}", type="bool", default=False)
    group = parser.getgroup("camgeo")
    group.addoption("--camgeo-out", metavar="DIR", help="keep the files and reports of all recipes that run under DIR")


def pytest_configure(config: pytest.Config) -> None:
    """Register the plugin in projects that name recipes; raises UsageError for options without recipes."""
    patterns: list[str] = config.getini(INI)
    out: str | None = config.getoption("camgeo_out")
    if out == "":
        raise pytest.UsageError("--camgeo-out: an empty name")
    if patterns:
        config.addinivalue_line("markers", "camgeo: a check of a recipe")
        folder = None if out is None else Path(config.invocation_params.dir, out)
        config.pluginmanager.register(Recipes(config, patterns, folder), "camgeo-recipes")
    elif config.getini(VERIFIED) and not config.getoption("help"):
        raise pytest.UsageError(f"{VERIFIED}: no recipes are named; give {INI} in the pytest configuration")
    elif out is not None and not config.getoption("help"):
        raise pytest.UsageError(f"--camgeo-out: no recipes are named; give {INI} in the pytest configuration")


class Recipes:
    """Recipes of one session; `runs` has a run for each, by the resolved path of its file.

    `out` is the folder in which the files are kept, None for none.
    """

    def __init__(self, config: pytest.Config, patterns: list[str], out: Path | None) -> None:
        self.config = config
        self.patterns = patterns
        self.out = out
        self.base = config.rootpath if config.inipath is None else config.inipath.parent
        self.runs: dict[Path, RecipeRun] = {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionstart(self) -> None:
        """Find the recipes, and add them to pytest's arguments where the command line has none.

        Raises UsageError for faulty patterns or lines of the settings, and where processes would write one recipe's
        files at once.
        """
        dist = self.config.getoption("dist", "no")
        if self.out is not None and dist not in TOGETHER and self.config.getoption("numprocesses", None):
            raise pytest.UsageError(
                f"--camgeo-out: under --dist {dist} several processes would write one recipe's files; "
                "give --dist loadfile"
            )
        options = {name: True for name in registry.options() if self.config.getini(OPTION.format(name))}
        for path in self._found():
            shown_path = _relative(path, self.config.invocation_params.dir)
            self.runs[path.resolve()] = RecipeRun(path, shown_path, self.out, options)
        for line in self.config.getini(VERIFIED):
            self._verified(line)
        sources = type(self.config).ArgsSource
        whole = self.config.invocation_params.dir == self.config.rootpath
        if whole and self.config.args_source is not sources.ARGS:
            self.config.args += [run.shown for run in self.runs.values() if self._can_be_named(run)]

    def pytest_report_header(self) -> str:
        """Line with the number of recipes."""
        return f"camgeo: {len(self.runs)} recipe{'s' * (len(self.runs) != 1)}"

    def pytest_collect_file(self, file_path: Path, parent: pytest.Collector) -> RecipeFile | None:
        """Collector of a recipe that the project names; None for any other file."""
        run = self.runs.get(file_path.resolve())
        if run is None:
            return None
        collected: RecipeFile = RecipeFile.from_parent(parent, path=file_path, run=run, others=self.runs)
        return collected

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Remove duplicate items: a recipe may be collected both by itself and with its folder."""
        names: set[str] = set()
        for item in [item for item in items if isinstance(item, RecipeItem)]:
            if item.nodeid in names:
                items.remove(item)
            names.add(item.nodeid)

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Note the items of each recipe that remain after -k, -m and other filters."""
        for item in session.items:
            if isinstance(item, CheckItem):
                item.run.selected.add(item.name)

    def _found(self) -> list[Path]:
        """Files that the patterns match, each once, in the order of the patterns.

        Raises UsageError for a pattern that matches no file.
        """
        paths: dict[Path, None] = {}
        faults = []
        for pattern in self.patterns:
            # pathlib's own glob takes no absolute patterns
            names = glob.glob(pattern, root_dir=self.base, recursive=True)  # noqa: PTH207
            matches = sorted(self.base / name for name in names)
            files = [path for path in matches if path.is_file()]
            if not files:
                fault = "names a folder; name the files in it, such as folder/*.yaml" if matches else "matches no file"
                faults.append(f"{INI}: {pattern!r} {fault} (looked for in {self.base})")
            paths |= dict.fromkeys(files)
        if faults:
            raise pytest.UsageError("\n".join(faults))
        return list(paths)

    def _verified(self, line: str) -> None:
        """Add the files and options of a line of the settings to the recipe that has to verify them.

        Raises UsageError for a recipe that is not among those found, a file that does not exist, and a line without
        files.
        """
        from camgeo.schema.file_bytes import path_fault

        words = shlex.split(line)
        options = {name: _value(text) for name, text in (word.split("=", 1) for word in words[1:] if "=" in word)}
        files = [self.base / word for word in words[1:] if "=" not in word]
        run = self.runs.get((self.base / words[0]).resolve())
        missing = [str(file) for file in files if path_fault(file)]
        if run is None:
            raise pytest.UsageError(f"{VERIFIED}: {words[0]!r} is not among the recipes of {INI}")
        if missing or not files:
            problem = f"no file {', '.join(missing)}" if missing else "no file is named"
            raise pytest.UsageError(f"{VERIFIED}: {line!r}: {problem}")
        run.verified.append((tuple(files), options))

    def _can_be_named(self, run: RecipeRun) -> bool:
        """Whether a recipe may stand among pytest's arguments, which outrank --ignore and give [ and :: a meaning."""
        folder = self.config.invocation_params.dir
        ignored = {Path(folder, name) for name in self.config.getoption("ignore") or ()}
        patterns = [str(Path(folder, name)) for name in self.config.getoption("ignore_glob") or ()]
        for path in (run.path, *run.path.parents):
            if path in ignored or any(fnmatch.fnmatch(str(path), pattern) for pattern in patterns):
                return False
        return "[" not in run.shown and "::" not in run.shown


@dataclass
class RecipeRun:
    """One recipe of a session, made and judged at the first use of its report.

    path      file of the recipe; `shown` is its path in messages
    out       folder in which its files are kept; None for none
    options   options of capabilities
    recipe    the recipe as read; None before it is read, and with faults
    fault     message on what prevents it from being made, empty for nothing
    certain   whether that would happen in any process and at any time
    selected  names of its items that are going to run
    verified  files and options of each line by which it verifies files
    """

    path: Path
    shown: str
    out: Path | None
    options: dict[str, Any]
    recipe: Order | None = None
    fault: str = ""
    certain: bool = False
    selected: set[str] = field(default_factory=set)
    verified: list[tuple[tuple[Path, ...], dict[str, Any]]] = field(default_factory=list)
    _report: Entry | None = field(default=None, repr=False)

    def load(self) -> None:
        """Read the recipe into `recipe`; its faults go into `fault`."""
        from camgeo.recipe.loading import load_order
        from camgeo.schema.errors import RecipeErrors

        try:
            self.recipe = load_order(self.path)
        except RecipeErrors as errors:
            self._refused(errors)

    @property
    def report(self) -> Entry | None:
        """Report on the recipe, as plain data; None where it cannot be made, with the reason in `fault`."""
        if self._report is None and not self.fault:
            self._run()
        return self._report

    def _run(self) -> None:
        from camgeo import check, export
        from camgeo.api.log import without_log
        from camgeo.common.errors import SurroundingsError
        from camgeo.schema.errors import RecipeErrors

        assert self.recipe is not None
        # message of the following items, should an exception end this item
        self.fault = (
            f"{self.shown}: the run broke off with an error of camgeo's own, reported by the first item that ran"
        )
        try:
            with without_log():  # each item reports its own check
                if self.out is None:
                    report = check(self.recipe, **self.options)
                else:
                    report = export(self.recipe, self.out, **self.options)
            self._report, self.fault = dict(report), ""
        except RecipeErrors as errors:
            self._refused(errors)
        except (SurroundingsError, OSError) as error:
            self.fault = f"{self.shown}: {error}"

    def _refused(self, errors: RecipeErrors) -> None:
        self.fault, self.certain = "\n".join(str(replace(error, file=self.shown)) for error in errors.errors), True


class RecipeFile(pytest.File):
    """A recipe as a collection of checks."""

    def __init__(self, *, run: RecipeRun, others: dict[Path, RecipeRun], **rest: Any) -> None:  # noqa: ANN401 - pytest's own
        super().__init__(**rest)
        self.run = run
        self.others = others

    def collect(self) -> Iterator[RecipeItem]:
        """One item for the recipe, one for each expected check, and one for each line of files that it verifies.

        Raises CollectError where two recipes of the session would write into the same folder.
        """
        self.run.load()
        recipe = self.run.recipe
        if recipe is not None and self.run.out is not None:
            for other_run in self.others.values():
                if (
                    other_run is not self.run
                    and other_run.recipe
                    and other_run.recipe.name.casefold() == recipe.name.casefold()
                ):
                    raise self.CollectError(
                        f"{self.run.shown}: its files would go to the folder of {other_run.shown}, "
                        f"as both are named {recipe.name}; give each its own `name:`"
                    )
        checks = () if recipe is None else _expected_checks(recipe, self.run.options)
        for check in (None, *checks):
            name = WHOLE if check is None else str(check)
            yield CheckItem.from_parent(self, name=name, run=self.run, check=check, foreseen=frozenset(checks))
        for files, options in self.run.verified:
            words = [file.name for file in files] + [f"{key}={value}" for key, value in options.items()]
            name = f"verify[{' '.join(words)}]"
            yield VerifyItem.from_parent(self, name=name, run=self.run, files=files, options=options)


def _expected_checks(recipe: Order, options: Iterable[str]) -> tuple[Foreseen, ...]:
    """Expected checks of a recipe with these options; empty where an option does not go with the recipe.

    The item of the recipe as a whole has all other checks.
    """
    from camgeo.api.root import root_of
    from camgeo.common.errors import CallError

    try:
        return tuple(root_of(recipe).foresee(recipe.using(*options)))
    except CallError:  # which the run will tell
        return ()


def _value(text: str) -> float | str:
    """Value of an option: a number where the text is one, else the text."""
    try:
        return float(text)
    except ValueError:
        return text


class RecipeItem(pytest.Item):
    """An item of a recipe."""

    def __init__(self, *, run: RecipeRun, **rest: Any) -> None:  # noqa: ANN401 - pytest's own
        super().__init__(**rest)
        self.run = run
        self.add_marker("camgeo")

    def repr_failure(
        self, excinfo: pytest.ExceptionInfo[BaseException], style: TracebackStyle | None = None
    ) -> str | TerminalRepr:
        """Text of a failure; the traceback of an error in camgeo leaves out pytest's own calls."""
        excinfo.traceback = excinfo.traceback.cut(path=__file__)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Path, line and name of the item, for pytest's messages."""
        return self.path, None, self.name

    def _hold(self, checks: list[Entry], report: Entry) -> None:
        from camgeo.api.report import explanation

        assert self.run.recipe is not None
        failed = [explanation(check, report, self.run.recipe, self.run.shown) for check in checks if not check["ok"]]
        if failed:
            _fail("\n".join(failed))


class VerifyItem(RecipeItem):
    """Files of any origin that a recipe verifies, such as points measured on its part."""

    def __init__(
        self,
        *,
        files: tuple[Path, ...],
        options: dict[str, Any],
        **rest: Any,  # noqa: ANN401 - pytest's own
    ) -> None:
        super().__init__(**rest)
        self.files = files
        self.options = options

    def runtest(self) -> None:
        """Judge the files; fails unless every check holds."""
        from camgeo import verify
        from camgeo.common.errors import CallError

        if self.run.recipe is None:
            _fail(self.run.fault)
        try:
            report: Entry = dict(verify(self.run.recipe, *self.files, **self.options))
        except CallError as error:
            _fail(str(error))
        self._hold(report["checks"], report)


class CheckItem(RecipeItem):
    """One check of a recipe; or, without a check, the recipe as a whole with all checks that were not foreseen."""

    def __init__(
        self,
        *,
        check: Foreseen | None,
        foreseen: frozenset[Foreseen],
        **rest: Any,  # noqa: ANN401 - pytest's own
    ) -> None:
        super().__init__(**rest)
        self.check = check
        self.known = foreseen

    def runtest(self) -> None:
        """Fail unless the check holds, or was not made for a reason that another item reports; run the recipe first."""
        report = self.run.report
        if self.check is None:
            self._whole(report)
        elif report is None:
            self._not_judged(self.run.fault.partition("\n")[0], WHOLE if self.run.certain else None)
        else:
            self._one(self.check, report)

    def _whole(self, report: Entry | None) -> None:
        if report is None:
            _fail(self.run.fault)
        unforeseen = [check for check in report["checks"] if (check["name"], check.get("file")) not in self.known]
        self._hold(unforeseen, report)

    def _one(self, foreseen: Foreseen, report: Entry) -> None:
        checks = [check for check in report["checks"] if (check["name"], check.get("file")) == foreseen]
        if checks:
            place = ("at_deg",) if "at_deg" in checks[0] else ("at", "at_unit")
            self.user_properties += [(key, checks[0][key]) for key in ("value", "limit", "unit", *place)]
            self._hold(checks, report)
        else:
            self._missing(foreseen, report)

    def _missing(self, foreseen: Foreseen, report: Entry) -> NoReturn:
        """Fail with the reason why an expected check was not made."""
        from camgeo.checks.declared import CHECKS, MOTION
        from camgeo.report.failure import headline
        from camgeo.synthesis.expected_checks import Foreseen

        recipe = self.run.recipe
        assert recipe is not None
        for entry in report["skipped"]:
            if entry.get("missing") and entry["what"] == foreseen.file:
                _fail(f"{foreseen}: not judged: {entry['why']}")
        cause = [check for check in report["checks"] if not check["ok"] and check.get("file") in (None, foreseen.file)]
        if cause:
            self._not_judged(headline(cause[0]), str(Foreseen(cause[0]["name"], cause[0].get("file"))))
        if recipe.trims and (
            foreseen.name == MOTION.name or (foreseen.name in CHECKS and CHECKS[foreseen.name].backlash)
        ):
            reason = (
                "an undercut is trimmed: what motion is lost is reported, and judged against verify.motion_error alone"
            )
            pytest.skip(f"{self.run.shown}: {reason}")
        why = next((entry["why"] for entry in report["skipped"] if entry["what"] == str(foreseen)), None)
        if why is not None and foreseen.name in CHECKS and CHECKS.owner(foreseen.name) in self.run.options:
            pytest.skip(f"{self.run.shown}: {why}")
        _fail(f"{foreseen} is not among the checks that were made")

    def _not_judged(self, cause: str, told_by: str | None) -> NoReturn:
        """Skip where another item of this session is certain to fail for the same cause, else fail.

        `told_by` is the name of the check of that item; None for a cause that may be absent in the process in which the
        other item runs.
        """
        if told_by is not None:
            name = told_by if told_by in map(str, self.known) else WHOLE
            if name in self.run.selected:
                pytest.skip(f"not judged, see {self.run.shown}::{name}")
        _fail(f"{self.name}: not judged: {cause}")


def _fail(text: str) -> NoReturn:
    pytest.fail(text, pytrace=False)


def _relative(path: Path, folder: Path) -> str:
    """Path relative to a folder; absolute on another drive."""
    try:
        return os.path.relpath(path, folder)
    except ValueError:
        return str(path)
