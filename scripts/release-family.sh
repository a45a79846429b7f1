#!/bin/sh
# Makes a folder of benchmarks to submit to SMT-LIB: candidates, measured by the solvers that are installed, a selection of
# them, checked, with a licence and a README that has the table of measured difficulty.
#
#   scripts/release-family.sh DIR [small|full|OPTIONS OF EMIT --family]
#
# HYPERPLAN is the command, if it is not in the PATH. `small` takes a minute, and its benchmarks are easy; `full`, the
# default, takes a day; options, --select N among them, say what else is wanted. What is interrupted goes on with the same
# command. DIR/submission is what is submitted, DIR/record what is kept of how it was made. dolmen, z3, cvc5 and pySMT
# check the files if they are there.
set -eu
here=$(dirname "$0")
[ $# -ge 1 ] || { sed -n '2,11s/^# \{0,1\}//p' "$0"; exit 2; }
hyperplan=${HYPERPLAN:-hyperplan}
dir=$1
shift
case ${1:-full} in
  small)
    set -- --sizes 5 --densities 10 --seeds 0 --maps random,rooms --objectives ar,isrs,cso,locks --horizons below,least \
      --limit 20 --select 16 --measure-limit 2 --easy 0.01 ;;
  full)
    set -- --sizes 6,8,10,12 --densities 10,20 --seeds 0..2 --maps random,rooms,maze,aisles \
      --objectives sp,isr,ar,iso,cso,isrs,ar2,ars,drift,cso3,alibi,locks,roads --horizons below,least \
      --limit 120 --select 250 --measure-limit 60 ;;
  --*) ;;
  *) echo "release-family: expected small, full or options, not $1" >&2; exit 2 ;;
esac
"$hyperplan" emit --family "$dir/family" "$@"

selected=$dir/family/selected
rm -rf "$dir/submission.new" "$dir/record.new"
mkdir -p "$dir/submission.new" "$dir/record.new"
cp -R "$selected/non-incremental" "$selected/problems" "$dir/submission.new/"
python3 "$here/family_readme.py" "$selected/manifest.json" > "$dir/submission.new/README.md"
cat > "$dir/submission.new/LICENSE" <<LICENCE
The benchmarks in this folder are licensed under the Creative Commons Attribution 4.0 International licence (CC BY 4.0),
as the header of each says: https://creativecommons.org/licenses/by/4.0/
LICENCE
cp "$selected/manifest.json" "$selected/manifest.csv" "$dir/record.new/"
gzip -9 -n -c "$dir/family/measured/runs.jsonl" > "$dir/record.new/runs.jsonl.gz"

# Problems are no benchmarks, and lie beside the folders that the library's rules are about.
python3 "$here/check-benchmarks.py" --external "$dir/submission.new"
if command -v dolmen >/dev/null; then
  find "$dir/submission.new" -name '*.smt2' -exec dolmen --strict=true {} + || { echo "dolmen refuses a benchmark" >&2; exit 1; }
else
  echo "not installed: dolmen" >&2
fi
megabytes=$(tar -C "$dir/submission.new" -cz . | wc -c | awk '{ print int($1 / 1000000) }')
[ "$megabytes" -le 200 ] || { echo "the folder has $megabytes MB packed; at most 200 are meant" >&2; exit 1; }

for folder in submission record; do
  rm -rf "${dir:?}/$folder"
  mv "$dir/$folder.new" "$dir/$folder"
done
echo "$dir/submission: $(find "$dir/submission" -name '*.smt2' | wc -l | tr -d ' ') benchmarks, $megabytes MB packed"
