//! HyperLTLf objectives, resolved and typed.

use crate::formula::Formula;
use crate::ids::{PathId, SystemId};
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

impl Semantics {
    /// All of them.
    pub const ALL: [Semantics; 4] = [
        Semantics::Pessimistic,
        Semantics::Optimistic,
        Semantics::HaltingPessimistic,
        Semantics::HaltingOptimistic,
    ];

    /// Its name in problem files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Semantics::Pessimistic => "pes",
            Semantics::Optimistic => "opt",
            Semantics::HaltingPessimistic => "hpes",
            Semantics::HaltingOptimistic => "hopt",
        }
    }

    /// The one with that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Semantics> {
        Semantics::ALL.into_iter().find(|s| s.name() == name)
    }
}

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
    /// Its declaration.
    pub span: Span,
}

impl Objective {
    /// The path variables of the leading block: those before the first change of quantifier.
    #[must_use]
    pub fn leading_block(&self) -> Vec<PathId> {
        let first = self.paths.first().map(|p| p.quantifier);
        self.paths
            .iter_enumerated()
            .take_while(|(_, p)| Some(p.quantifier) == first)
            .map(|(id, _)| id)
            .collect()
    }

    /// The path variable with that name.
    #[must_use]
    pub fn path(&self, name: &str) -> Option<PathId> {
        self.paths.iter_enumerated().find(|(_, p)| p.name == name).map(|(id, _)| id)
    }
}
