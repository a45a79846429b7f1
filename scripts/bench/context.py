"""What all measurements share, and how they write numbers."""

import dataclasses
import pathlib
from collections.abc import Callable, Iterable

from bench import run
from bench.run import Run

# Time beyond the command's own limit before it is killed.
GRACE = 10.0


@dataclasses.dataclass
class Context:
    """How to measure, and what has been measured."""

    binary: str
    folder: pathlib.Path
    sizes: list[int]
    objectives: list[str]
    solvers: list[str]
    formula_sizes: list[int]
    runs: int
    timeout: float
    map: pathlib.Path | None
    problems: pathlib.Path | None
    # Less memory than this cannot be seen.
    floor: int
    # The text of each section, rewritten as it grows.
    sections: dict[str, str] = dataclasses.field(default_factory=dict)
    publish: Callable[[], None] = lambda: None
    # The objectives solved, by objective and size.
    solved: dict[tuple[str, int], Run] = dataclasses.field(default_factory=dict)

    def command(self, file: pathlib.Path, *options: str) -> list[str]:
        """The command that solves a file and prints JSON."""
        limit = ["--timeout", f"{self.timeout:g}"]
        return [self.binary, "solve", str(file), "--format", "json", *limit, *options]

    def solve(self, file: pathlib.Path, *options: str) -> Run:
        """The median run of that command."""
        return run.median(self.command(file, *options), self.runs, self.timeout + GRACE)

    def once(self, file: pathlib.Path, *options: str) -> Run:
        """One run of that command."""
        return run.once(self.command(file, *options), self.timeout + GRACE)

    def show(self, section: str, text: str) -> None:
        """Makes what is known of a section part of the page."""
        self.sections[section] = text
        self.publish()


def table(header: list[str], rows: Iterable[list[str]]) -> str:
    """A Markdown table, its first column to the left."""
    lines = [header, ["---"] + ["---:"] * (len(header) - 1), *rows]
    return "".join("| " + " | ".join(cells) + " |\n" for cells in lines)


def seconds(value: float | None) -> str:
    """A time with as many digits as mean something."""
    if value is None:
        return "-"
    return f"{value:.3f}" if value < 10 else f"{value:.1f}"


def count(value: object) -> str:
    """A number with its thousands apart."""
    return f"{value:,}".replace(",", " ") if isinstance(value, int) else "-"


def megabytes(value: int, floor: int) -> str:
    """An amount of memory; what is not above the floor is not known better than that."""
    return f"{value / 1e6:.0f}" if value > 1.1 * floor else f"< {max(value, floor) / 1e6:.0f}"


def verdict(done: Run) -> str:
    """What came of a run, in a word or a few."""
    return done.problem or str(done.answer.get("verdict", "no answer"))


def times(over: float | None, under: float | None, target: float | None = None) -> str:
    """A ratio; with a target, whether it is met."""
    if over is None or not under:
        return "-"
    ratio = f"{over / under:.2f}"
    if target is None:
        return ratio
    return f"{ratio}, {'met' if over <= target * under else 'missed'}"
