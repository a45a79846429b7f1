//! The arena of terms.

mod arith;
mod bitvec;
mod boolean;
mod enumeration;
mod function;
mod quantifier;
mod view;

use std::hash::{Hash, Hasher};

use hashbrown::HashTable;
use rustc_hash::{FxHashMap, FxHasher};

use crate::name;
use crate::rational::Rational;
use crate::term::{Function, Op, Sort, Stem, Term};
use crate::value::{Value, mask};

use function::Signature;
pub use view::View;

/// One node: its arguments are `args[start..]` up to the start of the next node.
#[derive(Clone, Copy)]
struct Node {
    sort: Sort,
    start: u32,
    op: Op,
    /// Whether a quantifier or a bound variable occurs in it.
    quantified: bool,
}

/// The nodes and their arguments, which lie in one piece.
#[derive(Default)]
struct Pool {
    nodes: Vec<Node>,
    args: Vec<Term>,
}

impl Pool {
    #[inline]
    fn args(&self, index: usize) -> &[Term] {
        let start = self.nodes[index].start as usize;
        let end = self.nodes.get(index + 1).map_or(self.args.len(), |next| next.start as usize);
        &self.args[start..end]
    }
}

/// An entry of the hash table: with its hash, so that the table grows without looking at nodes.
#[derive(Clone, Copy)]
struct Entry {
    hash: u32,
    index: u32,
}

impl Entry {
    /// The hash as the table wants it, which takes bits from both ends.
    #[inline]
    fn spread(self) -> u64 {
        u64::from(self.hash) << 32 | u64::from(self.hash)
    }
}

/// What an enumeration and its constructors are called.
struct EnumerationText {
    name: name::Mangled,
    constructors: Vec<name::Mangled>,
}

/// A hash-consed arena of sort-checked terms.
///
/// Children come before their parents, so that a pass over all terms is a loop over indices, and
/// nothing recurses. Building the same term twice gives the same handle.
///
/// The constructors simplify what they can see at once: constants, equal and complementary
/// arguments. They panic when the sorts do not fit or 2^31 nodes are exceeded: terms are built by
/// programs, and an ill-sorted one is an error in the program.
pub struct Terms {
    pool: Pool,
    table: HashTable<Entry>,
    stems: Vec<name::Mangled>,
    stem_ids: FxHashMap<Box<str>, Stem>,
    enumerations: Vec<EnumerationText>,
    functions: Vec<Signature>,
    function_ids: FxHashMap<Signature, Function>,
    scratch: Vec<Term>,
}

impl Default for Terms {
    fn default() -> Self {
        Terms::new()
    }
}

impl Terms {
    /// An arena that holds the constants true and false.
    #[must_use]
    pub fn new() -> Self {
        let mut terms = Terms {
            pool: Pool::default(),
            table: HashTable::new(),
            stems: Vec::new(),
            stem_ids: FxHashMap::default(),
            enumerations: Vec::new(),
            functions: Vec::new(),
            function_ids: FxHashMap::default(),
            scratch: Vec::new(),
        };
        let top = terms.intern(Op::True, Sort::Bool, &[]);
        debug_assert_eq!(top, Term::TRUE);
        terms
    }

