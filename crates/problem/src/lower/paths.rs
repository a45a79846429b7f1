//! Names in an objective: what is read of which path.

use super::base::Actions;
use super::consts::Consts;
use super::costs;
use super::diagnostics::{Diagnostics, suggest};
use super::expr::{Context, typed};
use super::limits::Limits;
use super::state::has_value;
use super::template::{Bindings, unquantified_path};
use super::typed::{Bounds, EnumType, Typed};
use crate::expr::{Expr, Leaf, PathLeaf};
use crate::formula::Formula;
use crate::ids::{PathId, SystemId};
use crate::objective::{Mode, PathVar};
use crate::system::System;
use hyperplan_syntax::ast::{self, CompareOp, ExprKind, Ident, Set};
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

/// Definitions by name; `true` for those inside the objective or template, which see its parameters.
pub(super) type Defines<'a> = FxHashMap<&'a str, (&'a ast::Define, bool)>;

/// What the names of a body stand for: of the objective itself, or of a definition that is being expanded.
#[derive(Clone, Debug, Default)]
pub(super) struct Frame<'a> {
    /// Path names; `None` for a path whose system is not known after an error.
    pub(super) paths: Vec<(&'a str, Option<PathId>)>,
    /// Whether the parameters of the template are visible.
    pub(super) parameters: bool,
}

/// Typing expressions over the paths of one objective, and collecting its formula.
pub(super) struct PathContext<'a> {
    pub(super) systems: &'a TiSlice<SystemId, System>,
    /// Systems of which names may be missing after an error.
    pub(super) poisoned: &'a TiSlice<SystemId, bool>,
    pub(super) actions: &'a Actions,
    /// The constants of the file.
    pub(super) globals: &'a Consts,
    /// The constants and the numbers that a template's parameters stand for.
    pub(super) consts: &'a Consts,
    pub(super) bindings: Bindings<'a>,
    pub(super) defines: &'a Defines<'a>,
    pub(super) paths: TiVec<PathId, PathVar>,
    pub(super) frame: Frame<'a>,
    /// The definitions that are being expanded.
    pub(super) expanding: Vec<&'a str>,
    pub(super) mode: Mode,
    pub(super) formula: Formula,
    /// Where a cost is read first.
    pub(super) cost: Option<Span>,
    pub(super) diagnostics: &'a mut Diagnostics,
    pub(super) limits: Limits,
}

