//! Systems: variables, actions, labels, and what else an item of a system can say.

use super::base::{Actions, Base};
use super::clauses::lower_clause;
use super::consts::duplicate;
use super::env::Env;
use super::expr::{Context, truth, typed};
use super::labels;
use super::limits::{Limits, MAX_RANGE};
use super::state::{Names, StateContext, TransContext};
use super::typed::{EnumType, and_also, or_else};
use super::{also, costs, graphs, maps};
use crate::edges::Edges;
use crate::expr::{Expr, Leaf, Type};
use crate::ids::{ActionId, LabelId, VarId};
use crate::system::{Label, System, Var};
use hyperplan_syntax::ast::{self, ExprKind, Ident, SystemItem, SystemKind};
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::FxHashMap;
use std::cell::RefCell;
use typed_index_collections::TiVec;

/// Names with a meaning of their own in objectives.
const RESERVED: [&str; 5] = ["action", "state", "obs", "enabled", "none"];

/// A system, and whether names of it may be missing after an error.
pub(crate) fn lower_system(ast: &ast::System, env: &mut Env) -> (System, bool) {
    let base = base(ast, env);
    let mut cx = StateContext {
        consts: env.consts,
        diagnostics: env.diagnostics,
        names: Names::default(),
        vars: base.vars,
        label_types: vec![Type::Bool; base.labels.len()],
        system: ast.name.name.clone(),
        poisoned: base.poisoned,
        limits: Limits::default(),
        values: RefCell::default(),
    };
    declare_base(&mut cx, &base.labels);
    let actions = actions(&mut cx, ast, base.actions, env.actions);
    variables(&mut cx, ast, &|| actions.iter().map(|&action| env.actions.names[action].clone()).collect());
    let labels = lower_labels(&mut cx, ast, base.labels);
    demand_new_names(&mut cx, base.edges.as_ref());
    let mut system = System {
        name: ast.name.name.clone(),
        vars: cx.vars.clone(),
        actions,
        clauses: base.clauses,
        also: Vec::new(),
        costs: TiVec::new(),
        base: None,
        edges: base.edges,
        trans: Expr::TRUE,
        init: base.init,
        labels: labels.into_iter().collect(),
        absorb: base.absorb,
        observe: Vec::new(),
        map: base.map,
        coordinates: base.coordinates,
        span: ast.span,
    };
    for item in &ast.items {
        lower_item(&mut cx, item, &ast.kind, env.actions, &mut system);
    }
    also::demand_apart(&mut cx, &system);
    (system, cx.poisoned)
}

/// Where the system starts from: a map, a graph, or nothing.
fn base(ast: &ast::System, env: &mut Env) -> Base {
    match &ast.kind {
        SystemKind::Plain => Base::default(),
        SystemKind::GridRows(rows) => maps::inline(ast, rows, env),
        SystemKind::GridFile(file) => maps::file(ast, file, env),
        SystemKind::Graph(file) => graphs::file(ast, file, env),
    }
}

/// Makes the variables and labels of a map or graph known.
fn declare_base(cx: &mut StateContext, labels: &[Label]) {
    let vars = cx.vars.iter_enumerated().map(|(id, var)| (var.name.clone(), Leaf::Var(id), var.span));
    let labels = labels.iter().enumerate();
    let labels = labels.map(|(id, label)| (label.name.clone(), Leaf::Label(LabelId::from(id)), label.span));
    for (name, leaf, span) in vars.chain(labels).collect::<Vec<_>>() {
        declare(cx, &Ident { name, span }, leaf);
    }
}

/// Declares a variable or label, unless its name is taken.
fn declare(cx: &mut StateContext, name: &Ident, leaf: Leaf) -> bool {
    let what = match leaf {
        Leaf::Var(_) => "variable",
        Leaf::Label(_) => "label",
    };
    if RESERVED.contains(&name.name.as_str()) {
        let message =
            format!("`{}` has a meaning of its own in objectives: no {what} can have that name", name.name);
        cx.diagnostics.push(Diagnostic::error("reserved-name", name.span, message));
        return false;
    }
    let clash = match cx.names.get(&name.name) {
        Some((Leaf::Var(_), first)) => Some(duplicate("variable", name, *first)),
        Some((Leaf::Label(_), first)) => Some(duplicate("label", name, *first)),
        None => cx.consts.get(&name.name).map(|constant| duplicate("constant", name, constant.span)),
    };
    if let Some(diagnostic) = clash {
        cx.diagnostics.push(diagnostic);
        return false;
    }
    cx.names.insert(name.name.clone(), (leaf, name.span));
    true
}

