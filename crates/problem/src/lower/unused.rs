//! What a file declares and never uses.
//!
//! Uses are by name: a label of one system counts as used if any system, objective or template names it so, which
//! misses some unused labels and blames no used one. Labels that a map's letters declare are not asked about.

use super::walk::{visit, visit_set};
use hyperplan_syntax::Diagnostic;
use hyperplan_syntax::ast::{
    Expr, ExprKind, File, Formula, Ident, Item, Objective, ObjectiveBody, SystemItem, Template, Type,
    UpdateValue,
};
use rustc_hash::FxHashSet;

/// A warning for each declaration that nothing uses, in the order of the file.
pub(super) fn unused(file: &File) -> Vec<Diagnostic> {
    let mut uses = Uses::default();
    for item in &file.items {
        uses.item(item);
    }
    if file.items.iter().all(|item| !matches!(item, Item::Objective(_))) {
        // A file of systems alone is there to be looked at.
        return Vec::new();
    }
    let quantified = systems_quantified(file);
    let mut found = Vec::new();
    for item in &file.items {
        match item {
            Item::Const(item) => found.extend(uses.unless_used("constant", &item.name)),
            Item::Template(item) => found.extend(uses.unless_used("template", &item.name)),
            Item::Define(item) => found.extend(uses.unless_used("definition", &item.name)),
            Item::System(item) if !quantified.contains(item.name.name.as_str()) => {
                found.push(warning("system", &item.name).with_help("no path of an objective is one of it"));
            }
            Item::System(item) => {
                for item in &item.items {
                    if let SystemItem::Label(name, _) = item {
                        found.extend(uses.unless_used("label", name));
                    }
                }
            }
            Item::Objective(_) => {}
        }
    }
    found
}

/// Whether something in the file, an objective or what it may depend on, uses that name.
#[must_use]
pub fn uses(file: &File, name: &str) -> bool {
    let mut uses = Uses::default();
    file.items.iter().for_each(|item| uses.item(item));
    uses.names.contains(name)
}

fn warning(what: &str, name: &Ident) -> Diagnostic {
    Diagnostic::warning("unused", name.span, format!("{what} {} is never used", name.name))
}

/// The systems that paths belong to: the only one, or those that quantifiers name.
fn systems_quantified(file: &File) -> FxHashSet<&str> {
    let systems = file.items.iter().filter_map(|item| match item {
        Item::System(system) => Some(system.name.name.as_str()),
        _ => None,
    });
    let all: FxHashSet<&str> = systems.collect();
    if all.len() < 2 {
        return all;
    }
    let quantifiers = file.items.iter().flat_map(|item| match item {
        Item::Template(Template { formula, .. })
        | Item::Objective(Objective { body: ObjectiveBody::Formula(formula), .. }) => {
            &formula.quantifiers[..]
        }
        _ => &[],
    });
    quantifiers.filter_map(|q| q.system.as_ref()).map(|s| s.name.as_str()).collect()
}

/// Every name that stands in an expression.
#[derive(Default)]
struct Uses<'a> {
    names: FxHashSet<&'a str>,
}

impl<'a> Uses<'a> {
    fn unless_used(&self, what: &str, name: &Ident) -> Option<Diagnostic> {
        (!self.names.contains(name.name.as_str())).then(|| warning(what, name))
    }

    fn item(&mut self, item: &'a Item) {
        match item {
            Item::Const(item) => self.exprs([&item.value]),
            Item::System(item) => item.items.iter().for_each(|item| self.system_item(item)),
            Item::Define(item) => self.exprs([&item.body]),
            Item::Template(item) => self.formula(&item.formula),
            Item::Objective(objective) => {
                self.exprs(&objective.within);
                match &objective.body {
                    ObjectiveBody::Formula(formula) => self.formula(formula),
                    ObjectiveBody::Instance { template, args } => {
                        self.names.insert(&template.name);
                        self.exprs(args);
                    }
                }
            }
        }
    }

    fn formula(&mut self, formula: &'a Formula) {
        self.exprs(
            formula.defines.iter().map(|define| &define.body).chain([&formula.body]).chain(&formula.minimize),
        );
    }

    fn system_item(&mut self, item: &'a SystemItem) {
        match item {
            SystemItem::State(declared) => {
                for declared in declared {
                    if let Type::Range(lo, hi) = &declared.ty {
                        self.exprs([lo, hi]);
                    }
                }
            }
            SystemItem::On(clause) | SystemItem::Also(clause) => {
                self.exprs(&clause.guard);
                for update in &clause.updates {
                    match &update.value {
                        UpdateValue::Assign(e) => self.exprs([e]),
                        UpdateValue::Choose(set) => visit_set(set, &mut |e| self.name(e)),
                    }
                }
            }
            SystemItem::Init(e)
            | SystemItem::Label(_, e)
            | SystemItem::Cost(_, e)
            | SystemItem::Absorb(e)
            | SystemItem::Trans(e) => self.exprs([e]),
            SystemItem::Observe(es) => self.exprs(es),
            SystemItem::Map { item, .. } => self.exprs(item.exprs()),
            _ => {}
        }
    }

    fn exprs(&mut self, es: impl IntoIterator<Item = &'a Expr>) {
        for e in es {
            visit(e, &mut |e| self.name(e));
        }
    }

    fn name(&mut self, e: &'a Expr) {
        match &e.kind {
            ExprKind::Name(name) | ExprKind::Primed(name) => drop(self.names.insert(name)),
            ExprKind::At(name, _) | ExprKind::Call(name, _) => drop(self.names.insert(&name.name)),
            _ => {}
        }
    }
}
