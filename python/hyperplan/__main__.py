"""`python -m hyperplan` is the command."""

import os
import subprocess
import sys

from ._command import command


def main() -> int:
    program = str(command())
    if hasattr(os, "execv") and os.name == "posix":
        os.execv(program, [program, *sys.argv[1:]])
    return subprocess.call([program, *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
