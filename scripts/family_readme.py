#!/usr/bin/env python3
"""Writes the README of a family of benchmarks from the manifest of its selection.

    scripts/family_readme.py MANIFEST

Everything that it says of difficulty comes from the manifest, which has it from the log of the runs.
"""

import collections
import json
import pathlib
import sys

# What each objective is about, in a line.
SOURCES = {
    "sp": "a path that no other is faster than",
    "isr": "one plan for two starts",
    "isrs": "one plan for several starts",
    "ar": "a plan that copes with one faulty action",
    "ar2": "a plan that copes with two faulty actions",
    "ars": "a plan that copes with faults that do not follow each other",
    "iso": "a path whose start cannot be told by its observer",
    "cso": "a path that looks like another",
    "cso3": "a path that looks like two others",
    "drift": "conformant planning while the robot drifts",
    "alibi": "for every suspected way another that looks the same: exists, forall, exists",
    "locks": "counters that one sequence brings to their goal from two starts",
    "roads": "a roadmap with lengths and a budget, and two ways that look alike",
}


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        manifest = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
        print(readme(manifest), end="")
    except (OSError, ValueError, KeyError, TypeError) as error:
        print(f"{sys.argv[1]}: not the manifest of a selection: {error!r}", file=sys.stderr)
        return 2
    return 0


def readme(manifest: dict) -> str:
    """The whole text."""
    benchmarks = manifest["benchmarks"]
    solvers = ", ".join(f"{name} {version}" for name, version in manifest["solvers"].items())
    statuses = collections.Counter(entry["status"] for entry in benchmarks)
    lines = [
        f"# {manifest['family']}",
        "",
        f"{len(benchmarks)} benchmarks ({statuses['sat']} sat, {statuses['unsat']} unsat), generated on",
        f"{manifest['date']} by {manifest['generator']}: robot motion planning from hyperproperties, after Y. Wang, S. Nalluri,",
        "M. Pajic, *Hyperproperties for Robotics: Planning via HyperLTL*, ICRA 2020. Each asks whether there are paths of so",
        "many steps that satisfy an objective over several paths; `problems/` has what each was generated from.",
        "",
        "## Where they come from",
        "",
        *sources(benchmarks),
        "",
        "## How hard they are",
        "",
        f"Measured with {solvers},",
        f"with a limit of {number(manifest['limit_s'])} s of wall time for each run. A benchmark is as hard as it is for the",
        "slowest solver that takes it; one that a solver leaves unsolved is over the limit.",
        "",
        *difficulty(benchmarks, manifest["easy_s"], manifest["limit_s"]),
        "",
        *shares(benchmarks, manifest["easy_s"], manifest["limit_s"]),
        *remarks(benchmarks),
        "",
        "## Licence",
        "",
        "CC BY 4.0, as the header of each file says.",
    ]
    return "\n".join(lines) + "\n"


def number(value: float) -> str:
    """A number without needless digits."""
    return f"{value:g}"


def table(head: list[str], rows: list[list[str]], words: int) -> list[str]:
    """A table, of which so many columns are words and the others numbers."""
    rule = ["---"] * words + ["---:"] * (len(head) - words)
    return ["| " + " | ".join(row) + " |" for row in [head, rule, *rows]]


def sources(benchmarks: list[dict]) -> list[str]:
    """How many there are of each objective and kind of map."""
    counts = collections.Counter((entry["objective"], entry.get("map", "random")) for entry in benchmarks)
    own = ("locks", "roads")
    rows = [[objective, "-" if objective in own else kind, SOURCES.get(objective, ""), str(count)]
            for (objective, kind), count in sorted(counts.items())]
    return table(["objective", "maps", "what it asks for", "benchmarks"], rows, 3)


def difficulty(benchmarks: list[dict], easy: float, limit: float) -> list[str]:
    """How many there are of each logic and status, by bins of difficulty."""
    bins = sorted({entry["bin"] for entry in benchmarks}, key=lambda name: order(name, easy, limit))
    rows = []
    for logic, status in sorted({(entry["logic"], entry["status"]) for entry in benchmarks}):
        those = [entry for entry in benchmarks if (entry["logic"], entry["status"]) == (logic, status)]
        counts = collections.Counter(entry["bin"] for entry in those)
        rows.append([logic, status, *(str(counts[name]) for name in bins), str(len(those))])
    counts = collections.Counter(entry["bin"] for entry in benchmarks)
    rows.append(["all", "", *(str(counts[name]) for name in bins), str(len(benchmarks))])
    return table(["logic", "status", *bins, "all"], rows, 2)


def order(name: str, easy: float, limit: float) -> float:
    """Where a bin stands among the others."""
    if name.startswith("under"):
        return 0.0
    return limit if name.startswith("over") else max(float(name.split()[0]), easy)


def is_hard(entry: dict, seconds: float) -> bool:
    """Whether a solver that takes it is at it for longer; one that gives up at once is not."""
    return any(run["outcome"] in ("solved", "unsolved") and run["seconds"] > seconds for run in entry["runs"].values())


def is_easy(entry: dict) -> bool:
    """Whether all solvers that take it do it at once."""
    return entry["bin"].startswith("under")


def shares(benchmarks: list[dict], easy: float, limit: float) -> list[str]:
    """What competitions ask: how many are hard for somebody, and easy for all."""
    hard = sum(1 for entry in benchmarks if is_hard(entry, min(limit, 20.0)))
    simple = sum(1 for entry in benchmarks if is_easy(entry))
    lines = [f"{hard} of {len(benchmarks)} take one of the solvers over {number(min(limit, 20.0))} s; {simple} are done by all "
             f"within {number(easy)} s."]
    both = collections.defaultdict(set)
    for entry in benchmarks:
        both[entry["logic"]].add(entry["status"])
    lone = sorted(logic for logic, statuses in both.items() if len(statuses) < 2)
    lines.append(f"Only one status has {', '.join(lone)}." if lone else "Every logic has both statuses.")
    return lines


def remarks(benchmarks: list[dict]) -> list[str]:
    """What solvers did wrong."""
    counts = collections.Counter((solver, run["outcome"]) for entry in benchmarks for solver, run in entry["runs"].items())
    words = {"wrong": "are answered wrongly", "error": "end with an error", "unsupported": "are not taken"}
    said = [f"{count} {words[outcome]} by {solver}" for (solver, outcome), count in sorted(counts.items()) if outcome in words]
    return ["", "Of these runs " + ", ".join(said) + "; headers say of which files."] if said else []


if __name__ == "__main__":
    sys.exit(main())
