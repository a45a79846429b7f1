//! The semantics by the book: all paths enumerated, formulas evaluated recursively.

use super::build::F;
use hyperplan_problem::Mode;
use hyperplan_syntax::ast::BinaryOp;

/// States and actions; the action at position t is the one that led there.
pub(crate) type Path = Vec<(i64, Option<u32>)>;

pub(crate) struct Naive<'a> {
    pub(crate) states: i64,
    pub(crate) edges: &'a [(i64, u32, i64)],
    pub(crate) init: &'a [i64],
    pub(crate) mode: Mode,
    /// Bounded: at least as far as the formula looks.
    pub(crate) steps: u32,
}

impl Naive<'_> {
    fn live(&self, state: i64) -> bool {
        let mut reached = vec![state];
        for _ in 0..self.states {
            reached = self.edges.iter().filter(|e| reached.contains(&e.0)).map(|e| e.2).collect();
            reached.sort_unstable();
            reached.dedup();
        }
        !reached.is_empty()
    }

    pub(crate) fn paths(&self) -> Vec<Path> {
        let mut paths: Vec<Path> = self.init.iter().map(|&s| vec![(s, None)]).collect();
        for _ in 0..self.steps {
            let longer = paths.iter().flat_map(|path| {
                let last = path[path.len() - 1].0;
                self.edges.iter().filter(move |e| e.0 == last).map(|e| {
                    let mut path = path.clone();
                    path.push((e.2, Some(e.1)));
                    path
                })
            });
            paths = longer.collect();
            paths.sort_unstable();
            paths.dedup();
        }
        if self.mode == Mode::Bounded {
            paths.retain(|p| self.live(p[p.len() - 1].0));
        }
        paths
    }

    pub(crate) fn holds(&self, prefix: &str, chosen: &[&Path], f: &F) -> bool {
        let Some(quantifier) = prefix.chars().next() else { return self.eval(f, chosen, 0) };
        let paths = self.paths();
        let rest = |path: &Path| {
            let mut chosen = chosen.to_vec();
            chosen.push(path);
            self.holds(&prefix[1..], &chosen, f)
        };
        if quantifier == 'e' { paths.iter().any(rest) } else { paths.iter().all(rest) }
    }

    fn eval(&self, f: &F, paths: &[&Path], t: u32) -> bool {
        let now = |p: &u32| paths[*p as usize][t as usize];
        let last = self.steps;
        let window = |lo: u32, hi: Option<u32>| (t + lo)..=hi.map_or(last, |hi| t + hi);
        let exists = |j: u32| {
            assert!(self.mode != Mode::Bounded || j <= last, "the test enumerates too short paths");
            j <= last
        };
        let until = |lo, hi, a: &F, b: &F| {
            let reached =
                |j: u32| exists(j) && self.eval(b, paths, j) && (t..j).all(|i| self.eval(a, paths, i));
            window(lo, hi).any(reached)
        };
        match f {
            F::At(p, n) => now(p).0 == *n,
            F::Took(p, a) => now(p).1 == Some(*a),
            F::SameAction(p, q) => now(p).1 == now(q).1,
            F::SameState(p, q) => now(p).0 == now(q).0,
            F::Enabled(p, a) => self.edges.iter().any(|e| e.0 == now(p).0 && e.1 == *a),
            F::Not(a) => !self.eval(a, paths, t),
            F::And(fs) => fs.iter().all(|a| self.eval(a, paths, t)),
            F::Or(fs) => fs.iter().any(|a| self.eval(a, paths, t)),
            F::Implies(a, b) => !self.eval(a, paths, t) || self.eval(b, paths, t),
            F::Iff(a, b) => self.eval(a, paths, t) == self.eval(b, paths, t),
            F::X(a) => exists(t + 1) && self.eval(a, paths, t + 1),
            F::N(a) => !exists(t + 1) || self.eval(a, paths, t + 1),
            F::Fin(lo, hi, a) => window(*lo, *hi).any(|j| exists(j) && self.eval(a, paths, j)),
            F::Glob(lo, hi, a) => window(*lo, *hi).all(|j| !exists(j) || self.eval(a, paths, j)),
            F::Bin(BinaryOp::Until, lo, hi, a, b) => until(*lo, *hi, a, b),
            F::Bin(BinaryOp::Release, lo, hi, a, b) => {
                let (a, b) = (F::Not(a.clone()), F::Not(b.clone()));
                !until(*lo, *hi, &a, &b)
            }
            F::Bin(BinaryOp::StrongRelease, lo, hi, a, b) => window(*lo, *hi)
                .any(|j| exists(j) && self.eval(a, paths, j) && (t..=j).all(|i| self.eval(b, paths, i))),
            F::Bin(BinaryOp::WeakUntil, lo, hi, a, b) => {
                until(*lo, *hi, a, b) || window(0, *hi).all(|j| !exists(j) || self.eval(a, paths, j))
            }
        }
    }
}
