#!/usr/bin/env python3
"""The paper's Table I with every solver that is installed: the time for each objective and map, verification included.

The paper's times are those of z3 on an Intel i7-7820X, for a formula in which not every quantifier is enforced.
"""

import sys

import compared

# Seconds by the length of the map's side, of the objectives in the order of OBJECTIVES.
PAPER = {
    10: ["0.14", "0.12", "0.24", "0.15", "0.15"],
    20: ["5.2", "2.9", "4.7", "5.5", "5.0"],
    40: ["30", "24", "49", "38", "172"],
    60: ["382", "191", "320", "306", "244"],
}
OBJECTIVES = ["iso", "cso", "isr", "ar", "sp"]


def main() -> None:
    parser = compared.parser(__doc__, "table-1", 400)
    sizes = parser.add_argument("--sizes", type=int, nargs="+", choices=PAPER, default=list(PAPER), metavar="N")
    sizes.help = "sides of the maps [10 20 40 60]"
    arguments, others = parser.parse_known_args()
    cases = [(size, objective) for size in arguments.sizes for objective in OBJECTIVES]
    files = [f"specs/case-studies/{objective}-{size}.hp" for size, objective in cases]
    records, status = compared.compare(arguments, *files, *others)
    ways = sorted({(record["solver"], record["quantifiers"], record["states"]) for record in records})
    several = len(ways) > len({solver for solver, *_ in ways})
    rows = []
    for size, objective in cases:
        row = [f"{size} x {size}", objective.upper(), str(2 * size), PAPER[size][OBJECTIVES.index(objective)]]
        for way in ways:
            of = [r for r in records if (r["solver"], r["quantifiers"], r["states"]) == way]
            row.append(compared.result([r for r in of if r["instance"].endswith(f"/{objective}-{size}.hp#{objective}")]))
        rows.append(row)
    compared.table(["map", "objective", "T", "paper", *(" ".join(way) if several else way[0] for way in ways)], rows)
    sys.exit(status)


if __name__ == "__main__":
    main()
