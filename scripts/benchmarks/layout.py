"""Where the files of a submission are, and whether two are alike."""

import datetime
import pathlib
import re

from .rules import Checked, Finding

# The library has the first two. The others are of our own making, for what a competition derives from the library.
FOLDERS = {
    "non-incremental": "single", "incremental": "incremental", "model-validation": "model", "unsat-core": "unsat-core",
}
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+-]*")


def track(path: pathlib.PurePath) -> str:
    """The track of a file, by its path in the folder of a submission."""
    return FOLDERS.get(path.parts[0], "auto") if path.parts else "auto"


def misplaced(path: pathlib.PurePath, checked: Checked) -> str | None:
    """What is wrong with a path in the folder of a submission."""
    if len(path.parts) < 4:
        return "expected [non-]incremental/LOGIC/YYYYMMDD-FAMILY-SUBMITTER/.../NAME.smt2"
    top, logic, family = path.parts[:3]
    if FOLDERS.get(top) != checked.track:
        folder = next(folder for folder, track in FOLDERS.items() if track == checked.track)
        return f"it lies in {top}, not in {folder}, below the folder that was named"
    if checked.logic and logic != checked.logic:
        return f"the logic is {checked.logic}, the folder's {logic}"
    date, _, rest = family.partition("-")
    try:
        good = re.fullmatch(r"\d{8}", date) and datetime.datetime.strptime(date, "%Y%m%d")
    except ValueError:
        good = None
    if not good or not rest:
        return f"the set is called {family}, not YYYYMMDD-FAMILY-SUBMITTER"
    for part in path.parts[2:]:
        if not NAME.fullmatch(part):
            return f"`{part}` is no plain name"
    return None


def duplicates(hashes: dict[str, str]) -> list[Finding]:
    """The files that are like an earlier one."""
    first: dict[str, str] = {}
    found = []
    for file, sha256 in sorted(hashes.items()):
        if sha256 in first:
            found.append(Finding(file, 1, "duplicate", f"as {first[sha256]}"))
        first.setdefault(sha256, file)
    return found
