#!/usr/bin/env python3
"""Runs hyperplan and other tools side by side on tables of models and formulas, and judges what they say.

    scripts/peers.py ../peers/instances.tsv
    scripts/peers.py ../peers/instances.tsv --peers hyperplan,hyperqb2 --timeout 60 --write docs/peers.md

A table is one of `hyperplan compare`: family, models, formula, bound and what is known, separated by tabs; a further column whose
name in the first line ends with "s" is shown beside the times here. How tools are run stands in peers.toml; those that
are not installed are passed over, and that is said. Runs are kept in a log, and what is there is not run again.
Exit status: 0 nothing is wrong; 1 a verdict is not the one that is known, or contradicts a witness that was checked.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
KNOWN = {"realizable": "holds", "holds": "holds", "unrealizable": "violated", "violated": "violated"}
# What `hyperplan check` says where a formula asks for nothing, or for less than it seems to.
DOUBTS = ("trivially-true", "trivially-false", "vacuous", "no-initial-state", "unreachable-label")
BEGIN, END = "<!-- begin: scripts/peers.py -->", "<!-- end -->"


@dataclasses.dataclass(frozen=True)
class Instance:
    """A row of a table."""

    models: tuple[str, ...]
    formula: str
    bound: str
    semantics: str
    known: str | None
    """`holds` or `violated`, where it is known."""
    elsewhere: str
    """A time that was measured elsewhere."""

    def label(self) -> str:
        stem = lambda path: pathlib.Path(path).stem
        names = [stem(model) for model in dict.fromkeys(self.models)]
        return f"{', '.join(names[:3])}{', ...' if len(names) > 3 else ''}: {stem(self.formula)}, K = {self.bound}"


def instances(table: pathlib.Path) -> list[Instance]:
    """The rows of a table; files are those beside it."""
    found = []
    for number, line in enumerate(table.read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        cells = line.split("\t")
        if len(cells) < 5:
            raise ValueError(f"{table}:{number}: expected family, models, formula, bound and what is known")
        _, models, formula, bound, known, *more = (cell.strip() for cell in cells)
        steps, _, semantics = bound.partition(" ")
        if not steps.isdigit() or known not in (*KNOWN, "", "-", "unknown"):
            raise ValueError(f"{table}:{number}: `{bound}` is no bound, or `{known}` nothing that is known")
        path = lambda name: str(table.parent / name)
        elsewhere = more[-1] if len(more) > 1 else ""
        found.append(Instance(tuple(map(path, models.split())), path(formula), steps, semantics, KNOWN.get(known), elsewhere))
    return found


def programs(peers: dict) -> dict[str, str]:
    """The tools that are installed, with their programs. An environment variable, HYPERQB2 for [hyperqb2], says where one is."""
    found = {}
    for name, peer in peers.items():
        wanted = [os.environ.get(name.upper(), ""), *peer["programs"]]
        program = next((where for where in map(shutil.which, filter(None, wanted)) if where), None)
        if program:
            found[name] = program
    return found


def command(peer: dict, program: str, instance: Instance, timeout: float) -> list[str]:
    """The command line for an instance. One model stands for all quantifiers if it is the only one."""
    values = {
        "program": program, "formula": instance.formula, "bound": instance.bound, "semantics": instance.semantics,
        "timeout": f"{timeout:g}", "model": instance.models[0],
    }
    words = []
    for part in peer["command"]:
        group = part if isinstance(part, list) else [part]
        if len(group) > 1 and not all(values.get(word[1:-1], word) for word in group if word.startswith("{")):
            continue
        if len(group) > 1 and "{models}" in group:
            words += [model if word == "{models}" else word for model in instance.models for word in group]
            continue
        for word in group:
            if word == "{models}":
                words += instance.models
            elif word == "{text}":
                words.append(pathlib.Path(instance.formula).read_text().strip())
            else:
                words.append(word.format_map(values))
    return words


def run(words: list[str], timeout: float) -> dict:
    """Runs a command with all that it starts, for so long at most."""
    begin = time.monotonic()
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True)
    late = False
    try:
        out, err = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        late = True
        os.killpg(process.pid, signal.SIGKILL)
        out, err = process.communicate()
    return {"status": process.returncode, "late": late, "seconds": time.monotonic() - begin, "out": out[-1_000_000:], "err": err[-2000:]}


def verdict(peer: dict, ended: dict) -> tuple[str, str]:
    """What a tool said, `holds`, `violated`, `timeout` or `unknown`, and how the witness was verified."""
    if ended["late"]:
        return "timeout", ""
    verified = ""
    if "json" in peer:
        line = next((line for line in ended["out"].splitlines() if line.startswith("{")), "{}")
        try:
            verified = str(json.loads(line).get(peer["json"]) or "")
        except ValueError:
            pass
    said = peer.get("statuses", {}).get(str(ended["status"]))
    if said:
        return said, verified
    both = ended["out"] + "\n" + ended["err"]
    # "unsat" has "sat" in it: what says the most is looked for first.
    for what in ("violated", "holds"):
        if what in peer and re.search(peer[what], both, re.MULTILINE | re.IGNORECASE):
            return what, verified
    return "unknown", verified


def doubts(program: str, instance: Instance, timeout: float) -> list[str]:
    """The codes of what `hyperplan check` finds doubtful about a row: that it asks for nothing, or less than it seems to."""
    words = [program, "check", *instance.models, instance.formula, "--bound", instance.bound, "--format", "json"]
    words += ["--semantics", instance.semantics] if instance.semantics else []
    found = []
    for line in run([*words, "--timeout", f"{timeout:g}"], timeout + 5)["out"].splitlines():
        try:
            code = json.loads(line).get("code")
        except ValueError:
            continue
        if code in DOUBTS and code not in found:
            found.append(code)
    return found


def judge(instance: Instance, said: dict[str, tuple[str, str]], peers: dict) -> list[str]:
    """What is wrong with the answers to an instance. Tools that speak of infinite paths are not judged by those that end."""
    truth = instance.known
    checked = said.get("hyperplan", ("", ""))
    wrong = []
    if checked[1] == "by-search" and checked[0] in ("holds", "violated"):
        if truth not in (None, checked[0]):
            wrong.append(f"{instance.label()}: a checked witness says {checked[0]}, and known is {truth}")
        truth = checked[0]
    for name, (answer, _) in said.items():
        if answer in ("holds", "violated") and truth not in (None, answer) and not peers[name].get("infinite"):
            wrong.append(f"{instance.label()}: {peers[name]['title']} says {answer}, not {truth}")
    return wrong


def result(answer: str, seconds: float, truth: str | None) -> str:
    if answer in ("timeout", "unknown"):
        return answer
    return f"{seconds:.2f}" if truth in (None, answer) else f"{answer} ({seconds:.2f})"


def table(rows: list[dict], peers: dict, names: list[str], elsewhere: str) -> str:
    """The rows as Markdown."""
    head = ["instance", "verdict", "verified", *(f"{peers[name]['title']} s" for name in names)]
    head += [elsewhere] if elsewhere else []
    lines = [[*head, "what `check` says"]]
    for row in rows:
        instance, said = row["instance"], row["said"]
        own, verified = said.get("hyperplan", ("", ""))
        truth = instance.known or (own if own in ("holds", "violated") else None)
        cells = [instance.label(), truth or "unknown", verified or "-"]
        cells += [result(said[n][0], row["seconds"][n], truth) if n in said else "-" for n in names]
        cells += [instance.elsewhere] if elsewhere else []
        lines.append([*cells, ", ".join(f"`{code}`" for code in row["doubts"])])
    text = ["| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines]
    aligned = ["---"] * 3 + ["---:"] * (len(lines[0]) - 4) + ["---"]
    return "\n".join([text[0], "| " + " | ".join(aligned) + " |", *text[1:]])


def written(page: str, found: str) -> str:
    """A page with the table between its marks."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"the page has no lines `{BEGIN}` and `{END}`")
    return f"{before}{BEGIN}\n{found}\n{END}{after}"


