//! Discrete transition systems (the paper's Definition 1, with initial states and nondeterminism).

use crate::edges::Edges;
use crate::expr::{Expr, Leaf, State, StepLeaf, TransLeaf, Type, Value};
use crate::ids::{ActionId, AttributeId, CostId, LabelId, SystemId, VarId};
use crate::place::Place;
use crate::strategy::Trace;
use hyperplan_syntax::Span;
use std::sync::Arc;
use typed_index_collections::TiVec;

/// A transition system, symbolically.
///
/// A state gives each variable a value of its type. In a state where [`System::absorb`] holds, every action of the
/// system leads back to that state and nowhere else. In any other state `s`, a clause that lists action `a` and
/// whose guard holds in `s` gives transitions `s -a-> s'`: one for each combination of the values that its updates
/// allow, all expressions read in `s`, variables without an update unchanged; a combination in which some value is
/// outside its variable's type is no transition. [`System::edges`] are further transitions of such states. Of all these
/// only those are transitions for which [`System::trans`] holds. Two ways to the same `s'` with the same action are one
/// transition.
///
/// Each [`Also`] that lists `a` and whose guard holds in `s` makes its updates too, whatever clause or edge gives the
/// transition: as if they stood in it. What a transition itself changes, and what another such clause does, none of
/// them does.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// Its name.
    pub name: String,
    /// State variables.
    pub vars: TiVec<VarId, Var>,
    /// Its actions, in order of declaration; never empty.
    pub actions: Vec<ActionId>,
    /// Transition clauses.
    pub clauses: Vec<Clause>,
    /// What transitions do besides.
    pub also: Vec<Also>,
    /// Transitions that are listed one by one, for graphs.
    pub edges: Option<Edges>,
    /// What holds of every step but those of absorbing states: other transitions are none.
    pub trans: Expr<TransLeaf>,
    /// Initial states.
    pub init: Expr<Leaf>,
    /// What steps cost.
    pub costs: TiVec<CostId, Cost>,
    /// The system of the file, where this is that system with costs added up.
    pub base: Option<SystemId>,
    /// Labels; a label's expression reads only labels before it.
    pub labels: TiVec<LabelId, Label>,
    /// Where every action changes nothing.
    pub absorb: Expr<Leaf>,
    /// What `obs` sees.
    pub observe: Vec<Expr<Leaf>>,
    /// How to draw it, for maps.
    pub map: Option<Map>,
    /// Where each value of the variable of [`System::edges`] lies in the plane, if a graph says so of all.
    pub coordinates: Option<Arc<[(f64, f64)]>>,
    /// Its declaration.
    pub span: Span,
}

/// A state variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Var {
    /// Its name.
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// The cost that it adds up, where the file does not declare it.
    pub sums: Option<CostId>,
    /// Its declaration.
    pub span: Span,
}

/// `cost NAME = EXPR;`
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// Its name.
    pub name: String,
    /// What a step costs that does not start where [`System::absorb`] holds; those cost nothing. Never negative.
    pub expr: Expr<StepLeaf>,
    /// No step costs more.
    pub most: i64,
    /// Its declaration.
    pub span: Span,
}

/// A named set of states; or, where it is no truth value, a name for something that depends on the state.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Its name.
    pub name: String,
    /// Where it holds, or what it is.
    pub expr: Expr<Leaf>,
    /// Its type, with the bounds that its value cannot leave.
    pub ty: Type,
    /// Whether it reads other labels.
    pub nested: bool,
    /// Its declaration.
    pub span: Span,
}

/// What labels are found to be in one state. Labels that read labels may share them, and may be in long chains: so each of
/// those is found once, and none within another.
#[derive(Clone, Debug)]
pub struct LabelMemo<V>(Vec<Option<V>>);

impl<V> Default for LabelMemo<V> {
    fn default() -> Self {
        LabelMemo(Vec::new())
    }
}

impl<V: Clone> LabelMemo<V> {
    /// What a label is: as found before, or by `find` of its expression, which gets the memo with all that the expression
    /// reads.
    pub fn find(
        &mut self,
        system: &System,
        label: LabelId,
        find: &mut dyn FnMut(&Expr<Leaf>, &Self) -> V,
    ) -> V {
        if let Some(found) = self.known(label) {
            return found;
        }
        if system.labels[label].nested {
            for below in system.labels_below(label) {
                if self.known(below).is_none() {
                    let found = find(&system.labels[below].expr, self);
                    self.keep(below, found);
                }
            }
        }
        // What is read only once or twice and reads no label, nearly all, is not worth the room.
        find(&system.labels[label].expr, self)
    }

    /// What was found of a label.
    #[must_use]
    pub fn known(&self, label: LabelId) -> Option<V> {
        self.0.get(usize::from(label)).cloned().flatten()
    }

    fn keep(&mut self, label: LabelId, found: V) {
        let at = usize::from(label);
        if self.0.len() <= at {
            self.0.resize(at + 1, None);
        }
        self.0[at] = Some(found);
    }
}

