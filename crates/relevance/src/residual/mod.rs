//! What of a formula one path alone still has to meet: the formula in negation normal form, weakened and progressed.
//!
//! Atoms that are not known (they read another path that is not fixed) are replaced by `true` in either polarity,
//! which weakens the formula. A path along which the weakened formula becomes `false` can therefore satisfy the
//! formula together with no choice of the other paths. `reach` uses this to prune.

mod obligation;

pub(crate) use obligation::Settling;

use crate::goal::Goal;
use hyperplan_problem::{Formula, FormulaId, Interval, Node};
use rustc_hash::FxHashMap;
use typed_index_collections::TiVec;

/// A hash-consed residual.
pub type Residual = u32;

/// Nothing more is asked.
pub const TRUE: Residual = 0;
/// What was asked can no longer be met.
pub const FALSE: Residual = 1;

/// An atom's truth value now is a bit of a word, so at most this many atoms are tracked; more count as unknown.
pub const MAX_ATOMS: usize = 64;

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Shape {
    True,
    False,
    Literal {
        bit: u8,
        positive: bool,
    },
    And(Box<[Residual]>),
    Or(Box<[Residual]>),
    /// `strong`: false at the last position of a finite trace; else true there.
    Next {
        strong: bool,
        then: Residual,
    },
    Until(Interval, Residual, Residual),
    Release(Interval, Residual, Residual),
}

/// The atoms' values at one position.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Now {
    /// One bit an atom.
    pub bits: u64,
    /// Atoms whose value is not known: their literals count as true.
    pub unknown: u64,
    /// Whether this is the last position of a finite trace.
    pub last: bool,
}

/// All residuals of one formula.
#[derive(Clone, Debug)]
pub struct Residuals {
    shapes: Vec<Shape>,
    /// Of each shape: whether it can still be met, and whether it owes nothing, as far as the settling atoms tell.
    /// Parts stand before what has them, so it is found when a shape is made, once.
    outlooks: Vec<(bool, bool)>,
    settling: Settling,
    index: FxHashMap<Shape, Residual>,
    steps: FxHashMap<(Residual, Now), Residual>,
    reads: FxHashMap<Residual, u64>,
}

impl Residuals {
    /// The weakened goal. `bit` numbers the known atoms.
    pub fn new(
        formula: &Formula,
        goal: &Goal,
        bit: &dyn Fn(FormulaId) -> Option<u8>,
    ) -> (Residuals, Residual) {
        Residuals::settling(formula, goal, Settling::default(), bit)
    }

    /// The same, where some of the known atoms settle.
    pub(crate) fn settling(
        formula: &Formula,
        goal: &Goal,
        settling: Settling,
        bit: &dyn Fn(FormulaId) -> Option<u8>,
    ) -> (Residuals, Residual) {
        let mut all = Residuals {
            shapes: vec![Shape::True, Shape::False],
            outlooks: vec![(true, true), (false, false)],
            settling,
            index: FxHashMap::default(),
            steps: FxHashMap::default(),
            reads: FxHashMap::default(),
        };
        let mut both: TiVec<FormulaId, [Residual; 2]> = TiVec::new();
        for (id, node) in formula.nodes.iter_enumerated() {
            let pair = [false, true].map(|want| all.convert(id, node, want, &both, bit));
            both.push(pair);
        }
        let parts = goal.parts.iter().map(|&(id, want)| both[id][usize::from(want)]).collect();
        let root = all.join(goal.all, parts);
        (all, root)
    }

    /// Number of residuals made so far.
    pub fn count(&self) -> usize {
        self.shapes.len()
    }

