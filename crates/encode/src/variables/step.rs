//! What the commands of a system ask and do, as terms over its variables.

use crate::value::{Leaves, Val, compare, constant, equal, member_of, merge, same, translate, width};
use hyperplan_problem::{Comparison, Expr, LabelMemo, Leaf, System, TransLeaf, Type, Update, VarId};
use hyperplan_smt::{Term, Terms};
use hyperplan_space::{Command, Commands, Guard, Listed, NewValue, bounds};

/// Whether a variable can get a value that an update allows.
type Chosen<'b> = &'b mut dyn FnMut(&mut Terms, &mut InState<'_>, VarId, &Update) -> Term;

/// For each command, whether it can be taken in a state, with some inputs. Where there are inputs, and `trans` says
/// something of them, that is not to be had without quantifiers; see [`is_told`].
pub(super) fn enabled(commands: &Commands, terms: &mut Terms, system: &System, state: &[Val]) -> Vec<Term> {
    let mut enabled = each(commands, terms, system, state, &mut |terms, leaves, var, update| {
        let range = bounds(&system.vars[var].ty);
        over_update(terms, leaves, update, &mut |terms, leaves, update| match update {
            Applied::Values(es) => {
                let inside: Vec<Term> = es
                    .iter()
                    .map(|e| {
                        let value = translate(terms, e, leaves);
                        within(terms, value, range)
                    })
                    .collect();
                terms.or(&inside)
            }
            Applied::Between(lo, hi) => {
                let (lo, hi) = (translate(terms, lo, leaves), translate(terms, hi, leaves));
                let mut parts = vec![compare(terms, Comparison::Le, lo.clone(), hi.clone())];
                if let Some((least, most)) = range {
                    parts.push(compare(terms, Comparison::Le, lo, constant(most)));
                    parts.push(compare(terms, Comparison::Le, constant(least), hi));
                }
                terms.and(&parts)
            }
        })
    });
    if is_told(commands, system) {
        constrain(commands, terms, system, state, state, &mut enabled);
    }
    enabled
}

/// Whether [`enabled`] says all: not where `trans` may ask something of inputs.
pub(super) fn is_told(commands: &Commands, system: &System) -> bool {
    system.trans.is_true() || commands.inputs.is_empty()
}

/// Adds to each command that `trans` holds of its step.
fn constrain(
    commands: &Commands,
    terms: &mut Terms,
    system: &System,
    state: &[Val],
    inputs: &[Val],
    enabled: &mut [Term],
) {
    if system.trans.is_true() {
        return;
    }
    for (command, enabled) in commands.all.iter().zip(enabled) {
        if matches!(command.guard, Guard::Absorbing) || *enabled == Term::FALSE {
            continue;
        }
        let vars = system.vars.iter_enumerated();
        let next: Vec<Val> = vars
            .map(|(var, declared)| {
                let value = after(command, terms, system, var, state, inputs);
                clip(terms, &value, &declared.ty)
            })
            .collect();
        let mut step = InStep { before: InState::new(system, state), after: InState::new(system, &next) };
        let holds = translate(terms, &system.trans, &mut step).truth();
        *enabled = terms.and2(*enabled, holds);
    }
}

/// What an update without conditions allows.
enum Applied<'u> {
    Values(&'u [Expr<Leaf>]),
    Between(&'u Expr<Leaf>, &'u Expr<Leaf>),
}

/// What `f` says of what applies of an update.
fn over_update(
    terms: &mut Terms,
    leaves: &mut InState<'_>,
    update: &Update,
    f: &mut dyn FnMut(&mut Terms, &mut InState<'_>, Applied<'_>) -> Term,
) -> Term {
    match update {
        Update::Assign(e) => f(terms, leaves, Applied::Values(std::slice::from_ref(e))),
        Update::OneOf(es) => f(terms, leaves, Applied::Values(es)),
        Update::Within(lo, hi) => f(terms, leaves, Applied::Between(lo, hi)),
        Update::If(branches, last) => {
            let mut rest = over_update(terms, leaves, last, f);
            for (condition, branch) in branches.iter().rev() {
                let condition = translate(terms, condition, leaves).truth();
                let branch = over_update(terms, leaves, branch, f);
                rest = terms.ite(condition, branch, rest);
            }
            rest
        }
    }
}

/// For each command, whether it can be taken in a state with these inputs.
pub(super) fn enabled_with(
    commands: &Commands,
    terms: &mut Terms,
    system: &System,
    state: &[Val],
    inputs: &[Val],
) -> Vec<Term> {
    let mut enabled = each(commands, terms, system, state, &mut |terms, leaves, var, update| {
        let input = &inputs[usize::from(var)];
        let fits = within(terms, input.clone(), bounds(&system.vars[var].ty));
        let allowed = over_update(terms, leaves, update, &mut |terms, leaves, update| match update {
            Applied::Values(es) => {
                let equal: Vec<Term> = es
                    .iter()
                    .map(|e| {
                        let value = translate(terms, e, leaves);
                        same(terms, &value, input)
                    })
                    .collect();
                terms.or(&equal)
            }
            Applied::Between(lo, hi) => {
                let (lo, hi) = (translate(terms, lo, leaves), translate(terms, hi, leaves));
                let above = compare(terms, Comparison::Le, lo, input.clone());
                let below = compare(terms, Comparison::Le, input.clone(), hi);
                terms.and2(above, below)
            }
        });
        terms.and2(allowed, fits)
    });
    constrain(commands, terms, system, state, inputs, &mut enabled);
    enabled
}

/// For each command, whether it can be taken in a state, but for `trans`; `chosen` says whether an input can be had.
fn each(
    commands: &Commands,
    terms: &mut Terms,
    system: &System,
    state: &[Val],
    chosen: Chosen<'_>,
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
                NewValue::Among(update) => parts.push(chosen(terms, &mut leaves, *var, update)),
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
                NewValue::Among(update) => {
                    let range = bounds(&system.vars[*var].ty);
                    unchanged.push(over_update(terms, &mut leaves, update, &mut |terms, leaves, update| {
                        only(terms, leaves, here, update, range)
                    }));
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
        Some((_, NewValue::Among(_))) => inputs[at].clone(),
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

/// The leaves of what is said of a step.
struct InStep<'a> {
    before: InState<'a>,
    after: InState<'a>,
}

impl Leaves<TransLeaf> for InStep<'_> {
    fn leaf(&mut self, terms: &mut Terms, leaf: &TransLeaf) -> Val {
        match leaf {
            TransLeaf::Before(leaf) => self.before.leaf(terms, leaf),
            TransLeaf::After(leaf) => self.after.leaf(terms, leaf),
        }
    }

    fn whole(&mut self, _: &mut Terms, _: &Expr<TransLeaf>) -> Option<Val> {
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

/// Whether no value that is allowed (some are) and in the variable's range differs from the present one.
fn only(
    terms: &mut Terms,
    leaves: &mut InState<'_>,
    here: &Val,
    update: Applied<'_>,
    range: Option<(i64, i64)>,
) -> Term {
    let (lo, hi) = match update {
        Applied::Values(es) => {
            let same: Vec<Term> = es
                .iter()
                .map(|e| {
                    let value = translate(terms, e, leaves);
                    let inside = within(terms, value.clone(), range);
                    let same = same(terms, &value, here);
                    terms.implies(inside, same)
                })
                .collect();
            return terms.and(&same);
        }
        Applied::Between(lo, hi) => (translate(terms, lo, leaves), translate(terms, hi, leaves)),
    };
    let mut none_below = vec![compare(terms, Comparison::Le, here.clone(), lo.clone())];
    let mut none_above = vec![compare(terms, Comparison::Le, hi.clone(), here.clone())];
    if let Some((least, most)) = range {
        none_below.push(equal(terms, here, least));
        none_above.push(equal(terms, here, most));
    }
    let (none_below, none_above) = (terms.or(&none_below), terms.or(&none_above));
    terms.and2(none_below, none_above)
}

/// A new value at its variable's width and bounds: a command that leaves them is not enabled.
pub(super) fn clip(terms: &mut Terms, value: &Val, ty: &Type) -> Val {
    let Some((lo, hi)) = bounds(ty) else { return value.clone() };
    match value {
        Val::Bits { .. } => Val::Bits { term: value.bits_of_width(terms, width(lo, hi)), lo, hi },
        Val::Cases(cases) => Val::Cases(cases.iter().copied().filter(|c| (lo..=hi).contains(&c.0)).collect()),
        Val::Bool(_) | Val::Number(_) => value.clone(),
    }
}
