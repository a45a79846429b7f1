#!/usr/bin/env bash
# Builds a wheel around a command that was built before, installs it in clean environments (of this Python, and of the oldest
# that is supported, if it is there), and runs the tests, the notebooks and the type checker on what was installed.
set -euo pipefail
command=$(realpath "$1")
cd "$(dirname "$0")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

say() { printf -- '-- %s\n' "$*" >&2; }

# Registries are now and then out of reach.
install() {
  local attempt pip=$1
  shift
  for attempt in 1 2 3; do
    if "$pip" install --quiet --disable-pip-version-check "$@"; then return 0; fi
    echo "attempt $attempt failed: pip install $*" >&2
    sleep $((attempt * 5))
  done
  return 1
}

say "format, lints"
cargo fmt --check
cargo clippy --locked -- -D warnings

say "wheel"
python3 -m venv "$work/build"
install "$work/build/bin/pip" 'maturin>=1.9,<2'
PYTHON="$work/build/bin/python" ./build.sh --dev --command "$command" "$work/dist"
ls -sh "$work/dist" >&2

say "tests on $(python3 --version)"
python3 -m venv "$work/new"
install "$work/new/bin/pip" "$work"/dist/hyperplan-*.whl numpy networkx matplotlib pytest mypy nbmake ipykernel \
  unified-planning==1.3.0
# Not where the sources are: what is imported is what was installed.
cp -r tests "$work/tests"
(cd "$work" && new/bin/python -m pytest -q -p no:cacheprovider tests)
(cd "$work" && new/bin/python -m pytest -q -p no:cacheprovider --nbmake "$OLDPWD/../docs/notebooks")
say "types"
(cd "$work" && new/bin/python -m mypy --strict --disable-error-code import-untyped -p hyperplan)

# What is in the PATH may be a script that stands for a version which is not chosen.
oldest=""
for python in python3.9 "$HOME"/.pyenv/versions/3.9.*/bin/python; do
  if "$python" -c "" 2>/dev/null; then oldest=$python; break; fi
done
if [ -n "$oldest" ] && "$oldest" -m venv "$work/old" 2>/dev/null; then
  say "tests on $("$oldest" --version)"
  install "$work/old/bin/pip" "$work"/dist/hyperplan-*.whl numpy networkx pytest
  (cd "$work" && old/bin/python -m pytest -q -p no:cacheprovider tests)
else
  say "no Python 3.9 here: not tested on it"
fi
