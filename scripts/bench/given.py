"""Problems that somebody has: every problem file of a folder, solved once with the choices left to hyperplan."""

import json
import pathlib

from bench.context import Context, megabytes, seconds, table

HEADER = ["file", "objective", "answer", "by", "total", "MB"]


def given(context: Context) -> None:
    """A line for each objective of each file."""
    if context.problems is None:
        context.show("given", "No folder was given (`--problems DIR`).\n")
        return
    rows: list[list[str]] = []
    for file in sorted(context.problems.glob("*.hp")):
        rows += lines(context, file)
        context.show("given", table(HEADER, rows))


def lines(context: Context, file: pathlib.Path) -> list[list[str]]:
    """The answers for one file; the memory is that of the whole command."""
    done = context.once(file, "--objective", "all")
    memory = megabytes(done.memory, context.floor)
    answers = [json.loads(line) for line in done.output.splitlines() if line.startswith("{")]
    if not answers:
        return [[file.name, "-", (done.problem or "no answer").replace(str(file), file.name), "-", seconds(done.wall), memory]]
    return [
        [
            file.name,
            answer["objective"],
            answer["reason"] if answer["verdict"] == "unknown" else answer["verdict"],
            answer["quantifiers"],
            seconds(answer["seconds"]["total"]),
            memory,
        ]
        for answer in answers
    ]
