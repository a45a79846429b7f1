//! What a script needs of a solver, and the logic that says so.

use crate::script::Script;
use crate::term::{Op, Sort, Term};
use crate::terms::Terms;

/// What occurs in terms.
#[derive(Copy, Clone, PartialEq, Eq, Debug, Default)]
pub struct Features {
    /// A quantifier.
    pub quantifiers: bool,
    /// A Boolean symbol or bound variable.
    pub booleans: bool,
    /// A term of a bit-vector sort.
    pub bitvec: bool,
    /// A term of sort Int.
    pub int: bool,
    /// A term of sort Real.
    pub real: bool,
    /// A term of an enumeration.
    pub datatypes: bool,
    /// A declared function with arguments.
    pub functions: bool,
}

impl Features {
    /// What the assertions of a script need.
    #[must_use]
    pub fn of(script: &Script) -> Features {
        let mut features = Features::default();
        for t in script.used_terms() {
            features.add(&script.terms, t);
        }
        features
    }

    /// Adds what one node needs, its children apart.
    pub fn add(&mut self, terms: &Terms, t: Term) {
        let op = terms.op(t);
        self.quantifiers |= op == Op::Forall;
        self.functions |= op == Op::Apply;
        match terms.sort(t) {
            Sort::Bool if !matches!(op, Op::Symbol | Op::Bound | Op::Apply) => {}
            sort => self.add_sort(sort),
        }
    }

    /// Adds what a symbol of that sort needs.
    pub fn add_sort(&mut self, sort: Sort) {
        match sort {
            Sort::Bool => self.booleans = true,
            Sort::BitVec(_) => self.bitvec = true,
            Sort::Int => self.int = true,
            Sort::Real => self.real = true,
            Sort::Enum(_) => self.datatypes = true,
        }
    }

    /// With the enumerations of the arena, whether they occur or not: for a dialogue in which they may yet.
    #[must_use]
    pub fn beside(self, terms: &Terms) -> Features {
        Features { datatypes: self.datatypes || terms.has_enumerations(), ..self }
    }

    /// Both.
    #[must_use]
    pub fn union(self, other: Features) -> Features {
        Features {
            quantifiers: self.quantifiers | other.quantifiers,
            booleans: self.booleans | other.booleans,
            bitvec: self.bitvec | other.bitvec,
            int: self.int | other.int,
            real: self.real | other.real,
            datatypes: self.datatypes | other.datatypes,
            functions: self.functions | other.functions,
        }
    }
}

/// The smallest logic for those features. Mixtures of bit-vectors, numbers and enumerations, of which none is written, get
/// `ALL`.
#[must_use]
pub fn logic(features: &Features) -> &'static str {
    let Features { quantifiers, booleans: _, bitvec, int, real, datatypes, functions } = *features;
    // Without quantifiers and functions, with either, with both.
    let [plain, quantified, applied, both] = match (datatypes, bitvec, int, real) {
        (false, false, false, false) => ["QF_UF", "UF", "QF_UF", "UF"],
        (false, true, false, false) => ["QF_BV", "BV", "QF_UFBV", "UFBV"],
        (false, false, true, false) => ["QF_LIA", "LIA", "QF_UFLIA", "UFLIA"],
        (false, false, false, true) => ["QF_LRA", "LRA", "QF_UFLRA", "UFLRA"],
        (false, false, true, true) => ["QF_LIRA", "LIRA", "QF_UFLIRA", "UFLIRA"],
        (true, false, false, false) => ["QF_DT", "UFDT", "QF_UFDT", "UFDT"],
        (true, ..) | (false, true, ..) => return "ALL",
    };
    match (quantifiers, functions) {
        (false, false) => plain,
        (true, false) => quantified,
        (false, true) => applied,
        (true, true) => both,
    }
}
