#!/usr/bin/env python3
"""What talking to a solver costs: the time that hyperplan waits for solvers, over the time that the same solver takes
when it is run by hand on the same queries.

Solves problems of specs/ with --queries, reads how long hyperplan waited, and runs the solver on the files kept. Each
is done several times, and the least time counts. The target is a ratio of at most 1.1 over all queries together.

usage: cost-of-talking.py path/to/hyperplan [--solver z3 --solver yices] [--queries 20] [--repeat 5]
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

SPECS = pathlib.Path(__file__).resolve().parent.parent / "specs"
BY_HAND = {
    "z3": ["z3", "-in"],
    "yices": ["yices-smt2", "--incremental"],
    "cvc5": ["cvc5", "--lang=smt2", "--incremental", "--produce-models"],
}
PROBLEMS = [
    ("case-studies/sp-10.hp", "sp"),
    ("case-studies/isr-10.hp", "isr"),
    ("case-studies/ar-10.hp", "ar"),
    ("case-studies/iso-10.hp", "iso"),
    ("case-studies/cso-10.hp", "cso"),
    ("case-studies/sp-20.hp", "sp"),
    ("case-studies/iso-20.hp", "iso"),
    ("rooms.hp", "sp"),
    ("rooms.hp", "isr"),
    ("rooms.hp", "ar"),
    ("rooms.hp", "iso"),
    ("rooms.hp", "cso"),
]
WAYS = [["--quantifiers", "auto"], ["--quantifiers", "expand"], ["--quantifiers", "cegis"], ["--states", "bitvec"]]


def solve(hyperplan, problem, objective, way, solver, queries):
    """How long hyperplan waited for solvers; None if there is no answer."""
    command = [hyperplan, "solve", SPECS / problem, "--objective", objective, "--solver", solver]
    command += ["--queries", queries, "--format", "json", "--timeout", "60"] + way
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode not in (0, 1):
        return None
    return json.loads(run.stdout)["seconds"]["solve"]


def by_hand(solver, query):
    """How long the solver takes for a query."""
    with open(query, "rb") as text:
        start = time.perf_counter()
        subprocess.run(BY_HAND[solver], stdin=text, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return time.perf_counter() - start


def measure(arguments, solver):
    """Pairs of times for problems, until there are enough queries."""
    ours, alone, queries = 0.0, 0.0, 0
    for way in WAYS:
        for problem, objective in PROBLEMS:
            if queries >= arguments.queries:
                break
            waited, taken = [], []
            for _ in range(arguments.repeat):
                # In turn, so that a busy moment of the machine is unfair to both.
                with tempfile.TemporaryDirectory(prefix="cost-of-talking-") as folder:
                    waited.append(solve(arguments.hyperplan, problem, objective, way, solver, folder))
                    files = sorted(pathlib.Path(folder).glob("*.smt2"))
                    taken.append([by_hand(solver, file) for file in files])
                if waited[-1] is None:
                    break
            if files and None not in waited:
                alone_here = sum(min(times) for times in zip(*taken))
                ours, alone, queries = ours + min(waited), alone + alone_here, queries + len(files)
                what = f"{problem} {objective} {' '.join(way)}"
                print(f"{solver:6} {len(files):3} {min(waited):8.3f} s {alone_here:8.3f} s  {what}")
    return ours, alone, queries


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hyperplan", type=pathlib.Path)
    parser.add_argument("--solver", action="append", choices=sorted(BY_HAND))
    parser.add_argument("--queries", type=int, default=20)
    parser.add_argument("--repeat", type=int, default=5)
    arguments = parser.parse_args()
    missed = False
    print("solver  n  hyperplan     by hand  problem")
    for solver in arguments.solver or ["z3", "yices"]:
        ours, alone, queries = measure(arguments, solver)
        ratio = ours / alone if alone else 0
        missed |= ratio > 1.1
        print(f"{solver}: {queries} queries, {ours:.3f} s, by hand {alone:.3f} s, ratio {ratio:.3f}")
    sys.exit(missed)


if __name__ == "__main__":
    main()
