"""Each package is built with the features that it has in the whole workspace, and its dependencies too: none twice."""

import json
import pathlib
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def cargo(*arguments: str) -> str:
    """What cargo says, of what is locked."""
    line = ["cargo", *arguments, "--locked", "--manifest-path", str(ROOT / "Cargo.toml")]
    return subprocess.run(line, check=True, stdout=subprocess.PIPE, text=True).stdout


def features(*selection: str) -> set[str]:
    """What is built for tests, our own packages too, each with its features."""
    line = ["tree", *selection, "--edges", "normal,build,dev", "--prefix", "none", "--format", "{p} [{f}]"]
    return {line.removesuffix(" (*)") for line in cargo(*line).splitlines()}


class Features(unittest.TestCase):
    """What stands in `crates/workspace-hack/Cargo.toml`, that every package has it, and that `cadical` is handed on."""

    def test_packages_share_what_is_built(self) -> None:
        packages = json.loads(cargo("metadata", "--no-deps", "--format-version", "1"))["packages"]
        whole = features("--workspace")
        for package in packages:
            with self.subTest(package["name"]):
                other = sorted(features("--package", package["name"]) - whole)
                self.assertEqual(other, [], "the workspace has more features: add them in crates/workspace-hack")


if __name__ == "__main__":
    unittest.main()
