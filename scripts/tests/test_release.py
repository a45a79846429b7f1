"""What is said of the release that was made at full size is what its manifest and its log say."""

import collections
import collections.abc
import fractions
import gzip
import json
import pathlib
import unittest

import family_readme

DOCS = pathlib.Path(family_readme.__file__).parent.parent / "docs"
RECORD = DOCS / "benchmarks-release"
# What takes a solver longer is hard, in seconds.
HARD = 20.0


class Release(unittest.TestCase):
    """The record in `docs/benchmarks-release`."""

    def setUp(self) -> None:
        self.manifest = json.loads((RECORD / "manifest.json").read_text(encoding="utf-8"))
        self.benchmarks = self.manifest["benchmarks"]
        with gzip.open(RECORD / "runs.jsonl.gz", "rt", encoding="utf-8") as lines:
            self.runs = [json.loads(line) for line in lines]

    def share(self, holds: collections.abc.Callable[[dict], bool]) -> fractions.Fraction:
        return fractions.Fraction(sum(map(holds, self.benchmarks)), len(self.benchmarks))

    def test_its_size(self) -> None:
        self.assertTrue(200 <= len(self.benchmarks) <= 300)
        # Packed they are less.
        self.assertLess(sum(entry["bytes"] for entry in self.benchmarks), 200_000_000)

    def test_a_third_is_hard_for_some_solver(self) -> None:
        self.assertGreaterEqual(self.manifest["limit_s"], HARD)
        self.assertEqual(set(self.manifest["solvers"]), {"z3", "cvc5", "yices"})
        self.assertGreaterEqual(self.share(lambda entry: family_readme.is_hard(entry, HARD)), fractions.Fraction(1, 3))

    def test_a_tenth_is_easy_for_all(self) -> None:
        def is_easy(entry: dict) -> bool:
            taken = [run for run in entry["runs"].values() if run["outcome"] in ("solved", "unsolved")]
            return all(run["outcome"] == "solved" and run["seconds"] <= 1.0 for run in taken)

        self.assertLessEqual(self.share(is_easy), fractions.Fraction(1, 10))

    def test_each_logic_has_both_statuses(self) -> None:
        statuses = collections.defaultdict(set)
        for entry in self.benchmarks:
            statuses[entry["logic"]].add(entry["status"])
        self.assertGreaterEqual(len(statuses), 10)
        for logic, those in statuses.items():
            self.assertEqual(those, {"sat", "unsat"}, logic)

    def test_no_answer_is_wrong(self) -> None:
        outcomes = {run["outcome"] for entry in self.benchmarks for run in entry["runs"].values()}
        self.assertLessEqual(outcomes, {"solved", "unsolved", "unsupported"})

    def test_times_are_those_of_the_log(self) -> None:
        log = {(run["sha256"], run["solver"]): run for run in self.runs}
        self.assertEqual(len(log), len(self.runs))
        for entry in self.benchmarks:
            for solver, run in entry["runs"].items():
                logged = log[entry["sha256"], solver]
                self.assertAlmostEqual(logged["wall_s"], run["seconds"], delta=0.001)
                self.assertEqual(logged["limit"]["wall_s"], self.manifest["limit_s"])
                self.assertEqual(logged["status"] in ("sat", "unsat"), run["outcome"] == "solved")
                if run["outcome"] == "solved":
                    self.assertEqual(logged["status"], entry["status"])

    def test_the_table_is_the_manifests(self) -> None:
        page = (DOCS / "benchmarks.md").read_text(encoding="utf-8")
        easy, limit = self.manifest["easy_s"], self.manifest["limit_s"]
        self.assertIn("\n".join(family_readme.difficulty(self.benchmarks, easy, limit)), page)
        for line in family_readme.shares(self.benchmarks, easy, limit):
            self.assertIn(line, page)


if __name__ == "__main__":
    unittest.main()
