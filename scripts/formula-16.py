#!/usr/bin/env python3
"""The paper's formula (16), which leaves quantifiers to the solver, against what hyperplan does by itself.

Path constraints are antecedents under "for all", not conjuncts as printed, or there would be no plan at all. Otherwise
`--quantifiers keep` is the formula of the paper: one query, with its quantifiers.
"""

import sys

import compared

FILES = ["specs/rooms.hp", *(f"specs/case-studies/{name}-10.hp" for name in ("iso", "cso", "isr", "ar", "sp"))]


def main() -> None:
    arguments, others = compared.parser(__doc__, "formula-16", 60).parse_known_args()
    records, status = compared.compare(arguments, *FILES, "--quantifiers", "keep,auto", *others)
    # The embedded engine takes no quantifiers.
    takes = {record["solver"] for record in records} - {"builtin"}
    rows = []
    for instance in dict.fromkeys(record["instance"] for record in records):
        for solver in sorted(takes):
            of = [r for r in records if r["instance"] == instance and r["solver"] == solver]
            keep, auto = (compared.result([r for r in of if r["quantifiers"] == how]) for how in ("keep", "auto"))
            rows.append([instance.removeprefix("specs/"), solver, keep, auto, ratio(keep, auto, arguments.timeout)])
    compared.table(["instance", "solver", "keep", "auto", "keep / auto"], rows)
    sys.exit(status)


def ratio(keep: str, auto: str, timeout: float) -> str:
    """How many times longer; at least so many if it did not end."""
    try:
        return f"> {timeout / float(auto):.0f}" if keep == "timeout" else f"{float(keep) / float(auto):.1f}"
    except (ValueError, ZeroDivisionError):
        return ""


if __name__ == "__main__":
    main()
