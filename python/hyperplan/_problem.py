"""Problems: from files, texts, and built in code."""

from __future__ import annotations

import datetime
import json
import os
import tempfile
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path as FilePath
from typing import Any, Callable, Hashable, Iterator, Mapping, Optional, Sequence, Union

from . import _native
from ._command import ANSWERS, run
from ._result import Explanation, Path, Result, Verification
from ._systems import System

#: How a constant is given.
Number = Union[int, float, str, Fraction]

#: How often is told how far a search is, in seconds.
_EVERY = 0.1

#: Time to look for reasons, where none was said.
_REASONS = 30.0


@dataclass(frozen=True)
class Minimized:
    """The least value of a constant."""

    #: The least value for which the objective is realizable; `None` where none was found.
    value: Optional[int]
    #: Whether every smaller value of the range is unrealizable.
    proved: bool
    #: The problem with that value.
    problem: "Problem"
    #: Its result.
    result: Result


class Problem:
    """Systems and objectives without errors."""

    def __init__(
        self,
        native: _native.Problem,
        *,
        file: FilePath | None = None,
        constants: Sequence[tuple[str, str]] = (),
        states: Mapping[str, Mapping[str, Hashable]] | None = None,
    ) -> None:
        self._native = native
        self._file = file
        self._set = list(constants)
        self._states = dict(states or {})

    @classmethod
    def from_text(
        cls, text: str, *, folder: str | os.PathLike[str] | None = None, files: Mapping[str, bytes] | None = None
    ) -> Problem:
        """A problem from its text. Files that it names are those given, or in the folder."""
        return cls.build(text=text, folder=folder, files=files)

    @classmethod
    def build(
        cls,
        systems: Mapping[str, System] | None = None,
        objectives: Mapping[str, str] | None = None,
        constants: Mapping[str, Number] | None = None,
        *,
        text: str = "",
        folder: str | os.PathLike[str] | None = None,
        files: Mapping[str, bytes] | None = None,
    ) -> Problem:
        """A problem of systems and objectives, each by its name; `text` has definitions and templates, or anything else."""
        systems = systems or {}
        native = _native.build(
            None,
            text,
            None if folder is None else os.fspath(folder),
            [(name, bytes(contents)) for name, contents in (files or {}).items()],
            [(name, _number(value)) for name, value in (constants or {}).items()],
            [(name, system._native) for name, system in systems.items()],
            list((objectives or {}).items()),
        )
        return cls(native, states={name: system.states for name, system in systems.items()})

    def with_constants(self, **constants: Number) -> Problem:
        """The same problem with other values of constants."""
        native, given = self._native, list(self._set)
        for name, value in constants.items():
            native = native.with_constant(name, _number(value))
            given.append((name, _number(value)))
        return Problem(native, file=self._file, constants=given, states=self._states)

    @property
    def objectives(self) -> list[str]:
        """The names of its objectives."""
        return self._native.objectives()

    @property
    def constants(self) -> dict[str, Union[int, Fraction]]:
        """Its constants with their values."""
        values = ((name, Fraction(value)) for name, value in self._native.constants())
        return {name: int(value) if value.denominator == 1 else value for name, value in values}

    @property
    def warnings(self) -> list[dict[str, Any]]:
        """What is doubtful in it, with places and hints."""
        return self._native.warnings()

    @property
    def text(self) -> Optional[str]:
        """Its text; none where it was read from files of other tools."""
        return self._native.text()

    def save(self, folder: str | os.PathLike[str], name: str = "problem") -> FilePath:
        """Writes the problem into a folder, with the files that it names, for the command. Files of other tools are written
        as what they mean. Where it is."""
        return FilePath(self._native.save(folder, name))

    def solve(
        self,
        objective: str | None = None,
        *,
        solver: str = "builtin",
        profiles: str | None = None,
        quantifiers: str | None = None,
        states: str | None = None,
        timeout: float | None = None,
        seed: int = 0,
        memory_mib: int | None = None,
        first: bool = False,
        progress: Callable[[dict[str, Any]], object] | None = None,
        every: float = _EVERY,
    ) -> Result:
        """Decides an objective: the only one, or the one that is named. Solvers are `builtin`, those that `hyperplan solvers`
        lists, those of `profiles` (TOML as in `docs/solvers.md`), or several with commas, which race. `timeout` is in
        seconds; when it is up the verdict is `unknown`. `progress` is told now and then how far it is."""
        options = _options(
            solver, profiles, quantifiers, states, timeout, seed, memory_mib, first, progress, every
        )
        return Result(self._native.solve(objective, options), self._states)

    def minimize(
        self,
        constant: str,
        objective: str | None = None,
        *,
        range: tuple[int, int] | None = None,
        solver: str = "builtin",
        profiles: str | None = None,
        timeout: float | None = None,
        progress: Callable[[dict[str, Any]], object] | None = None,
        every: float = _EVERY,
    ) -> Minimized:
        """The least value of a constant for which an objective is realizable, from the first of the range to the last."""
        options = _options(solver, profiles, timeout=timeout, progress=progress, every=every)
        value, proved, native, outcome = self._native.minimize(objective, constant, range, options)
        given = [*self._set] if value is None else [*self._set, (constant, str(value))]
        problem = Problem(native, file=self._file, constants=given, states=self._states)
        return Minimized(value, proved, problem, Result(outcome, self._states))

    def verify(
        self,
        strategy: Result | Sequence[Path] | Mapping[str, Sequence[str]] | str,
        objective: str | None = None,
        *,
        timeout: float | None = None,
    ) -> Verification:
        """Whether a strategy does what an objective asks, decided without any solver: a result, paths, the actions of each
        path by its name, or a text as the command reads it (JSON, CSV, PDDL)."""
        if isinstance(strategy, Result):
            objective = objective or strategy.objective
            witness = json.dumps({"objective": objective, "witness": [path._json() for path in strategy.paths]})
        elif isinstance(strategy, str):
            witness = strategy
        elif isinstance(strategy, Mapping):
            paths = [{"path": name, "actions": list(actions)} for name, actions in strategy.items()]
            witness = json.dumps({"objective": objective, "witness": paths})
        else:
            witness = json.dumps({"objective": objective, "witness": [path._json() for path in strategy]})
        told = self._native.verify(objective, witness, _options(timeout=timeout))
        paths_found = [Path(path, self._states) for path in told["paths"]]
        return Verification(told["verdict"], told["reason"], paths_found)

    def horizon(self, objective: str | None = None) -> dict[str, dict[str, Any]]:
        """How many steps of each path matter (`steps`, `None` where it is not read), and why (`reason`)."""
        return self._native.horizon(objective)

    def emit(
        self,
        objective: str | None = None,
        *,
        date: str | None = None,
        solver: str = "builtin",
        profiles: str | None = None,
        quantifiers: str | None = None,
        states: str | None = None,
        track: str = "single",
        status: str | None = None,
        timeout: float | None = None,
    ) -> str:
        """The query as a benchmark in SMT-LIB 2. Where its status is not given, it is found out by solving."""
        date = date or datetime.date.today().isoformat()
        options = _options(solver, profiles, timeout=timeout)
        return self._native.emit(objective, date, quantifiers, states, track, status, options)

    def explain(
        self,
        objective: str | None = None,
        *,
        strategy: Result | None = None,
        solver: str = "builtin",
        timeout: float = _REASONS,
    ) -> Explanation:
        """Why an objective is unrealizable, or a strategy fails, as `hyperplan explain` finds it, which this runs."""
        with self._on_disk() as (file, given):
            arguments = ["explain", str(file), *given, "--solver", solver, "--timeout", str(timeout)]
            if objective is None and strategy is not None:
                objective = strategy.objective
            arguments += [] if objective is None else ["--objective", objective]
            if strategy is not None:
                with tempfile.TemporaryDirectory() as folder:
                    plan = FilePath(folder) / "strategy.json"
                    plan.write_text(json.dumps(strategy.to_dict()), encoding="utf-8")
                    arguments.insert(2, str(plan))
                    text, facts = run(arguments), run([*arguments, "--format", "json"])
            else:
                text, facts = run(arguments), run([*arguments, "--format", "json"])
        return Explanation(text, json.loads(facts.splitlines()[0]))

    def compare(
        self,
        solvers: Sequence[str] = ("builtin",),
        objective: str = "all",
        *,
        timeout: float = 60.0,
        out: str | os.PathLike[str] | None = None,
    ) -> list[dict[str, Any]]:
        """Runs of solvers on the objectives, as `hyperplan compare` does them, which this runs: a record each, as in its log.
        Tables and plots are in the folder `out`, if one is given."""
        with self._on_disk() as (file, given), tempfile.TemporaryDirectory() as scratch:
            folder = FilePath(scratch) / "comparison" if out is None else FilePath(out)
            arguments = ["compare", str(file), *given, "--solver", ",".join(solvers), "--objective", objective]
            arguments += ["--timeout", str(timeout), "--out", str(folder)]
            # That a solver is wrong stands in the records.
            run(arguments, good=(*ANSWERS, 4))
            lines = (folder / "runs.jsonl").read_text(encoding="utf-8").splitlines()
        return [json.loads(line) for line in lines]

    @contextmanager
    def _on_disk(self) -> Iterator[tuple[FilePath, list[str]]]:
        """A file of the problem, with the arguments that set its constants."""
        given = [word for name, value in self._set for word in ("--set", f"{name}={value}")]
        if self._file is not None:
            yield self._file, given
            return
        with tempfile.TemporaryDirectory() as folder:
            yield self.save(folder), given

    def _repr_svg_(self) -> Optional[str]:
        try:
            return self._native.draw("svg").decode()
        except _native.HyperplanError:
            # Not all systems have a picture.
            return None

    def __repr__(self) -> str:
        where = "" if self._file is None else f" of {self._file}"
        return f"<hyperplan.Problem{where} with objectives {', '.join(self.objectives)}>"


