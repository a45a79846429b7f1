#!/bin/sh
# Makes a folder of benchmarks to submit to SMT-LIB: candidates, measured by the solvers that are installed, a selection of
# them, checked, with a licence and a README that has the table of measured difficulty.
#
#   scripts/release-family.sh DIR [small|full|OPTIONS OF EMIT --family]
#
# HYPERPLAN is the command, if it is not in the PATH. `small` takes a minute, and its benchmarks are easy; `full`, the
# default, takes an hour on one core; options, --select N among them, say what else is wanted. What is
# interrupted goes on with the same command. DIR/submission is what is submitted, DIR/record what is kept of how it was
# made. dolmen, z3, cvc5 and pySMT check the files if they are there.
set -eu
here=$(dirname "$0")
[ $# -ge 1 ] || { sed -n '2,11s/^# \{0,1\}//p' "$0"; exit 2; }
hyperplan=${HYPERPLAN:-hyperplan}
dir=$1
shift

# The candidates of the full release, with a line for each kind: sizes were chosen by trying some, so that few are easy.
candidates() {
  while read -r quantifiers states seeds sizes maps objectives; do
    "$hyperplan" emit --family "$dir/family" --horizons below,least --densities 15 --limit 30 --quantifiers "$quantifiers" \
      --states "$states" --seeds "$seeds" --sizes "$sizes" --maps "$maps" --objectives "$objectives" "$@" < /dev/null
  done
}

case ${1:-full} in
  small)
    "$hyperplan" emit --family "$dir/family" --sizes 5 --densities 10 --seeds 0 --maps random,rooms \
      --objectives ar,isrs,cso,locks --horizons below,least --limit 20 --select 16 --measure-limit 2 --easy 0.01 ;;
  full)
    candidates <<LINES
expand int 0 8,12 random,maze iso,cso,cso3,isr
expand int 0 12,16 random roads,locks
expand int 37..38 12,14 maze iso
expand real 1 8,12 random,aisles iso,cso,cso3,isr
expand real 1 12,16 random roads
expand real 39 12,14 maze iso
expand bitvec 2 12,16 random iso,cso,cso3,isr
expand bitvec 2 6,8 random,rooms isrs
expand bitvec 2 14,18 random locks,roads
expand bitvec 20..22 12 random cso3,isr
expand enum 3 6,9 random,rooms sp,iso,cso3,isrs,drift
expand enum 41..42 9 random,rooms drift
expand onehot 4 6,8 random ar,isrs,drift,iso,cso
expand onehot 4 8 rooms ar2,ars,cso3,isrs
expand onehot 35..36 8 random,aisles cso
keep onehot 5 6,8 random sp,isr,drift,locks
keep onehot 5 6 random isrs
keep onehot 29..31 6 random isr
keep bitvec 6 6,9 random sp,isr,locks
keep bitvec 6 6 random,rooms sp,isr,isrs,alibi
keep bitvec 6 6 aisles sp,isr,alibi
keep bitvec 32..34 9 random isr
keep int 7 6,8 random,rooms sp,isr
keep int 7 6 random isrs
keep int 24..26 6 random isr
keep real 8 6,9 random,rooms sp,isr
keep real 8 6 random ar,drift
keep real 21..23 6 random isr
keep enum 9 6,8 random,rooms sp,isr,locks
keep enum 27..28 8 random isr
expand int 63..64 14 random roads
expand int 66..67 8 maze cso3
expand real 60..62 14 random roads
expand real 68 12 aisles cso3
expand enum 65 9 random,rooms drift
LINES
    candidates --jobs 1 --select 200 --measure-limit 21 --measure-by z3,cvc5,yices <<LINES
expand bitvec 70..71 12 random cso3,isr
LINES
    ;;
  --*) "$hyperplan" emit --family "$dir/family" "$@" ;;
  *) echo "release-family: expected small, full or options, not $1" >&2; exit 2 ;;
esac

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
