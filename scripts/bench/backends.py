"""The SAT solvers that are built in against each other."""

import json
import pathlib
from typing import NamedTuple

from bench import run
from bench.context import GRACE, Context, seconds, table, times

SPECS = pathlib.Path(__file__).resolve().parents[2] / "specs"
NAMES = ("cadical", "batsat")
WAYS = {"auto": [], "cegis": ["--quantifiers", "cegis"], "bit-vectors": ["--states", "bitvec"]}
# What takes less with each of them is told in one row.
LEAST = 0.1


class Answers(NamedTuple):
    """The time spent waiting for a SAT solver, and how many objectives were decided or not."""

    waited: float
    decided: int
    undecided: int

    def shown(self) -> str:
        """As it stands in a table."""
        time = seconds(self.waited)
        return f"> {time}, {self.undecided} undecided" if self.undecided else time


NONE = Answers(0.0, 0, 0)


def together(*parts: Answers) -> Answers:
    """Several answers as one."""
    return Answers(*(sum(values) for values in zip(*parts, strict=True)))


def backends(context: Context) -> None:
    """All objectives of all good files, in several ways, by each SAT solver."""
    header = ["file", "asked", *NAMES, "batsat / cadical"]
    rows: list[list[str]] = []
    rest, total = [NONE] * len(NAMES), [NONE] * len(NAMES)
    files = [file for file in sorted(SPECS.rglob("*.hp")) if "fail" not in file.parts]
    for way, options in WAYS.items():
        for file in files:
            both = [asked(context, file, name, *options) for name in NAMES]
            if not all(answers.decided + answers.undecided for answers in both):
                continue
            total = [together(*pair) for pair in zip(total, both, strict=True)]
            if max(answers.waited for answers in both) < LEAST:
                rest = [together(*pair) for pair in zip(rest, both, strict=True)]
            else:
                rows.append(row(str(file.relative_to(SPECS)), way, both))
            decided = " and ".join(str(answers.decided) for answers in total)
            sums = [row("all others", "", rest), row(f"all; {decided} decided", "", total)]
            context.show("backends", table(header, rows + sums))


def row(name: str, way: str, both: list[Answers]) -> list[str]:
    """A row of the table."""
    cadical, batsat = both
    ratio = "-" if cadical.undecided or batsat.undecided else times(batsat.waited, cadical.waited)
    return [name, way, cadical.shown(), batsat.shown(), ratio]


def asked(context: Context, file: pathlib.Path, name: str, *options: str) -> Answers:
    """What a file comes to; nothing where it is beyond both of them."""
    line = context.command(file, "--objective", "all", "--solver", name, *options)
    done = run.once(line, context.timeout + GRACE)
    answers = [json.loads(line) for line in done.output.splitlines()] if done.status in (0, 1, 3) else []
    undecided = sum(answer["verdict"] == "unknown" for answer in answers)
    return Answers(sum(answer["seconds"]["solve"] for answer in answers), len(answers) - undecided, undecided)
