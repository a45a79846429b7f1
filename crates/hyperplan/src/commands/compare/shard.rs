//! A share of a comparison: some of its runs, on this machine, with a log of their own.

use super::comparison::Comparison;
use super::doing::{Doing, host, keys};
use super::told_before;
use crate::args::{self, Part, Shard};
use crate::failure::{Exit, Failure, Result};
use crate::files::{cannot_write, reason};
use crate::output::Output;
use crate::progress::Progress;
use hyperplan_compare::list::Listed;
use hyperplan_compare::plan::{Run, sha256};
use hyperplan_compare::share::{expected, shares};
use hyperplan_compare::work::Work;
use hyperplan_compare::{Log, Record};
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The most pieces that are handed out.
const MOST_PIECES: usize = 512;
/// After how long without a sign of life a machine is taken for dead.
const PATIENCE: Duration = Duration::from_secs(60);

pub(super) fn run(
    args: &args::Compare,
    shard: Shard,
    comparison: &Comparison,
    verbose: bool,
    out: &Output,
) -> Result {
    let doing = Doing::new(args)?;
    let source = Source::new(comparison, out)?;
    let (name, all) = match shard {
        Shard::Share(Part { index, of }) => {
            let name = format!("runs-{}-of-{of}.jsonl", index + 1);
            (args.cluster.log.clone().unwrap_or(name), source.pieces(of).swap_remove(index))
        }
        Shard::Next => (own_log(&args.out)?, (0..source.listed.len()).collect()),
    };
    let path = args.out.join(name);
    let (mut log, past) = Log::open(&path).map_err(Failure::input)?;
    past.notes.iter().for_each(|note| out.remark(format_args!("note: {note}")));
    let mut share = Share { doing, source, out_folder: &args.out, done: BTreeSet::new(), out };
    share.look()?;
    let left = all.iter().filter(|&&index| !share.done.contains(&share.source.listed[index].key)).count();
    told_before(all.len() - left, all.len(), out);
    let mut progress = share.doing.progress(left, verbose, out);
    let before = share.done.len();
    let finished = match shard {
        Shard::Share(_) => share.some(&all, &mut log, &mut progress),
        Shard::Next => share.all_that_is_left(&args.out, &mut log, &mut progress),
    };
    drop(progress);
    let kept =
        format!("{} runs were done here, and are kept in {}", share.done.len() - before, path.display());
    match finished {
        Ok(true) => {
            let folder = args.out.display();
            out.remark(format_args!(
                "note: {kept}; to put logs together: hyperplan compare --out {folder} --merge LOG..."
            ));
            Ok(Exit::Good)
        }
        Ok(false) => {
            out.error(format_args!("interrupted: {kept}; the same command does the others"));
            Ok(Exit::Undecided)
        }
        Err(failure) => Err(Failure::new(failure.status, format_args!("{}; {kept}", failure.message))),
    }
}

/// Where runs come from.
struct Source<'a> {
    comparison: &'a Comparison,
    listed: Vec<Listed>,
    /// Without a plan all runs were made, in the order of the list.
    made: Option<Vec<Run>>,
    out: &'a Output,
}

impl<'a> Source<'a> {
    fn new(comparison: &'a Comparison, out: &'a Output) -> Result<Source<'a>> {
        if let Some(listed) = &comparison.listed {
            return Ok(Source { comparison, listed: listed.clone(), made: None, out });
        }
        let runs = comparison.runs(out)?;
        // From nothing but the arguments, so that all machines cut alike.
        let seconds = expected(&runs, &[]);
        let listed = runs.iter().zip(seconds).map(|(run, seconds)| Listed::new(run, seconds)).collect();
        Ok(Source { comparison, listed, made: Some(runs), out })
    }

    /// So many shares, each as places in the list.
    fn pieces(&self, of: usize) -> Vec<Vec<usize>> {
        let seconds: Vec<f64> = self.listed.iter().map(|run| run.seconds).collect();
        let mut pieces = vec![Vec::new(); of];
        for (place, share) in shares(&seconds, of).into_iter().enumerate() {
            pieces[share].push(place);
        }
        pieces
    }

    fn runs(&self, places: &[usize]) -> Result<Vec<Run>> {
        match &self.made {
            Some(runs) => Ok(places.iter().map(|&place| runs[place].clone()).collect()),
            None => {
                let listed: Vec<&Listed> = places.iter().map(|&place| &self.listed[place]).collect();
                self.comparison.of_plan(&listed, self.out)
            }
        }
    }
}

