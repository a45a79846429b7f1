//! What the commands of a system ask and do, as terms over its variables.

use crate::value::{Leaves, Val, compare, constant, equal, member_of, merge, same, translate};
use hyperplan_problem::{Comparison, Expr, LabelMemo, Leaf, System, VarId};
use hyperplan_smt::{Term, Terms};
use hyperplan_space::{Command, Commands, Guard, Listed, NewValue, bounds};

/// Whether a variable can get a value between two ends.
type Between<'b> = &'b mut dyn FnMut(&mut Terms, &mut InState<'_>, VarId, &Expr<Leaf>, &Expr<Leaf>) -> Term;

/// For each command, whether it can be taken in a state, with some inputs.
pub(super) fn enabled(commands: &Commands, terms: &mut Terms, system: &System, state: &[Val]) -> Vec<Term> {
    each(commands, terms, system, state, &mut |terms, leaves, var, lo, hi| {
        let lo = translate(terms, lo, leaves);
        let hi = translate(terms, hi, leaves);
        let mut parts = vec![compare(terms, Comparison::Le, lo.clone(), hi.clone())];
        if let Some((least, most)) = bounds(&system.vars[var].ty) {
            parts.push(compare(terms, Comparison::Le, lo, constant(most)));
            parts.push(compare(terms, Comparison::Le, constant(least), hi));
        }
        terms.and(&parts)
    })
}

/// For each command, whether it can be taken in a state with these inputs.
pub(super) fn enabled_with(
    commands: &Commands,
    terms: &mut Terms,
    system: &System,
    state: &[Val],
    inputs: &[Val],
) -> Vec<Term> {
    each(commands, terms, system, state, &mut |terms, leaves, var, lo, hi| {
        let lo = translate(terms, lo, leaves);
        let hi = translate(terms, hi, leaves);
        let input = inputs[usize::from(var)].clone();
        let above = compare(terms, Comparison::Le, lo, input.clone());
        let below = compare(terms, Comparison::Le, input.clone(), hi);
        let fits = within(terms, input, bounds(&system.vars[var].ty));
        terms.and(&[above, below, fits])
    })
}

/// For each command, whether it can be taken in a state; `between` says whether a value in a range can.
fn each(
    commands: &Commands,
    terms: &mut Terms,
    system: &System,
    state: &[Val],
    between: Between<'_>,
) -> Vec<Term> {
    let mut leaves = InState::new(system, state);
    let absorbing = translate(terms, &system.absorb, &mut leaves).truth();
    let mut enabled = Vec::with_capacity(commands.all.len());
    for command in &commands.all {
        let mut parts = vec![!absorbing];
        match &command.guard {
            Guard::Absorbing => parts[0] = absorbing,
            Guard::Clause(clause) => {
                parts.push(translate(terms, &system.clauses[*clause].guard, &mut leaves).truth());
            }
            Guard::Listed(var, table) => parts.push(has_target(terms, &state[usize::from(*var)], table)),
        }
        for (var, new) in &command.updates {
            let range = bounds(&system.vars[*var].ty);
            match new {
                NewValue::Is(expr) => {
                    let value = translate(terms, expr, &mut leaves);
                    parts.push(within(terms, value, range));
                }
                NewValue::OneOf { value, lo, hi } => {
                    let value = translate(terms, value, &mut leaves);
                    let (lo, hi) = (translate(terms, lo, &mut leaves), translate(terms, hi, &mut leaves));
                    parts.push(compare(terms, Comparison::Le, lo, value.clone()));
                    parts.push(compare(terms, Comparison::Le, value, hi));
                }
                NewValue::Between { lo, hi } => parts.push(between(terms, &mut leaves, *var, lo, hi)),
            }
        }
        enabled.push(terms.and(&parts));
    }
    enabled
}

/// Whether every command that can be taken in a state, as [`enabled`] says, leads back to it.
pub(super) fn halted(
    commands: &Commands,
    terms: &mut Terms,
    system: &System,
    state: &[Val],
    enabled: &[Term],
) -> Term {
    let mut leaves = InState::new(system, state);
    let mut parts = Vec::with_capacity(commands.all.len());
    for (command, &possible) in commands.all.iter().zip(enabled) {
        let mut unchanged = Vec::new();
        if let Guard::Listed(var, table) = &command.guard {
            let here = &state[usize::from(*var)];
            let loops = table.iter().filter(|(from, to)| from == to).copied().collect();
            unchanged.push(has_target(terms, here, &loops));
        }
        for (var, new) in &command.updates {
            let here = &state[usize::from(*var)];
            match new {
                NewValue::Is(value) | NewValue::OneOf { value, .. } => {
                    let value = translate(terms, value, &mut leaves);
                    unchanged.push(same(terms, &value, here));
                }
                NewValue::Between { lo, hi } => {
                    let (lo, hi) = (translate(terms, lo, &mut leaves), translate(terms, hi, &mut leaves));
                    let range = bounds(&system.vars[*var].ty);
                    unchanged.push(only(terms, here, &lo, &hi, range));
                }
            }
        }
        let unchanged = terms.and(&unchanged);
        parts.push(terms.implies(possible, unchanged));
    }
    terms.and(&parts)
}

/// The value of a variable after a command.
pub(super) fn after(
    command: &Command,
    terms: &mut Terms,
    system: &System,
    var: VarId,
    state: &[Val],
    inputs: &[Val],
) -> Val {
    let at = usize::from(var);
    if let Guard::Listed(moving, table) = &command.guard
        && *moving == var
    {
        return follow(terms, &state[at], table);
    }
    match command.updates.iter().find(|(updated, _)| *updated == var) {
        None => state[at].clone(),
        Some((_, NewValue::Is(value) | NewValue::OneOf { value, .. })) => {
            translate(terms, value, &mut InState::new(system, state))
        }
        Some((_, NewValue::Between { .. })) => inputs[at].clone(),
    }
}

/// Whether some listed transition starts at a value.
fn has_target(terms: &mut Terms, from: &Val, table: &Listed) -> Term {
    let sources: Vec<[i64; 1]> = table.iter().map(|(from, _)| [*from]).collect();
    let sources: Vec<&[i64]> = sources.iter().map(|from| &from[..]).collect();
    member_of(terms, std::slice::from_ref(from), &sources)
}

/// Where listed transitions lead from a value that has one: each target with the condition to be at one of its
/// sources.
fn follow(terms: &mut Terms, from: &Val, table: &Listed) -> Val {
    let mut by_target = table.clone();
    by_target.sort_unstable_by_key(|&(from, to)| (to, from));
    let mut cases = Vec::new();
    for same in by_target.chunk_by(|a, b| a.1 == b.1) {
        cases.push((same[0].1, has_target(terms, from, &same.to_vec())));
    }
    merge(terms, cases.into_iter())
}

/// The leaves of a system's expressions in a state.
pub(super) struct InState<'a> {
    pub(super) system: &'a System,
    pub(super) state: &'a [Val],
    labels: LabelMemo<Val>,
}

