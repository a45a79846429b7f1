"""What other programs say of a file: whether they can read it."""

import dataclasses
import importlib.util
import re
import shutil
import subprocess
import sys

SECONDS = 120
# The logics of which pySMT can read everything; those with datatypes are not among them.
PYSMT = frozenset("QF_BV BV QF_UF UF QF_LIA LIA QF_LRA LRA QF_UFLIA QF_UFLRA QF_UFBV UFBV QF_IDL QF_RDL".split())
# It warns of logics that it does not know by name, such as BV, and reads them all the same.
PYSMT_SCRIPT = """
import sys
sys.setrecursionlimit(1_000_000)
from pysmt.smtlib.parser import SmtLibParser
with open(sys.argv[1], encoding="utf-8") as file:
    SmtLibParser().get_script(file)
"""
ASKS = re.compile(rb"^\((?:check-sat|get-model|get-unsat-core)\)", re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Reading:
    """What a program says of a file; no message where it can be read, or is not for this program."""

    program: str
    message: str | None


def missing() -> list[str]:
    """The programs that are not here."""
    found = [name for name in ("z3", "cvc5") if shutil.which(name) is None]
    return found + ([] if importlib.util.find_spec("pysmt") else ["pysmt"])


def read(path: str, logic: str, without: list[str]) -> list[Reading]:
    """Has a file read by every program that is here."""
    readings = []
    if "z3" not in without:
        with open(path, "rb") as file:
            # z3 has no way to read without solving.
            readings.append(Reading("z3", complaint(["z3", "-in", "-smt2"], ASKS.sub(b"", file.read()))))
    if "cvc5" not in without:
        command = ["cvc5", "--parse-only", "--strict-parsing", "--lang=smt2.6", path]
        readings.append(Reading("cvc5", complaint(command)))
    if "pysmt" not in without and logic in PYSMT:
        readings.append(Reading("pysmt", complaint([sys.executable, "-W", "ignore", "-c", PYSMT_SCRIPT, path])))
    return readings


def complaint(command: list[str], text: bytes = b"") -> str | None:
    """What a program says that should say nothing."""
    try:
        done = subprocess.run(command, input=text, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SECONDS,
                              check=False)
    except subprocess.TimeoutExpired:
        return f"not read in {SECONDS} s"
    lines = [line for line in done.stdout.decode("utf-8", "replace").splitlines() if line.strip()]
    if done.returncode == 0 and not lines:
        return None
    return lines[-1] if lines else f"exit status {done.returncode}"
