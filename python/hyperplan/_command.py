"""The command that is in the wheel, for what is asked of whole files."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Sequence

from ._native import HyperplanError

_NAME = "hyperplan.exe" if os.name == "nt" else "hyperplan"

#: Exit statuses of the command that are answers: realizable or not, and undecided.
ANSWERS = (0, 1, 3)


def command() -> Path:
    """Where the command `hyperplan` is that came with this package."""
    schemes = [sysconfig.get_path("scripts"), str(Path(sys.prefix) / "bin")]
    if os.name == "posix":
        schemes.append(sysconfig.get_path("scripts", "posix_user"))
    # Where `pip install --target` puts it.
    schemes.append(str(Path(__file__).parent.parent / "bin"))
    for folder in schemes:
        program = Path(folder) / _NAME
        if program.is_file():
            return program
    found = shutil.which(_NAME)
    if found is None:
        error = HyperplanError("the command hyperplan is not installed: this package was built without it")
        error.code = "no-command"
        raise error
    return Path(found)


def run(arguments: Sequence[str], good: Sequence[int] = ANSWERS) -> str:
    """What the command prints; an exception where it ends with another status. Ctrl-C ends it."""
    done = subprocess.run(
        [str(command()), *arguments], capture_output=True, text=True, encoding="utf-8", stdin=subprocess.DEVNULL
    )
    if done.returncode not in good:
        error = HyperplanError(done.stderr.strip() or f"hyperplan ended with status {done.returncode}")
        error.code = "command-failed"
        raise error
    return done.stdout
