#!/usr/bin/env python3
"""Runs the fuzz targets under libFuzzer, each for a given time, and makes their corpora small afterwards.

Takes cargo-fuzz (cargo install cargo-fuzz), a C++ compiler, and any compiler of Rust: what is unstable is allowed by
RUSTC_BOOTSTRAP=1. What is found on the way goes to fuzz/corpus, where the next run begins, and what fails to fuzz/artifacts.
Ends with 1 if something fails.
"""

import argparse
import os
import pathlib
import shlex
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FUZZ = ROOT / "fuzz"
# Nothing here is unsafe: what a sanitizer would find, there is none of, and it takes half of the time.
OPTIONS = ["--sanitizer", "none"]
# Seconds for one input, as in tests/src/fuzz/driver.rs.
PATIENCE = 30
# Bytes, as in tests/src/fuzz/mod.rs.
CHOICES = 600


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("targets", nargs="*", metavar="TARGET", help="only these")
    parser.add_argument("--seconds", type=int, default=60, metavar="N", help="for each target [%(default)s]")
    parser.add_argument("--list", action="store_true", help="name the targets, and run none")
    arguments = parser.parse_args()
    known = targets()
    unknown = set(arguments.targets) - set(known)
    if unknown:
        parser.error(f"no target is called {', '.join(sorted(unknown))}; there are {', '.join(known)}")
    if arguments.list:
        print("\n".join(known))
        return
    if cargo("--version", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL):
        parser.error("cargo-fuzz is missing: cargo install cargo-fuzz")
    if cargo("build", *OPTIONS):
        parser.error("the targets cannot be built")
    failed = [target for target in arguments.targets or known if not survives(target, arguments.seconds)]
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


def targets() -> list[str]:
    """Their names."""
    return [binary["name"] for binary in tomllib.loads((FUZZ / "Cargo.toml").read_text())["bin"]]


def cargo(*words: str, **options) -> int:
    """The exit status of cargo-fuzz."""
    return subprocess.run(["cargo", "fuzz", *words], cwd=ROOT, env={**os.environ, "RUSTC_BOOTSTRAP": "1"}, **options).returncode


def survives(target: str, seconds: int) -> bool:
    """Runs a target; tells what it does not survive, and how to see that again."""
    corpus, artifacts = FUZZ / "corpus" / target, FUZZ / "artifacts" / target
    corpus.mkdir(parents=True, exist_ok=True)
    before = set(artifacts.glob("*"))
    status = cargo("run", *OPTIONS, target, *map(str, [corpus, *seeds(target)]), "--", *limits(target, seconds))
    for path in sorted(set(artifacts.glob("*")) - before):
        again = f"HYPERPLAN_FUZZ_INPUT={shlex.quote(str(path))} cargo test -p hyperplan-tests --test fuzz -- --nocapture {target}"
        print(f"{target}: {path.relative_to(ROOT)}\n  {again}")
    # What fails again would end this too.
    if status == 0:
        status = cargo("cmin", *OPTIONS, target, str(corpus))
    print(f"{target}: {'FAILED' if status else 'nothing found'}, {len(list(corpus.iterdir()))} inputs kept", flush=True)
    return status == 0


def seeds(target: str) -> list[pathlib.Path]:
    """Where to begin, besides what earlier runs have found."""
    folders = [ROOT / "tests" / "corpus" / target] + [ROOT / "specs"] * (target == "problem")
    return [folder for folder in folders if folder.is_dir()]


def limits(target: str, seconds: int) -> list[str]:
    """What libFuzzer is told."""
    words = FUZZ / f"{target}.dict"
    given = [f"-max_total_time={seconds}", f"-timeout={PATIENCE}"] + [f"-dict={words}"] * words.is_file()
    # Inputs from which something is made: short ones make nothing of interest.
    return given if seeds(target) else [*given, "-len_control=0", f"-max_len={CHOICES}"]


if __name__ == "__main__":
    main()
