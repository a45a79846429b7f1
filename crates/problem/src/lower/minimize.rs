//! `minimize EXPR, ...`: sums of costs of paths of the leading block.

use super::consts::{Constant, Consts};
use super::costs::{known_cost, most};
use super::diagnostics::{Diagnostics, suggest};
use super::template::unquantified_path;
use super::typed::LIMIT;
use super::walk::visit;
use crate::expr::Value;
use crate::ids::{CostId, PathId, SystemId};
use crate::objective::{Objective, Quantifier};
use crate::problem::Problem;
use crate::system::System;
use crate::target::Target;
use hyperplan_syntax::ast::{ArithOp, Expr, ExprKind, Ident};
use hyperplan_syntax::{Diagnostic, SourceId, Span};
use typed_index_collections::TiSlice;

/// What `--minimize EXPR, ...` says of an objective of a problem, whose constants are given.
///
/// # Errors
/// What is wrong with it.
pub fn targets(
    problem: &Problem,
    objective: &Objective,
    consts: &[(String, Value)],
    exprs: &[Expr],
) -> Result<Vec<Target>, Vec<Diagnostic>> {
    let mut known = Consts::default();
    let span = Span::new(SourceId(0), 0..0);
    for (name, value) in consts {
        known.insert(name, Constant { value: Some(*value), span });
    }
    let mut diagnostics = Diagnostics::default();
    let all = lower_minimize(&problem.systems, None, objective, &known, exprs, &mut diagnostics);
    all.ok_or_else(|| diagnostics.into_list())
}

/// What is to be as small as possible; `None` after a message. Of systems that are `poisoned` names may be missing.
pub(super) fn lower_minimize(
    systems: &TiSlice<SystemId, System>,
    poisoned: Option<&TiSlice<SystemId, bool>>,
    objective: &Objective,
    consts: &Consts,
    exprs: &[Expr],
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Target>> {
    let mut all = Vec::new();
    for e in exprs {
        let mut reader =
            Reader { systems, poisoned, objective, consts, diagnostics, terms: Vec::new(), constant: 0 };
        let understood = reader.add(e, 1);
        let (terms, constant) = (reader.terms, reader.constant);
        all.push(understood.and_then(|()| target(systems, objective, e, terms, constant, diagnostics)));
    }
    all.into_iter().collect()
}

/// The target of these terms, in which costs may stand several times.
fn target(
    systems: &TiSlice<SystemId, System>,
    objective: &Objective,
    e: &Expr,
    mut terms: Vec<(i128, PathId, CostId)>,
    constant: i128,
    diagnostics: &mut Diagnostics,
) -> Option<Target> {
    terms.sort_unstable_by_key(|term| (term.1, term.2));
    let mut sums: Vec<(i128, PathId, CostId)> = Vec::new();
    for (factor, path, cost) in terms {
        match sums.last_mut().filter(|last| (last.1, last.2) == (path, cost)) {
            Some(last) => last.0 += factor,
            None => sums.push((factor, path, cost)),
        }
    }
    sums.retain(|sum| sum.0 != 0);
    if sums.is_empty() {
        let diagnostic = Diagnostic::error("nothing-to-minimize", e.span, "this reads no cost");
        return diagnostics
            .refuse(diagnostic.with_help("write `cost NAME[p]`, where the system of p has that cost"));
    }
    if sums.iter().any(|sum| sum.0 < 0) {
        let message = "what is minimized must not fall when a cost grows";
        return diagnostics.refuse(Diagnostic::error("negative-cost", e.span, message));
    }
    let cost_of = |path: PathId, cost: CostId| &systems[objective.paths[path].system].costs[cost];
    let greatest: i128 =
        sums.iter().map(|&(f, p, c)| f.saturating_mul(i128::from(most(cost_of(p, c))))).sum();
    let fits = greatest <= LIMIT && constant.abs() <= LIMIT;
    let terms =
        sums.iter().map(|&(f, p, c)| Some((i64::try_from(f).ok()?, p, c))).collect::<Option<Vec<_>>>();
    match (terms, i64::try_from(constant)) {
        (Some(terms), Ok(constant)) if fits => Some(Target { terms, constant, span: e.span }),
        _ => {
            let message = "the sum may not fit in 62 bits";
            diagnostics.refuse(Diagnostic::error("number-too-large", e.span, message))
        }
    }
}

/// Reads one expression as a sum.
struct Reader<'a> {
    systems: &'a TiSlice<SystemId, System>,
    poisoned: Option<&'a TiSlice<SystemId, bool>>,
    objective: &'a Objective,
    consts: &'a Consts,
    diagnostics: &'a mut Diagnostics,
    terms: Vec<(i128, PathId, CostId)>,
    constant: i128,
}

