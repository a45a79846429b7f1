//! Scores of contestants: how many instances they solved, and how fast.
//!
//! Each contestant has one run per instance, the median of its repetitions (see [`crate::contest::Cell`]). What a
//! contestant does not support is not counted. Instances on which answers contradict each other, and of which nothing
//! tells who is right, are left out, as in the rules of SMT-COMP; there only if solvers are involved that are right
//! wherever the status is known.

use std::cmp::Ordering;

use serde::Serialize;

use crate::contest::{Cell, Contest, allowed};
use crate::{Answer, RunStatus};

/// SMT-COMP's parallel score: fewer errors, then more correct answers, then less wall time, then less CPU time, both of
/// the instances that were solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Parallel {
    /// Instances with a wrong answer.
    pub errors: usize,
    /// Instances with a correct answer.
    pub correct: usize,
    /// Wall time of these, in seconds.
    pub wall_s: f64,
    /// CPU time of these, in seconds.
    pub cpu_s: f64,
}

/// SMT-COMP's sequential score: the same, of what needed no more CPU time than it was allowed wall time, compared by CPU
/// time alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Sequential {
    /// Instances with a wrong answer.
    pub errors: usize,
    /// Instances with a correct answer.
    pub correct: usize,
    /// CPU time of these, in seconds.
    pub cpu_s: f64,
}

/// How a contestant did.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Score {
    /// Its name.
    pub contestant: String,
    /// Instances that count: run, supported, and not in dispute.
    pub counted: usize,
    /// Of these, solved.
    pub solved: usize,
    /// Solved, satisfiable.
    pub sat: usize,
    /// Solved, unsatisfiable.
    pub unsat: usize,
    /// The solver gave up.
    pub unknown: usize,
    /// Out of time.
    pub timeout: usize,
    /// Out of memory.
    pub memout: usize,
    /// Failed otherwise.
    pub error: usize,
    /// Answered wrongly, or with a witness that fails.
    pub wrong: usize,
    /// Not supported; not among those that count.
    pub unsupported: usize,
    /// The mean over what counts of the wall time in seconds, twice the limit for what was not solved.
    pub par2: f64,
    /// Instances that no other contestant solved.
    pub unique: usize,
    /// Instances that this contestant's solver alone solved, in whatever configuration; credited to each that did.
    pub unique_solver: usize,
    /// Instances on which none was faster.
    pub fastest: usize,
    /// SMT-COMP's parallel score.
    pub parallel: Parallel,
    /// SMT-COMP's sequential score.
    pub sequential: Sequential,
    /// The place by the parallel score, from 1; shared by equals.
    pub rank: usize,
    /// The place by the sequential score.
    pub sequential_rank: usize,
}

/// The scores of a contest.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scores {
    /// By contestant, in the contest's order.
    pub scores: Vec<Score>,
    /// The virtual best solver: on each instance, the fastest that solved it.
    pub best: Score,
    /// Instances left out since answers to them contradict each other.
    pub disputed: usize,
    /// Runs of one contestant on one instance, at most.
    pub repetitions: usize,
}

impl Scores {
    /// Without contestants of which nothing counts, who would have a place before those that were wrong.
    pub fn of_counted(mut self) -> Self {
        self.scores.retain(|score| score.counted > 0);
        rank(&mut self.scores);
        self
    }

    /// The contestants, best first: by SMT-COMP's parallel score, then in the contest's order.
    pub fn order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.scores.len()).collect();
        order.sort_by_key(|&i| self.scores[i].rank);
        order
    }
}

impl Parallel {
    /// Better is less.
    pub fn compare(&self, other: &Self) -> Ordering {
        (self.errors.cmp(&other.errors))
            .then(other.correct.cmp(&self.correct))
            .then(self.wall_s.total_cmp(&other.wall_s))
            .then(self.cpu_s.total_cmp(&other.cpu_s))
    }
}

impl Sequential {
    /// Better is less.
    pub fn compare(&self, other: &Self) -> Ordering {
        (self.errors.cmp(&other.errors))
            .then(other.correct.cmp(&self.correct))
            .then(self.cpu_s.total_cmp(&other.cpu_s))
    }
}

