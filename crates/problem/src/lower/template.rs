//! Templates: what their parameters stand for, and binding them to arguments.

use super::consts::{Constant, Consts, duplicate};
use super::diagnostics::Diagnostics;
use super::walk::visit;
use hyperplan_syntax::ast::{self, Expr, ExprKind, Ident};
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::FxHashMap;

/// What a parameter stands for, as its uses say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Label,
    Number,
}

/// The arguments of a template's instance.
#[derive(Clone, Debug, Default)]
pub(super) struct Bindings<'a> {
    /// Parameters that stand for labels (or variables), with the arguments.
    pub(super) labels: FxHashMap<&'a str, &'a Expr>,
    /// Parameters that stand for numbers: where their arguments stand.
    pub(super) numbers: FxHashMap<&'a str, Span>,
}

/// How each parameter is used; reports uses that disagree. The answer follows the order of the parameters.
fn kinds(template: &ast::Template, diagnostics: &mut Diagnostics) -> Vec<Option<(Kind, Span)>> {
    let mut kinds: FxHashMap<&str, Option<(Kind, Span)>> =
        template.params.iter().map(|p| (p.name.as_str(), None)).collect();
    let bodies = template.formula.defines.iter().map(|d| &d.body).chain([&template.formula.body]);
    for body in bodies {
        visit(body, &mut |e| {
            let (name, kind, span) = match &e.kind {
                ExprKind::At(name, _) => (name.name.as_str(), Kind::Label, name.span),
                ExprKind::Name(name) => (name.as_str(), Kind::Number, e.span),
                _ => return,
            };
            let Some(known) = kinds.get_mut(name) else { return };
            match *known {
                Some((other, first)) if other != kind => {
                    let message =
                        format!("`{name}` stands for a label in one place and for a number in another");
                    let diagnostic = Diagnostic::error("parameter-kind", span, message);
                    diagnostics.push(diagnostic.with_related(first, "the other place"));
                }
                Some(_) => {}
                None => *known = Some((kind, span)),
            }
        });
    }
    template.params.iter().map(|p| kinds.get(p.name.as_str()).copied().flatten()).collect()
}

/// Checks what can be checked of a template that may never be used.
pub(super) fn check(template: &ast::Template, diagnostics: &mut Diagnostics) {
    for (index, param) in template.params.iter().enumerate() {
        if let Some(first) = template.params[..index].iter().find(|p| p.name == param.name) {
            diagnostics.push(duplicate("parameter", param, first.span));
        }
    }
    kinds(template, diagnostics);
    let paths: Vec<&str> = template.formula.quantifiers.iter().map(|q| q.path.name.as_str()).collect();
    unquantified(&template.formula.body, &paths, diagnostics);
    for define in &template.formula.defines {
        let paths: Vec<&str> = define.params.iter().map(|p| p.name.as_str()).collect();
        unquantified(&define.body, &paths, diagnostics);
    }
}

/// Reports paths that nothing quantifies.
pub(super) fn unquantified(body: &Expr, known: &[&str], diagnostics: &mut Diagnostics) {
    visit(body, &mut |e| {
        let paths: Vec<&Ident> = match &e.kind {
            ExprKind::At(_, paths) | ExprKind::Cost(_, paths) | ExprKind::Call(_, paths) => {
                paths.iter().collect()
            }
            ExprKind::In(_, ast::Set::Enabled(path, _)) => vec![path],
            _ => return,
        };
        for path in paths.into_iter().filter(|p| !known.contains(&p.name.as_str())) {
            diagnostics.push(unquantified_path(path, known));
        }
    });
}

/// The message about a path that nothing quantifies.
pub(super) fn unquantified_path(path: &Ident, known: &[&str]) -> Diagnostic {
    let message = format!("the path `{}` is not quantified", path.name);
    let diagnostic = Diagnostic::error("unquantified-path", path.span, message);
    super::diagnostics::suggest(diagnostic, &path.name, known.iter().copied())
}

/// Binds the arguments of an instance. The numbers are added to (a copy of) the constants, where they hide constants
/// of the same names. `None` after a message.
pub(super) fn bind<'a>(
    template: &'a ast::Template,
    name: &Ident,
    args: &'a [Expr],
    consts: &Consts,
    diagnostics: &mut Diagnostics,
) -> Option<(Bindings<'a>, Consts)> {
    if args.len() != template.params.len() {
        let params: Vec<&str> = template.params.iter().map(|p| p.name.as_str()).collect();
        let message = format!("`{}` takes {}, not {}", name.name, count(params.len()), args.len());
        let help = format!("its parameters are ({})", params.join(", "));
        return diagnostics.refuse(Diagnostic::error("argument-count", name.span, message).with_help(help));
    }
    let kinds = kinds(template, diagnostics);
    let mut bindings = Bindings::default();
    let mut visible = consts.clone();
    let mut complete = true;
    for ((param, kind), arg) in template.params.iter().zip(kinds).zip(args) {
        match kind {
            None => {}
            Some((Kind::Label, used)) => match &arg.kind {
                ExprKind::Name(_) => drop(bindings.labels.insert(param.name.as_str(), arg)),
                _ => {
                    complete = false;
                    let message = format!("`{}` stands for a label", param.name);
                    let diagnostic = Diagnostic::error("parameter-kind", arg.span, message);
                    diagnostics.push(diagnostic.with_related(used, "used as a label here"));
                }
            },
            Some((Kind::Number, used)) => {
                let words = format!("`{}` stands for a number", param.name);
                diagnostics.enter_use(used, words);
                let value = consts.number(arg, diagnostics);
                diagnostics.leave_use();
                complete &= value.is_some();
                visible.insert(&param.name, Constant { value, span: arg.span });
                bindings.numbers.insert(param.name.as_str(), arg.span);
            }
        }
    }
    complete.then_some((bindings, visible))
}

fn count(n: usize) -> String {
    if n == 1 { "one argument".into() } else { format!("{n} arguments") }
}
