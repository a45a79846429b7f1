#!/usr/bin/env python3
"""Measures hyperplan against its targets and writes docs/performance.md and the chart beside it.

Needs nothing but Python 3.11 and a release build. What has been measured is written at once, so that an interrupted
run leaves a page in which the rest is said to be missing.
"""

import argparse
import os
import pathlib
import string
import sys
import tempfile
from collections.abc import Callable

from bench import backends, compare, costs, explicit, given, machine, maps, run, scattered, targets
from bench.context import Context

ROOT = pathlib.Path(__file__).resolve().parent.parent
SECTIONS = ("targets", "large", "growth", "explicit", "scattered", "given", "least", "quantifiers", "external", "backends", "command", "builds", "profile")
NOT_BY_DEFAULT = ("builds", "profile")


def main() -> None:
    arguments = parsed()
    if arguments.check_maps:
        wrong = maps.differences()
        sys.exit(f"these maps do not follow their rule: {', '.join(wrong)}" if wrong else 0)
    with tempfile.TemporaryDirectory() as folder:
        context = prepared(arguments, pathlib.Path(folder))
        write = publisher(context, arguments.out, arguments.note)
        context.publish = write
        write()
        picture = arguments.out.with_name(arguments.out.stem + "-growth.svg")
        for name in arguments.only:
            print(name, file=sys.stderr, flush=True)
            measure(name, context, picture)
    print(f"{arguments.out} written", file=sys.stderr)


def parsed() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--hyperplan", default="target/release/hyperplan", metavar="FILE", help="the command (default: %(default)s)")
    add("--sizes", type=numbers, default=[10, 20, 40, 60, 100, 200], metavar="N,...", help="map sizes")
    add("--formula-sizes", type=numbers, default=[10, 20], metavar="N,...", help="those for formula (16)")
    add("--objectives", type=names(maps.OBJECTIVES), default=list(maps.OBJECTIVES), metavar="NAME,...")
    add(
        "--solvers",
        type=lambda text: text.split(","),
        default=["z3", "yices"],
        metavar="NAME,...",
        help="external solvers (default: z3,yices)",
    )
    add("--runs", type=int, default=3, metavar="K", help="the median of so many (default: %(default)s)")
    add("--timeout", type=float, default=120.0, metavar="SECONDS", help="of each run (default: %(default)s)")
    add(
        "--map",
        type=pathlib.Path,
        default=os.environ.get("HYPERPLAN_MAP"),
        metavar="FILE.map",
        help="a real map of 512 x 512 cells, in the format of the Moving AI Lab (default: $HYPERPLAN_MAP)",
    )
    add("--problems", type=pathlib.Path, metavar="DIR", help="a folder of problem files to be solved, too")
    add("--out", type=pathlib.Path, default=ROOT / "docs" / "performance.md", metavar="FILE.md")
    add(
        "--only",
        type=names(SECTIONS),
        metavar="SECTION,...",
        help=f"of {', '.join(SECTIONS)}; without it, all but {' and '.join(NOT_BY_DEFAULT)}",
    )
    add(
        "--also",
        type=names(NOT_BY_DEFAULT),
        default=[],
        metavar="SECTION,...",
        help="sections that take long: cold builds, and the profile with the functions that perf sees",
    )
    add("--note", default="", metavar="TEXT", help="what else a reader should know, such as what else was running")
    add("--check-maps", action="store_true", help="only check that the committed maps follow their rules")
    arguments = parser.parse_args()
    if arguments.only is None:
        arguments.only = [name for name in SECTIONS if name not in NOT_BY_DEFAULT]
    arguments.only += [name for name in arguments.also if name not in arguments.only]
    if arguments.runs < 1 or arguments.timeout <= 0 or min(arguments.sizes + arguments.formula_sizes) < 10:
        parser.error("runs and timeout must be positive, and sizes at least 10")
    if not arguments.out.parent.is_dir():
        parser.error(f"there is no directory {arguments.out.parent}")
    return arguments


def numbers(text: str) -> list[int]:
    """A list of integers, in order."""
    return sorted({int(part) for part in text.split(",")})


def names(known: tuple[str, ...]) -> Callable[[str], list[str]]:
    """A reader of lists of names, which keeps the known order."""

    def read(text: str) -> list[str]:
        given = text.split(",")
        for name in given:
            if name not in known:
                raise argparse.ArgumentTypeError(f"{name} is none of {', '.join(known)}")
        return [name for name in known if name in given]

    return read


def prepared(arguments: argparse.Namespace, folder: pathlib.Path) -> Context:
    """What the measurements share."""
    version = run.once([arguments.hyperplan, "--version"], 10.0)
    if version.problem is not None:
        sys.exit(f"{arguments.hyperplan} --version: {version.problem}; build it, or name it with --hyperplan")
    return Context(
        binary=arguments.hyperplan,
        folder=folder,
        sizes=arguments.sizes,
        objectives=arguments.objectives,
        solvers=arguments.solvers,
        formula_sizes=arguments.formula_sizes,
        runs=arguments.runs,
        timeout=arguments.timeout,
        map=arguments.map,
        problems=arguments.problems,
        floor=run.floor(),
    )


def publisher(context: Context, file: pathlib.Path, note: str) -> Callable[[], None]:
    """A function that writes the page as far as it is known."""
    template = string.Template((pathlib.Path(__file__).parent / "bench" / "performance.md").read_text("utf-8"))
    about = machine.description(context.binary) + (f"- note: {note}\n" if note else "")
    times = "one run" if context.runs == 1 else f"{context.runs} runs"

    def write() -> None:
        values = {name: context.sections.get(name, "Not measured.\n") for name in SECTIONS}
        floor, timeout = f"{context.floor / 1e6:.0f}", f"{context.timeout:g}"
        page = template.substitute(values, machine=about, runs=times, timeout=timeout, floor=floor)
        file.write_text(page, encoding="utf-8")

    return write


def measure(name: str, context: Context, picture: pathlib.Path) -> None:
    """One section of the page."""
    if name == "growth":
        targets.growth(context, picture)
        return
    sections = {
        "targets": targets.targets,
        "large": targets.large,
        "explicit": explicit.explicit,
        "scattered": scattered.scattered,
        "given": given.given,
        "least": compare.least,
        "quantifiers": compare.quantifiers,
        "external": compare.external,
        "backends": backends.backends,
        "command": costs.command,
        "builds": costs.builds,
        "profile": costs.profile,
    }
    sections[name](context)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("interrupted; what had been measured is written")
