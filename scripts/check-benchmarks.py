#!/usr/bin/env python3
"""Checks .smt2 files by the rules of the SMT-LIB benchmark library and of SMT-COMP.

Of a folder all .smt2 files are checked, and that they are where a submission has them; of all files together, that no
two are alike. Exit status: 0 if all rules are followed, 1 if not, 2 for bad usage. Needs nothing but Python 3.11;
--external also has z3, cvc5 and pySMT read the files, as far as they are installed.
"""

import argparse
import concurrent.futures
import functools
import hashlib
import os
import pathlib
import sys

from benchmarks import external, layout, rules
from benchmarks.rules import Finding


def main() -> int:
    arguments = parsed()
    if arguments.rules:
        for rule, text in rules.RULES.items():
            print(f"{rule:18} {text}")
        return 0
    without = external.missing() if arguments.external else ["z3", "cvc5", "pysmt"]
    if arguments.external and without:
        print(f"not installed: {', '.join(without)}", file=sys.stderr)
        if arguments.require:
            return 2
    # Each file once, also where it is named and in a folder that is.
    files = {str(file): root for path in arguments.paths for file, root in found(path)}
    check = functools.partial(checked, track=arguments.track, without=without)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(check, files.keys(), files.values()))
    findings = [finding for result in results for finding in result[0]]
    findings += layout.duplicates({file: sha256 for file, (_, sha256) in zip(files, results) if sha256})
    for finding in sorted(findings):
        print(finding)
    wrong = len({finding.file for finding in findings})
    print(f"{len(files)} files, {wrong} of them with findings", file=sys.stderr)
    return 1 if findings else 0


def parsed() -> argparse.Namespace:
    """The arguments."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="*", type=pathlib.Path, metavar="FILE|DIR")
    parser.add_argument("--track", choices=("auto", *rules.TRACKS), default="auto",
                        help="the track; by default what the options, the number of checks, or the folder say")
    parser.add_argument("--external", action="store_true", help="have z3, cvc5 and pySMT read the files too")
    parser.add_argument("--require", action="store_true", help="with --external: fail where one of them is missing")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="how many files at a time")
    parser.add_argument("--rules", action="store_true", help="list the rules")
    arguments = parser.parse_args()
    if not arguments.paths and not arguments.rules:
        parser.error("expected files or folders")
    for path in arguments.paths:
        if not path.exists():
            parser.error(f"there is no {path}")
    return arguments


def found(path: pathlib.Path) -> list[tuple[pathlib.Path, pathlib.Path | None]]:
    """The files that are meant, each with the folder of its submission."""
    if not path.is_dir():
        return [(path, None)]
    return [(file, path) for file in sorted(path.rglob("*.smt2")) if file.is_file()]


def checked(file: str, root: pathlib.Path | None, track: str, without: list[str]) -> tuple[list[Finding], str]:
    """What is wrong with a file, and its hash."""
    path = pathlib.Path(file)
    inner = path.relative_to(root) if root else None
    if inner and track == "auto":
        track = layout.track(inner)
    size = path.stat().st_size
    if size > rules.MOST_BYTES:
        return [Finding(file, 1, "size", f"{size} bytes, more than {rules.MOST_BYTES}")], ""
    text = path.read_bytes()
    result = rules.checked(file, text, track)
    findings = result.findings
    wrong = layout.misplaced(inner, result) if inner else None
    if wrong:
        findings.append(Finding(file, 1, "layout", wrong))
    for reading in external.read(file, result.logic, without):
        if reading.message:
            findings.append(Finding(file, 1, reading.program, reading.message))
    return findings, hashlib.sha256(text).hexdigest()


if __name__ == "__main__":
    sys.exit(main())
