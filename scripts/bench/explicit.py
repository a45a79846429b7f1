"""hyperplan beside explicit searches that know only one objective each: how far a tool for any objective is from that."""

import json
import pathlib
import subprocess
import sys

from bench import maps, run
from bench.context import GRACE, Context, seconds, table
from bench.run import Run

SOURCE = pathlib.Path(__file__).with_name("reference.rs")
# At most so many times as long, by size.
TARGETS = {60: 10, 200: 20}
HEADER = ["objective", "size", "search", "hyperplan", "times", "target", "met"]
# What takes a millisecond is measured so often; the fastest run counts, as others measure the machine.
RUNS = 15


def explicit(context: Context) -> None:
    """Every objective at the sizes that have a target, as whole commands."""
    program = context.folder / "reference"
    built = subprocess.run(["rustc", "--edition", "2024", "-O", str(SOURCE), "-o", str(program)], check=False)
    if built.returncode != 0:
        context.show("explicit", "rustc did not build the reference searches.\n")
        return
    rows: list[list[str]] = []
    for size in context.sizes:
        for objective in context.objectives:
            if size in TARGETS:
                rows.append(row(context, program, objective, size))
                context.show("explicit", table(HEADER, rows))


def row(context: Context, program: pathlib.Path, objective: str, size: int) -> list[str]:
    """A line of the table."""
    file = maps.case_study(objective, size, context.folder)
    cells = maps.map_file(objective, size, context.folder)
    reference = [str(program), objective, str(cells), str(2 * size)]
    said = subprocess.run(reference, capture_output=True, text=True, check=True).stdout.strip()
    search = fastest(context, reference)
    ours = fastest(context, context.command(file))
    agrees(file, said, ours)
    target = TARGETS[size]
    ratio = ours.wall / search.wall
    met = "yes" if ratio <= target else "no"
    return [objective, f"{size} x {size}", seconds(search.wall), seconds(ours.wall), f"{ratio:.1f}", str(target), met]


def fastest(context: Context, command: list[str]) -> Run:
    """The fastest of some runs."""
    runs = [run.once(command, context.timeout + GRACE) for _ in range(RUNS)]
    return min(runs, key=lambda done: done.wall)


def agrees(file: pathlib.Path, said: str, ours: Run) -> None:
    """Both have to say whether there is a plan, and say the same."""
    verdict = "unrealizable" if said == "unrealizable" else "realizable"
    if ours.answer.get("verdict") != verdict:
        sys.exit(f"{file}: the search says {verdict}, hyperplan {json.dumps(ours.answer)}")
