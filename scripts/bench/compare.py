"""Ratios, each of two measurements of the same run of the script."""

import itertools
import pathlib
import shutil
from typing import NamedTuple

from bench import maps, run
from bench.context import Context, seconds, table, times, verdict
from bench.run import Run

LEAST_SIZE = 40
# Objectives with a change of quantifier; the others are a single query in every mode.
ALTERNATING = ("sp", "isr", "ar")


def ended(done: Run) -> float | None:
    """The wall time of a run with an answer."""
    return done.wall if done.problem is None else None


def least(context: Context) -> None:
    """The search for the least T against the single solve at that T, and the proof for one less."""
    size = min(LEAST_SIZE, max(context.sizes))
    header = ["objective", "size", "least T", "--minimize T", "at the least T", "ratio (target 3)"]
    header += ["one below", "answer", "ratio (target 3)"]
    rows = []
    for objective in context.objectives:
        file = maps.case_study(objective, size, context.folder)
        search = context.solve(file, "--minimize", "T")
        found = (search.answer.get("minimized") or {}).get("value")
        cells = [objective, f"{size} x {size}"]
        if search.problem is not None or found is None:
            rows.append(cells + ["-", verdict(search)] + ["-"] * 5)
        else:
            at, below = (context.solve(file, "--set", f"T={t}") for t in (found, found - 1))
            cells += [str(found), seconds(search.wall), shown(at), times(search.wall, ended(at), 3)]
            rows.append(cells + [shown(below), verdict(below), times(ended(below), ended(at), 3)])
        context.show("least", table(header, rows))


def shown(done: Run) -> str:
    """The time, or why there is none."""
    return seconds(done.wall) if done.problem is None else done.problem


def quantifiers(context: Context) -> None:
    """Formula (16) as printed against `auto`, for each solver."""
    header = ["objective", "size", "solver", "keep", "auto", "keep / auto"]
    rows = []
    for size in context.formula_sizes:
        for objective in (name for name in ALTERNATING if name in context.objectives):
            file = maps.case_study(objective, size, context.folder)
            for solver in context.solvers:
                keep, auto = (context.solve(file, "--solver", solver, "--quantifiers", how) for how in ("keep", "auto"))
                ratio = times(ended(keep), ended(auto))
                if keep.status in (None, 3) and ended(auto):
                    ratio = f"> {context.timeout / auto.wall:.0f}"
                rows.append([objective, f"{size} x {size}", solver, shown(keep), shown(auto), ratio])
                context.show("quantifiers", table(header, rows))


BY_HAND = {"z3": ["z3"], "yices": ["yices-smt2", "--incremental"], "cvc5": ["cvc5", "--incremental"]}


def external(context: Context) -> None:
    """The time spent waiting for a solver against that of the solver alone on the files of the same queries."""
    header = ["objective", "size", "quantifiers", "solver", "queries", "waiting for it", "on the files"]
    header.append("ratio (target 1.1)")
    rows: list[list[str]] = []
    for solver in (name for name in context.solvers if name in BY_HAND):
        talks: list[Talk] = []
        sizes = [n for n in context.sizes if n <= 20]
        for size, objective, how in itertools.product(sizes, context.objectives, ("auto", "expand")):
            file = maps.case_study(objective, size, context.folder)
            done, talk = talked(context, file, "--solver", solver, "--quantifiers", how)
            cells = [objective, f"{size} x {size}", how, solver, str(talk.queries)]
            cells += [seconds(talk.waited) if talk.waited else shown(done), seconds(talk.alone)]
            rows.append([*cells, times(talk.waited, talk.alone, 1.1)])
            talks.append(talk)
            context.show("external", table(header, rows))
        rows.append(["all", "", "", solver, *together(talks)])
        context.show("external", table(header, rows))


class Talk(NamedTuple):
    """So many queries, the time spent waiting for their answers, and that of the solver alone."""

    queries: int
    waited: float | None
    alone: float | None


def talked(context: Context, file: pathlib.Path, *options: str) -> tuple[Run, Talk]:
    """A run, and what talking cost."""
    folder = context.folder / "queries"
    # One run, whose queries are kept; those timed keep none.
    run.once(context.command(file, *options, "--queries", str(folder)), context.timeout)
    files = sorted(folder.glob("*.smt2")) if folder.is_dir() else []
    done = context.solve(file, *options)
    by_hand = BY_HAND[options[1]]
    alone = [run.wall([*by_hand, str(query)], context.runs, context.timeout) for query in files]
    shutil.rmtree(folder, ignore_errors=True)
    waited = (done.answer.get("seconds") or {}).get("solve") if done.problem is None else None
    known = [time for time in alone if time is not None]
    return done, Talk(len(files), waited, sum(known) if files and len(known) == len(files) else None)


def together(talks: list[Talk]) -> list[str]:
    """All queries of a solver at once, where both times are known."""
    both = [talk for talk in talks if talk.waited is not None and talk.alone is not None]
    waited, alone = (sum(getattr(talk, name) for talk in both) for name in ("waited", "alone"))
    return [str(sum(talk.queries for talk in both)), seconds(waited), seconds(alone), times(waited, alone, 1.1)]
