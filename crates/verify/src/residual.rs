//! Residual formulas: hash-consed, in negation normal form, normalized as they are built.

use hyperplan_problem::Mode;
use rustc_hash::FxHashMap;
use std::rc::Rc;
use typed_index_collections::TiVec;

id! {
    /// A residual. Operands have smaller ids than what is built from them.
    ResidualId, "entries, and so residuals, are kept below 2^32"
}

id! {
    /// An elementary proposition of the objective.
    AtomId, "fewer atoms than bytes of the problem file"
}

/// `&` or `|`; also the family of an operator, by what its unrolling begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Connective {
    And,
    Or,
}

impl Connective {
    pub(crate) fn dual(self) -> Self {
        match self {
            Connective::And => Connective::Or,
            Connective::Or => Connective::And,
        }
    }

    /// What it gives without operands.
    fn neutral(self) -> ResidualId {
        match self {
            Connective::And => ResidualId::TRUE,
            Connective::Or => ResidualId::FALSE,
        }
    }
}

/// The form of a residual, read at the next position of the paths.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Residual {
    /// One of [`ResidualId::FALSE`], [`ResidualId::TRUE`], [`ResidualId::MISSING`], [`ResidualId::START`].
    Constant(u8),
    /// An atom or its negation.
    Literal { atom: AtomId, positive: bool },
    /// At least two operands, sorted.
    Connected(Connective, Rc<[ResidualId]>),
    /// `Or`: strong next; `And`: weak next.
    Next(Connective, ResidualId),
    /// `Or`: `lhs U[lo,hi] rhs`; `And`: `lhs R[lo,hi] rhs`.
    Temporal(Connective, Bounds, ResidualId, ResidualId),
}

/// The interval of a temporal operator, from the next position.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Bounds {
    pub(crate) lo: u32,
    pub(crate) hi: Option<u32>,
}

impl Bounds {
    /// The interval seen from one position later; it must not end now.
    pub(crate) fn later(self) -> Self {
        Bounds { lo: self.lo.saturating_sub(1), hi: self.hi.map(|hi| hi.saturating_sub(1)) }
    }

    fn longer_than(self, other: Bounds) -> bool {
        match (self.hi, other.hi) {
            (None, _) => true,
            (Some(_), None) => false,
            (Some(a), Some(b)) => a >= b,
        }
    }
}

impl ResidualId {
    pub(crate) const FALSE: ResidualId = ResidualId(0);
    pub(crate) const TRUE: ResidualId = ResidualId(1);
    /// What a trace that has ended would have said.
    pub(crate) const MISSING: ResidualId = ResidualId(2);
    /// Names no residual: values of the search use it for "nothing read yet".
    pub(crate) const START: ResidualId = ResidualId(3);
}

/// All residuals met.
#[derive(Debug)]
pub(crate) struct Residuals {
    nodes: TiVec<ResidualId, Residual>,
    index: FxHashMap<Residual, ResidualId>,
    endless: bool,
}

impl Residuals {
    /// Only the constants.
    pub(crate) fn new(mode: Mode) -> Self {
        let nodes = (0..4).map(Residual::Constant).collect();
        Residuals { nodes, index: FxHashMap::default(), endless: mode == Mode::Bounded }
    }

    /// The form of a residual.
    pub(crate) fn get(&self, id: ResidualId) -> &Residual {
        &self.nodes[id]
    }

