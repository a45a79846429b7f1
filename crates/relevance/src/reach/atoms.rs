//! The atoms of a formula on the states and moves of explored paths.

use super::question::{Place, Question};
use crate::reads::in_state;
use crate::residual::{MAX_ATOMS, Settling};
use hyperplan_problem::{ActionId, Comparison, Expr, FormulaId, Node, PathId, PathLeaf};
use hyperplan_space::{Graph, StateIx, eval};
use rustc_hash::FxHashMap;

/// The values of atoms, one bit each; what is neither known nor set counts as false.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Bits {
    /// The atoms that hold.
    pub(crate) holds: u64,
    /// The atoms of which nothing is known.
    pub(crate) unknown: u64,
}

/// The atoms of which something is known, each with its bit.
pub(crate) struct Atoms<'a, const N: usize> {
    pub(crate) bit: FxHashMap<FormulaId, u8>,
    /// Those that depend on the state of one explored path only, by path.
    of_state: [Vec<(u8, &'a Expr<PathLeaf>)>; N],
    /// Those that read the actions of explored paths, several of them, or fixed ones beside them.
    of_step: Vec<(u8, OfStep<'a>)>,
    /// `of_state` by state, computed when asked.
    by_state: [Vec<Option<u64>>; N],
    /// Those that read no explored path, by time.
    background: Vec<Bits>,
    pub(crate) settling: Settling,
}

/// An atom on a joint move.
enum OfStep<'a> {
    SameAction(usize, usize),
    SameState(usize, usize),
    Took(usize, ActionId),
    /// A comparison of one path's state with another's, each side by state.
    Compare(Comparison, (usize, Vec<i64>), (usize, Vec<i64>)),
    Other(&'a Expr<PathLeaf>),
}

impl<'a, const N: usize> Atoms<'a, N> {
    pub(crate) fn new(question: &Question<'a, N>, graphs: [&Graph; N], horizon: u32) -> Self {
        let mut atoms = Atoms {
            bit: FxHashMap::default(),
            of_state: std::array::from_fn(|_| Vec::new()),
            of_step: Vec::new(),
            by_state: graphs.map(|graph| vec![None; graph.len()]),
            background: vec![Bits::default(); horizon as usize + 1],
            settling: Settling::default(),
        };
        let mut behind = Vec::new();
        for (id, node) in question.arena.task.objective.formula.nodes.iter_enumerated() {
            let Node::Atom(expr) = node else { continue };
            if atoms.bit.len() >= MAX_ATOMS {
                break;
            }
            let bit = atoms.bit.len() as u8;
            match classify(question, expr) {
                Reads::Unknown => continue,
                Reads::State(at) => {
                    atoms.of_state[at].push((bit, expr));
                    atoms.settling.own |= 1 << bit;
                }
                Reads::Moves => {
                    atoms.of_step.push((bit, OfStep::new(question, &graphs, expr)));
                    atoms.settling.own |= 1 << bit;
                }
                Reads::MovesAndFixed => atoms.of_step.push((bit, OfStep::Other(expr))),
                Reads::Background => behind.push((bit, expr)),
            }
            atoms.bit.insert(id, bit);
        }
        for (bit, expr) in behind {
            let values = along(question, expr);
            for (time, bits) in atoms.background.iter_mut().enumerate() {
                let value = values.get(time).copied().flatten();
                bits.holds |= u64::from(value == Some(true)) << bit;
                bits.unknown |= u64::from(value.is_none()) << bit;
            }
            settle(&mut atoms.settling, bit, &values);
        }
        atoms
    }

    /// The values where the paths enter these places at a time.
    pub(crate) fn bits(
        &mut self,
        question: &Question<'a, N>,
        graphs: &[&Graph; N],
        places: &[Place; N],
        time: u32,
    ) -> Bits {
        let mut all = self.background.get(time as usize).copied().unwrap_or_default();
        for (bit, atom) in &self.of_step {
            all.holds |= u64::from(atom.holds(question, graphs, places, time)) << bit;
        }
        all.holds |= self.of_states(question, graphs, places);
        all
    }

    /// The values of the atoms that depend on the explored paths' states and moves alone; nothing is known of the
    /// others.
    pub(crate) fn own_bits(
        &mut self,
        question: &Question<'a, N>,
        graphs: &[&Graph; N],
        places: &[Place; N],
    ) -> Bits {
        let own = self.settling.own;
        let mut all = Bits { holds: 0, unknown: !own };
        for (bit, atom) in self.of_step.iter().filter(|(bit, _)| own >> bit & 1 == 1) {
            all.holds |= u64::from(atom.holds(question, graphs, places, 0)) << bit;
        }
        all.holds |= self.of_states(question, graphs, places);
        all
    }

    fn of_states(&mut self, question: &Question<'a, N>, graphs: &[&Graph; N], places: &[Place; N]) -> u64 {
        let mut all = 0;
        for (at, &(state, _)) in places.iter().enumerate() {
            let of_state = &self.of_state[at];
            all |= *self.by_state[at][state as usize].get_or_insert_with(|| {
                of_state.iter().fold(0u64, |word, (bit, expr)| {
                    word | u64::from(holds(question, graphs, expr, places, 0)) << bit
                })
            });
        }
        all
    }
}

impl<'a> OfStep<'a> {
    fn new<const N: usize>(
        question: &Question<'a, N>,
        graphs: &[&Graph; N],
        expr: &'a Expr<PathLeaf>,
    ) -> Self {
        let at = |path: PathId| question.paths.iter().position(|&q| q == path);
        let side = |expr: &'a Expr<PathLeaf>| match classify(question, expr) {
            Reads::State(at) => {
                let states = 0..graphs[at].len() as StateIx;
                let place = |state| std::array::from_fn(|_| (state, None));
                let values = states
                    .map(|state| eval(expr, &mut |leaf| value(question, graphs, leaf, &place(state), 0)));
                Some((at, values.collect()))
            }
            _ => None,
        };
        let compare =
            |op, a: &'a Expr<PathLeaf>, b: &'a Expr<PathLeaf>| Some(OfStep::Compare(op, side(a)?, side(b)?));
        let fast = match expr {
            Expr::Leaf(PathLeaf::SameAction(p, q)) => {
                at(*p).zip(at(*q)).map(|(p, q)| OfStep::SameAction(p, q))
            }
            Expr::Leaf(PathLeaf::SameState(p, q)) => at(*p).zip(at(*q)).map(|(p, q)| OfStep::SameState(p, q)),
            Expr::Leaf(PathLeaf::Took(p, action)) => at(*p).map(|p| OfStep::Took(p, *action)),
            Expr::Compare(op, a, b) => compare(*op, a, b),
            Expr::Iff(a, b) => compare(Comparison::Eq, a, b),
            _ => None,
        };
        fast.unwrap_or(OfStep::Other(expr))
    }

    fn holds<const N: usize>(
        &self,
        question: &Question<'_, N>,
        graphs: &[&Graph; N],
        places: &[Place; N],
        time: u32,
    ) -> bool {
        match self {
            OfStep::SameAction(p, q) => places[*p].1 == places[*q].1,
            OfStep::SameState(p, q) => places[*p].0 == places[*q].0,
            OfStep::Took(p, action) => places[*p].1 == Some(*action),
            OfStep::Compare(op, (p, left), (q, right)) => {
                let (a, b) = (left[places[*p].0 as usize], right[places[*q].0 as usize]);
                match op {
                    Comparison::Eq => a == b,
                    Comparison::Lt => a < b,
                    Comparison::Le => a <= b,
                }
            }
            OfStep::Other(expr) => holds(question, graphs, expr, places, time),
        }
    }
}

enum Reads {
    /// A path of which nothing is known, or too much at once.
    Unknown,
    /// Only the state of this explored path.
    State(usize),
    /// Explored paths only.
    Moves,
    /// Explored paths and fixed ones.
    MovesAndFixed,
    /// Fixed paths only, or the state of one path of which is known where it can be.
    Background,
}

fn classify<const N: usize>(question: &Question<'_, N>, expr: &Expr<PathLeaf>) -> Reads {
    let explored = |p: PathId| question.paths.iter().position(|&q| q == p);
    let fixed = |p: PathId| question.fixed[usize::from(p)].is_some();
    let mut paths = Vec::new();
    let mut only_state = true;
    expr.for_each_leaf(&mut |leaf| {
        paths.extend(leaf.paths().into_iter().flatten());
        only_state &= matches!(leaf, PathLeaf::State(..) | PathLeaf::Enabled(..) | PathLeaf::Halted(_));
    });
    paths.sort_unstable();
    paths.dedup();
    match paths.as_slice() {
        // An atom that reads no path is a constant, which nothing is gained by knowing.
        [] => Reads::Unknown,
        [path] if only_state && explored(*path).is_some() => {
            explored(*path).map_or(Reads::Unknown, Reads::State)
        }
        paths if paths.iter().all(|&p| explored(p).is_some()) => Reads::Moves,
        paths if paths.iter().all(|&p| fixed(p)) => Reads::Background,
        [path] if only_state && question.declared.contains_key(path) => Reads::Background,
        paths if paths.iter().all(|&p| explored(p).is_some() || fixed(p)) => Reads::MovesAndFixed,
        _ => Reads::Unknown,
    }
}

/// The value of a background atom at each time at which it can be read, where it is the same wherever its path can
/// be.
fn along<const N: usize>(question: &Question<'_, N>, expr: &Expr<PathLeaf>) -> Vec<Option<bool>> {
    let mut declared = None;
    expr.for_each_leaf(&mut |leaf| {
        let mut paths = leaf.paths().into_iter().flatten();
        declared = declared.or_else(|| paths.find(|&p| question.fixed[usize::from(p)].is_none()));
    });
    let Some(path) = declared else {
        let question = question.about([]);
        let at = |time| Some(holds(&question, &[], expr, &[], time));
        return (0..=paths_end(&question, expr)).map(at).collect();
    };
    let Some(layers) = question.declared.get(&path) else { return Vec::new() };
    let graph = &question.arena.graphs[path];
    let question = question.about([path]);
    let mut truth: Vec<Option<bool>> = vec![None; graph.len()];
    let mut holds = |state: StateIx| {
        *truth[state as usize].get_or_insert_with(|| holds(&question, &[&**graph], expr, &[(state, None)], 0))
    };
    let same = |states: &Vec<StateIx>| {
        let first = holds(*states.first()?);
        states.iter().all(|&state| holds(state) == first).then_some(first)
    };
    layers.at.iter().map(same).collect()
}

/// The last time at which all the fixed paths of an atom are there.
fn paths_end<const N: usize>(question: &Question<'_, N>, expr: &Expr<PathLeaf>) -> u32 {
    let mut last = u32::MAX;
    expr.for_each_leaf(&mut |leaf| {
        for path in leaf.paths().into_iter().flatten() {
            let end = question.fixed[usize::from(path)].as_ref().map_or(0, |fixed| fixed.actions.len());
            last = last.min(end as u32);
        }
    });
    last
}

/// Notes from when on an atom keeps its value, up to the last time at which it can be read.
fn settle(settling: &mut Settling, bit: u8, values: &[Option<bool>]) {
    let Some(Some(last)) = values.last() else { return };
    let from = values.iter().rposition(|&value| value != Some(*last)).map_or(0, |at| at + 1);
    settling.known |= 1 << bit;
    settling.bits |= u64::from(*last) << bit;
    settling.from = Some(settling.from.unwrap_or(0).max(from as u32));
}

/// Whether an atom whose paths are all known holds. A fixed path is read only within its trace: beyond it the
/// formula does not read it, and the value given does not matter.
fn holds<const N: usize>(
    question: &Question<'_, N>,
    graphs: &[&Graph; N],
    expr: &Expr<PathLeaf>,
    places: &[Place; N],
    time: u32,
) -> bool {
    eval(expr, &mut |leaf| value(question, graphs, leaf, places, time)) != 0
}

fn value<const N: usize>(
    question: &Question<'_, N>,
    graphs: &[&Graph; N],
    leaf: &PathLeaf,
    places: &[Place; N],
    time: u32,
) -> i64 {
    let place = |p: PathId| -> Option<(&Graph, StateIx, Option<ActionId>)> {
        if let Some(at) = question.paths.iter().position(|&q| q == p) {
            return Some((graphs[at], places[at].0, places[at].1));
        }
        let fixed = question.fixed[usize::from(p)].as_ref()?;
        let time = time as usize;
        let taken = time.checked_sub(1).and_then(|before| fixed.actions.get(before)).copied();
        Some((&fixed.graph, *fixed.states.get(time)?, taken))
    };
    match *leaf {
        PathLeaf::State(p, _) | PathLeaf::Enabled(p, _) | PathLeaf::Halted(p) => {
            let system = question.arena.task.system(p);
            place(p).and_then(|(graph, state, _)| in_state(system, graph, leaf, state)).unwrap_or(0)
        }
        PathLeaf::Took(p, wanted) => i64::from(place(p).is_some_and(|(_, _, taken)| taken == Some(wanted))),
        PathLeaf::SameAction(p, q) => i64::from(place(p).map(|x| x.2) == place(q).map(|x| x.2)),
        PathLeaf::SameState(p, q) => i64::from(place(p).map(|x| x.1) == place(q).map(|x| x.1)),
    }
}
