"""Every target is run with what it has, and what fails is told; a program in the place of cargo says what it was asked."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "fuzz.py"

# Keeps what it was asked; with a `run` of the target `graph` it fails as libFuzzer does.
CARGO = """#!/bin/sh
echo "$RUSTC_BOOTSTRAP $*" >> "$LOG"
case "$*" in "fuzz run"*" graph "*) mkdir -p "$ARTIFACTS" && touch "$ARTIFACTS/crash-of-a-test" && exit 77;; esac
"""


class Fuzz(unittest.TestCase):
    def run_script(self, *words: str) -> tuple[subprocess.CompletedProcess, list[str]]:
        """What the script says, and what it asked of cargo."""
        with tempfile.TemporaryDirectory() as folder:
            program, log = pathlib.Path(folder, "cargo"), pathlib.Path(folder, "log")
            program.write_text(CARGO)
            program.chmod(0o755)
            log.touch()
            environment = {**os.environ, "PATH": f"{folder}{os.pathsep}{os.environ['PATH']}", "LOG": str(log),
                           "ARTIFACTS": str(self.artifacts)}
            done = subprocess.run([sys.executable, SCRIPT, *words], env=environment, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True)
            return done, log.read_text().splitlines()

    def setUp(self) -> None:
        self.artifacts = ROOT / "fuzz" / "artifacts" / "graph"

    def tearDown(self) -> None:
        (self.artifacts / "crash-of-a-test").unlink(missing_ok=True)

    def test_every_target_is_also_a_test(self) -> None:
        done, asked = self.run_script("--list")
        self.assertEqual((done.returncode, asked), (0, []), done.stderr)
        tests = (ROOT / "tests" / "tests" / "fuzz.rs").read_text()
        names = done.stdout.split()
        self.assertGreater(len(names), 8)
        self.assertEqual(sorted(names), sorted(path.stem for path in (ROOT / "fuzz" / "targets").glob("*.rs")))
        for name in names:
            with self.subTest(name):
                body = (ROOT / "fuzz" / "targets" / f"{name}.rs").read_text()
                self.assertIn(f"fuzz::{name.upper()}.body", body)
                self.assertIn(f"run(fuzz::{name.upper()});", tests)

    def test_what_is_there_is_used_and_made_small(self) -> None:
        done, asked = self.run_script("--seconds", "7", "problem", "solve")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([line.split()[:3] for line in asked],
                         [["1", "fuzz", word] for word in ("--version", "build", "run", "cmin", "run", "cmin")])
        self.assertIn("-max_total_time=7", asked[2])
        for word in ("fuzz/corpus/problem ", "tests/corpus/problem ", "specs ", "-dict=", "fuzz/problem.dict"):
            self.assertIn(word, asked[2])
        self.assertNotIn("-dict", asked[4])

    def test_what_fails_is_told(self) -> None:
        done, asked = self.run_script("--seconds", "1", "graph", "map")
        self.assertEqual(done.returncode, 1)
        self.assertIn("graph: fuzz/artifacts/graph/crash-of-a-test", done.stdout)
        self.assertIn("HYPERPLAN_FUZZ_INPUT=", done.stdout)
        self.assertIn("failed: graph", done.stderr)
        # The others run all the same; what has failed is not made small.
        self.assertEqual([line.split()[2] for line in asked], ["--version", "build", "run", "run", "cmin"])

    def test_targets_that_are_not_there_are_an_error(self) -> None:
        done, asked = self.run_script("grahp")
        self.assertEqual((done.returncode, asked), (2, []))
        self.assertIn("no target is called grahp", done.stderr)


if __name__ == "__main__":
    unittest.main()