    fn convert(
        &mut self,
        id: FormulaId,
        node: &Node,
        want: bool,
        both: &TiVec<FormulaId, [Residual; 2]>,
        bit: &dyn Fn(FormulaId) -> Option<u8>,
    ) -> Residual {
        let of = |id: &FormulaId, want: bool| both[*id][usize::from(want)];
        let many = |ids: &[FormulaId]| ids.iter().map(|id| of(id, want)).collect::<Vec<_>>();
        match node {
            Node::Atom(e) if e.is_true() || e.is_false() => {
                if e.is_true() == want {
                    TRUE
                } else {
                    FALSE
                }
            }
            Node::Atom(_) => match bit(id) {
                Some(bit) => self.intern(Shape::Literal { bit, positive: want }),
                None => TRUE,
            },
            Node::Not(a) => of(a, !want),
            Node::And(ids) | Node::Or(ids) => {
                let parts = many(ids);
                self.join(matches!(node, Node::And(_)) == want, parts)
            }
            Node::Iff(a, b) => {
                let left = self.join(true, vec![of(a, true), of(b, want)]);
                let right = self.join(true, vec![of(a, false), of(b, !want)]);
                self.join(false, vec![left, right])
            }
            Node::Next(a) => self.next(want, of(a, want)),
            Node::WeakNext(a) => self.next(!want, of(a, want)),
            Node::Until(interval, a, b) => self.temporal(want, *interval, of(a, want), of(b, want)),
            Node::Release(interval, a, b) => self.temporal(!want, *interval, of(a, want), of(b, want)),
        }
    }

    fn intern(&mut self, shape: Shape) -> Residual {
        if let Some(&known) = self.index.get(&shape) {
            return known;
        }
        let id = self.shapes.len() as Residual;
        self.outlooks.push(self.outlook(&shape));
        self.shapes.push(shape.clone());
        self.index.insert(shape, id);
        id
    }

    fn next(&mut self, strong: bool, then: Residual) -> Residual {
        // A weak next of true and a strong next of false are decided; the others still depend on the trace's end.
        match (strong, then) {
            (false, TRUE) => TRUE,
            (true, FALSE) => FALSE,
            _ => self.intern(Shape::Next { strong, then }),
        }
    }

    /// `left U right` or `left R right`.
    fn temporal(&mut self, until: bool, interval: Interval, left: Residual, right: Residual) -> Residual {
        match (until, right) {
            (true, FALSE) => FALSE,
            (false, TRUE) => TRUE,
            (true, TRUE) if interval.lo == 0 => TRUE,
            (false, FALSE) if interval.lo == 0 => FALSE,
            (true, _) => self.intern(Shape::Until(interval, left, right)),
            (false, _) => self.intern(Shape::Release(interval, left, right)),
        }
    }

    /// A conjunction (`and`) or disjunction.
    fn join(&mut self, and: bool, parts: Vec<Residual>) -> Residual {
        let (neutral, absorbing) = if and { (TRUE, FALSE) } else { (FALSE, TRUE) };
        let mut flat = Vec::with_capacity(parts.len());
        for part in parts {
            match &self.shapes[part as usize] {
                Shape::And(inner) if and => flat.extend_from_slice(inner),
                Shape::Or(inner) if !and => flat.extend_from_slice(inner),
                _ => flat.push(part),
            }
        }
        flat.retain(|&part| part != neutral);
        flat.sort_unstable();
        flat.dedup();
        if flat.contains(&absorbing) {
            return absorbing;
        }
        self.subsume(and, &mut flat);
        match flat.as_slice() {
            [] => neutral,
            [only] => *only,
            _ if and => self.intern(Shape::And(flat.into())),
            _ => self.intern(Shape::Or(flat.into())),
        }
    }