/// Refuses variables, labels and constants that are called as the numbers of a graph's transitions are.
fn demand_new_names(cx: &mut StateContext, edges: Option<&Edges>) {
    for attribute in edges.iter().flat_map(|edges| edges.attributes()).filter(|a| !a.derived) {
        let name = attribute.name.as_str();
        let constant = || cx.consts.get(name).map(|constant| constant.span);
        if let Some(place) = cx.names.get(name).map(|(_, place)| *place).or_else(constant) {
            let message = format!("`{name}` is an attribute of the graph's transitions");
            let diagnostic = Diagnostic::error("duplicate-name", place, message);
            cx.diagnostics.push(diagnostic.with_help("rename one of them"));
        }
    }
}

/// Reads the `state` items, of a system with these actions.
fn variables(cx: &mut StateContext, ast: &ast::System, actions: &dyn Fn() -> EnumType) {
    for item in &ast.items {
        let SystemItem::State(declarations) = item else { continue };
        for declaration in declarations {
            let id = VarId::from(cx.vars.len());
            match lower_type(cx, declaration, actions) {
                Some(ty) if declare(cx, &declaration.name, Leaf::Var(id)) => {
                    let (name, span) = (declaration.name.name.clone(), declaration.name.span);
                    cx.vars.push(Var { name, ty, sums: None, span });
                }
                _ => cx.poisoned = true,
            }
        }
    }
}

fn lower_type(
    cx: &mut StateContext,
    declaration: &ast::StateDecl,
    actions: &dyn Fn() -> EnumType,
) -> Option<Type> {
    let span = declaration.ty_span;
    match &declaration.ty {
        ast::Type::Bool => Some(Type::Bool),
        ast::Type::Range(lo, hi) => {
            let ends = [lo, hi].map(|end| cx.consts.evaluate(end, cx.diagnostics));
            let [Some(lo), Some(hi)] = ends else { return None };
            let diagnostic = if lo > hi {
                let help = format!("the lower end comes first: {hi}..{lo}");
                Diagnostic::error("empty-range", span, format!("the range {lo}..{hi} is empty"))
                    .with_help(help)
            } else if lo < -MAX_RANGE || hi > MAX_RANGE {
                Diagnostic::error("number-too-large", span, "the ends of a range must lie within 2^40")
            } else {
                return Some(Type::Range { lo, hi });
            };
            cx.error(diagnostic)
        }
        ast::Type::Enum(values) => {
            let mut seen = FxHashMap::default();
            for value in values {
                if let Some(first) = seen.insert(value.name.as_str(), value.span) {
                    return cx.error(duplicate("value", value, first));
                }
            }
            Some(Type::Enum(values.iter().map(|v| v.name.clone()).collect()))
        }
        ast::Type::Int => Some(Type::Int),
        ast::Type::Real => Some(Type::Real),
        ast::Type::Action => Some(Type::Enum(actions())),
    }
}

/// Reads the `action` items; they follow the moves of the map or the actions of the graph. A system without any has
/// the action `step`.
fn actions(
    cx: &mut StateContext,
    ast: &ast::System,
    mut declared: Vec<ActionId>,
    known: &mut Actions,
) -> Vec<ActionId> {
    let mut places: FxHashMap<String, Span> =
        declared.iter().map(|id| (known.names[*id].clone(), ast.span)).collect();
    for item in &ast.items {
        let SystemItem::Action(names) = item else { continue };
        for name in names {
            if name.name == "none" {
                let message =
                    "`none` says in objectives that no action was taken: no action can have that name";
                cx.diagnostics.push(Diagnostic::error("reserved-name", name.span, message));
                // Clauses of it are not wrong on their own account.
                declared.push(known.intern(&name.name));
            } else if let Some(first) = places.get(name.name.as_str()) {
                cx.diagnostics.push(duplicate("action", name, *first));
            } else {
                places.insert(name.name.clone(), name.span);
                declared.push(known.intern(&name.name));
            }
        }
    }
    if declared.is_empty() {
        declared.push(known.intern("step"));
    }
    declared
}