def load(
    path: str | os.PathLike[str],
    *more: str | os.PathLike[str],
    bound: int | None = None,
    semantics: str | None = None,
    dialect: str | None = None,
) -> Problem:
    """Reads a problem file; or models and formulas of other tools, with the number of steps and the semantics with which these
    are read."""
    if more or any(said is not None for said in (bound, semantics, dialect)):
        return Problem(_native.Problem.load_foreign([path, *more], bound, semantics, dialect))
    return Problem(_native.Problem.load(path), file=FilePath(path))


def _number(value: Number) -> str:
    """As the problem language has it; a decimal number stands for the shortest fraction that reads as it."""
    return str(Fraction(repr(float(value)))) if isinstance(value, float) else str(value)


def _options(
    solver: str = "builtin",
    profiles: str | None = None,
    quantifiers: str | None = None,
    states: str | None = None,
    timeout: float | None = None,
    seed: int = 0,
    memory_mib: int | None = None,
    first: bool = False,
    progress: Callable[[dict[str, Any]], object] | None = None,
    every: float = _EVERY,
) -> _native.Options:
    return {
        "solver": solver,
        "profiles": profiles,
        "quantifiers": quantifiers,
        "states": states,
        "timeout": timeout,
        "seed": seed,
        "memory_mib": memory_mib,
        "first": first,
        "progress": progress,
        "every": every,
    }
