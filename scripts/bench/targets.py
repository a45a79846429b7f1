"""The table of targets: the case studies, the large map, and how time grows."""

import dataclasses
import pathlib
import sys

from bench import chart, maps
from bench.context import Context, count, megabytes, seconds, table, verdict
from bench.run import Run

# Seconds and bytes by size.
TARGETS = {10: (0.05, None), 20: (0.05, None), 40: (0.3, None), 60: (1.0, 500e6), 100: (5.0, None), 200: (60.0, None)}
LARGE = (10.0, 4e9)
# Below, the time to start the command and to verify hides how the rest grows.
FITTED_FROM = 40

STAGES = ("read", "encode", "solve", "verify", "total")
HEADER = ["objective", "size", "T", "answer", "variables", "clauses", "rounds", *STAGES, "wall", "MB", "target", "met"]


@dataclasses.dataclass(frozen=True)
class Goal:
    """What a run may take."""

    seconds: float | None
    memory: float | None = None

    def text(self) -> str:
        """As it stands in the table."""
        parts = [f"{self.seconds:g} s"] if self.seconds else []
        parts += [f"{self.memory / 1e6:.0f} MB"] if self.memory else []
        return ", ".join(parts) or "-"

    def met(self, done: Run) -> str:
        """Whether the run kept to it and gave a verified strategy."""
        if self.seconds is None:
            return "-"
        if done.answer.get("verdict") != "realizable" or not done.answer.get("verified"):
            return "no"
        fits = done.wall <= self.seconds and (self.memory is None or done.memory <= self.memory)
        return "yes" if fits else "no"


def row(name: str, size: str, horizon: int, done: Run, goal: Goal, floor: int) -> list[str]:
    """A line of the table."""
    answer = done.answer
    queries = answer.get("size") or {}
    stages = answer.get("seconds") or {}
    return [
        name,
        size,
        str(horizon),
        verdict(done),
        count(queries.get("variables")),
        count(queries.get("clauses")),
        count(answer.get("iterations")),
        *(seconds(stages.get(stage)) for stage in STAGES),
        seconds(done.wall),
        megabytes(done.memory, floor),
        goal.text(),
        goal.met(done),
    ]


def targets(context: Context) -> None:
    """Every objective at every size."""
    rows: list[list[str]] = []
    for size in context.sizes:
        goal = Goal(*TARGETS.get(size, (None, None)))
        for objective in context.objectives:
            file = maps.case_study(objective, size, context.folder)
            done = context.solve(file)
            context.solved[objective, size] = done
            rows.append(row(objective, f"{size} x {size}", 2 * size, done, goal, context.floor))
            context.show("targets", table(HEADER, rows))


def large(context: Context) -> None:
    """The shortest path on maps of 512 x 512 cells: a generated one, and a real one if there is one."""
    given: list[tuple[str, list[str]]] = [("rooms, generated", maps.rooms(512))]
    missing = ""
    if context.map is None:
        missing = "\nNo real map was given (`--map FILE.map`).\n"
    else:
        try:
            given.append((context.map.name, maps.read_map(context.map)))
        except (OSError, ValueError) as error:
            why = error.strerror if isinstance(error, OSError) else error
            missing = f"\n{context.map.name} was skipped: {why}.\n"
            print(missing.strip(), file=sys.stderr)
    rows = []
    for number, (name, cells) in enumerate(given):
        folder = context.folder / f"large-{number}"
        folder.mkdir()
        file, least, horizon = maps.large(cells, folder)
        done = context.solve(file)
        size = f"{len(cells[0])} x {len(cells)}, least {least}"
        rows.append(row(name, size, horizon, done, Goal(*LARGE), context.floor))
        context.show("large", table(["map", *HEADER[1:]], rows) + missing)


def growth(context: Context, picture: pathlib.Path) -> None:
    """Time against free cells x T, for the runs of the table that came to an end."""
    every, notes = [], []
    for objective in context.objectives:
        points = []
        for size in context.sizes:
            done = context.solved.get((objective, size))
            if done is not None and done.problem is None:
                points.append((size, float(work(context, objective, size)), done.wall))
        if len(points) < 2:
            notes.append(f"- `{objective}`: fewer than two sizes came to an end")
            continue
        every.append(chart.Series(objective, [(cells, wall) for _, cells, wall in points]))
        notes.append(f"- `{objective}`: {fit(points)}")
    if every:
        labels = "free cells x T", "wall time of the command, in seconds"
        picture.write_text(chart.draw("Growth of the case studies", labels, every), encoding="utf-8")
    shown = f"![time against free cells x T, log-log]({picture.name})\n\n" if every else ""
    context.show("growth", shown + "\n".join(notes) + "\n")


def fit(points: list[tuple[int, float, float]]) -> str:
    """The exponent of growth, in words."""
    used = [point for point in points if point[0] >= FITTED_FROM]
    if len(used) < 2:
        used = points
    exponent = chart.slope([(cells, wall) for _, cells, wall in used])
    return f"(free cells x T)^{exponent:.2f} from {used[0][0]} x {used[0][0]} to {used[-1][0]} x {used[-1][0]}"


def work(context: Context, objective: str, size: int) -> int:
    """Cells that are no obstacles, times the horizon."""
    maps.case_study(objective, size, context.folder)
    text = maps.map_file(objective, size, context.folder).read_text(encoding="utf-8")
    return sum(text.count(letter) for letter in ".SG") * 2 * size