impl<'a> PathContext<'a> {
    /// The constants that the present body sees.
    pub(super) fn visible(&self) -> &'a Consts {
        if self.frame.parameters { self.consts } else { self.globals }
    }

    /// The path of that name; `None` after a message.
    pub(super) fn path(&mut self, name: &Ident) -> Option<PathId> {
        if let Some((_, path)) = self.frame.paths.iter().find(|(known, _)| *known == name.name) {
            return *path;
        }
        let known: Vec<&str> = self.frame.paths.iter().map(|(name, _)| *name).collect();
        self.diagnostics.refuse(unquantified_path(name, &known))
    }

    /// The one path of `NAME[PATHS]`.
    pub(super) fn one_path(&mut self, name: &Ident, paths: &[Ident], span: Span) -> Option<PathId> {
        if let [path] = paths {
            return self.path(path);
        }
        let message = format!("`{}` is read of one path, not of {}", name.name, paths.len());
        self.diagnostics.refuse(Diagnostic::error("argument-count", span, message))
    }

    /// The system of a path.
    pub(super) fn system(&self, path: PathId) -> &'a System {
        &self.systems[self.paths[path].system]
    }

    /// A variable or label of a path.
    fn read(&mut self, name: &str, span: Span, path: PathId) -> Option<Typed<PathLeaf>> {
        let system = self.system(path);
        let leaf = |leaf| Expr::Leaf(PathLeaf::State(path, leaf));
        if let Some(var) = system.var(name) {
            return Some(Typed::of_type(leaf(Leaf::Var(var)), &system.vars[var].ty));
        }
        if let Some(label) = system.label(name) {
            return Some(Typed::of_type(leaf(Leaf::Label(label)), &system.labels[label].ty));
        }
        if self.poisoned[self.paths[path].system] {
            return None;
        }
        let message = format!("no label or variable `{name}` in system {}", system.name);
        let diagnostic = Diagnostic::error("unknown-name", span, message);
        if self.actions.get(name).is_some() {
            let p = &self.paths[path].name;
            let help = format!("it is an action: write `action[{p}] == {name}` or `{name} in enabled[{p}]`");
            return self.error(diagnostic.with_help(help));
        }
        let labels = system.labels.iter().map(|label| label.name.as_str());
        let candidates = labels.chain(system.vars.iter().map(|var| var.name.as_str()));
        self.error(suggest(diagnostic, name, candidates))
    }

    /// Whether some system has a label or variable of that name.
    fn is_read_of_paths(&self, name: &str) -> bool {
        self.systems.iter().any(|system| system.label(name).is_some() || system.var(name).is_some())
    }

    /// `goal_p`, `goal.p` or `p.goal`, as other tools write `goal[p]`: the label or variable, and the path.
    fn written_otherwise<'n>(&self, name: &'n str) -> Option<(&'n str, &'n str)> {
        let is_path = |name: &str| self.frame.paths.iter().any(|(known, _)| *known == name);
        let turned = name.split_once('.').map(|(path, read)| (read, path));
        let ways = [name.rsplit_once('_'), name.rsplit_once('.'), turned];
        ways.into_iter().flatten().find(|(read, path)| is_path(path) && self.is_read_of_paths(read))
    }

    /// The label that a template's parameter stands for.
    fn argument(&mut self, param: &Ident, actual: &str, span: Span, path: PathId) -> Option<Typed<PathLeaf>> {
        match self.read(actual, span, path)? {
            Typed::Int(..) | Typed::Enum(..) => {
                let message =
                    format!("`{}` stands for a label, and `{actual}` is no truth value", param.name);
                let diagnostic = Diagnostic::error("parameter-kind", span, message);
                self.error(diagnostic.with_related(param.span, "used as a label here"))
            }
            read => Some(read),
        }
    }

    /// Expands `NAME(ARGS)`: `f` is given the definition's body, with its parameters as the paths in reach.
    pub(super) fn expand<T>(
        &mut self,
        name: &Ident,
        args: &[Ident],
        span: Span,
        f: impl FnOnce(&mut Self, &'a ast::Expr) -> Option<T>,
    ) -> Option<T> {
        let Some((define, local)) = self.defines.get(name.name.as_str()).copied() else {
            let diagnostic =
                Diagnostic::error("unknown-name", name.span, format!("no definition `{}`", name.name));
            if let ([path], true) = (args, self.is_read_of_paths(&name.name)) {
                let help = format!("write `{}[{}]`", name.name, path.name);
                return self.diagnostics.refuse(diagnostic.with_help(help));
            }
            let mut known: Vec<&str> = self.defines.keys().copied().collect();
            known.sort_unstable();
            return self.diagnostics.refuse(suggest(diagnostic, &name.name, known));
        };
        if self.expanding.contains(&define.name.name.as_str()) {
            let message = format!("the definition `{}` uses itself", name.name);
            return self.diagnostics.refuse(Diagnostic::error("cyclic-define", name.span, message));
        }
        if args.len() != define.params.len() {
            let message = format!("`{}` takes {} paths, not {}", name.name, define.params.len(), args.len());
            let diagnostic = Diagnostic::error("argument-count", span, message);
            return self.diagnostics.refuse(diagnostic.with_related(define.name.span, "defined here"));
        }
        let mut paths = Vec::with_capacity(args.len());
        for (param, arg) in define.params.iter().zip(args) {
            paths.push((param.name.as_str(), Some(self.path(arg)?)));
        }
        let outer = std::mem::replace(&mut self.frame, Frame { paths, parameters: local });
        self.expanding.push(&define.name.name);
        self.diagnostics.enter_use(span, format!("in this use of `{}`", name.name));
        let result = f(self, &define.body);
        self.diagnostics.leave_use();
        self.expanding.pop();
        self.frame = outer;
        result
    }
}

