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
    /// How many classes there are.
    count: u32,
    interner: Interner,
}

struct Interner {
    sets: Vec<Box<[u32]>>,
    ids: FxHashMap<Box<[u32]>, Set>,
    unions: FxHashMap<(Set, Set), Set>,
}

impl Free {
    pub(crate) fn new(terms: &Terms) -> Free {
        let (mut sets, count) = classes(terms);
        let mut interner = Interner::new();
        for t in terms.iter() {
            sets[t.index()] = match terms.op(t) {
                _ if !terms.is_quantified(t) => Set::EMPTY,
                Op::Bound => interner.intern(&[sets[t.index()].0]),
                Op::Forall => {
                    let View::Forall(bound, body) = terms.view(t) else { continue };
                    let mut bound: Vec<Set> = bound.iter().map(|v| sets[v.index()]).collect();
                    bound.dedup();
                    let bound: Vec<u32> =
                        bound.into_iter().flat_map(|set| interner.get(set)).copied().collect();
                    let free = interner.get(sets[body.index()]);
                    let rest: Vec<u32> = free.iter().copied().filter(|c| !bound.contains(c)).collect();
                    interner.intern(&rest)
                }
                _ => {
                    let children = terms.children(t).iter();
                    children.fold(Set::EMPTY, |set, child| interner.union(set, sets[child.index()]))
                }
            };
        }
        Free { sets, count, interner }
    }

    /// Whether no bound variable is free in the term.
    pub(crate) fn is_closed(&self, t: Term) -> bool {
        self.sets[t.index()] == Set::EMPTY
    }

    /// The classes of the variables that are free in the term.
    pub(crate) fn of(&self, t: Term) -> &[u32] {
        self.interner.get(self.sets[t.index()])
    }

    /// How many classes there are.
    pub(crate) fn class_count(&self) -> usize {
        self.count as usize
    }

    /// The classes of some variables, each once, sorted.
    pub(crate) fn classes_of(&self, variables: &[Term]) -> Vec<u32> {
        let mut sets: Vec<Set> = variables.iter().map(|v| self.sets[v.index()]).collect();
        sets.dedup();
        let mut classes: Vec<u32> =
            sets.into_iter().flat_map(|set| self.interner.get(set)).copied().collect();
        classes.sort_unstable();
        classes.dedup();
        classes
    }
}

/// Per bound variable the number of its class, and how many classes there are. Each quantifier splits the classes of
/// its variables.
fn classes(terms: &Terms) -> (Vec<Set>, u32) {
    let mut classes = vec![Set::EMPTY; terms.len()];
    let mut count = 1;
    let mut split: FxHashMap<Set, Set> = FxHashMap::default();
    for t in terms.iter() {
        let View::Forall(bound, _) = terms.view(t) else { continue };
        split.clear();
        for &variable in bound {
            let class = &mut classes[variable.index()];
            *class = *split.entry(*class).or_insert_with(|| {
                count += 1;
                Set(count - 1)
            });
        }
    }
    (classes, count)
}

impl Interner {
    fn new() -> Interner {
        let mut interner =
            Interner { sets: Vec::new(), ids: FxHashMap::default(), unions: FxHashMap::default() };
        interner.intern(&[]);
        interner
    }

    fn get(&self, set: Set) -> &[u32] {
        &self.sets[set.0 as usize]
    }

    fn intern(&mut self, classes: &[u32]) -> Set {
        if let Some(&set) = self.ids.get(classes) {
            return set;
        }
        let set = Set(self.sets.len() as u32);
        self.sets.push(classes.into());
        self.ids.insert(classes.into(), set);
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
        let set = self.intern(&classes);
        self.unions.insert((a, b), set);
        set
    }
}