impl<'a> InState<'a> {
    pub(super) fn new(system: &'a System, state: &'a [Val]) -> Self {
        InState { system, state, labels: LabelMemo::default() }
    }
}

impl Leaves<Leaf> for InState<'_> {
    fn leaf(&mut self, terms: &mut Terms, leaf: &Leaf) -> Val {
        match *leaf {
            Leaf::Var(v) => self.state[usize::from(v)].clone(),
            Leaf::Label(l) => {
                let state = self.state;
                self.labels.find(self.system, l, &mut |expr, labels| {
                    translate(terms, expr, &mut Labelled { state, labels })
                })
            }
        }
    }

    fn whole(&mut self, _: &mut Terms, _: &Expr<Leaf>) -> Option<Val> {
        None
    }
}

/// The leaves of a label in a state, where the labels that it reads are known.
struct Labelled<'a> {
    state: &'a [Val],
    labels: &'a LabelMemo<Val>,
}

impl Leaves<Leaf> for Labelled<'_> {
    fn leaf(&mut self, _: &mut Terms, leaf: &Leaf) -> Val {
        match *leaf {
            Leaf::Var(v) => self.state[usize::from(v)].clone(),
            Leaf::Label(l) => self.labels.known(l).unwrap_or(Val::Bool(Term::FALSE)),
        }
    }

    fn whole(&mut self, _: &mut Terms, _: &Expr<Leaf>) -> Option<Val> {
        None
    }
}

/// Whether a new value is in its variable's range, where it has one.
pub(super) fn within(terms: &mut Terms, value: Val, range: Option<(i64, i64)>) -> Term {
    let Some((lo, hi)) = range else { return Term::TRUE };
    match &value {
        Val::Bool(_) => Term::TRUE,
        Val::Cases(cases) if cases.iter().all(|c| (lo..=hi).contains(&c.0)) => Term::TRUE,
        Val::Cases(cases) => {
            let inside: Vec<Term> = cases.iter().filter(|c| (lo..=hi).contains(&c.0)).map(|c| c.1).collect();
            terms.or(&inside)
        }
        Val::Bits { .. } | Val::Number(_) => {
            let low = compare(terms, Comparison::Le, constant(lo), value.clone());
            let high = compare(terms, Comparison::Le, value, constant(hi));
            terms.and2(low, high)
        }
    }
}

/// Whether no value from `lo` to `hi` (some are) that is in the variable's range differs from the present one.
fn only(terms: &mut Terms, here: &Val, lo: &Val, hi: &Val, range: Option<(i64, i64)>) -> Term {
    let mut none_below = vec![compare(terms, Comparison::Le, here.clone(), lo.clone())];
    let mut none_above = vec![compare(terms, Comparison::Le, hi.clone(), here.clone())];
    if let Some((least, most)) = range {
        none_below.push(equal(terms, here, least));
        none_above.push(equal(terms, here, most));
    }
    let (none_below, none_above) = (terms.or(&none_below), terms.or(&none_above));
    terms.and2(none_below, none_above)
}
