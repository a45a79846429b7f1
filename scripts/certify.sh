#!/bin/sh
# Solves a problem file, makes certificates of what is impossible, and lets every checker that is there check them.
#
#   scripts/certify.sh FILE [OPTIONS OF SOLVE]
#
# HYPERPLAN is the command, if it is not in the PATH. veripb, lrat-check and cake_lpr are used if they are in the PATH.
set -eu
[ $# -ge 1 ] || { sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 2; }
hyperplan=${HYPERPLAN:-hyperplan}
file=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
status=0
"$hyperplan" solve "$file" "$@" --proof "$folder/proofs" || status=$?
[ "$status" -le 1 ] || exit "$status"
ls "$folder"/proofs/*.json >/dev/null 2>&1 || { echo "nothing to certify: verify checks strategies"; exit 0; }
"$hyperplan" certify "$file" "$folder/proofs" --export "$folder/clauses"
failed=0
# The words that a checker says if it accepts a certificate.
accepts() {
  said=$1
  shift
  if command -v "$1" >/dev/null; then
    if "$@" 2>&1 | grep -q "$said"; then echo "$1: $name accepted"; else echo "$1: $name REFUSED"; failed=1; fi
  fi
}
for cnf in "$folder"/clauses/*.cnf; do
  base=${cnf%.cnf}
  name=${base##*/}
  accepts "s VERIFIED UNSATISFIABLE" veripb --cnf "$cnf" "$base.pbp"
  accepts "VERIFIED" lrat-check "$cnf" "$base.lrat"
  accepts "s VERIFIED UNSAT" cake_lpr "$cnf" "$base.lrat"
done
exit $failed
