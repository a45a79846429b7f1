"""What the scripts around `hyperplan compare` share."""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOLVED = ("sat", "unsat")


def parser(description: str | None, out: str, timeout: int) -> argparse.ArgumentParser:
    """The options of all scripts. Others go to `hyperplan compare` as they are: `--jobs 2 --memory 4096`."""
    built = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"), "release", "hyperplan")
    wanted = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False,
        epilog="All other options are those of hyperplan compare: --solver z3,cvc5 --jobs 2 --repeat 3 ...",
    )
    add = wanted.add_argument
    add("--hyperplan", default=str(built), metavar="PROGRAM", help="the program [%(default)s]")
    add("--out", type=pathlib.Path, default=pathlib.Path(out), metavar="DIR", help="log and reports [%(default)s]")
    add("--timeout", type=float, default=timeout, metavar="SECONDS", help="of each run [%(default)s]")
    return wanted


def compare(arguments: argparse.Namespace, *options: str) -> tuple[list[dict], int]:
    """Compares, or goes on where it was interrupted. The records, and the exit status: 4 and 5 say that answers are wrong."""
    # From the root, so that problems have the same names wherever this is started.
    program = arguments.hyperplan
    command = [str(pathlib.Path(program).resolve()) if os.sep in program else program, "compare", *options]
    command += ["--timeout", f"{arguments.timeout:g}", "--out", str(arguments.out.resolve())]
    # The tables are on standard output, where the script's own is to come.
    try:
        process = subprocess.Popen(command, stdout=sys.stderr, cwd=ROOT)
    except OSError as error:
        build = "build it with cargo build --release -p hyperplan, or name it: --hyperplan FILE"
        print(f"cannot run {program}: {error.strerror}; {build}", file=sys.stderr)
        # As hyperplan does where the usage is bad: 1 says that something has become worse.
        sys.exit(2)
    status = ended(process)
    runs = arguments.out / "runs.json"
    if status not in (0, 4, 5) or not runs.is_file():
        sys.exit(status or 1)
    return json.loads(runs.read_text()), status


def ended(process: subprocess.Popen) -> int:
    """How it ended. Ctrl-C goes to both; the program says what is done and what to do, and this ends with it."""
    try:
        return process.wait()
    except KeyboardInterrupt:
        try:
            process.wait()
        except KeyboardInterrupt:
            process.kill()
        sys.exit(130)


def wrong(out: pathlib.Path) -> list[str]:
    """What the last report in the folder finds wrong with answers, a line each."""
    scores = out / "scores.json"
    findings = json.loads(scores.read_text())["judgement"]["findings"] if scores.is_file() else []
    lines = []
    for finding in findings:
        said = [f"{claim['who']} {claim['answer'] or claim['message'] or ''}".strip() for claim in finding["claims"]]
        known = f" (known: {finding['truth']})" if finding["truth"] else ""
        lines.append(f"{finding['instance']}: {finding['kind']}: {'; '.join(said)}{known}")
    return lines


def result(records: list[dict]) -> str:
    """The median time of some runs, or what happened to them, as in the tables of hyperplan."""
    solved = sorted(record["wall_s"] for record in records if record["status"] in SOLVED)
    if len(solved) * 2 <= len(records):
        return next((record["status"] for record in records if record["status"] not in SOLVED), "")
    return f"{statistics.median_high(solved):.3f}"


def table(head: list[str], rows: list[list[str]]) -> None:
    """Prints Markdown: the first column to the left, the others to the right."""
    rule = ["---"] + ["---:"] * (len(head) - 1)
    for row in [head, rule, *rows]:
        print(f"| {' | '.join(row)} |")