impl Reader<'_> {
    /// Adds so many times an expression; `None` after a message.
    fn add(&mut self, e: &Expr, factor: i128) -> Option<()> {
        match &e.kind {
            ExprKind::Cost(name, paths) => self.cost(name, paths, e.span, factor),
            ExprKind::Neg(a) => self.add(a, -factor),
            ExprKind::Sum(parts) => {
                let all =
                    parts.iter().map(|(minus, part)| self.add(part, if *minus { -factor } else { factor }));
                all.fold(Some(()), Option::and)
            }
            ExprKind::Arith(ArithOp::Mul, a, b) if reads_cost(e) => {
                let (sum, times) = if reads_cost(a) { (a, b) } else { (b, a) };
                if reads_cost(times) {
                    let message = "the product of two costs is no sum of costs";
                    return self.diagnostics.refuse(Diagnostic::error("nonlinear", e.span, message));
                }
                let times = i128::from(self.consts.evaluate(times, self.diagnostics)?);
                match factor.checked_mul(times).filter(|f| f.abs() <= LIMIT) {
                    Some(factor) => self.add(sum, factor),
                    None => {
                        let message = "the factor does not fit in 62 bits";
                        self.diagnostics.refuse(Diagnostic::error("number-too-large", e.span, message))
                    }
                }
            }
            _ if reads_cost(e) => {
                let message = "what is minimized is a sum of costs, and this is none";
                let help = "costs may be added and multiplied by constants: `2 * cost fuel[p] + cost time[q]`; what else a step \
                     costs is said where the cost is declared";
                self.diagnostics.refuse(Diagnostic::error("nonlinear", e.span, message).with_help(help))
            }
            _ => {
                let value = i128::from(self.consts.evaluate(e, self.diagnostics)?);
                self.constant = self.constant.saturating_add(value.saturating_mul(factor));
                Some(())
            }
        }
    }

    fn cost(&mut self, name: &Ident, paths: &[Ident], span: Span, factor: i128) -> Option<()> {
        let [path] = paths else {
            let message = format!("`cost {}` is read of one path, not of {}", name.name, paths.len());
            return self.diagnostics.refuse(Diagnostic::error("argument-count", span, message));
        };
        let Some(id) = self.objective.path(&path.name) else {
            let known: Vec<&str> = self.objective.paths.iter().map(|path| path.name.as_str()).collect();
            return self.diagnostics.refuse(suggest(unquantified_path(path, &known), &path.name, known));
        };
        let leads = self.objective.leading_block().contains(&id)
            && self.objective.paths[id].quantifier == Quantifier::Exists;
        if !leads {
            let message = format!("`{}` is not one of the paths that a strategy gives", path.name);
            let help = "what is minimized speaks of paths of a leading `exists`; a bound on the costs of others is part of the \
                 formula";
            return self
                .diagnostics
                .refuse(Diagnostic::error("misplaced-cost", span, message).with_help(help));
        }
        let system = self.objective.paths[id].system;
        let poisoned = self.poisoned.is_some_and(|poisoned| poisoned.get(system).is_some_and(|p| *p));
        let cost = known_cost(&self.systems[system], name, poisoned, self.diagnostics)?;
        self.terms.push((factor, id, cost));
        Some(())
    }
}

fn reads_cost(e: &Expr) -> bool {
    let mut found = false;
    visit(e, &mut |part| found |= matches!(part.kind, ExprKind::Cost(..)));
    found
}