/// `on ACTIONS when GUARD { UPDATES }`
#[derive(Clone, Debug, PartialEq)]
pub struct Clause {
    /// The actions concerned, without repetition.
    pub actions: Vec<ActionId>,
    /// Where it is enabled.
    pub guard: Expr<Leaf>,
    /// At most one update a variable.
    pub updates: Vec<(VarId, Update)>,
    /// Its place; for a map's moves, the map's declaration.
    pub span: Span,
    /// Whether a map's rules made it, not the user.
    pub generated: bool,
}

/// `also on ACTIONS when GUARD { UPDATES }`
#[derive(Clone, Debug, PartialEq)]
pub struct Also {
    /// The actions concerned, sorted.
    pub actions: Vec<ActionId>,
    /// Where it applies.
    pub guard: Expr<Leaf>,
    /// At most one update a variable.
    pub updates: Vec<(VarId, Update<StepLeaf>)>,
    /// Its place.
    pub span: Span,
}

/// What becomes of a variable; expressions read the state before.
#[derive(Clone, Debug, PartialEq)]
pub enum Update<L = Leaf> {
    /// `v' = E`
    Assign(Expr<L>),
    /// `v' in {E, ...}`; never empty
    OneOf(Vec<Expr<L>>),
    /// `v' in LO..HI`: every number of the variable's type between the two, both included; none where the first
    /// is greater.
    Within(Expr<L>, Expr<L>),
    /// `v' in if C then SET else SET`: what stands beside the first condition that holds, or the last. No
    /// [`Update::Assign`] stands inside.
    If(Vec<(Expr<L>, Update<L>)>, Box<Update<L>>),
}

impl<L> Update<L> {
    /// Its expressions, conditions too.
    #[must_use]
    pub fn exprs(&self) -> Vec<&Expr<L>> {
        match self {
            Update::Assign(e) => vec![e],
            Update::OneOf(es) => es.iter().collect(),
            Update::Within(lo, hi) => vec![lo, hi],
            Update::If(branches, last) => {
                let own = branches.iter().flat_map(|(c, branch)| [c].into_iter().chain(branch.exprs()));
                own.chain(last.exprs()).collect()
            }
        }
    }

    /// The same of other expressions.
    pub fn map<M>(&self, f: &mut dyn FnMut(&Expr<L>) -> Expr<M>) -> Update<M> {
        match self {
            Update::Assign(e) => Update::Assign(f(e)),
            Update::OneOf(es) => Update::OneOf(es.iter().map(f).collect()),
            Update::Within(lo, hi) => Update::Within(f(lo), f(hi)),
            Update::If(branches, last) => {
                let branches = branches.iter().map(|(c, branch)| (f(c), branch.map(f))).collect();
                Update::If(branches, Box::new(last.map(f)))
            }
        }
    }

    /// What of it applies in a state, given which conditions hold there: never an [`Update::If`].
    pub fn in_state<E>(&self, holds: &mut impl FnMut(&Expr<L>) -> Result<bool, E>) -> Result<&Update<L>, E> {
        let mut update = self;
        while let Update::If(branches, last) = update {
            update = last;
            for (condition, branch) in branches {
                if holds(condition)? {
                    update = branch;
                    break;
                }
            }
        }
        Ok(update)
    }
}

/// How to draw a map: cells are named by column `x` from the left and row `y` from the bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Obstacle cells `(x, y)`, sorted.
    pub obstacles: Vec<(u32, u32)>,
    /// Cells that nobody has seen, as maps of ROS have, whatever they were taken for; sorted.
    pub unknown: Vec<(u32, u32)>,
    /// Labels that letters of the map carry, each with its letter.
    pub letters: Vec<(String, char)>,
    /// The variable that holds the column.
    pub x: VarId,
    /// The variable that holds the row.
    pub y: VarId,
    /// The variable that says that the robot has crashed, where some rule says `crash`.
    pub crash: Option<VarId>,
    /// Where it lies, if its file says so.
    pub place: Option<Place>,
}

