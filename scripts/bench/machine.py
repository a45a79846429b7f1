"""What was measured, on what, and when."""

import datetime
import os
import pathlib
import platform
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]


def said(*command: str) -> str:
    """The output of a command; nothing if it fails."""
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60, check=True)
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip()


def value(file: str, key: str, separator: str) -> str:
    """The value of the first line with that key."""
    try:
        lines = pathlib.Path(file).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    for line in lines:
        name, found, rest = line.partition(separator)
        if found and name.strip() == key:
            return rest.strip().strip('"')
    return ""


def date() -> str:
    """The day of SOURCE_DATE_EPOCH, or else of the commit."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH") or said("git", "log", "-1", "--format=%ct")
    if not epoch.isdigit():
        return "unknown"
    return datetime.datetime.fromtimestamp(int(epoch), datetime.UTC).date().isoformat()


def solver_versions(binary: str) -> str:
    """What `hyperplan solvers` found, without the places."""
    found = []
    for line in said(binary, "solvers").splitlines():
        name, _, rest = line.partition(" ")
        version = rest.strip().partition(", ")[0]
        if name and version and version != "not found":
            found.append(f"{name} {version}")
    return ", ".join(found) or "unknown"


def description(binary: str) -> str:
    """The machine and the programs, as a Markdown list."""
    memory = value("/proc/meminfo", "MemTotal", ":").removesuffix(" kB")
    commit = said("git", "rev-parse", "--short=12", "HEAD") or "unknown"
    changed = " with changes" if said("git", "status", "--porcelain", "--untracked-files=no") else ""
    cores = len(os.sched_getaffinity(0))
    system = value("/etc/os-release", "PRETTY_NAME", "=") or platform.system()
    facts = {
        "processor": f"{value('/proc/cpuinfo', 'model name', ':') or platform.machine()}, {cores} cores",
        "memory": f"{int(memory) / 1e6:.1f} GB" if memory.isdigit() else "unknown",
        "system": f"{system}, kernel {platform.release()}",
        "compiler": said("rustc", "--version") or "unknown",
        "hyperplan": f"{said(binary, '--version') or 'unknown'}, commit {commit}{changed}",
        "solvers": solver_versions(binary),
        "date": date(),
    }
    return "".join(f"- {name}: {fact}\n" for name, fact in facts.items())
