"""Ratios, each of two measurements of the same run of the script."""

import shutil

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


def external(context: Context) -> None:
    """The time spent waiting for a solver against that of the solver alone on the files of the same queries."""
    header = ["objective", "size", "solver", "queries", "waiting for it", "on the files", "ratio (target 1.1)"]
    rows = []
    commands = {"z3": ["z3"], "yices": ["yices-smt2", "--incremental"], "cvc5": ["cvc5", "--incremental"]}
    for size in (n for n in context.sizes if n <= 20):
        for objective in context.objectives:
            file = maps.case_study(objective, size, context.folder)
            for solver in (name for name in context.solvers if name in commands):
                folder = context.folder / f"queries-{objective}-{size}-{solver}"
                # One run, whose queries are kept; those timed keep none.
                run.once(context.command(file, "--solver", solver, "--queries", str(folder)), context.timeout)
                files = sorted(folder.glob("*.smt2")) if folder.is_dir() else []
                done = context.solve(file, "--solver", solver)
                alone = [run.wall([*commands[solver], str(query)], context.runs, context.timeout) for query in files]
                total = sum(time for time in alone if time is not None)
                waited = (done.answer.get("seconds") or {}).get("solve") if done.problem is None else None
                fair = None if not files or None in alone else total
                cells = [objective, f"{size} x {size}", solver, str(len(files))]
                cells += [seconds(waited) if waited else shown(done), seconds(fair), times(waited, fair, 1.1)]
                rows.append(cells)
                context.show("external", table(header, rows))
                shutil.rmtree(folder, ignore_errors=True)
