//! Truth values of all atoms at one position.

use crate::residual::AtomId;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// An interned valuation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct ValuationId(pub(crate) u32);

impl ValuationId {
    /// No atom is true, none is unknown: neutral for [`Valuations::join`].
    pub(crate) const EMPTY: ValuationId = ValuationId(0);
}

const TRUE: u64 = 1;
const UNKNOWN: u64 = 2;
const ATOMS_PER_WORD: usize = 32;

/// Two bits an atom: whether it is true, whether its value is unknown because a trace has ended.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Valuation(Rc<[u64]>);

impl Valuation {
    /// The value of an atom.
    pub(crate) fn get(&self, atom: AtomId) -> Option<bool> {
        let index = usize::from(atom);
        let bits = self.0[index / ATOMS_PER_WORD] >> (2 * (index % ATOMS_PER_WORD));
        if bits & UNKNOWN != 0 { None } else { Some(bits & TRUE != 0) }
    }
}

/// All valuations met. Parts that concern different atoms are interned apart and joined.
#[derive(Debug)]
pub(crate) struct Valuations {
    words: usize,
    all: Vec<Valuation>,
    index: FxHashMap<Valuation, ValuationId>,
    joined: FxHashMap<(ValuationId, ValuationId), ValuationId>,
    scratch: Vec<u64>,
}

impl Valuations {
    /// For so many atoms.
    pub(crate) fn new(atoms: usize) -> Self {
        let words = atoms.div_ceil(ATOMS_PER_WORD);
        let empty = Valuation(vec![0; words].into());
        Valuations {
            words,
            all: vec![empty.clone()],
            index: FxHashMap::from_iter([(empty, ValuationId::EMPTY)]),
            joined: FxHashMap::default(),
            scratch: Vec::new(),
        }
    }

    /// The valuation itself.
    pub(crate) fn get(&self, id: ValuationId) -> Valuation {
        self.all[id.0 as usize].clone()
    }

    /// The valuation with these values and no others.
    pub(crate) fn part(&mut self, values: impl Iterator<Item = (AtomId, Option<bool>)>) -> ValuationId {
        let mut words = std::mem::take(&mut self.scratch);
        words.clear();
        words.resize(self.words, 0);
        for (atom, value) in values {
            let bits = match value {
                Some(true) => TRUE,
                Some(false) => 0,
                None => UNKNOWN,
            };
            let index = usize::from(atom);
            words[index / ATOMS_PER_WORD] |= bits << (2 * (index % ATOMS_PER_WORD));
        }
        let id = self.intern(&words);
        self.scratch = words;
        id
    }

    /// Two parts as one.
    pub(crate) fn join(&mut self, a: ValuationId, b: ValuationId) -> ValuationId {
        if a == ValuationId::EMPTY || a == b {
            return b;
        }
        if b == ValuationId::EMPTY {
            return a;
        }
        if let Some(&known) = self.joined.get(&(a, b)) {
            return known;
        }
        let words: Vec<u64> = self.get(a).0.iter().zip(self.get(b).0.iter()).map(|(a, b)| a | b).collect();
        let id = self.intern(&words);
        self.joined.insert((a, b), id);
        id
    }

    fn intern(&mut self, words: &[u64]) -> ValuationId {
        let valuation = Valuation(words.into());
        if let Some(&id) = self.index.get(&valuation) {
            return id;
        }
        // One valuation for each set of moves at most, which the budget bounds.
        let id = ValuationId(u32::try_from(self.all.len()).unwrap_or(u32::MAX));
        self.all.push(valuation.clone());
        self.index.insert(valuation, id);
        id
    }
}
