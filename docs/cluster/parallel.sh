#!/bin/sh
# A comparison with GNU parallel: shares of plan.jsonl, several at a time, put together in the folder `all`.
#
#   hyperplan compare specs/case-studies --timeout 60 --plan plan.jsonl
#   SHARES=16 JOBS=4 docs/cluster/parallel.sh
#
# On several machines with SSH, from a folder that all of them have at the same place: LOGINS=first,second,: (`:` is this one).
# Each run comes back on standard output, so that nothing has to be shared.
set -eu
shares=${SHARES:-8}
mkdir -p all
seq "$shares" |
  parallel --jobs "${JOBS:-1}" --sshlogin "${LOGINS:-:}" --workdir "$PWD" --joblog all/parallel.log \
    hyperplan compare --quiet --plan plan.jsonl --shard "{}/$shares" --out shares --echo >>all/printed.jsonl
hyperplan compare --plan plan.jsonl --out all --merge all/printed.jsonl