class Log:
    """What was run, a line each; the same command line with the same limit is not run again."""

    def __init__(self, path: pathlib.Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self.path = path
        lines = path.read_text().splitlines() if path.is_file() else []
        self.known = {}
        for line in lines:
            try:
                record = json.loads(line)
                self.known[record["key"]] = record
            except (ValueError, KeyError):
                # The last line of a run that was interrupted.
                continue

    def run(self, words: list[str], timeout: float) -> dict:
        program = pathlib.Path(words[0]).stat()
        key = json.dumps([words, timeout, program.st_size, program.st_mtime])
        if key not in self.known:
            self.known[key] = {"key": key, **run(words, timeout)}
            with self.path.open("a") as log:
                log.write(json.dumps(self.known[key]) + "\n")
        return self.known[key]


def elsewhere(path: pathlib.Path) -> str:
    """The name of the last column, where it is a time."""
    first = next(iter(path.read_text().splitlines()), "")
    name = first.split("\t")[-1].strip() if first.startswith("#") else ""
    return name if name.endswith(" s") else ""


def arguments() -> argparse.Namespace:
    wanted = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    add = wanted.add_argument
    add("tables", nargs="+", type=pathlib.Path, metavar="TABLE.tsv", help="what is run")
    add("--peers", default="", metavar="NAME,...", help="only these [all that are installed]")
    add("--config", type=pathlib.Path, default=HERE / "peers.toml", metavar="FILE", help="how they are run [%(default)s]")
    add("--timeout", type=float, default=60, metavar="SECONDS", help="of each run [%(default)s]")
    add("--out", type=pathlib.Path, default=pathlib.Path("peers"), metavar="DIR", help="for the log [%(default)s]")
    add("--write", type=pathlib.Path, metavar="PAGE.md", help="puts the table between its marks in this page")
    return wanted.parse_args()


def main() -> None:
    wanted = arguments()
    peers = tomllib.loads(wanted.config.read_text())
    chosen = [name for name in wanted.peers.split(",") if name] or list(peers)
    unknown = [name for name in chosen if name not in peers]
    if unknown:
        sys.exit(f"no peer `{unknown[0]}`; there are {', '.join(peers)}")
    found = programs({name: peers[name] for name in chosen})
    for name in chosen:
        if name not in found:
            print(f"note: {peers[name]['title']} is not installed, and passed over", file=sys.stderr)
    if not found:
        sys.exit("none of them is installed")
    log = Log(wanted.out / "peers.jsonl")
    rows, wrong, column = [], [], ""
    for path in wanted.tables:
        column = column or elsewhere(path)
        for instance in instances(path):
            row = {"instance": instance, "said": {}, "seconds": {}, "doubts": []}
            for name, program in found.items():
                if not all(model.endswith(tuple(peers[name]["for"])) for model in instance.models):
                    continue
                # What can end by itself has a little longer.
                ended = log.run(command(peers[name], program, instance, wanted.timeout), wanted.timeout + 5)
                row["said"][name] = verdict(peers[name], ended)
                row["seconds"][name] = ended["seconds"]
            if "hyperplan" in found:
                row["doubts"] = doubts(found["hyperplan"], instance, 20)
            wrong += judge(instance, row["said"], peers)
            rows.append(row)
            print(f"{instance.label()}: {row['said']}", file=sys.stderr)
    text = table(rows, peers, list(found), column)
    if wanted.write:
        wanted.write.write_text(written(wanted.write.read_text(), text))
    else:
        print(text)
    for line in wrong:
        print(f"wrong: {line}", file=sys.stderr)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
