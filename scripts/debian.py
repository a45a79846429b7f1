#!/usr/bin/env python3
"""Makes a Debian package with cargo-deb, and tries it.

    scripts/debian.py [--command FILE] [--out DIR] [--try SYSTEM]

The command is built, or taken as it is. Its manual pages, its completions and the list of the libraries in it, with their
licences, are made with it and beside it; what goes where stands in `crates/hyperplan/Cargo.toml`. lintian has a look at
the package where it is installed. With --try the package is installed in SYSTEM, the folder of a Debian system in which
nothing else need be (`mmdebstrap --variant=apt bookworm SYSTEM` makes one), and used there.

DEBFULLNAME and DEBEMAIL say who publishes it. What is made of the same sources and the same command is the same, byte for
byte.
"""

import argparse
import datetime
import email.utils
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import release_notes

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHELLS = {"bash": "hyperplan", "zsh": "_hyperplan", "fish": "hyperplan.fish"}
#: Nobody's address: whoever publishes a package has one.
NOBODY = "The hyperplan authors <nobody@hyperplan.invalid>"

PROBLEM = """system Line {
  state x: 0..3;
  action left, right;
  on left  { x' = x - 1; }
  on right { x' = x + 1; }
  init x == 0;
}
objective end { exists p. F[0,3] x[p] == 3 }
"""

#: What is tried where it was installed; each line has to succeed. Shells and `man` are tried where they are.
TRIAL = """
set -euo pipefail
hyperplan --version
hyperplan solve /tmp/line.hp --quiet
hyperplan solve /tmp/line.hp --format json | hyperplan verify /tmp/line.hp -
test "$(ls /usr/share/man/man1/hyperplan*.1.gz | wc -l)" -gt 10
gunzip --test /usr/share/man/man1/hyperplan*.1.gz
! command -v man || man hyperplan-solve | grep -e --timeout >/tmp/found
. /usr/share/bash-completion/completions/hyperplan
COMP_WORDS=(hyperplan ver) COMP_CWORD=1
_hyperplan hyperplan ver hyperplan
test "${COMPREPLY[*]}" = verify
! command -v zsh || zsh -c 'autoload -U compinit; compinit -D -u; test "$_comps[hyperplan]" = _hyperplan; autoload +X _hyperplan'
! command -v fish || fish -c 'complete -C "hyperplan ver"' | grep ^verify >/tmp/found
echo "all of it works"
"""


def changelog(version: str, maintainer: str, time: int) -> str:
    """As Debian has it: an entry for the version. What is new stands in the changelog beside it."""
    date = email.utils.format_datetime(datetime.datetime.fromtimestamp(time, datetime.timezone.utc))
    news = "  * What is new is in /usr/share/doc/hyperplan/changelog.gz."
    return f"hyperplan ({version}-1) unstable; urgency=medium\n\n{news}\n\n -- {maintainer}  {date}\n"


def copyright_file(mit: str, libraries: list[str]) -> str:
    """Licences in Debian's form, with those of what is in the program."""
    owner = re.search(r"Copyright \(c\) (.*)", mit)
    assert owner is not None, "LICENSE-MIT says whose it is"
    text = mit[owner.end() :].strip().splitlines()
    lines = "".join(f" {line or '.'}\n" for line in text)
    listed = "".join(f"  {library}\n" for library in libraries)
    return (
        "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n"
        "Upstream-Name: hyperplan\n"
        f"Comment: The program has these libraries in it, each under its own licence:\n{listed}"
        f"\nFiles: *\nCopyright: {owner[1]}\nLicense: Expat or Apache-2.0\n"
        f"\nLicense: Expat\n{lines}"
        "\nLicense: Apache-2.0\n On Debian systems the text is in /usr/share/common-licenses/Apache-2.0.\n"
    )


def output(*command: object) -> str:
    return subprocess.run(list(map(str, command)), check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT).stdout


def libraries() -> list[str]:
    """What is linked into the command, with licences."""
    tree = output(
        "cargo", "tree", "--locked", "--package", "hyperplan", "--edges", "normal,no-proc-macro", "--prefix", "none",
        "--format", "{p}: {l}",
    )  # fmt: skip
    # Ours have a path behind the version; what stands twice has a mark.
    lines = {line.removesuffix(" (*)") for line in tree.splitlines()}
    return sorted(re.sub(r" v(\S+?):", r" \1:", line) for line in lines if "(" not in line.split(":")[0])


