//! Steps of a refutation, as they come from a SAT solver, and those that are needed.

use rustc_hash::FxHashMap;
use std::io::{self, BufWriter, Write};

/// So many literals and hints are kept, in numbers of 32 bits.
const MOST: usize = 1 << 28;

/// A clause that was given, or a step: by its number, from 0 on.
#[derive(Clone, Copy)]
enum Source {
    Given(u32),
    Step(u32),
}

/// Clauses that follow from those before them.
#[derive(Default)]
pub(super) struct Trace {
    /// What clauses are by the solver's numbers.
    sources: FxHashMap<i64, Source>,
    given: u32,
    /// Literals of all steps, and then hints: a clause that was given as its number, from 1 on, a step as its own, from -1
    /// downwards.
    numbers: Vec<i32>,
    /// Where the literals and hints of each step start.
    starts: Vec<(usize, usize)>,
    /// The step with the empty clause.
    end: Option<u32>,
    /// An empty clause was given.
    is_broken: bool,
}

impl Trace {
    /// Whether there is no room for more.
    pub(super) fn is_full(&self) -> bool {
        self.numbers.len() > MOST
    }

    pub(super) fn given(&mut self, id: i64) {
        self.sources.insert(id, Source::Given(self.given));
        self.given += 1;
    }

    /// A clause that follows from others; or one that `follows` not, but changes nothing.
    pub(super) fn derived(&mut self, id: i64, clause: &[i32], antecedents: &[i64], follows: bool) {
        let step = u32::try_from(self.starts.len()).unwrap_or(u32::MAX);
        self.is_broken |= !follows;
        let start = self.numbers.len();
        self.numbers.extend_from_slice(clause);
        self.starts.push((start, self.numbers.len()));
        for antecedent in antecedents {
            // Numbers are below 2^28: each has a place in the list.
            match self.sources.get(antecedent) {
                Some(Source::Given(number)) => self.numbers.push(*number as i32 + 1),
                Some(Source::Step(number)) => self.numbers.push(-(*number as i32) - 1),
                None => self.is_broken = true,
            }
        }
        self.sources.insert(id, Source::Step(step));
        if clause.is_empty() && self.end.is_none() {
            self.end = Some(step);
        }
    }

    fn hints(&self, step: usize) -> &[i32] {
        let end = self.starts.get(step + 1).map_or(self.numbers.len(), |next| next.0);
        &self.numbers[self.starts[step].1..end]
    }

    /// Writes the steps that lead to the empty clause, and when one is needed no more.
    pub(super) fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        if self.is_broken {
            return Err(io::Error::other("the SAT solver took a step that does not follow"));
        }
        // An empty clause that was given needs no step.
        let Some(end) = self.end.map(|end| end as usize) else { return Ok(()) };
        let mut last: Vec<Option<usize>> = vec![None; end + 1];
        last[end] = Some(end);
        for step in (0..=end).rev() {
            if last[step].is_some() {
                for before in steps(self.hints(step)) {
                    last[before].get_or_insert(step);
                }
            }
        }
        let mut to = BufWriter::new(to);
        let mut numbers = vec![0_u64; end + 1];
        let mut next = u64::from(self.given);
        for step in 0..=end {
            if last[step].is_none() {
                continue;
            }
            next += 1;
            numbers[step] = next;
            write!(to, "{next}")?;
            let (start, middle) = self.starts[step];
            for literal in &self.numbers[start..middle] {
                write!(to, " {literal}")?;
            }
            write!(to, " 0")?;
            for &hint in self.hints(step) {
                match usize::try_from(hint) {
                    Ok(given) => write!(to, " {given}")?,
                    Err(_) => write!(to, " {}", numbers[hint.unsigned_abs() as usize - 1])?,
                }
            }
            writeln!(to, " 0")?;
            let mut done: Vec<u64> =
                steps(self.hints(step)).filter(|s| last[*s] == Some(step)).map(|s| numbers[s]).collect();
            done.sort_unstable();
            done.dedup();
            if !done.is_empty() && step < end {
                write!(to, "{next} d")?;
                for number in done {
                    write!(to, " {number}")?;
                }
                writeln!(to, " 0")?;
            }
        }
        to.flush()
    }
}

/// The steps among hints.
fn steps(hints: &[i32]) -> impl Iterator<Item = usize> + '_ {
    hints.iter().filter(|hint| **hint < 0).map(|hint| hint.unsigned_abs() as usize - 1)
}