    /// Drops parts that others imply: of the same operator with the same operands, an `U` with a longer interval is weaker, an
    /// `R` with a longer one stronger. A goal that is asked for again each time that something happens, as in
    /// `F[0,5] (a & F[0,5] b)`, would else leave a part for every time.
    fn subsume(&self, and: bool, parts: &mut Vec<Residual>) {
        let timed = |part: &Residual| match self.shapes[*part as usize] {
            Shape::Until(Interval { lo, hi }, left, right) => Some(((true, lo, left, right), hi)),
            Shape::Release(Interval { lo, hi }, left, right) => Some(((false, lo, left, right), hi)),
            _ => None,
        };
        let length = |hi: Option<u32>| hi.map_or(u64::MAX, u64::from);
        // A conjunction keeps the strongest, a disjunction the weakest.
        let wants_longer = |until: bool| until != and;
        let mut kept: FxHashMap<_, Option<u32>> = FxHashMap::default();
        for (key, hi) in parts.iter().filter_map(timed) {
            let best = kept.entry(key).or_insert(hi);
            if (length(hi) > length(*best)) == wants_longer(key.0) {
                *best = hi;
            }
        }
        parts.retain(|part| timed(part).is_none_or(|(key, hi)| kept.get(&key) == Some(&hi)));
    }

    /// The atoms that a residual reads, now or later, one bit each.
    pub fn looks_at(&mut self, residual: Residual) -> u64 {
        if let Some(&known) = self.reads.get(&residual) {
            return known;
        }
        let parts: Vec<Residual> = match &self.shapes[residual as usize] {
            Shape::True | Shape::False | Shape::Literal { .. } => Vec::new(),
            Shape::And(parts) | Shape::Or(parts) => parts.to_vec(),
            Shape::Next { then, .. } => vec![*then],
            Shape::Until(_, left, right) | Shape::Release(_, left, right) => vec![*left, *right],
        };
        let own = match self.shapes[residual as usize] {
            Shape::Literal { bit, .. } => 1 << bit,
            _ => 0,
        };
        let reads = parts.into_iter().fold(own, |all, part| all | self.looks_at(part));
        self.reads.insert(residual, reads);
        reads
    }

    /// What is left for the next position once the atoms have these values now; at the last position of a finite
    /// trace, `TRUE` or `FALSE`. Recursion is bounded by the nesting of the formula.
    pub fn progress(&mut self, residual: Residual, now: Now) -> Residual {
        if residual <= FALSE {
            return residual;
        }
        if let Some(&known) = self.steps.get(&(residual, now)) {
            return known;
        }
        let result = match self.shapes[residual as usize].clone() {
            Shape::True => TRUE,
            Shape::False => FALSE,
            Shape::Literal { bit, positive } => {
                if now.unknown >> bit & 1 == 1 || (now.bits >> bit & 1 == 1) == positive {
                    TRUE
                } else {
                    FALSE
                }
            }
            Shape::And(parts) => self.progress_all(true, &parts, now),
            Shape::Or(parts) => self.progress_all(false, &parts, now),
            Shape::Next { strong, then } => match (now.last, strong) {
                (false, _) => then,
                (true, true) => FALSE,
                (true, false) => TRUE,
            },
            Shape::Until(interval, left, right) => self.unfold(true, interval, left, right, now),
            Shape::Release(interval, left, right) => self.unfold(false, interval, left, right, now),
        };
        self.steps.insert((residual, now), result);
        result
    }

    fn progress_all(&mut self, and: bool, parts: &[Residual], now: Now) -> Residual {
        let parts = parts.iter().map(|&part| self.progress(part, now)).collect();
        self.join(and, parts)
    }

    /// `U[0,b]` is `right | left & X U[0,b-1]`, `U[a,b]` is `left & X U[a-1,b-1]`; `R` is the dual, with `N`.
    fn unfold(
        &mut self,
        until: bool,
        interval: Interval,
        left: Residual,
        right: Residual,
        now: Now,
    ) -> Residual {
        let stay = self.progress(left, now);
        let end = if until { FALSE } else { TRUE };
        let later = match interval {
            _ if now.last => end,
            Interval { hi: Some(0), .. } => end,
            Interval { lo, hi } => {
                let rest = Interval { lo: lo.saturating_sub(1), hi: hi.map(|h| h - 1) };
                self.temporal(until, rest, left, right)
            }
        };
        let wait = self.join(until, vec![stay, later]);
        if interval.lo > 0 {
            return wait;
        }
        let release = self.progress(right, now);
        self.join(!until, vec![release, wait])
    }
}
