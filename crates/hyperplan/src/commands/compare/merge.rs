//! Logs of several machines, put together.

use super::{comparison, doing, last, open, report};
use crate::args;
use crate::failure::{Exit, Failure, Result};
use crate::files::{cannot_write, read_bytes, reason};
use crate::output::Output;
use hyperplan_compare::foreign::{self, is_foreign};
use hyperplan_compare::merge::added;
use hyperplan_compare::{Limit, Log, Past, Record, prepare, tidy};
use std::collections::BTreeSet;
use std::path::PathBuf;

pub(super) fn run(args: &args::Compare, out: &mut Output) -> Result {
    let listed = match &args.cluster.plan {
        Some(file) => Some(comparison::read(file, &args.asked)?.1),
        None if !args.asked.is_default() => {
            return Err(Failure::input("--merge runs nothing; a plan says what is to be there: --plan FILE"));
        }
        None => None,
    };
    let more = read(&args.cluster.merge, args.cluster.limit, out)?;
    let folder = prepare(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
    let records = put_together(args, &more, out)?;
    tidy(&folder);
    let Some(listed) = listed else { return report(args, &last(records, out), out) };
    let wanted: BTreeSet<&str> = listed.iter().map(|run| run.key.as_str()).collect();
    let ours: Vec<Record> = records.into_iter().filter(|run| wanted.contains(run.key.as_str())).collect();
    let missing = listed.len() - doing::keys(&ours).len();
    let status = report(args, &super::settle(ours, out), out)?;
    if missing == 0 {
        return Ok(status);
    }
    out.error(format_args!("{missing} of {} runs of the plan are missing", listed.len()));
    Ok(status.max(Exit::Undecided))
}

/// The runs of some logs, and results of others, with that limit where they have none.
fn read(paths: &[PathBuf], limit: Option<f64>, out: &Output) -> Result<Vec<Record>> {
    let mut all = Vec::new();
    for path in paths {
        if is_foreign(path) {
            let cannot = |why: String| Failure::input(format_args!("cannot read {}: {why}", path.display()));
            let bytes = read_bytes(path).map_err(|error| cannot(reason(&error)))?;
            let mut theirs = foreign::read(path, &bytes).map_err(|error| cannot(error.to_string()))?;
            for run in theirs.iter_mut().filter(|run| run.limit == Limit::default()) {
                run.limit.wall_s = limit;
            }
            all.extend(theirs);
            continue;
        }
        let Past { records, notes } = Log::look(path).map_err(Failure::input)?;
        notes.iter().for_each(|note| out.remark(format_args!("note: {note}")));
        all.extend(records);
    }
    Ok(all)
}

/// Adds runs to the log of the folder; gives all that are in it then.
pub(super) fn put_together(args: &args::Compare, more: &[Record], out: &Output) -> Result<Vec<Record>> {
    let (mut log, mut records) = open(&args.out, out)?;
    let new = added(&records, more).map_err(Failure::input)?;
    log.extend(&new).map_err(Failure::input)?;
    out.remark(format_args!("note: {} of {} runs are new", new.len(), more.len()));
    records.extend(new);
    Ok(records)
}
