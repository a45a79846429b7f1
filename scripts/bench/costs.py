"""What the command itself costs, and where its time goes."""

import pathlib
import re
import shutil
import tempfile
from typing import NamedTuple

from bench import maps, run
from bench.context import GRACE, Context, seconds, table, verdict

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROFILED = (60, 200)
STAGES = ("read", "encode", "solve", "verify")


def command(context: Context) -> None:
    """Starting it, its size, and what writing a query takes."""
    rows = []
    start = run.wall([context.binary, "--version"], max(context.runs, 5), 10.0)
    if start is not None:
        rows.append(["`hyperplan --version`", f"{start * 1e3:.1f} ms", "10 ms", met(start <= 0.010)])
    found = shutil.which(context.binary)
    if found:
        size = pathlib.Path(found).stat().st_size / 1e6
        rows.append(["the binary", f"{size:.1f} MB", "20 MB", met(size < 20)])
    size = min(60, max(context.sizes))
    query = context.folder / "query.smt2"
    file = maps.case_study("ar", size, context.folder)
    options = ["--quantifiers", "expand", "--quiet", "-o", str(query)]
    time = run.wall([context.binary, "emit", str(file), *options], context.runs, context.timeout)
    if time is not None and query.exists():
        written = query.stat().st_size / 1e6
        what = f"`emit`, ar at {size} x {size}: {written:.1f} MB with building the query"
        rows.append([what, f"{seconds(time)} s, {written / time:.0f} MB/s", "-", "-"])
    rows += writer()
    context.show("command", table(["what", "measured", "target", "met"], rows))


def writer() -> list[list[str]]:
    """How fast the writer is by itself, by its own benchmark."""
    line = ["cargo", "bench", "--offline", "--manifest-path", str(ROOT / "Cargo.toml")]
    done = run.once([*line, "-p", "hyperplan-smt", "--bench", "write", "--", "--quick"], 3600.0)
    rows = []
    # `write/NAME`, some lines later `thrpt: [LOW UNIT MIDDLE UNIT HIGH UNIT]`.
    rates = re.compile(r"^(write/\w+)\s.*?thrpt:\s+\[\S+ \S+ (\S+) (\S+)", re.MULTILINE | re.DOTALL)
    for name, speed, unit in rates.findall(done.output):
        rate = float(speed) * {"KiB/s": 1 << 10, "MiB/s": 1 << 20, "GiB/s": 1 << 30}[unit] / 1e6
        rows.append([f"the writer alone, `{name}`", f"{rate:.0f} MB/s", "150 MB/s", met(rate >= 150)])
    return rows or [["the writer alone", done.problem or "no cargo", "150 MB/s", "-"]]


def met(fits: bool) -> str:
    """As it stands in a table."""
    return "yes" if fits else "no"


class Build(NamedTuple):
    """A cold build, and how many seconds it may take."""

    name: str
    options: list[str]
    target: float


def builds(context: Context) -> None:
    """Cold release builds of the command, with dependencies downloaded before."""
    rows = []
    for build in (
        Build("with CaDiCaL", [], 300),
        Build("without", ["--no-default-features", "--features", "cli"], 120),
    ):
        with tempfile.TemporaryDirectory() as folder:
            line = ["cargo", "build", "--release", "--offline", "-p", "hyperplan", "--target-dir", folder]
            line += ["--manifest-path", str(ROOT / "Cargo.toml"), *build.options]
            done = run.once(line, 3600.0)
        if done.problem is not None:
            rows.append([build.name, done.problem, f"{build.target:.0f} s", "-"])
        else:
            rows.append([build.name, f"{done.wall:.0f} s", f"{build.target:.0f} s", met(done.wall <= build.target)])
        context.show("builds", table(["cold release build", "measured", "target", "met"], rows))


def profile(context: Context) -> None:
    """The share of each stage, and with perf the functions that take most."""
    header = ["objective", "size", *STAGES, "rest", "wall"]
    rows: list[list[str]] = []
    functions: list[str] = []
    for size in (n for n in PROFILED if n in context.sizes):
        for objective in context.objectives:
            file = maps.case_study(objective, size, context.folder)
            done = context.solved.get((objective, size)) or context.solve(file)
            stages = done.answer.get("seconds")
            if stages is None:
                rows.append([objective, f"{size} x {size}"] + ["-"] * 5 + [verdict(done)])
            else:
                known = [stages[stage] for stage in STAGES]
                rest = max(0.0, done.wall - sum(known))
                shares = [f"{100 * time / done.wall:.0f} %" for time in [*known, rest]]
                rows.append([objective, f"{size} x {size}", *shares, seconds(done.wall)])
            functions.append(hottest(context, objective, size, file))
            context.show("profile", table(header, rows) + "\n" + "".join(functions))


def hottest(context: Context, objective: str, size: int, file: pathlib.Path) -> str:
    """The functions with most samples, as perf sees them."""
    title = f"`{objective}` at {size} x {size}: "
    perf = shutil.which("perf")
    if perf is None:
        return title + "no perf on this machine\n\n"
    data = context.folder / "perf.data"
    record = [perf, "record", "-q", "-F", "499", "-o", str(data), "--", *context.command(file)]
    run.once(record, context.timeout + GRACE)
    report = [perf, "report", "-i", str(data), "--stdio", "--percent-limit", "2", "--sort", "symbol", "-q"]
    listed = run.once(report, 300.0)
    # perf pads lines, and some versions add empty columns.
    lines = [line.strip(" -") for line in listed.output.splitlines() if "%" in line]
    if listed.problem or not lines:
        return title + "perf could not be used\n\n"
    if any(" 0x" in line for line in lines):
        return title + "functions have no names, as the command was built without symbols\n\n"
    return title + "\n\n" + "\n".join(f"- `{line[:110]}`" for line in lines[:8]) + "\n\n"
