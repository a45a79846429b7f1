"""The objectives of the case studies among obstacles that are thrown at random: quantiles instead of single cases."""

import pathlib
import random

from bench import maps
from bench.context import Context, seconds, table
from bench.run import Run

SIZE = 40
DENSITIES = (10, 20, 30, 40)
SEEDS = 10
HEADER = ["objective", "obstacles, %", "realizable", "unrealizable", "undecided", "median", "90 %", "worst"]


def random_map(objective: str, density: int, seed: int) -> str:
    """The starts and goals of a case study, and obstacles on so many of 100 other cells."""
    draw = random.Random(f"{objective} {density} {seed}")
    starts, goals = maps.ends(objective, SIZE)

    def letter(x: int, y: int) -> str:
        blocked = draw.random() * 100 < density
        return "S" if (x, y) in starts else "G" if (x, y) in goals else "#" if blocked else "."

    rows = ("".join(letter(x, y) for x in range(SIZE)) for y in reversed(range(SIZE)))
    return "".join(row + "\n" for row in rows)


def problem(objective: str, density: int, seed: int, folder: pathlib.Path) -> pathlib.Path:
    """The case study with such a map."""
    name = f"random-{objective}-{density}-{seed}"
    text = (maps.SPECS / f"{objective}-{SIZE}.hp").read_text(encoding="utf-8")
    old = f"maps/{objective}-{SIZE}.map.txt"
    if old not in text:
        raise ValueError(f"{objective}-{SIZE}.hp no longer contains: {old}")
    (folder / f"{name}.txt").write_text(random_map(objective, density, seed), encoding="utf-8")
    file = folder / f"{name}.hp"
    file.write_text(text.replace(old, f"{name}.txt"), encoding="utf-8")
    return file


def quantile(values: list[float], part: float) -> float:
    """The least value that so large a part of all does not exceed."""
    return sorted(values)[max(0, -(-int(part * 100) * len(values) // 100) - 1)]


def scattered(context: Context) -> None:
    """Every objective at every density, one run for each seed."""
    rows: list[list[str]] = []
    for objective in context.objectives:
        for density in DENSITIES:
            done = [context.once(problem(objective, density, seed, context.folder)) for seed in range(SEEDS)]
            rows.append(row(objective, density, done))
            context.show("scattered", table(HEADER, rows))


def row(objective: str, density: int, done: list[Run]) -> list[str]:
    """A line of the table."""
    verdicts = [run.answer.get("verdict") for run in done]
    walls = [run.wall for run in done]
    counts = [verdicts.count("realizable"), verdicts.count("unrealizable")]
    counts.append(len(done) - sum(counts))
    shown = [seconds(quantile(walls, part)) for part in (0.5, 0.9, 1.0)]
    return [objective, str(density), *map(str, counts), *shown]