struct Share<'a> {
    doing: Doing,
    source: Source<'a>,
    out_folder: &'a Path,
    /// The keys of what is done, by anybody.
    done: BTreeSet<String>,
    out: &'a Output,
}

impl Share<'_> {
    /// Looks at what was done: here before, or by others where the folder is shared.
    fn look(&mut self) -> Result<()> {
        for path in logs(self.out_folder)? {
            self.done.extend(keys(&Log::look(&path).map_err(Failure::input)?.records));
        }
        Ok(())
    }

    /// Does those of some runs that were not done; whether all are.
    fn some(&mut self, places: &[usize], log: &mut Log, progress: &mut Progress<'_>) -> Result<bool> {
        let missing = places.iter().copied().filter(|&place| {
            let run = &self.source.listed[place];
            !self.done.contains(&run.key)
        });
        let missing = self.source.runs(&missing.collect::<Vec<_>>())?;
        let done = &mut self.done;
        self.doing.all(&missing, log, progress, |record: Record| {
            done.insert(record.key);
        })
    }

    /// Takes pieces as long as there are some; whether it was not interrupted.
    fn all_that_is_left(&mut self, out: &Path, log: &mut Log, progress: &mut Progress<'_>) -> Result<bool> {
        let pieces = self.source.pieces(self.source.listed.len().clamp(1, MOST_PIECES));
        let keys: Vec<&str> = self.source.listed.iter().map(|run| run.key.as_str()).collect();
        let folder = out.join(format!("work-{}", &sha256(keys.join("\n").as_bytes())[..12]));
        let cannot = |error: io::Error| cannot_write(&folder, &error);
        let who = format!("{}-{}", host(), std::process::id());
        let work = Work::open(&folder, pieces.len(), &who, PATIENCE).map_err(cannot)?;
        while !self.doing.is_cancelled() {
            let Some(piece) = work.take().map_err(cannot)? else {
                if work.is_going_on().map_err(cannot)? {
                    self.out.remark(
                        "note: the rest is with others; if one of them dies, the same command does what it had",
                    );
                }
                return Ok(true);
            };
            if piece.again {
                self.look()?;
            }
            if !self.some(pieces.get(piece.number).map_or(&[], Vec::as_slice), log, progress)? {
                return Ok(false);
            }
            piece.finish().map_err(cannot)?;
        }
        Ok(false)
    }
}

/// The logs in a folder.
pub(super) fn logs(folder: &Path) -> Result<Vec<PathBuf>> {
    let cannot = |error: io::Error| {
        Failure::input(format_args!("cannot read {}: {}", folder.display(), reason(&error)))
    };
    let mut logs = Vec::new();
    for entry in fs::read_dir(folder).map_err(cannot)? {
        let entry = entry.map_err(cannot)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with("runs") && name.ends_with(".jsonl") {
            logs.push(entry.path());
        }
    }
    logs.sort();
    Ok(logs)
}

/// A log that nobody has yet: several machines may share the folder, and names.
fn own_log(folder: &Path) -> Result<String> {
    for number in 0.. {
        let name = format!("runs-{}-{}-{number}.jsonl", host(), std::process::id());
        match fs::File::create_new(folder.join(&name)) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(cannot_write(&folder.join(name), &error)),
            Ok(_) => return Ok(name),
        }
    }
    Err(Failure::input("there is no name left for a log"))
}