    /// Number of residuals.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    fn intern(&mut self, node: Residual) -> ResidualId {
        if let Some(&id) = self.index.get(&node) {
            return id;
        }
        let id = self.nodes.push_and_get_key(node.clone());
        self.index.insert(node, id);
        id
    }

    /// An atom or its negation.
    pub(crate) fn literal(&mut self, atom: AtomId, positive: bool) -> ResidualId {
        self.intern(Residual::Literal { atom, positive })
    }

    /// Strong (`Or`) or weak (`And`) next. On endless paths they are the same.
    pub(crate) fn next(&mut self, kind: Connective, operand: ResidualId) -> ResidualId {
        if operand == kind.neutral() || (self.endless && operand == kind.dual().neutral()) {
            return operand;
        }
        self.intern(Residual::Next(if self.endless { Connective::Or } else { kind }, operand))
    }

    /// `lhs U[lo,hi] rhs` (`Or`) or `lhs R[lo,hi] rhs` (`And`). The simplifications hold on finite paths too,
    /// where only the present position is sure to exist.
    pub(crate) fn temporal(
        &mut self,
        kind: Connective,
        bounds: Bounds,
        lhs: ResidualId,
        rhs: ResidualId,
    ) -> ResidualId {
        let decided_now = bounds.lo == 0;
        if rhs == kind.neutral() || (decided_now && rhs == kind.dual().neutral()) {
            return rhs;
        }
        if decided_now && (lhs == kind.neutral() || bounds.hi == Some(0)) {
            return rhs;
        }
        if lhs == kind.neutral() {
            return lhs;
        }
        self.intern(Residual::Temporal(kind, bounds, lhs, rhs))
    }

    /// Conjunction or disjunction: flat, sorted, without repetition, neutral or absorbed operands.
    pub(crate) fn connect(
        &mut self,
        kind: Connective,
        operands: impl IntoIterator<Item = ResidualId>,
    ) -> ResidualId {
        let mut flat = Vec::new();
        for id in operands {
            match self.get(id) {
                // Operands of a flat node are flat.
                Residual::Connected(k, inner) if *k == kind => flat.extend_from_slice(inner),
                _ => flat.push(id),
            }
        }
        let decisive = kind.dual().neutral();
        flat.retain(|&id| id != kind.neutral());
        flat.sort_unstable();
        flat.dedup();
        if flat.contains(&decisive) || self.has_complement(&flat) {
            return decisive;
        }
        if flat.len() > 1 {
            self.drop_implied(kind, &mut flat);
            let present = flat.clone();
            flat.retain(|&id| !self.absorbed(kind, id, &present));
        }
        match flat.as_slice() {
            [] => kind.neutral(),
            [one] => *one,
            _ => self.intern(Residual::Connected(kind, flat.into())),
        }
    }

    fn has_complement(&self, sorted: &[ResidualId]) -> bool {
        sorted.iter().any(|&id| match self.get(id) {
            Residual::Literal { atom, positive: true } => self
                .index
                .get(&Residual::Literal { atom: *atom, positive: false })
                .is_some_and(|not| sorted.binary_search(not).is_ok()),
            _ => false,
        })
    }

    /// `a & (a | b)` is `a`; dually.
    fn absorbed(&self, kind: Connective, id: ResidualId, present: &[ResidualId]) -> bool {
        match self.get(id) {
            Residual::Connected(k, inner) if *k == kind.dual() => {
                inner.iter().any(|i| present.binary_search(i).is_ok())
            }
            _ => false,
        }
    }

    /// Operators that differ in their last step only: the longer U follows from the shorter, the shorter R from the
    /// longer. A conjunction keeps what implies, a disjunction what is implied.
    fn drop_implied(&self, kind: Connective, flat: &mut Vec<ResidualId>) {
        let mut best: FxHashMap<(Connective, u32, ResidualId, ResidualId), (Bounds, ResidualId)> =
            FxHashMap::default();
        let temporal = |id: ResidualId| match self.get(id) {
            Residual::Temporal(k, bounds, lhs, rhs) => Some(((*k, bounds.lo, *lhs, *rhs), *bounds)),
            _ => None,
        };
        for &id in flat.iter() {
            let Some((key, bounds)) = temporal(id) else { continue };
            // A disjunction of U wants the longest, as does a conjunction of R.
            let longest = key.0 == kind;
            let entry = best.entry(key).or_insert((bounds, id));
            if bounds.longer_than(entry.0) == longest {
                *entry = (bounds, id);
            }
        }
        flat.retain(|&id| temporal(id).is_none_or(|(key, _)| best.get(&key).is_some_and(|b| b.1 == id)));
    }
}
