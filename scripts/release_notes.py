#!/usr/bin/env python3
"""Prints what CHANGELOG.md says of a version, which are its release notes.

    scripts/release_notes.py VERSION [CHANGELOG]

VERSION is a number, or `Unreleased`. The same file gives the same notes, byte for byte.
"""

import pathlib
import re
import sys
from typing import NamedTuple, Optional

CHANGELOG = pathlib.Path(__file__).resolve().parent.parent / "CHANGELOG.md"
HEADING = re.compile(r"## \[(?P<version>[^\]]+)\](?: - (?P<date>\d{4}-\d{2}-\d{2}))?")
# At the end of the file: what the versions in brackets lead to.
LINK = re.compile(r"\[[^\]]+\]: \S+")


class Notes(NamedTuple):
    """What is said of a version."""

    #: None where it is not released yet.
    date: Optional[str]
    #: Without the heading, without empty lines around it.
    text: str


def versions(changelog: str) -> dict[str, Notes]:
    """All that a changelog speaks of, in its order."""
    found: dict[str, tuple[Optional[str], list[str]]] = {}
    lines: list[str] = []
    for number, line in enumerate(changelog.splitlines(), 1):
        if not line.startswith("## "):
            lines += [] if LINK.fullmatch(line) else [line.rstrip()]
            continue
        heading = HEADING.fullmatch(line.rstrip())
        if heading is None:
            raise ValueError(f"line {number}: a heading is `## [VERSION] - YYYY-MM-DD` or `## [Unreleased]`, not `{line}`")
        version, date = heading["version"], heading["date"]
        if version in found:
            raise ValueError(f"line {number}: there are two headings for {version}")
        if (date is None) != (version == "Unreleased"):
            raise ValueError(f"line {number}: a released version has a date, and nothing else has")
        lines = []
        found[version] = (date, lines)
    return {version: Notes(date, "\n".join(lines).strip("\n")) for version, (date, lines) in found.items()}


def main() -> None:
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    changelog = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else CHANGELOG
    try:
        found = versions(changelog.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        sys.exit(f"{changelog}: {error}")
    version = sys.argv[1].removeprefix("v")
    if version not in found:
        sys.exit(f"{changelog}: there is no {version}, only {', '.join(found) or 'nothing'}")
    if not found[version].text:
        sys.exit(f"{changelog}: nothing is said of {version}")
    sys.stdout.write(found[version].text + "\n")


if __name__ == "__main__":
    main()