/// Reads the `label` items; they follow the labels of the map, and are sorted so that each reads only earlier ones.
fn lower_labels(cx: &mut StateContext, ast: &ast::System, mut labels: Vec<Label>) -> Vec<Label> {
    let mut bodies = Vec::new();
    let mut next = labels.len();
    for item in &ast.items {
        let SystemItem::Label(name, body) = item else { continue };
        if declare(cx, name, Leaf::Label(LabelId::from(next))) {
            next += 1;
            bodies.push((name, body));
        } else {
            // Its expression may be wrong on its own account.
            typed(cx, body, None);
        }
    }
    let own = labels.len();
    let names =
        (0..).zip(&bodies).map(|(at, (name, _)): (usize, &(&Ident, &ast::Expr))| (name.name.as_str(), at));
    let names: FxHashMap<&str, usize> = names.collect();
    let exprs: Vec<&ast::Expr> = bodies.iter().map(|(_, body)| *body).collect();
    for (name, _) in &bodies {
        let (name, span) = (name.name.clone(), name.span);
        labels.push(Label { name, expr: Expr::FALSE, ty: Type::Bool, nested: false, span });
    }
    cx.label_types.resize(labels.len(), Type::Bool);
    for at in labels::typing_order(&exprs, &names) {
        let hint = only_enumeration(cx, exprs[at]);
        let Some(found) = typed(cx, exprs[at], hint.as_ref()) else { continue };
        let (expr, ty) = found.into_parts();
        if ty == Type::Real {
            let message = "a label is a truth value, an integer, or one of an enumeration";
            cx.diagnostics.push(Diagnostic::error("type-mismatch", exprs[at].span, message));
            continue;
        }
        cx.label_types[own + at] = ty.clone();
        labels[own + at] = Label { expr, ty, ..labels[own + at].clone() };
    }
    let (labels, new) = labels::sort(labels, cx.diagnostics);
    cx.label_types = labels.iter().map(|label| label.ty.clone()).collect();
    for (leaf, _) in cx.names.values_mut() {
        if let Leaf::Label(id) = leaf {
            *id = new[usize::from(*id)];
        }
    }
    labels
}

/// The enumeration of a choice all of whose values are names of some: the only one that has all of them.
fn only_enumeration(cx: &StateContext, e: &ast::Expr) -> Option<EnumType> {
    if !matches!(e.kind, ExprKind::If(..)) {
        return None;
    }
    let mut values = Vec::new();
    let mut stack = vec![e];
    while let Some(e) = stack.pop() {
        match &e.kind {
            ExprKind::If(branches, last) => {
                stack.extend(branches.iter().map(|(_, value)| value).chain([&**last]));
            }
            ExprKind::Name(name) if !cx.names.contains_key(name) => values.push(name),
            ExprKind::Text(name) => values.push(name),
            _ => return None,
        }
    }
    let has_all = |of: &EnumType| values.iter().all(|value| of.contains(value));
    let enumerations = cx.vars.iter().filter_map(|var| match &var.ty {
        Type::Enum(of) => Some(of),
        _ => None,
    });
    let mut fitting = enumerations.filter(|of| has_all(of));
    let first = fitting.next()?;
    fitting.all(|other| other == first).then(|| first.clone())
}

fn lower_item(
    cx: &mut StateContext,
    item: &SystemItem,
    kind: &SystemKind,
    actions: &Actions,
    system: &mut System,
) {
    match item {
        SystemItem::State(_) | SystemItem::Label(..) | SystemItem::Action(_) => {}
        SystemItem::On(clause) => system.clauses.extend(lower_clause(cx, clause, system, actions)),
        SystemItem::Also(clause) => system.also.extend(also::lower_also(cx, clause, system, actions)),
        SystemItem::Cost(name, e) => system.costs.extend(costs::lower_cost(cx, name, e, system, actions)),
        SystemItem::Init(e) => {
            if let Some(e) = truth(cx, e) {
                and_also(&mut system.init, e);
            }
        }
        SystemItem::Absorb(e) => {
            if let Some(e) = truth(cx, e) {
                or_else(&mut system.absorb, e);
            }
        }
        SystemItem::Trans(e) => {
            let mut step = TransContext::new(cx);
            if let Some(e) = truth(&mut step, e) {
                and_also(&mut system.trans, e);
            }
        }
        SystemItem::Observe(es) => {
            for e in es {
                let Some(typed) = typed(cx, e, None) else { continue };
                system.observe.push(typed.into_parts().0);
            }
        }
        SystemItem::Moves(names) => only_maps(cx, kind, "moves", names.first()),
        SystemItem::Obstacle(name) => only_maps(cx, kind, "obstacle", Some(name)),
        SystemItem::Edge(name) => only_maps(cx, kind, "edge", Some(name)),
        SystemItem::Corner(name) => only_maps(cx, kind, "corner", Some(name)),
        SystemItem::Map { item, span } => {
            let name = Ident { name: item.word().to_owned(), span: *span };
            only_maps(cx, kind, item.word(), Some(&name));
        }
        SystemItem::Legend { letter, span, .. } => {
            let name = Ident { name: letter.text.clone(), span: *span };
            only_maps(cx, kind, "legend", Some(&name));
        }
    }
}

/// Refuses an item that only maps have.
fn only_maps(cx: &mut StateContext, kind: &SystemKind, item: &str, at: Option<&Ident>) {
    if let (SystemKind::Plain | SystemKind::Graph(_), Some(at)) = (kind, at) {
        let message = format!("`{item}` belongs to maps");
        let diagnostic = Diagnostic::error("misplaced-item", at.span, message);
        cx.diagnostics
            .push(diagnostic.with_help("a map is declared as `system NAME = grid(\"file\") { ... }`"));
    }
}