/// The scores over the instances that are wanted, all or a family.
pub fn scores(contest: &Contest<'_>, wanted: impl Fn(usize) -> bool) -> Scores {
    let wanted: Vec<usize> = (0..contest.instances.len()).filter(|&i| wanted(i)).collect();
    let counted: Vec<usize> = wanted.iter().copied().filter(|&i| !contest.disputed[i]).collect();
    let longest = contest.longest();
    let mut found: Vec<Score> = contest
        .contestants
        .iter()
        .enumerate()
        .map(|(c, contestant)| {
            let cells = counted.iter().filter_map(|&i| contest.cells[i][c].as_ref());
            Score { contestant: contestant.label.clone(), ..score(cells, longest) }
        })
        .collect();
    wins(contest, &counted, &mut found);
    let best = counted.iter().filter_map(|&i| best(&contest.cells[i]));
    let best = Score { contestant: "virtual best".to_owned(), ..score(best, longest) };
    rank(&mut found);
    let runs = wanted.iter().flat_map(|&i| &contest.cells[i]).flatten().map(|cell| cell.runs.len());
    Scores {
        scores: found,
        best,
        disputed: wanted.len() - counted.len(),
        repetitions: runs.max().unwrap_or(0),
    }
}

fn score<'a: 'b, 'b>(cells: impl Iterator<Item = &'b Cell<'a>>, longest: f64) -> Score {
    let mut score = Score::default();
    for cell in cells {
        let run = cell.median;
        if !cell.counts() {
            score.unsupported += 1;
            continue;
        }
        score.counted += 1;
        if let Some(answer) = cell.solved() {
            score.solved += 1;
            match answer {
                Answer::Sat => score.sat += 1,
                Answer::Unsat => score.unsat += 1,
            }
            score.par2 += run.wall_s;
            score.parallel.correct += 1;
            score.parallel.wall_s += run.wall_s;
            score.parallel.cpu_s += run.cpu_s;
        } else {
            score.par2 += 2.0 * allowed(run).unwrap_or(longest);
            match run.status {
                _ if cell.wrong => score.wrong += 1,
                RunStatus::Unknown => score.unknown += 1,
                RunStatus::Timeout => score.timeout += 1,
                RunStatus::Memout => score.memout += 1,
                RunStatus::Sat | RunStatus::Unsat | RunStatus::Error | RunStatus::Unsupported => {
                    score.error += 1
                }
            }
        }
        // The virtual limit: a solver should not gain from using several processors.
        if allowed(run).is_none_or(|limit| run.cpu_s <= limit) {
            score.sequential.errors += usize::from(cell.wrong);
            if cell.solved().is_some() {
                score.sequential.correct += 1;
                score.sequential.cpu_s += run.cpu_s;
            }
        }
    }
    score.parallel.errors = score.wrong;
    if score.counted > 0 {
        #[expect(clippy::cast_precision_loss, reason = "nobody runs 2^52 instances")]
        let counted = score.counted as f64;
        score.par2 /= counted;
    }
    score
}

/// The cell of the fastest that solved the instance; where none did, of any for which it counts and that was not wrong.
fn best<'a, 'b>(row: &'b [Option<Cell<'a>>]) -> Option<&'b Cell<'a>> {
    let key = |cell: &Cell<'_>| (cell.solved().is_none(), cell.median.wall_s);
    row.iter().flatten().filter(|cell| cell.counts() && !cell.wrong).min_by(|a, b| {
        let (a, b) = (key(a), key(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    })
}

fn wins(contest: &Contest<'_>, counted: &[usize], scores: &mut [Score]) {
    for &i in counted {
        let row = &contest.cells[i];
        let solved = |c: &usize| row[*c].as_ref().is_some_and(|cell| cell.solved().is_some());
        let winners: Vec<usize> = (0..row.len()).filter(solved).collect();
        let wall = |c: usize| row[c].as_ref().map_or(f64::INFINITY, |cell| cell.median.wall_s);
        let fastest = winners.iter().map(|&c| wall(c)).fold(f64::INFINITY, f64::min);
        let solver = |c: usize| contest.contestants[c].solver;
        let alone = winners.iter().all(|&c| solver(c) == solver(winners[0]));
        for &c in &winners {
            scores[c].unique += usize::from(winners.len() == 1);
            scores[c].unique_solver += usize::from(alone);
            scores[c].fastest += usize::from(wall(c) <= fastest);
        }
    }
}

fn rank(scores: &mut [Score]) {
    let parallel: Vec<Parallel> = scores.iter().map(|score| score.parallel).collect();
    let sequential: Vec<Sequential> = scores.iter().map(|score| score.sequential).collect();
    for score in scores {
        score.rank = 1 + parallel.iter().filter(|other| other.compare(&score.parallel).is_lt()).count();
        score.sequential_rank =
            1 + sequential.iter().filter(|other| other.compare(&score.sequential).is_lt()).count();
    }
}