impl Context for PathContext<'_> {
    type Leaf = PathLeaf;

    fn parts(&mut self) -> (&mut Diagnostics, &mut Limits) {
        (self.diagnostics, &mut self.limits)
    }

    fn resolve(&mut self, name: &str) -> Option<Option<Typed<PathLeaf>>> {
        // What a system lacks after an error may have been meant.
        let missing = || self.poisoned.iter().any(|poisoned| *poisoned).then_some(None);
        self.visible().typed(name).or_else(missing)
    }

    fn is_enum_value(&self, name: &str) -> bool {
        self.systems.iter().any(|system| system.vars.iter().any(|var| has_value(&var.ty, name)))
    }

    fn unknown(&mut self, name: &str, span: Span) -> Diagnostic {
        if let Some(help) = special_help(name) {
            let message = format!("`{name}` is read of a path: say of which");
            return Diagnostic::error("missing-path", span, message).with_help(help);
        }
        if self.is_read_of_paths(name) {
            let path = self.frame.paths.first().map_or("p", |(path, _)| path);
            let message = format!("`{name}` is read of a path: say of which");
            let help = format!("write `{name}[{path}]`");
            return Diagnostic::error("missing-path", span, message).with_help(help);
        }
        if self.actions.get(name).is_some() {
            let message = format!("`{name}` is an action, and no value");
            let help = format!("write `action[p] == {name}` or `{name} in enabled[p]`");
            return Diagnostic::error("misplaced-action", span, message).with_help(help);
        }
        let diagnostic = Diagnostic::error("unknown-name", span, format!("no constant `{name}`"));
        if let Some((read, path)) = self.written_otherwise(name) {
            return diagnostic.with_help(format!("write `{read}[{path}]`"));
        }
        if let Some((read, _)) = name.split_once('[').filter(|(read, _)| self.is_read_of_paths(read)) {
            let path = self.frame.paths.first().map_or("p", |(path, _)| path);
            return diagnostic.with_help(format!("in brackets stands a path: write `{read}[{path}]`"));
        }
        let named = self.systems.iter().flat_map(|s| {
            let labels = s.labels.iter().map(|l| l.name.as_str());
            labels.chain(s.vars.iter().map(|v| v.name.as_str()))
        });
        suggest(diagnostic, name, self.visible().names().chain(named))
    }

    fn at(&mut self, name: &Ident, paths: &[Ident], span: Span) -> Option<Typed<PathLeaf>> {
        if let [read] = paths
            && self.frame.paths.iter().any(|(path, _)| *path == name.name)
            && !self.frame.paths.iter().any(|(path, _)| *path == read.name)
            && self.is_read_of_paths(&read.name)
        {
            let message = format!("`{}` is a path, and `{}` is read of it", name.name, read.name);
            let help = format!("write `{}[{}]`", read.name, name.name);
            return self.error(Diagnostic::error("unknown-name", span, message).with_help(help));
        }
        let path = self.one_path(name, paths, span)?;
        if let Some(help) = special_help(&name.name) {
            let message = format!("`{}[...]` is no value", name.name);
            return self.error(Diagnostic::error("misplaced-special", span, message).with_help(help));
        }
        let argument =
            if self.frame.parameters { self.bindings.labels.get(name.name.as_str()) } else { None };
        match argument {
            Some(ast::Expr { kind: ExprKind::Name(actual), span }) => {
                self.argument(name, actual, *span, path)
            }
            _ => self.read(&name.name, name.span, path),
        }
    }

    fn cost(&mut self, name: &Ident, paths: &[Ident], span: Span) -> Option<Typed<PathLeaf>> {
        let path = self.one_path(name, paths, span)?;
        let poisoned = self.poisoned[self.paths[path].system];
        let system = self.system(path);
        let cost = costs::known_cost(system, name, poisoned, self.diagnostics)?;
        self.cost.get_or_insert(span);
        let leaf = PathLeaf::State(path, Leaf::Var(costs::placeholder(system, cost)));
        Some(Typed::Int(Expr::Leaf(leaf), Some(Bounds { lo: 0, hi: costs::most(&system.costs[cost]) })))
    }

    fn call(
        &mut self,
        name: &Ident,
        args: &[Ident],
        hint: Option<&EnumType>,
        span: Span,
    ) -> Option<Typed<PathLeaf>> {
        self.expand(name, args, span, |cx, body| typed(cx, body, hint))
    }

    fn compare_special(
        &mut self,
        op: CompareOp,
        a: &ast::Expr,
        b: &ast::Expr,
        span: Span,
    ) -> Option<Option<Typed<PathLeaf>>> {
        self.special_comparison(op, a, b, span)
    }

    fn member_special(
        &mut self,
        element: &ast::Expr,
        set: &Set,
        span: Span,
    ) -> Option<Option<Typed<PathLeaf>>> {
        self.special_membership(element, set, span)
    }

    fn temporal(&self, span: Span) -> Diagnostic {
        Diagnostic::error("misplaced-temporal", span, "a temporal operator cannot stand inside an expression")
            .with_help("only `! & | -> <->`, `==` and `if` may stand around a temporal operator")
    }
}

/// How the names that are no variables are used.
fn special_help(name: &str) -> Option<&'static str> {
    match name {
        "action" => Some("compare it: `action[p] == up` or `action[p] == action[q]`"),
        "state" => Some("compare it: `state[p] == state[q]`"),
        "obs" => Some("compare it: `obs[p] == obs[q]`"),
        "enabled" => Some("write `ACTION in enabled[p]`"),
        _ => None,
    }
}
