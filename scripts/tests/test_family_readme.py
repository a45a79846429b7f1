"""The README of a family says what its manifest says."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import family_readme

SCRIPT = pathlib.Path(family_readme.__file__)


def entry(status: str, logic: str, name: str, slowest: float | None, **runs: tuple[str, float]) -> dict:
    """A benchmark of the manifest, with what each solver made of it in so many seconds."""
    measured = {
        solver: {"outcome": outcome, "answer": None, "seconds": seconds} for solver, (outcome, seconds) in runs.items()
    }
    return {"objective": "ar", "status": status, "logic": logic, "bin": name, "slowest": slowest, "runs": measured}


MANIFEST = {
    "family": "maps", "date": "2026-02-28", "generator": "g", "easy_s": 1.0, "limit_s": 60.0,
    "solvers": {"z3": "5", "cvc5": "1"},
    "benchmarks": [
        entry("sat", "UF", "under 1 s", 0.5, z3=("solved", 0.5), cvc5=("error", 50.0)),
        entry("unsat", "UF", "over 60 s", None, z3=("unsolved", 60.1), cvc5=("solved", 1.0)),
        entry("sat", "QF_UF", "31.62 to 60 s", 40.0, z3=("solved", 40.0), cvc5=("wrong", 1.0)),
        # One that gives up at once has not solved it, but has taken no time either.
        entry("sat", "QF_UF", "over 60 s", None, z3=("unsolved", 0.1), cvc5=("solved", 1.0)),
    ],
}


class Readme(unittest.TestCase):
    """What is said of difficulty."""

    def test_tables_count_what_is_there(self) -> None:
        text = family_readme.readme(MANIFEST)
        self.assertIn("4 benchmarks (3 sat, 1 unsat)", text)
        self.assertIn("| logic | status | under 1 s | 31.62 to 60 s | over 60 s | all |", text)
        self.assertIn("| UF | unsat | 0 | 0 | 1 | 1 |", text)
        self.assertIn("| all |  | 1 | 1 | 2 | 4 |", text)
        self.assertIn("| ar | random | a plan that copes with one faulty action | 4 |", text)

    def test_targets_are_measured(self) -> None:
        text = family_readme.readme(MANIFEST)
        self.assertIn("2 of 4 take one of the solvers over 20 s; 1 are done by all within 1 s.", text)
        self.assertIn("Only one status has QF_UF.", text)
        self.assertIn("1 end with an error by cvc5, 1 are answered wrongly by cvc5", text)

    def test_what_is_no_manifest_is_refused(self) -> None:
        for contents in ["", "[]", json.dumps({"benchmarks": []})]:
            with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
                file.write(contents)
                file.flush()
                run = subprocess.run([sys.executable, SCRIPT, file.name], capture_output=True, text=True, check=False)
                self.assertEqual(run.returncode, 2)
                self.assertIn("not the manifest of a selection", run.stderr)


if __name__ == "__main__":
    unittest.main()
