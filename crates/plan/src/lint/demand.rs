//! What is demanded of every path although some does not meet it: an assumption that was written as a conjunct.

use super::question::Asker;
use super::rewrite::{Builder, Replaced, conjuncts, leaves};
use hyperplan_problem::{Formula, FormulaId, PathId, Quantifier};
use hyperplan_syntax::{Diagnostic, Span};

/// Looks at the conjuncts that read only `forall` paths. One that some path refutes makes the objective fail,
/// whatever the `exists` paths are. Without those that is just what an objective asks; and an implication has an
/// assumption already.
pub(crate) fn lint(asker: &mut Asker<'_>, found: &mut Vec<Diagnostic>) {
    let objective = asker.objective;
    let formula = &objective.formula;
    if objective.paths.iter().all(|p| p.quantifier == Quantifier::Forall) {
        return;
    }
    for part in conjuncts(formula, formula.root(), &Replaced::new()) {
        if asker.is_over(formula.spans[part]) {
            return;
        }
        if formula.implication(part).is_some() {
            continue;
        }
        let paths = paths(formula, part);
        if paths.is_empty() || paths.iter().any(|&p| objective.paths[p].quantifier == Quantifier::Exists) {
            continue;
        }
        let mut builder = Builder::new(formula);
        let built = builder.part(part, false);
        let Ok(question) = builder.finish(built) else { continue };
        let span = formula.spans[part];
        if asker.possible(question, span, "every path satisfies this") == Some(true) {
            found.push(demanded(&objective.paths[paths[0]].name, span));
        }
    }
}

fn demanded(name: &str, span: Span) -> Diagnostic {
    let message =
        format!("this is demanded of every path {name}, and some do not satisfy it: the objective fails");
    Diagnostic::warning("demanded-of-every-path", span, message).with_help(format!(
        "to speak only of the paths {name} that satisfy something, write it as an assumption: `... -> ...`"
    ))
}

/// The paths that a subformula reads, without repetition.
pub(crate) fn paths(formula: &Formula, root: FormulaId) -> Vec<PathId> {
    let mut paths = Vec::new();
    leaves(formula, root, &mut |leaf| paths.extend(leaf.paths().into_iter().flatten()));
    paths.sort_unstable();
    paths.dedup();
    paths
}
