#!/usr/bin/env bash
# Makes a wheel with the package and the command, in the folder that is named (`dist` without one). With `--dev` it is
# made fast, for tests; `--command FILE` takes a command that was built before.
set -euo pipefail
cd "$(dirname "$0")"

profile=release command="" out=dist
while [ $# -gt 0 ]; do
  case "$1" in
    --dev) profile=dev; shift ;;
    --command) command=$(realpath "$2"); shift 2 ;;
    *) out=$1; shift ;;
  esac
done

if [ -z "$command" ]; then
  (cd .. && cargo build --locked --profile "$profile" -p hyperplan --bin hyperplan)
  folder=$profile
  if [ "$profile" = dev ]; then folder=debug; fi
  command=../target/$folder/hyperplan
fi
mkdir -p hyperplan.data/scripts
trap 'rm -rf hyperplan.data' EXIT
cp "$command" hyperplan.data/scripts/hyperplan
# What is stripped is compiled apart, so that is left to releases.
options=()
if [ "$profile" = dev ]; then strip hyperplan.data/scripts/hyperplan; else options+=(--strip); fi

"${PYTHON:-python3}" -m maturin build --profile "$profile" --out "$out" "${options[@]}"
