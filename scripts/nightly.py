#!/usr/bin/env python3
"""Compares all solvers on all problems, in a folder named after the day, and says what has become worse since the last.

Ends with 1 if something has: an answer changed or got lost, or takes twice as long and a second more. An interrupted
night goes on where it stopped if started again on the same day. With --faults every fault of scripts/planted-faults.py is
planted after that: one that the tests miss is bad news as well. So is what scripts/fuzz.py finds, with --fuzz SECONDS.
"""

import argparse
import datetime
import json
import os
import subprocess
import sys

import compared

PROBLEMS = ["specs/rooms.hp", "specs/case-studies", "specs/pass"]
WAY = ("solver", "quantifiers", "states", "options")


def main() -> None:
    parser = compared.parser(__doc__, "nightly", 20)
    parser.add_argument("--faults", action="store_true", help="plant every fault, too")
    parser.add_argument("--fuzz", type=int, metavar="SECONDS", help="fuzz, too, for so long each target")
    parser.add_argument("--problems", nargs="+", metavar="FILE|FOLDER", help="instead of those in specs/")
    parser.add_argument("--day", default=datetime.date.today().isoformat(), help="the folder's name [today]")
    arguments, others = parser.parse_known_args()
    status = night(arguments, others)
    if arguments.faults:
        status = status or subprocess.run([compared.ROOT / "scripts" / "planted-faults.py"]).returncode
    if arguments.fuzz:
        fuzz = [compared.ROOT / "scripts" / "fuzz.py", "--seconds", str(arguments.fuzz)]
        status = status or subprocess.run(fuzz).returncode
    sys.exit(status)


def night(arguments: argparse.Namespace, others: list[str]) -> int:
    """Compares, and says what is new: 0 for nothing."""
    named = arguments.problems and [os.path.relpath(problem, compared.ROOT) for problem in arguments.problems]
    nights = arguments.out
    before = sorted(path.parent for path in nights.glob("*/runs.json") if path.parent.name < arguments.day)
    arguments.out = nights / arguments.day
    records, status = compared.compare(arguments, *(named or PROBLEMS), *others)
    findings = compared.wrong(arguments.out)
    if findings or status:
        print(f"answers are wrong: hyperplan compare ends with {status}")
    for line in findings:
        print(f"  {line}")
    if not before:
        print("nothing to compare with")
        return status
    last = before[-1]
    old, new = grouped(json.loads((last / "runs.json").read_text())), grouped(records)
    worse = list(regressions(old, new))
    both = len(old.keys() & new.keys())
    print(f"{len(worse)} of {both} runs are worse than on {last.name}; {len(new) - both} are new, {len(old) - both} gone")
    for line in worse:
        print(f"  {line}")
    return status or (1 if worse else 0)


def grouped(records: list[dict]) -> dict[str, list[dict]]:
    """The repetitions of each run."""
    groups: dict[str, list[dict]] = {}
    for record in records:
        parts = [record["instance"], *record["set"], *(record[key] for key in WAY), record["seed"] and f"seed {record['seed']}"]
        groups.setdefault(" ".join(part for part in parts if part), []).append(record)
    return groups


def regressions(old: dict[str, list[dict]], new: dict[str, list[dict]]):
    """What is worse; what is new or gone is not."""
    for key, records in new.items():
        before, now = (sorted({r["status"] for r in runs}) for runs in (old.get(key, []), records))
        times = [min((r["wall_s"] for r in runs), default=0.0) for runs in (old.get(key, []), records)]
        if not set(before) & set(compared.SOLVED):
            continue
        if now != before:
            yield f"{key}: {', '.join(before)}, now {', '.join(now)}"
        elif times[1] > 2 * times[0] and times[1] > times[0] + 1:
            yield f"{key}: {times[0]:.3f} s, now {times[1]:.3f} s"


if __name__ == "__main__":
    main()
