"""Release notes are what the changelog says of a version, and Debian's files follow its rules."""

import pathlib
import subprocess
import sys
import tomllib
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SCRIPTS))

import debian  # noqa: E402
import release_notes  # noqa: E402

CHANGELOG = """# Changelog

Words before.

## [Unreleased]

## [0.2.0] - 2027-01-31

### Added
- One thing,
  in two lines.

### Fixed
- Another.

## [0.1.0] - 2026-12-01
- The first.

[0.2.0]: somewhere
"""


class Notes(unittest.TestCase):
    def test_each_version_has_its_own(self) -> None:
        found = release_notes.versions(CHANGELOG)
        self.assertEqual(list(found), ["Unreleased", "0.2.0", "0.1.0"])
        self.assertEqual(found["Unreleased"], (None, ""))
        self.assertEqual(found["0.1.0"], ("2026-12-01", "- The first."))
        text = "### Added\n- One thing,\n  in two lines.\n\n### Fixed\n- Another."
        self.assertEqual(found["0.2.0"], ("2027-01-31", text))

    def test_headings_that_are_none(self) -> None:
        for heading in ["0.1.0", "[0.1.0] 2026-12-01", "[0.1.0]", "[0.1.0] - 1.12.2026", "[Unreleased] - 2026-12-01"]:
            with self.subTest(heading), self.assertRaisesRegex(ValueError, "line 1"):
                release_notes.versions(f"## {heading}\n- x\n")
        with self.assertRaisesRegex(ValueError, "line 3: there are two"):
            release_notes.versions("## [0.1.0] - 2026-12-01\n- x\n## [0.1.0] - 2026-12-02\n")

    def test_the_command(self) -> None:
        def notes(version: str) -> subprocess.CompletedProcess[bytes]:
            return subprocess.run([sys.executable, SCRIPTS / "release_notes.py", version], capture_output=True)

        ours = release_notes.versions(release_notes.CHANGELOG.read_text(encoding="utf-8"))
        for version, own in ours.items():
            if own.text:
                self.assertEqual(notes(version).stdout.decode(), own.text + "\n")
                self.assertEqual(notes(version).stdout, notes("v" + version).stdout)
        missing = notes("99.0.0")
        self.assertEqual(missing.returncode, 1)
        self.assertIn(b"there is no 99.0.0", missing.stderr)


class Debian(unittest.TestCase):
    def test_the_changelog_has_the_form_of_debian(self) -> None:
        entry = debian.changelog("0.1.0", "The authors <us@example.org>", 1_796_083_200)
        lines = entry.splitlines()
        self.assertEqual(lines[0], "hyperplan (0.1.0-1) unstable; urgency=medium")
        self.assertEqual(lines[-1], " -- The authors <us@example.org>  Tue, 01 Dec 2026 00:00:00 +0000")
        self.assertTrue(all(line == "" or line.startswith("  ") for line in lines[1:-1]))

    def test_what_is_packed_is_there(self) -> None:
        crate = SCRIPTS.parent / "crates" / "hyperplan"
        deb = tomllib.loads((crate / "Cargo.toml").read_text(encoding="utf-8"))["package"]["metadata"]["deb"]
        sources = [source for source, _, _ in deb["assets"] if "target/" not in source]
        self.assertGreater(len(sources), 1)
        for source in sources:
            self.assertTrue((crate / source).is_file(), source)
        self.assertEqual({name for name in debian.SHELLS.values()}, {
            pathlib.Path(source).name for source, target, _ in deb["assets"] if "completions" in target
        })  # fmt: skip

    def test_licences_name_every_library(self) -> None:
        text = debian.copyright_file("MIT License\n\nCopyright (c) 2026 Us\n\nPermission.\n\nMore.\n", ["one 1.0.0: MIT", "two 2.0.0: ISC"])
        paragraphs = text.split("\n\n")
        self.assertTrue(paragraphs[0].startswith("Format: "))
        self.assertIn("Copyright: 2026 Us", text)
        self.assertIn(" Permission.\n .\n More.\n", text)
        self.assertIn("  one 1.0.0: MIT\n  two 2.0.0: ISC\n", text)
        self.assertEqual([p.split(":")[0] for p in paragraphs], ["Format", "Files", "License", "License"])


if __name__ == "__main__":
    unittest.main()
