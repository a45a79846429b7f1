#!/usr/bin/env python3
"""Plants faults in the encoder and the search, one at a time, and expects the differential tests to catch each.

Works on a copy of the tree in a temporary directory, and builds there unless CARGO_TARGET_DIR says otherwise.
Usage: scripts/planted-faults.py [NAME...]
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

# name, file, text, replacement
FAULTS = [
    ("horizon-one-short", "crates/horizon/src/lib.rs",
     "steps: atom.and_then(|atom| tight.time[atom]),",
     "steps: atom.and_then(|atom| tight.time[atom]).map(|t| t.saturating_sub(1)),"),
    ("no-path-guard", "crates/plan/src/cegis.rs",
     "self.query.script.clause(&[!game.guard, formula]);",
     "self.query.script.clause(&[formula]);"),
    ("no-path-guard-in-expansion", "crates/plan/src/direct.rs",
     "direct.query.script.clause(&[!guard, formula]);",
     "direct.query.script.clause(&[formula]);"),
    ("dead-ends-count-as-paths", "crates/encode/src/reach.rs",
     "Mode::Bounded => rank == LIVE,",
     "Mode::Bounded => rank > 0,"),
    ("within-forgets-what-follows", "crates/encode/src/reach.rs",
     "Mode::Within(steps) => rank >= steps.saturating_sub(time),",
     "Mode::Within(_) => true,"),
    ("strong-next-is-weak", "crates/encode/src/unroll.rs",
     "if matches!(&formula.nodes[id], Node::WeakNext(_)) { Term::TRUE } else { Term::FALSE }",
     "Term::TRUE"),
    ("window-one-short", "crates/encode/src/unroll.rs",
     "let unclipped = interval.hi.map(|hi| time.saturating_add(hi));",
     "let unclipped = interval.hi.map(|hi| time.saturating_add(hi.saturating_sub(1)).max(time + interval.lo));"),
    ("no-backward-clauses", "crates/encode/src/explicit.rs",
     "clause.extend(before.get(&(state, letter)).into_iter().flatten());\n            script.clause(&clause);",
     "clause.extend(before.get(&(state, letter)).into_iter().flatten());"),
    ("sweep-forgets-a-condition", "crates/encode/src/sweep.rs",
     "way.push(term.negate_if(!holds));",
     "if holds { way.push(term); }"),
    ("first-action-is-free", "crates/encode/src/atom.rs",
     "if self.time == 0 || p == q {",
     "if self.time <= 1 || p == q {"),
]


def catches(name, file, old, new, work):
    """Whether the tests fail with the fault in place."""
    path = work / file
    text = path.read_text()
    if old not in text:
        sys.exit(f"{name}: the text to replace is no longer in {file}")
    path.write_text(text.replace(old, new, 1))
    try:
        environment = {"CARGO_TARGET_DIR": str(work / "target"), **os.environ}
        run = subprocess.run(
            ["cargo", "test", "--quiet", "-p", "hyperplan-tests", "--test", "differential", "the_embedded"],
            cwd=work, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    finally:
        path.write_text(text)
    if run.returncode != 0 and "could not compile" in run.stdout:
        sys.exit(f"{name}: does not compile\n{run.stdout}")
    return run.returncode != 0


def main():
    chosen = [f for f in FAULTS if not sys.argv[1:] or f[0] in sys.argv[1:]]
    missed = []
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder) / "tree"
        shutil.copytree(ROOT, work, ignore=shutil.ignore_patterns("target", ".git"))
        for name, file, old, new in chosen:
            caught = catches(name, file, old, new, work)
            print(f"{name}: {'caught' if caught else 'MISSED'}", flush=True)
            if not caught:
                missed.append(name)
    sys.exit(f"missed: {', '.join(missed)}" if missed else 0)


if __name__ == "__main__":
    main()
