#!/usr/bin/env python3
"""Plants the faults of scripts/faults.toml, one at a time, and expects the tests to catch each.

Works on a copy of the tree in target/planted-faults, which stays for the next time, and builds it there: to cargo, crates of
equal paths within their workspaces are one, and it would take one's for the other's. A fault is found by its function, so
that code may move: one that applies no more, or in two places, is an error. Ends with 1 if a fault was missed.
"""

import argparse
import os
import pathlib
import random
import re
import shlex
import shutil
import subprocess
import sys
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
COPY = ROOT / "target" / "planted-faults" / "tree"
# A test that takes longer than this hangs: that is noticed too.
PATIENCE = 300


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these")
    parser.add_argument("--sample", type=int, metavar="N", help="only N of them, at random")
    parser.add_argument("--seed", type=int, default=0, help="which N [0]")
    parser.add_argument("--patience", type=int, default=PATIENCE, metavar="SECONDS", help="what hangs [%(default)s]")
    parser.add_argument("--list", action="store_true", help="say where each applies, and plant none")
    arguments = parser.parse_args()
    table = tomllib.loads((ROOT / "scripts" / "faults.toml").read_text())
    faults = table["fault"]
    unknown = set(arguments.names) - {fault["name"] for fault in faults}
    if unknown:
        sys.exit(f"no fault is called {', '.join(sorted(unknown))}")
    sources = {path: path.read_text() for path in sorted(ROOT.glob("crates/*/src/**/*.rs"))}
    planted = {fault["name"]: plant(fault, sources) for fault in faults}
    wrong = [f"{name}: {text}" for name, text in planted.items() if isinstance(text, str)]
    if wrong:
        sys.exit("\n".join(wrong))
    if arguments.list:
        for name, (path, line, _) in planted.items():
            print(f"{name}: {path.relative_to(ROOT)}:{line}")
        return
    chosen = [fault for fault in faults if not arguments.names or fault["name"] in arguments.names]
    if arguments.sample is not None:
        chosen = random.Random(arguments.seed).sample(chosen, min(arguments.sample, len(chosen)))
    refresh()
    commands = {f["name"]: ["cargo", "test", "--quiet", *shlex.split(table["tests"][f["test"]])] for f in chosen}
    for words in {tuple(words) for words in commands.values()}:
        passed, output = run(words, arguments.patience)
        if not passed:
            sys.exit(f"{output}\nfails without any fault: {shlex.join(words)}")
        if not any(int(count) for count in re.findall(r"^running (\d+) tests?$", output, re.MULTILINE)):
            sys.exit(f"{output}\nruns no test, so that it would miss all faults: {shlex.join(words)}")
    missed = [fault["name"] for fault in chosen if not caught(fault["name"], *planted[fault["name"]], commands, arguments.patience)]
    print(f"{len(chosen) - len(missed)} of {len(chosen)} faults are caught")
    if missed:
        sys.exit(f"missed: {', '.join(missed)}")


def plant(fault: dict, sources: dict) -> tuple | str:
    """The file, the line and the file's text with the fault; or what is wrong."""
    words = fault["text"].split()
    pattern = re.compile(r"\s+".join(re.escape(word) for word in words))
    found = []
    functions = 0
    for path, text in sources.items():
        if not str(path).endswith(fault.get("file", "")):
            continue
        for start, end in bodies(text, fault["in"]):
            functions += 1
            found += [(path, text, start + match.start(), start + match.end()) for match in pattern.finditer(text[start:end])]
    if len(found) == 1:
        path, text, start, end = found[0]
        return path, text.count("\n", 0, start) + 1, text[:start] + fault["instead"] + text[end:]
    if not functions:
        return f"there is no function {fault['in']} in a file {fault.get('file', '')}: bring scripts/faults.toml up to date"
    return f"applies {len(found)} times in {fault['in']}: bring scripts/faults.toml up to date"


def bodies(text: str, name: str):
    """Where functions of that name begin and end, as rustfmt sets them."""
    for match in re.finditer(rf"^( *)(?:pub(?:\([a-z]+\))? )?fn {name}\b", text, re.MULTILINE):
        end = text.find(f"\n{match[1]}}}\n", match.start())
        yield match.start(), end if end >= 0 else len(text)


def refresh() -> None:
    """Makes the copy equal to the tree; what has not changed keeps its time, so that it is not compiled again."""
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"], cwd=ROOT,
                            check=True, stdout=subprocess.PIPE, text=True).stdout.split("\0")
    wanted = {pathlib.Path(name) for name in listed if name and (ROOT / name).is_file()}
    for path in [path for path in COPY.rglob("*") if path.is_file() and path.relative_to(COPY) not in wanted]:
        path.unlink()
        # A folder without files would still be a crate to cargo.
        for folder in path.parents:
            if folder == COPY or any(folder.iterdir()):
                break
            folder.rmdir()
    for name in wanted:
        source, target = ROOT / name, COPY / name
        if not target.exists() or target.read_bytes() != source.read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)


def run(words, patience: int, name: str = "the tree") -> tuple[bool, str]:
    """Whether a test passes, and what it says."""
    environment = {**os.environ, "CARGO_TARGET_DIR": str(COPY.parent / "build"), "RUST_BACKTRACE": "0",
                   "HYPERPLAN_SHRINK_SECONDS": "0"}
    options = {"cwd": COPY, "env": environment, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    own = words.index("--") if "--" in words else len(words)
    built = subprocess.run([*words[:own], "--no-run"], **options)
    if built.returncode != 0:
        sys.exit(f"{built.stdout}\n{name}: does not compile")
    try:
        done = subprocess.run(words, timeout=patience, **options)
    except subprocess.TimeoutExpired:
        return False, f"no end after {patience} s"
    return done.returncode == 0, done.stdout


def caught(name: str, path: pathlib.Path, line: int, text: str, commands: dict, patience: int) -> bool:
    """Whether the test fails with the fault in place."""
    target = COPY / path.relative_to(ROOT)
    sound = target.read_text()
    start = time.monotonic()
    target.write_text(text)
    try:
        passed, _ = run(commands[name], patience, name)
    finally:
        target.write_text(sound)
    print(f"{name}: {'MISSED' if passed else 'caught'}, {time.monotonic() - start:.0f} s", flush=True)
    return not passed


if __name__ == "__main__":
    main()
