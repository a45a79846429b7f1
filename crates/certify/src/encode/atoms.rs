//! What the formula reads of paths at a time.

use super::{At, BEYOND, Encoder, Read, Tail, View};
use crate::error::Error;
use crate::layer::{Acts, FALSE, Layer, Lit, Order, TRUE};
use crate::reading::{VALUE_BOOL, alone, number, value_of};
use hyperplan_problem::{ActionId, Comparison, Expr, Leaf, PathId, PathLeaf, Value};
use std::rc::Rc;

/// So many combinations of values of an atom are written.
const COMBINATIONS: usize = 1 << 20;

impl<'p> Encoder<'p> {
    /// A literal that is true exactly if an atom of several paths, or of actions, is.
    pub(super) fn atom(&mut self, expr: &'p Expr<PathLeaf>, time: u32, view: &View) -> Result<Lit, Error> {
        if let Expr::Leaf(PathLeaf::Took(path, action)) = expr {
            return self.took(*path, *action, time, view);
        }
        let address = std::ptr::from_ref(expr) as usize;
        let mut paths = Vec::new();
        expr.for_each_leaf(&mut |leaf| paths.extend(leaf.paths().into_iter().flatten()));
        let key = (address, time, self.about(&paths, view));
        if let Some(&lit) = self.atoms.get(&key) {
            return Ok(lit);
        }
        let lit = match expr {
            Expr::Leaf(PathLeaf::SameAction(p, q)) => self.same_action(*p, *q, time, view)?,
            Expr::Leaf(PathLeaf::SameState(p, q)) => self.same_state(*p, *q, time, view)?,
            Expr::Compare(comparison, a, b) if alone(a).is_some() && alone(b).is_some() => {
                let mut side = |e: &'p Expr<PathLeaf>| {
                    self.order(Read::Expr(std::ptr::from_ref(e) as usize), e, time, view)
                };
                let (a, b) = (side(a)?, side(b)?);
                self.compare(*comparison, &a, &b)?
            }
            _ => self.combinations(expr, time, view)?,
        };
        self.atoms.insert(key, lit);
        Ok(lit)
    }

    /// Where a path is.
    fn layer_of(&mut self, path: PathId, time: u32, view: &View) -> Result<Rc<Layer>, Error> {
        let state = match view.tail.filter(|tail| tail.path == path).map(|tail| tail.at) {
            Some(At::State(state)) => state,
            Some(At::Anywhere) => return Err(BEYOND),
            Some(At::Along(_)) | None => {
                let layer = self.copy(path, &view.scope)?.layers.get(time as usize);
                return layer.cloned().ok_or(BEYOND);
            }
        };
        let key = (self.objective.paths[path].system, state);
        if let Some(point) = self.points.get(&key) {
            return Ok(Rc::clone(point));
        }
        let point = self.layer(vec![(state, TRUE)]);
        self.points.insert(key, Rc::clone(&point));
        Ok(point)
    }

    /// What a path has just done; nothing at time 0.
    fn done(&self, path: PathId, time: u32, view: &View) -> Result<Option<Rc<Acts>>, Error> {
        let Some(step) = (time as usize).checked_sub(1) else { return Ok(None) };
        match view.tail.filter(|tail| tail.path == path) {
            Some(Tail { at: At::State(_) | At::Anywhere, took, .. }) => {
                self.taken(took.ok_or(BEYOND)?, step, &view.scope).map(Some)
            }
            _ => self.acts_of(path, step, &view.scope).ok_or(BEYOND).map(Some),
        }
    }

    /// The action just taken; none at time 0.
    fn took(&self, path: PathId, action: ActionId, time: u32, view: &View) -> Result<Lit, Error> {
        let Some(acts) = self.done(path, time, view)? else { return Ok(FALSE) };
        Ok(acts.iter().find(|act| act.0 == action).map_or(FALSE, |act| act.1))
    }

    fn same_action(&mut self, p: PathId, q: PathId, time: u32, view: &View) -> Result<Lit, Error> {
        let (Some(own), Some(other)) = (self.done(p, time, view)?, self.done(q, time, view)?) else {
            return Ok(TRUE);
        };
        if own == other {
            return Ok(TRUE);
        }
        let same = self.fresh();
        let of = |acts: &Acts, action: ActionId| acts.iter().find(|a| a.0 == action).map_or(FALSE, |a| a.1);
        let mut actions: Vec<ActionId> = own.iter().chain(other.iter()).map(|act| act.0).collect();
        actions.sort_unstable();
        actions.dedup();
        for action in actions {
            let (a, b) = (of(&own, action), of(&other, action));
            self.add(&[], [-same, -a, b])?;
            self.add(&[], [-same, -b, a])?;
            self.add(&[], [same, -a, -b])?;
        }
        Ok(same)
    }

    fn same_state(&mut self, p: PathId, q: PathId, time: u32, view: &View) -> Result<Lit, Error> {
        let systems = [p, q].map(|path| self.objective.paths[path].system);
        if systems[0] == systems[1] && self.layer_of(p, time, view)?.id == self.layer_of(q, time, view)?.id {
            return Ok(TRUE);
        }
        let same = self.fresh();
        let mut some = vec![same];
        for var in self.problem.systems[self.objective.paths[p].system].vars.keys() {
            let mut side = |path| {
                let leaf = PathLeaf::State(path, Leaf::Var(var));
                self.order(Read::Leaf(leaf), &Expr::Leaf(leaf), time, view)
            };
            let (a, b) = (side(p)?, side(q)?);
            let equal = self.compare(Comparison::Eq, &a, &b)?;
            self.add(&[], [-same, equal])?;
            some.push(-equal);
        }
        self.add(&[], some)?;
        Ok(same)
    }

    /// What an expression over one path's state is at a time.
    pub(super) fn order(
        &mut self,
        read: Read,
        expr: &Expr<PathLeaf>,
        time: u32,
        view: &View,
    ) -> Result<Rc<Order>, Error> {
        let path = alone(expr).ok_or(Error::Malformed { what: "an expression reads several paths" })?;
        let layer = self.layer_of(path, time, view)?;
        if let Some(order) = self.orders.get(&(read, layer.id)) {
            return Ok(Rc::clone(order));
        }
        let (guard, graph) = (self.copy(path, &view.scope)?.guard.clone(), self.graph(path));
        let mut cells: Vec<(i64, Lit)> = Vec::with_capacity(layer.cells.len());
        for &(state, x) in &layer.cells {
            cells.push((number(expr.evaluate(&mut |leaf| graph.leaf(state, leaf)))?, x));
        }
        cells.sort_unstable();
        let mut order = Order { values: Vec::new(), lits: Vec::new() };
        for own in cells.chunk_by(|a, b| a.0 == b.0) {
            order.lits.push(if order.values.is_empty() { TRUE } else { self.fresh() });
            order.values.push(own[0].0);
        }
        for (at, own) in cells.chunk_by(|a, b| a.0 == b.0).enumerate() {
            let this = order.lits[at];
            let above = order.lits.get(at + 1).copied().unwrap_or(FALSE);
            self.add(&[], [-above, this])?;
            for &(_, x) in own {
                self.add(&[], [-x, this])?;
                self.add(&[], [-x, -above])?;
            }
            // If this is its value, the path is in one of these states.
            self.add(&guard, own.iter().map(|cell| cell.1).chain([-this, above]))?;
        }
        let order = Rc::new(order);
        self.orders.insert((read, layer.id), Rc::clone(&order));
        Ok(order)
    }

    /// A literal that is true exactly if the comparison is.
    fn compare(&mut self, comparison: Comparison, a: &Order, b: &Order) -> Result<Lit, Error> {
        // Where one of them is a constant, only the numbers around it are.
        let of = |own: &Order| match own.values.as_slice() {
            [value] => Some(vec![*value, value.saturating_add(1)]),
            _ => None,
        };
        let around = of(a).or(of(b));
        let [of_a, of_b] = [a, b].map(|own| around.clone().unwrap_or_else(|| own.values.clone()));
        if let ([a], [b]) = (a.values.as_slice(), b.values.as_slice()) {
            return Ok(if comparison.holds(Value::Int(*a), Value::Int(*b)) { TRUE } else { FALSE });
        }
        let lit = self.fresh();
        match comparison {
            Comparison::Lt => {
                let le = self.compare(Comparison::Le, b, a)?;
                return Ok(-le);
            }
            Comparison::Le => {
                for &n in &of_a {
                    self.add(&[], [-lit, -a.at_least(n), b.at_least(n)])?;
                }
                for &n in &of_b {
                    self.add(&[], [lit, -b.at_least(n), a.at_least(n + 1)])?;
                }
            }
            Comparison::Eq => {
                for &n in of_a.iter().chain(&of_b) {
                    self.add(&[], [-lit, -a.at_least(n), b.at_least(n)])?;
                    self.add(&[], [-lit, -b.at_least(n), a.at_least(n)])?;
                    let [a_above, b_above] = [a, b].map(|order| order.at_least(n + 1));
                    self.add(&[], [lit, -a.at_least(n), a_above, -b.at_least(n), b_above])?;
                }
            }
        }
        Ok(lit)
    }

    /// An atom by all combinations of the values that it reads.
    fn combinations(&mut self, expr: &'p Expr<PathLeaf>, time: u32, view: &View) -> Result<Lit, Error> {
        let mut leaves: Vec<PathLeaf> = Vec::new();
        expr.for_each_leaf(&mut |leaf| {
            if !leaves.contains(leaf) {
                leaves.push(*leaf)
            }
        });
        let mut orders: Vec<Rc<Order>> = Vec::new();
        let mut kinds = Vec::new();
        for &leaf in &leaves {
            let truth = |lit| Rc::new(Order { values: vec![0, 1], lits: vec![TRUE, lit] });
            let (order, kind) = match leaf {
                PathLeaf::Took(path, action) => (truth(self.took(path, action, time, view)?), VALUE_BOOL),
                PathLeaf::SameAction(p, q) => (truth(self.same_action(p, q, time, view)?), VALUE_BOOL),
                PathLeaf::SameState(p, q) => (truth(self.same_state(p, q, time, view)?), VALUE_BOOL),
                PathLeaf::Enabled(..) | PathLeaf::Halted(_) => {
                    (self.order(Read::Leaf(leaf), &Expr::Leaf(leaf), time, view)?, VALUE_BOOL)
                }
                PathLeaf::State(path, own) => {
                    let system = &self.problem.systems[self.objective.paths[path].system];
                    let order = self.order(Read::Leaf(leaf), &Expr::Leaf(leaf), time, view)?;
                    (order, value_of(system.leaf_type(own)))
                }
            };
            orders.push(order);
            kinds.push(kind);
        }
        let count = orders.iter().try_fold(1_usize, |n, order| n.checked_mul(order.values.len()));
        if count.is_none_or(|count| count > COMBINATIONS) {
            return Err(Error::TooLarge { what: "an atom combines too many values".to_owned() });
        }
        let lit = self.fresh();
        let mut at = vec![0; orders.len()];
        for _ in 0..count.unwrap_or(0) {
            let mut clause = Vec::new();
            for (order, &at) in orders.iter().zip(&at) {
                clause.push(-order.lits[at]);
                clause.extend(order.lits.get(at + 1));
            }
            let value = expr.evaluate(&mut |leaf| {
                let which = leaves.iter().position(|own| own == leaf)?;
                Some(kinds[which](orders[which].values[at[which]]))
            });
            clause.push(if number(value)? == 1 { lit } else { -lit });
            self.add(&[], clause)?;
            for (at, order) in at.iter_mut().zip(&orders) {
                *at += 1;
                if *at < order.values.len() {
                    break;
                }
                *at = 0;
            }
        }
        Ok(lit)
    }
}