impl System {
    /// Whether every variable has finitely many values.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.vars.iter().all(|var| var.ty.is_finite())
    }

    /// Whether it is equal but for costs, which change neither states nor transitions.
    #[must_use]
    pub fn equals_but_for_costs(&self, other: &System) -> bool {
        let System {
            name,
            vars,
            actions,
            clauses,
            also,
            edges,
            trans,
            init,
            costs: _,
            base,
            labels,
            absorb,
            observe,
            map,
            coordinates,
            span,
        } = self;
        (name, vars, actions, span) == (&other.name, &other.vars, &other.actions, &other.span)
            && (clauses, also, edges, trans) == (&other.clauses, &other.also, &other.edges, &other.trans)
            && (init, base, labels, absorb) == (&other.init, &other.base, &other.labels, &other.absorb)
            && (observe, map, coordinates) == (&other.observe, &other.map, &other.coordinates)
    }

    /// The variable with that name.
    #[must_use]
    pub fn var(&self, name: &str) -> Option<VarId> {
        self.vars.iter_enumerated().find(|(_, v)| v.name == name).map(|(id, _)| id)
    }

    /// The label with that name.
    #[must_use]
    pub fn label(&self, name: &str) -> Option<LabelId> {
        self.labels.iter_enumerated().find(|(_, l)| l.name == name).map(|(id, _)| id)
    }

    /// Where a state is in the plane: the centre of its cell in metres, on a map that says where it lies, or where its node
    /// does.
    #[must_use]
    pub fn position(&self, state: &State) -> Option<(f64, f64)> {
        if let (Some(coordinates), Some(edges)) = (&self.coordinates, &self.edges) {
            let Some(Value::Enum(node)) = state.get(usize::from(edges.var)) else { return None };
            return coordinates.get(*node as usize).copied();
        }
        let map = self.map.as_ref()?;
        let number = |var: VarId| match state.get(usize::from(var)) {
            Some(Value::Int(n)) => u32::try_from(*n).ok(),
            _ => None,
        };
        Some(map.place?.centre((number(map.x)?, number(map.y)?)))
    }

    /// The type of what a leaf reads.
    #[must_use]
    pub fn leaf_type(&self, leaf: Leaf) -> &Type {
        match leaf {
            Leaf::Var(var) => &self.vars[var].ty,
            Leaf::Label(label) => &self.labels[label].ty,
        }
    }

    /// The labels that a label reads, directly or not, in an order in which each reads only those before it.
    #[must_use]
    pub fn labels_below(&self, label: LabelId) -> Vec<LabelId> {
        let mut needed = vec![false; usize::from(label) + 1];
        needed[usize::from(label)] = true;
        // A label reads only labels before it.
        for at in (0..needed.len()).rev() {
            if needed[at] && self.labels[LabelId::from(at)].nested {
                self.labels[LabelId::from(at)].expr.for_each_leaf(&mut |leaf| {
                    if let Leaf::Label(read) = leaf {
                        needed[usize::from(*read)] = true;
                    }
                });
            }
        }
        needed.pop();
        (0..)
            .zip(needed)
            .filter(|(_, needed)| *needed)
            .map(|(at, _): (usize, bool)| LabelId::from(at))
            .collect()
    }

    /// What transitions with that action do besides, where guards say so.
    pub fn also_on(&self, action: ActionId) -> impl Iterator<Item = &Also> {
        self.also.iter().filter(move |also| also.actions.binary_search(&action).is_ok())
    }

    /// Gives the variables of a trace's states that add up costs the values that follow from its steps; a trace with
    /// something that is no step keeps what it has from there on.
    pub fn add_up(&self, trace: &mut Trace) {
        let sums = || self.vars.iter_enumerated().filter(|(_, var)| var.sums.is_some()).map(|(id, _)| id);
        for step in 0..trace.actions.len() {
            let (Some(from), Some(to)) = (trace.states.get(step), trace.states.get(step + 1)) else { return };
            let (from, mut to) = (from.clone(), to.clone());
            for var in sums() {
                let Some(value) = self.summed(var, &from, trace.actions[step], &to) else { return };
                to[usize::from(var)] = value;
            }
            trace.states[step + 1] = to;
        }
    }

    /// What a variable that adds up a cost is after a step.
    fn summed(&self, var: VarId, from: &State, action: ActionId, to: &State) -> Option<Value> {
        let read = |var: VarId| from.get(usize::from(var)).copied();
        if self.evaluate(&self.absorb, &read)? == Value::Bool(true) {
            return read(var);
        }
        let number = |attribute| Expr::Const(Value::Int(self.number(from, action, to, attribute)));
        let updates = self.also.iter().flat_map(|also| &also.updates);
        let (_, update) = updates.into_iter().find(|(updated, _)| *updated == var)?;
        let Update::Assign(next) = update else { return None };
        self.evaluate(&next.of_state(action, &number), &read)
    }

    /// The number of the listed transition that makes a step; 0 where none does.
    #[must_use]
    pub fn number(&self, from: &[Value], action: ActionId, to: &[Value], attribute: AttributeId) -> i64 {
        let Some(edges) = &self.edges else { return 0 };
        let node = |state: &[Value]| match state.get(usize::from(edges.var)) {
            Some(Value::Enum(node)) => *node,
            _ => u32::MAX,
        };
        let mut own = edges.numbered(node(from));
        let listed = own.find(|(_, edge)| edge.action == action && edge.to == node(to));
        listed.map_or(0, |(at, _)| edges.number(at, attribute))
    }

    /// The value of an expression where the variables have these values; see [`Expr::evaluate`].
    #[must_use]
    pub fn evaluate(&self, expr: &Expr<Leaf>, var: &impl Fn(VarId) -> Option<Value>) -> Option<Value> {
        let mut labels: LabelMemo<Option<Value>> = LabelMemo::default();
        let mut find = |expr: &Expr<Leaf>, known: &LabelMemo<Option<Value>>| {
            expr.evaluate(&mut |leaf| match *leaf {
                Leaf::Var(v) => var(v),
                Leaf::Label(l) => known.known(l).flatten(),
            })
        };
        expr.evaluate(&mut |leaf| match *leaf {
            Leaf::Var(v) => var(v),
            Leaf::Label(l) => labels.find(self, l, &mut find),
        })
    }
}
