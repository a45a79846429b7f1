//! Which bound variables occur free in which terms.
//!
//! Variables that exactly the same quantifiers bind are one class; a term's free variables are an
//! interned set of classes. That is exact, and stays small: there are about as many classes as
//! nested quantifiers, however many variables each of them binds.

use rustc_hash::FxHashMap;

use crate::term::{Op, Term};
use crate::terms::{Terms, View};

/// An interned sorted set of classes.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Set(u32);

impl Set {
    pub(crate) const EMPTY: Set = Set(0);
}

/// The free variables of every node of an arena.
pub(crate) struct Free {
    /// Per node.
    sets: Vec<Set>,
    classes: FxHashMap<Term, u32>,
    interner: Interner,
}

struct Interner {
    sets: Vec<Box<[u32]>>,
    ids: FxHashMap<Box<[u32]>, Set>,
    unions: FxHashMap<(Set, Set), Set>,
}

impl Free {
    pub(crate) fn new(terms: &Terms) -> Free {
        let classes = classes(terms);
        let mut interner = Interner::new();
        let mut sets: Vec<Set> = Vec::with_capacity(terms.len());
        for t in terms.iter() {
            let set = match terms.view(t) {
                _ if !terms.is_quantified(t) => Set::EMPTY,
                View::Bound(..) => interner.intern(classes.get(&t).copied().into_iter().collect()),
                View::Forall(bound, body) => {
                    let bound: Vec<u32> = bound.iter().filter_map(|v| classes.get(v).copied()).collect();
                    let free = interner.get(sets[body.index()]);
                    let rest: Vec<u32> = free.iter().copied().filter(|c| !bound.contains(c)).collect();
                    interner.intern(rest)
                }
                _ => {
                    let children = terms.children(t).iter();
                    children.fold(Set::EMPTY, |set, child| interner.union(set, sets[child.index()]))
                }
            };
            sets.push(set);
        }
        Free { sets, classes, interner }
    }

    /// Whether no bound variable is free in the term.
    pub(crate) fn is_closed(&self, t: Term) -> bool {
        self.sets[t.index()] == Set::EMPTY
    }

    /// The classes of the variables that are free in the term.
    pub(crate) fn of(&self, t: Term) -> &[u32] {
        self.interner.get(self.sets[t.index()])
    }

    /// The classes of some variables, each once.
    pub(crate) fn classes_of(&self, variables: &[Term]) -> Vec<u32> {
        let mut classes: Vec<u32> = variables.iter().filter_map(|v| self.classes.get(v).copied()).collect();
        classes.sort_unstable();
        classes.dedup();
        classes
    }
}

/// Numbers the classes of variables in the order of their first variable.
fn classes(terms: &Terms) -> FxHashMap<Term, u32> {
    let mut binders: FxHashMap<Term, Vec<u32>> = FxHashMap::default();
    for t in terms.iter() {
        if let View::Forall(bound, _) = terms.view(t) {
            for &variable in bound {
                binders.entry(variable).or_default().push(t.index() as u32);
            }
        }
    }
    let mut numbers: FxHashMap<Vec<u32>, u32> = FxHashMap::default();
    let mut classes = FxHashMap::default();
    for t in terms.iter().filter(|&t| terms.op(t) == Op::Bound) {
        let next = numbers.len() as u32;
        let key = binders.remove(&t).unwrap_or_else(|| vec![t.index() as u32]);
        classes.insert(t, *numbers.entry(key).or_insert(next));
    }
    classes
}

impl Interner {
    fn new() -> Interner {
        let mut interner =
            Interner { sets: Vec::new(), ids: FxHashMap::default(), unions: FxHashMap::default() };
        interner.intern(Vec::new());
        interner
    }

    fn get(&self, set: Set) -> &[u32] {
        &self.sets[set.0 as usize]
    }

    fn intern(&mut self, classes: Vec<u32>) -> Set {
        let classes = classes.into_boxed_slice();
        if let Some(&set) = self.ids.get(&classes) {
            return set;
        }
        let set = Set(self.sets.len() as u32);
        self.sets.push(classes.clone());
        self.ids.insert(classes, set);
        set
    }

    fn union(&mut self, a: Set, b: Set) -> Set {
        if a == b || b == Set::EMPTY {
            return a;
        }
        if a == Set::EMPTY {
            return b;
        }
        if let Some(&set) = self.unions.get(&(a, b)) {
            return set;
        }
        let mut classes = [self.get(a), self.get(b)].concat();
        classes.sort_unstable();
        classes.dedup();
        let set = self.intern(classes);
        self.unions.insert((a, b), set);
        set
    }
}
