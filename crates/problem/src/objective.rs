//! HyperLTLf objectives, resolved and typed.

use crate::expr::PathLeaf;
use crate::formula::{Formula, Node};
use crate::ids::{PathId, SystemId};
use crate::names::names;
use crate::target::Target;
use hyperplan_syntax::Span;
use typed_index_collections::TiVec;

/// `exists` or `forall`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantifier {
    /// There is a path.
    Exists,
    /// For all paths.
    Forall,
}

impl Quantifier {
    /// The other one.
    #[must_use]
    pub fn dual(self) -> Self {
        match self {
            Quantifier::Exists => Quantifier::Forall,
            Quantifier::Forall => Quantifier::Exists,
        }
    }
}

/// A quantified path variable.
#[derive(Clone, Debug)]
pub struct PathVar {
    /// Its name.
    pub name: String,
    /// How it is quantified.
    pub quantifier: Quantifier,
    /// The system whose path it is.
    pub system: SystemId,
    /// Its place in the quantifier prefix.
    pub span: Span,
}

/// How operators are read (`design` of the language: "Objectives").
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Without `within`: paths are infinite, every operator is bounded.
    Bounded,
    /// `within K`: every path has exactly this many steps, whatever may follow; positions are `0..=K`.
    Within(u32),
}

/// How a path of K steps stands for the infinite ones that it begins (`within K semantics S`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Semantics {
    /// `pes`: nothing holds beyond K.
    Pessimistic,
    /// `opt`: everything holds beyond K.
    Optimistic,
    /// `hpes`: as `pes`, but the rest is known once every path has halted.
    HaltingPessimistic,
    /// `hopt`: as `opt`, but the rest is known once every path has halted.
    HaltingOptimistic,
}

names!(pub Semantics: Pessimistic "pes", Optimistic "opt", HaltingPessimistic "hpes", HaltingOptimistic "hopt");

/// An objective: a quantifier prefix and a formula.
#[derive(Clone, Debug)]
pub struct Objective {
    /// Its name.
    pub name: String,
    /// Path variables, outermost first; never empty.
    pub paths: TiVec<PathId, PathVar>,
    /// How operators are read.
    pub mode: Mode,
    /// What `semantics` says, under [`Mode::Within`] only.
    pub semantics: Option<Semantics>,
    /// The quantifier-free rest, to be read as the mode says: it was translated where there are other semantics.
    pub formula: Formula,
    /// What is to be as small as possible, what counts most first.
    pub minimize: Vec<Target>,
    /// Its declaration.
    pub span: Span,
}

impl Objective {
    /// The blocks of the quantifier prefix: its maximal runs of one quantifier, outermost first.
    #[must_use]
    pub fn blocks(&self) -> Vec<Vec<PathId>> {
        let paths: Vec<PathId> = self.paths.keys().collect();
        paths
            .chunk_by(|&a, &b| self.paths[a].quantifier == self.paths[b].quantifier)
            .map(<[PathId]>::to_vec)
            .collect()
    }

    /// The path variables of the leading block: those before the first change of quantifier.
    #[must_use]
    pub fn leading_block(&self) -> Vec<PathId> {
        self.blocks().into_iter().next().unwrap_or_default()
    }

    /// Whether the formula compares actions or states of some two paths.
    #[must_use]
    pub fn has_ties(&self) -> bool {
        let mut paths = self.paths.keys();
        paths.any(|path| !self.tied_before(path).is_empty() || !self.compared_before(path).is_empty())
    }

    /// Whether the formula ties two paths: it compares their actions or states.
    #[must_use]
    pub fn ties(&self, first: PathId, second: PathId) -> bool {
        [self.tied_before(second), self.compared_before(second)].iter().any(|ties| ties.contains(&first))
    }

    /// The paths quantified before this one whose actions the formula compares with its own.
    #[must_use]
    pub fn tied_before(&self, path: PathId) -> Vec<PathId> {
        self.partners(path, |leaf| match *leaf {
            PathLeaf::SameAction(p, q) => Some((p, q)),
            _ => None,
        })
    }

    /// The paths quantified before this one whose states the formula compares with its own.
    #[must_use]
    pub fn compared_before(&self, path: PathId) -> Vec<PathId> {
        self.partners(path, |leaf| match *leaf {
            PathLeaf::SameState(p, q) => Some((p, q)),
            _ => None,
        })
    }

    fn partners(&self, path: PathId, pair: impl Fn(&PathLeaf) -> Option<(PathId, PathId)>) -> Vec<PathId> {
        let mut partners = Vec::new();
        for node in &self.formula.nodes {
            let Node::Atom(expr) = node else { continue };
            expr.for_each_leaf(&mut |leaf| {
                if let Some((p, q)) = pair(leaf) {
                    let other = if p == path { q } else { p };
                    if (p == path || q == path) && other < path {
                        partners.push(other);
                    }
                }
            });
        }
        partners.sort_unstable();
        partners.dedup();
        partners
    }

    /// The path variable with that name.
    #[must_use]
    pub fn path(&self, name: &str) -> Option<PathId> {
        self.paths.iter_enumerated().find(|(_, p)| p.name == name).map(|(id, _)| id)
    }
}