    /// How many nodes there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.pool.nodes.len()
    }

    /// Never: the constants are always there.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }

    /// All nodes, children before parents, unnegated.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Term> + use<> {
        (0..self.pool.nodes.len()).map(Term::of_index)
    }

    /// Interns a stem.
    pub fn stem(&mut self, text: &str) -> Stem {
        if let Some(&stem) = self.stem_ids.get(text) {
            return stem;
        }
        let stem = Stem(u32::try_from(self.stems.len()).expect("fewer than 2^32 stems"));
        self.stems.push(name::Mangled::new(text));
        self.stem_ids.insert(text.into(), stem);
        stem
    }

    /// A stem of its own, whose symbol without a time is written exactly so.
    pub(crate) fn verbatim_stem(&mut self, name: &str) -> Stem {
        let stem = Stem(u32::try_from(self.stems.len()).expect("fewer than 2^32 stems"));
        self.stems.push(name::Mangled::verbatim(name));
        stem
    }

    pub(crate) fn mangled(&self, stem: Stem) -> &name::Mangled {
        &self.stems[stem.0 as usize]
    }

    /// The declared symbol of that stem, time and sort, printed `stem@time`. One stem and time
    /// should not be used with two sorts: SMT-LIB knows no overloading.
    pub fn symbol(&mut self, stem: Stem, time: Option<u32>, sort: Sort) -> Term {
        self.leaf(Op::Symbol, stem, time, sort)
    }

    /// A variable for quantifiers, distinct from every declared symbol, printed `?stem@time`.
    pub fn bound_symbol(&mut self, stem: Stem, time: Option<u32>, sort: Sort) -> Term {
        self.leaf(Op::Bound, stem, time, sort)
    }

    fn leaf(&mut self, op: Op, stem: Stem, time: Option<u32>, sort: Sort) -> Term {
        check_sort(sort);
        let time = time.map_or(0, |t| t.checked_add(1).expect("times are below 2^32 - 1"));
        self.intern(op, sort, &[Term(stem.0), Term(time)])
    }

    /// The constant of that value.
    pub fn constant(&mut self, value: Value) -> Term {
        match value {
            Value::Bool(b) => Term::from(b),
            Value::Bv { width, bits } => {
                let sort = Sort::BitVec(width);
                check_sort(sort);
                let words = words_of(bits & mask(width));
                self.intern(Op::Const, sort, &words[..width.div_ceil(32) as usize])
            }
            Value::Int(i) => self.intern(Op::Const, Sort::Int, &words_of(i as u128)),
            Value::Enum(enumeration, position) => {
                let sort = Sort::Enum(enumeration);
                assert!(position < self.constructors(enumeration), "{sort} has no constructor {position}");
                self.intern(Op::Const, sort, &[Term(position)])
            }
            Value::Real(r) => {
                let numerator = words_of(r.numerator() as u128);
                let denominator = words_of(r.denominator() as u128);
                self.intern(Op::Const, Sort::Real, &[numerator, denominator].concat())
            }
        }
    }

    /// The value of a constant; `None` if the term is none.
    #[must_use]
    pub fn value(&self, t: Term) -> Option<Value> {
        if t.is_const() {
            return Some(Value::Bool(t == Term::TRUE));
        }
        let node = self.pool.nodes[t.index()];
        if node.op != Op::Const {
            return None;
        }
        let words = self.raw_args(t.index());
        Some(match node.sort {
            Sort::Bool => Value::Bool(true),
            Sort::BitVec(width) => Value::Bv { width, bits: word(words) },
            Sort::Int => Value::Int(word(words) as i128),
            Sort::Enum(enumeration) => Value::Enum(enumeration, words[0].0),
            Sort::Real => {
                let (numerator, denominator) = words.split_at(4);
                let r = Rational::new(word(numerator) as i128, word(denominator) as i128);
                Value::Real(r.expect("stored in lowest terms"))
            }
        })
    }

    /// The sort of a term.
    #[inline]
    #[must_use]
    pub fn sort(&self, t: Term) -> Sort {
        self.pool.nodes[t.index()].sort
    }

    /// The operator of a term's node (the complement does not count).
    #[inline]
    #[must_use]
    pub fn op(&self, t: Term) -> Op {
        self.pool.nodes[t.index()].op
    }

    /// The terms that a node is built from; none for symbols and constants.
    #[inline]
    #[must_use]
    pub fn children(&self, t: Term) -> &[Term] {
        let args = self.raw_args(t.index());
        match self.op(t).payload() {
            None => &[],
            Some(payload) => &args[..args.len() - payload],
        }
    }

    /// Whether a bound variable or a quantifier occurs in the term.
    #[inline]
    #[must_use]
    pub fn is_quantified(&self, t: Term) -> bool {
        self.pool.nodes[t.index()].quantified
    }

    #[inline]
    fn raw_args(&self, index: usize) -> &[Term] {
        self.pool.args(index)
    }

    /// The node with that operator, sort and arguments, made if there is none yet.
    fn intern(&mut self, op: Op, sort: Sort, args: &[Term]) -> Term {
        let hash = hash_node(op, sort, args);
        let same = |entry: &Entry| {
            let node = &self.pool.nodes[entry.index as usize];
            entry.hash == hash
                && node.op == op
                && node.sort == sort
                && self.raw_args(entry.index as usize) == args
        };
        let mut entry = Entry { hash, index: 0 };
        if let Some(found) = self.table.find(entry.spread(), same) {
            return Term::of_index(found.index as usize);
        }
        let index = self.pool.nodes.len();
        assert!(index < 1 << 31, "more than 2^31 terms");
        let start = u32::try_from(self.pool.args.len()).expect("fewer than 2^32 term arguments");
        let terms = op.payload().map_or(0, |payload| args.len() - payload);
        let quantified = matches!(op, Op::Bound | Op::Forall)
            || args[..terms].iter().any(|&t| self.pool.nodes[t.index()].quantified);
        self.pool.nodes.push(Node { sort, start, op, quantified });
        self.pool.args.extend_from_slice(args);
        entry.index = index as u32;
        self.table.insert_unique(entry.spread(), entry, |entry| entry.spread());
        Term::of_index(index)
    }

    /// The operation on constants as a constant, if all arguments are and the result fits.
    fn fold(&mut self, op: Op, sort: Sort, args: &[Term], numbers: &[u32]) -> Option<Term> {
        let mut values = Vec::with_capacity(args.len());
        for &t in args {
            values.push(self.value(t)?);
        }
        let value = crate::apply::apply(op, sort, &values, numbers)?;
        Some(self.constant(value))
    }

    /// Panics unless both have one sort, and gives it.
    fn same_sort(&self, what: &str, a: Term, b: Term) -> Sort {
        let (sort, other) = (self.sort(a), self.sort(b));
        assert!(sort == other, "{what}: {sort} and {other}");
        sort
    }
}

fn check_sort(sort: Sort) {
    if let Sort::BitVec(width) = sort {
        assert!((1..=128).contains(&width), "bit-vectors have 1 to 128 bits, not {width}");
    }
}

#[inline]
fn hash_node(op: Op, sort: Sort, args: &[Term]) -> u32 {
    let mut hasher = FxHasher::default();
    hasher.write_u64((op as u64) << 32 | args.len() as u64);
    sort.hash(&mut hasher);
    for pair in args.chunks(2) {
        let high = pair.get(1).map_or(0, |t| t.0);
        hasher.write_u64(u64::from(pair[0].0) | u64::from(high) << 32);
    }
    // Mixed once more: the table takes bits from both ends of these.
    (hasher.finish().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as u32
}

/// A 128-bit number as argument words.
fn words_of(bits: u128) -> [Term; 4] {
    [0, 32, 64, 96].map(|shift| Term((bits >> shift) as u32))
}

fn word(words: &[Term]) -> u128 {
    words.iter().rev().fold(0, |bits, word| bits << 32 | u128::from(word.0))
}