def make(made: pathlib.Path, program: pathlib.Path, maintainer: str, time: int, version: str) -> None:
    """What is in the package besides the command and what the sources have."""
    shutil.rmtree(made, ignore_errors=True)
    made.mkdir(parents=True)
    output(program, "man", "--output", made / "man")
    for shell, name in SHELLS.items():
        (made / name).write_text(output(program, "completions", shell), encoding="utf-8")
    mit = (ROOT / "LICENSE-MIT").read_text(encoding="utf-8")
    (made / "copyright").write_text(copyright_file(mit, libraries()), encoding="utf-8")
    (made / "changelog").write_text(changelog(version, maintainer, time), encoding="utf-8")


def package(program: pathlib.Path, out: pathlib.Path) -> pathlib.Path:
    """The package that is made around a command."""
    name, address = os.environ.get("DEBFULLNAME"), os.environ.get("DEBEMAIL")
    maintainer = f"{name} <{address}>" if name and address else NOBODY
    described = json.loads(output("cargo", "metadata", "--locked", "--no-deps", "--format-version", "1"))
    version = next(package["version"] for package in described["packages"] if package["name"] == "hyperplan")
    notes = release_notes.versions(release_notes.CHANGELOG.read_text(encoding="utf-8")).get(version)
    if notes is not None and notes.date is not None:
        time = int(datetime.datetime.fromisoformat(notes.date + "T00:00:00+00:00").timestamp())
    else:
        time = int(output("git", "log", "-1", "--format=%ct"))
    # Where the metadata of `crates/hyperplan` say, wherever else things are built.
    make(ROOT / "target" / "debian" / "made", program, maintainer, time, version)
    with tempfile.TemporaryDirectory() as scratch:
        # Where cargo-deb looks for what cargo builds: the command that is in the package may be another one.
        release = pathlib.Path(scratch, "release")
        release.mkdir()
        shutil.copy(program, release)
        command = ["cargo", "deb", "--quiet", "--no-build", "--package", "hyperplan", "--maintainer", maintainer, "--output", str(out)]
        environment = {**os.environ, "CARGO_TARGET_DIR": scratch, "SOURCE_DATE_EPOCH": str(time)}
        done = subprocess.run(command, cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE, text=True)
    return pathlib.Path(done.stdout.strip())


def try_in(system: pathlib.Path, file: pathlib.Path) -> None:
    """Installs a package in another system, and uses it there."""
    inside = system / "tmp"
    shutil.copy(file, inside / "hyperplan.deb")
    (inside / "line.hp").write_text(PROBLEM, encoding="utf-8")
    (inside / "trial").write_text(TRIAL, encoding="utf-8")
    # As a network may not be there, what the package rests on is: the libraries of C and C++.
    for command in (["dpkg", "--install", "/tmp/hyperplan.deb"], ["bash", "/tmp/trial"], ["dpkg", "--purge", "hyperplan"]):
        subprocess.run(["chroot", str(system), *command], check=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", type=pathlib.Path, metavar="FILE", help="instead of building it")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("target/debian"), metavar="DIR", help="[%(default)s]")
    parser.add_argument("--try", dest="system", type=pathlib.Path, metavar="SYSTEM", help="install and use it there")
    arguments = parser.parse_args()
    if shutil.which("cargo-deb") is None:
        sys.exit("cargo-deb is not here: cargo install cargo-deb --locked")
    try:
        made(arguments)
    except subprocess.CalledProcessError as error:
        sys.exit(f"{' '.join(map(str, error.cmd))} ended with {error.returncode}")


def made(arguments: argparse.Namespace) -> None:
    """Builds, packs, checks and tries, as was asked."""
    program = arguments.command
    if program is None:
        subprocess.run(["cargo", "build", "--release", "--locked", "-p", "hyperplan", "--bin", "hyperplan"], cwd=ROOT, check=True)
        program = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"), "release", "hyperplan")
    arguments.out.mkdir(parents=True, exist_ok=True)
    file = package(program.resolve(), arguments.out.resolve())
    print(file)
    if shutil.which("lintian"):
        # It is not Debian itself that publishes it, so no wish for it was filed there.
        quiet = ["--suppress-tags", "initial-upload-closes-no-bugs"]
        subprocess.run(["lintian", "--fail-on", "error,warning", "--allow-root", *quiet, str(file)], check=True)
    else:
        print("no lintian here: the package was not checked", file=sys.stderr)
    if arguments.system is not None:
        try_in(arguments.system, file)


if __name__ == "__main__":
    main()
