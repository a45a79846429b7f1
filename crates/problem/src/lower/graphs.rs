//! Systems from graph files: states and transitions listed one by one, in JSON; and graphs of others, whose edges become
//! actions.

mod geojson;
mod graphml;
mod node_link;
mod roadmap;

use super::base::Base;
use super::diagnostics::suggest;
use super::env::Env;
use super::files::load_text;
use super::json::{Kind, Piece};
use super::limits::MAX_RANGE;
use crate::edges::{Edge, Edges};
use crate::expr::{Comparison, Expr, Leaf, TupleSet, Type, Value};
use crate::ids::{ActionId, VarId};
use crate::system::{Label, Var};
use hyperplan_syntax::ast::{self, Text};
use hyperplan_syntax::{Diagnostic, Span, is_name};
use indexmap::IndexMap;
use rustc_hash::{FxBuildHasher, FxHashMap};
use std::sync::Arc;

/// The only variable of a graph: the state it is in.
const NODE: VarId = VarId(0);

/// More mistakes of one file are not worth telling one by one.
const MAX_ERRORS: usize = 10;

/// Most states that a graph may have.
const MAX_STATES: usize = 4_000_000;

/// Most attributes of one graph: each has a number for every transition.
const MAX_ATTRIBUTES: usize = 64;

/// What a transition with attributes has in any case.
const ENDS: [&str; 3] = ["from", "action", "to"];

/// What a graph file may say.
const MEMBERS: [&str; 6] = ["states", "actions", "initial", "transitions", "labels", "coordinates"];

/// The system that a graph file describes, as far as it can be read.
pub(super) fn file(ast: &ast::System, file: &Text, env: &mut Env) -> Base {
    let nothing = Base { poisoned: true, ..Base::default() };
    let Some(text) = load_text(file, "a graph", env) else { return nothing };
    let text: Arc<str> = text.into();
    let source = env.sources.add(file.text.clone(), text.clone());
    if u32::try_from(text.len()).is_err() {
        let message = format!("`{}` is larger than 4 GiB", file.text);
        env.diagnostics.push(Diagnostic::error("too-large", file.span, message));
        return nothing;
    }
    let mut reader = Reader { env, errors: 0 };
    let whole = Span::new(source, 0..text.len().min(1));
    if let Some((what, instead)) = other(&file.text) {
        let message = format!("`{}` is {what}, which is not read", file.text);
        reader.error(Diagnostic::error("not-supported", file.span, message).with_help(instead));
        return nothing;
    }
    if text.trim_start().starts_with('<') {
        let map = graphml::read(&mut reader, source, &text);
        return map.into_base(&mut reader, whole, ast.span).unwrap_or(nothing);
    }
    match Piece::parse(source, &text) {
        Ok(root) => {
            let members = root.object().unwrap_or_default();
            let map = if geojson::is_one(&members) {
                geojson::read(&mut reader, &members, root)
            } else if node_link::is_one(&members) {
                node_link::read(&mut reader, &members)
            } else {
                return reader.graph(root, ast.span).unwrap_or(nothing);
            };
            map.into_base(&mut reader, whole, ast.span).unwrap_or(nothing)
        }
        Err(diagnostic) => {
            reader.error(*diagnostic);
            nothing
        }
    }
}

/// What is no graph that can be read, by its name, and what to give instead.
fn other(path: &str) -> Option<(&'static str, &'static str)> {
    let lower = path.to_lowercase();
    let dot = [".dot", ".gv"].iter().any(|end| lower.ends_with(end));
    dot.then_some((
        "a graph in DOT",
        "networkx turns it into JSON: `json.dump(node_link_data(nx_pydot.read_dot(FILE)), ...)`",
    ))
}

/// Whether numbers of transitions can be called so.
fn is_attribute(name: &str) -> bool {
    is_name(name) && name != "node" && name != "action"
}

struct Reader<'a, 'e> {
    env: &'a mut Env<'e>,
    errors: usize,
}

/// Names in their order, and where each stands.
type Table = IndexMap<String, Span, FxBuildHasher>;

/// The transitions with their numbers, and what the numbers are called.
#[derive(Default)]
struct Listed {
    edges: Vec<(u32, Edge, Vec<i64>)>,
    attributes: Table,
}

impl Reader<'_, '_> {
    fn error(&mut self, diagnostic: Diagnostic) {
        self.errors += 1;
        if self.errors <= MAX_ERRORS {
            self.env.diagnostics.push(diagnostic);
        }
    }

    fn bad(&mut self, span: Span, message: impl Into<String>) {
        self.error(Diagnostic::error("bad-graph", span, message));
    }

    /// Says how many mistakes were not shown.
    fn end(&mut self, whole: Span) {
        if self.errors > MAX_ERRORS {
            let message = format!("{} more mistakes of the graph are not shown", self.errors - MAX_ERRORS);
            self.env.diagnostics.push(Diagnostic::error("bad-graph", whole, message));
        }
    }

    /// The members of an object; `None` after a message.
    fn object<'t>(&mut self, piece: Piece<'t>, what: &str) -> Option<Vec<(Piece<'t>, Piece<'t>)>> {
        let members = piece.object();
        if members.is_none() {
            self.bad(piece.start(), format!("{what} is an object, not {}", piece.describe()));
        }
        members
    }

    /// The parts of the system; poisoned after a message, `None` where nothing can be made of it.
    fn graph(&mut self, root: Piece<'_>, span: Span) -> Option<Base> {
        let members = self.members(root)?;
        let states = self.required(root, &members, "states");
        let actions = self.required(root, &members, "actions");
        let transitions = self.required(root, &members, "transitions");
        let states = states.and_then(|states| self.table(states, "state"));
        let actions = actions.and_then(|actions| self.table(actions, "action"));
        if let Some(span) = actions.as_ref().and_then(|a| a.get("none")) {
            let message = "`none` says in objectives that no action was taken: no action can have that name";
            self.error(Diagnostic::error("reserved-name", *span, message));
        }
        let ids: Vec<ActionId> =
            actions.iter().flat_map(Table::keys).map(|name| self.env.actions.intern(name)).collect();
        let edges = match (&states, &actions, transitions) {
            (Some(states), Some(actions), Some(all)) => self.transitions(all, states, actions, &ids),
            _ => Listed::default(),
        };
        let none = Table::default();
        let known = states.as_ref().unwrap_or(&none);
        let init = match members.get("initial") {
            Some(initial) if states.is_some() => self.initial(*initial, known),
            _ => Expr::TRUE,
        };
        let labels = match members.get("labels") {
            Some(labels) if states.is_some() => self.labels(*labels, known),
            _ => Vec::new(),
        };
        let coordinates = match members.get("coordinates") {
            Some(places) if states.is_some() => self.coordinates(*places, known),
            _ => None,
        };
        self.end(root.start());
        let states = states?;
        let count = states.len();
        let names: Vec<String> = edges.attributes.into_keys().collect();
        let mut edges = Edges::with_attributes(NODE, count, &names, edges.edges);
        if let Some(places) = &coordinates {
            edges = edges.with_distances(places);
        }
        let node =
            Var { name: "node".into(), ty: Type::Enum(states.into_keys().collect()), sums: None, span };
        Some(Base {
            vars: [node].into_iter().collect(),
            actions: ids,
            edges: Some(edges),
            labels,
            init,
            coordinates: coordinates.map(Into::into),
            poisoned: self.errors > 0,
            ..Base::default()
        })
    }

    /// The members of the file's object by name; what nobody knows is reported.
    fn members<'t>(&mut self, root: Piece<'t>) -> Option<FxHashMap<&'static str, Piece<'t>>> {
        let Some(all) = root.object() else {
            let message = format!("expected an object with the graph, found {}", root.describe());
            self.bad(root.start(), message);
            return None;
        };
        let mut members = FxHashMap::default();
        let mut places: FxHashMap<&str, Span> = FxHashMap::default();
        for (name, value) in all {
            let text = name.text().unwrap_or_default();
            let Some(known) = MEMBERS.into_iter().find(|known| *known == text) else {
                let message = format!("a graph has no `{text}`");
                self.error(suggest(
                    Diagnostic::error("unknown-member", name.span(), message),
                    &text,
                    MEMBERS,
                ));
                continue;
            };
            if let Some(first) = places.insert(known, name.span()) {
                let message = format!("`{known}` is given twice");
                let diagnostic = Diagnostic::error("duplicate-name", name.span(), message);
                self.error(diagnostic.with_related(first, "the first one"));
            }
            members.insert(known, value);
        }
        Some(members)
    }

    fn required<'t>(
        &mut self,
        root: Piece<'_>,
        members: &FxHashMap<&str, Piece<'t>>,
        name: &str,
    ) -> Option<Piece<'t>> {
        let found = members.get(name).copied();
        if found.is_none() {
            self.bad(root.start(), format!("the graph has no `{name}`"));
        }
        found
    }

    fn list<'t>(&mut self, piece: Piece<'t>, of: &str) -> Option<Vec<Piece<'t>>> {
        let members = piece.array();
        if members.is_none() {
            self.bad(piece.start(), format!("expected a list of {of}s, found {}", piece.describe()));
        }
        members
    }

    /// The states or the actions.
    fn table(&mut self, piece: Piece<'_>, what: &str) -> Option<Table> {
        let members = self.list(piece, what)?;
        if members.is_empty() {
            self.bad(piece.span(), format!("the graph has no {what}"));
            return None;
        }
        if members.len() > MAX_STATES {
            self.bad(piece.start(), format!("the graph has more than {MAX_STATES} {what}s"));
            return None;
        }
        let mut table = Table::default();
        for member in members {
            let Some(name) = self.name(member, what) else { continue };
            let span = member.span();
            if let Some(first) = table.get(&name) {
                let message = format!("the {what} `{name}` is listed twice");
                let diagnostic = Diagnostic::error("duplicate-name", span, message);
                self.error(diagnostic.with_related(*first, "the first one"));
                continue;
            }
            table.insert(name, span);
        }
        Some(table)
    }

    /// A name: a string, or an integer, which stands for its digits.
    fn name(&mut self, piece: Piece<'_>, what: &str) -> Option<String> {
        let name = match piece.kind() {
            Kind::Text => piece.text(),
            Kind::Number => piece.digits().map(str::to_owned),
            _ => None,
        };
        match name {
            Some(name) => self.plain_name(&name, piece.span()),
            None if piece.kind() == Kind::Text => {
                self.bad(piece.span(), "the string has an escape that stands for no character");
                None
            }
            None => {
                let found = match piece.kind() {
                    Kind::Number => format!("`{0}`; as a name it is written \"{0}\"", piece.raw()),
                    _ => piece.describe().to_owned(),
                };
                let an = if what == "action" { "an" } else { "a" };
                self.bad(piece.start(), format!("{an} {what} is a string or an integer, not {found}"));
                None
            }
        }
    }

    /// A name, if it can be one.
    fn plain_name(&mut self, name: &str, span: Span) -> Option<String> {
        if name.is_empty() || name.chars().any(char::is_control) {
            self.bad(span, "a name is not empty and has no control characters");
            return None;
        }
        Some(name.to_owned())
    }

    /// The position of a name that was listed.
    fn known(&mut self, piece: Piece<'_>, table: &Table, what: &str) -> Option<u32> {
        let name = self.name(piece, what)?;
        self.known_name(&name, table, what, piece.span())
    }

    fn known_name(&mut self, name: &str, table: &Table, what: &str, span: Span) -> Option<u32> {
        let position = table.get_index_of(name).and_then(|position| u32::try_from(position).ok());
        if position.is_none() {
            let message = format!("no {what} `{name}` in the graph");
            let diagnostic = Diagnostic::error(
                if what == "action" { "unknown-action" } else { "unknown-state" },
                span,
                message,
            );
            // Looking for what was meant takes time; beyond the limit nobody sees it.
            let shown = self.errors < MAX_ERRORS;
            let names = table.keys().map(String::as_str);
            self.error(if shown { suggest(diagnostic, name, names) } else { diagnostic });
        }
        position
    }

    fn transitions(&mut self, all: Piece<'_>, states: &Table, actions: &Table, ids: &[ActionId]) -> Listed {
        let all = self.list(all, "transition").unwrap_or_default();
        let mut listed = Listed { edges: Vec::with_capacity(all.len()), attributes: Table::default() };
        let mut places = Vec::new();
        for transition in all {
            let (ends, numbers) = match transition.kind() {
                Kind::Object => self.described(transition, &mut listed.attributes),
                _ => (self.triple(transition), Vec::new()),
            };
            let Some([from, action, to]) = ends else { continue };
            let from = self.known(from, states, "state");
            let action = self.known(action, actions, "action");
            let to = self.known(to, states, "state");
            if let (Some(from), Some(action), Some(to)) = (from, action, to) {
                listed.edges.push((from, Edge { action: ids[action as usize], to }, numbers));
                places.push(transition.span());
            }
        }
        self.demand_one_number(&listed, &places);
        listed
    }

    /// `[STATE, ACTION, STATE]`
    fn triple<'t>(&mut self, transition: Piece<'t>) -> Option<[Piece<'t>; 3]> {
        let parts = transition.array();
        if let Some([from, action, to]) = parts.as_deref() {
            return Some([*from, *action, *to]);
        }
        let found = match parts {
            Some(parts) => format!("a list of {}", parts.len()),
            None => transition.describe().to_owned(),
        };
        let message = format!(
            "a transition is `[STATE, ACTION, STATE]` or `{{\"from\": STATE, \"action\": ACTION, \"to\": STATE}}`, not {found}"
        );
        self.bad(transition.span(), message);
        None
    }

    /// `{"from": STATE, "action": ACTION, "to": STATE, "length": 3}`: the ends, and the numbers in the order of the
    /// attributes, of which new ones are added to those known.
    fn described<'t>(
        &mut self,
        transition: Piece<'t>,
        attributes: &mut Table,
    ) -> (Option<[Piece<'t>; 3]>, Vec<i64>) {
        let mut ends: [Option<Piece<'t>>; 3] = [None; 3];
        let mut numbers: Vec<Option<i64>> = Vec::new();
        for (name, value) in transition.object().unwrap_or_default() {
            let text = name.text().unwrap_or_default();
            let again = if let Some(end) = ENDS.iter().position(|end| *end == text) {
                ends[end].replace(value).is_some()
            } else if let Some(at) = self.attribute(text.clone(), name, attributes) {
                numbers.resize(numbers.len().max(at + 1), None);
                numbers[at].replace(self.number(value).unwrap_or(0)).is_some()
            } else {
                false
            };
            if again {
                self.bad(name.span(), format!("`{text}` is given twice"));
            }
        }
        for (end, name) in ends.iter().zip(ENDS) {
            if end.is_none() {
                self.bad(transition.span(), format!("the transition has no `{name}`"));
            }
        }
        let [from, action, to] = ends;
        let ends = from.zip(action).zip(to).map(|((from, action), to)| [from, action, to]);
        (ends, numbers.into_iter().map(Option::unwrap_or_default).collect())
    }

    /// The position of an attribute, known or new.
    fn attribute(&mut self, text: String, name: Piece<'_>, attributes: &mut Table) -> Option<usize> {
        if let Some(at) = attributes.get_index_of(&text) {
            return Some(at);
        }
        let mut refuse = |message: String, help: &str| {
            self.error(Diagnostic::error("bad-graph", name.span(), message).with_help(help));
            None
        };
        if !is_attribute(&text) {
            return refuse(
                format!("{text:?} cannot be the name of an attribute"),
                "names consist of the letters a-z and A-Z, digits, and `_`, are no keywords, and not `node` or `action`",
            );
        }
        if attributes.len() == MAX_ATTRIBUTES {
            return refuse(
                format!("the transitions have more than {MAX_ATTRIBUTES} attributes"),
                "leave out those that nothing reads",
            );
        }
        Some(attributes.insert_full(text, name.span()).0)
    }

    /// The value of an attribute.
    fn number(&mut self, value: Piece<'_>) -> Option<i64> {
        let number = value.digits().and_then(|digits| digits.parse().ok());
        let number = number.filter(|n: &i64| n.unsigned_abs() <= MAX_RANGE.unsigned_abs());
        if number.is_none() {
            let found = if value.kind() == Kind::Number { value.raw() } else { value.describe() };
            let message = format!("an attribute is an integer within 2^40, not {found}");
            let diagnostic = Diagnostic::error("bad-graph", value.span(), message);
            self.error(
                diagnostic.with_help("write fractions in smaller units, and leave out what is no number"),
            );
        }
        number
    }

    /// Refuses transitions that differ in their numbers only: nobody could say which of them was taken.
    fn demand_one_number(&mut self, listed: &Listed, places: &[Span]) {
        if listed.attributes.is_empty() {
            return;
        }
        let of = |at: usize, attribute: usize| listed.edges[at].2.get(attribute).copied().unwrap_or(0);
        let mut order: Vec<usize> = (0..listed.edges.len()).collect();
        order.sort_by_key(|at| (listed.edges[*at].0, listed.edges[*at].1));
        for pair in order.windows(2) {
            let &[first, second] = pair else { continue };
            let ends = |at: usize| (listed.edges[at].0, listed.edges[at].1);
            let differs = (0..listed.attributes.len()).any(|a| of(first, a) != of(second, a));
            if ends(first) == ends(second) && differs {
                let message = "a second transition with these states and this action has other numbers";
                let diagnostic = Diagnostic::error("bad-graph", places[second], message);
                self.error(
                    diagnostic
                        .with_related(places[first], "the first one")
                        .with_help("give them actions of different names"),
                );
            }
        }
    }

    /// `{"n1": [0.5, 2]}`: where states lie, in an order of their own. Every state has to lie somewhere.
    fn coordinates(&mut self, piece: Piece<'_>, states: &Table) -> Option<Vec<(f64, f64)>> {
        let mut places = vec![None; states.len()];
        for (name, value) in self.object(piece, "`coordinates`")? {
            let Some(state) = self.known(name, states, "state") else { continue };
            let place =
                node_link::point(value).filter(|(x, y)| x.abs().max(y.abs()) <= roadmap::MAX_DISTANCE);
            if place.is_none() {
                let message =
                    format!("a place is `[X, Y]`, two numbers within 10^9, not {}", value.describe());
                self.bad(value.span(), message);
            }
            if places[state as usize].replace(place.unwrap_or_default()).is_some() {
                self.bad(name.span(), "a state that lies somewhere already");
            }
        }
        if let Some(missing) = places.iter().position(Option::is_none) {
            let name = states.get_index(missing).map_or("", |state| state.0.as_str());
            self.bad(piece.start(), format!("the state `{name}` has no coordinates, though others have"));
        }
        places.into_iter().collect()
    }

    fn initial(&mut self, piece: Piece<'_>, states: &Table) -> Expr<Leaf> {
        let Some(members) = self.list(piece, "state") else { return Expr::TRUE };
        if members.is_empty() {
            let diagnostic = Diagnostic::error("bad-graph", piece.span(), "no state is initial");
            self.error(diagnostic.with_help("leave `initial` out where every state is"));
        }
        one_of(self.all_known(&members, states))
    }

    fn all_known(&mut self, members: &[Piece<'_>], states: &Table) -> Vec<u32> {
        members.iter().filter_map(|member| self.known(*member, states, "state")).collect()
    }

    fn labels(&mut self, piece: Piece<'_>, states: &Table) -> Vec<Label> {
        let Some(all) = piece.object() else {
            let message = format!(
                "expected an object with a list of states for each label, found {}",
                piece.describe()
            );
            self.bad(piece.start(), message);
            return Vec::new();
        };
        let mut labels = Vec::new();
        for (name, members) in all {
            let (text, span) = (name.text().unwrap_or_default(), name.span());
            let known = match self.list(members, "state") {
                Some(members) => self.all_known(&members, states),
                None => continue,
            };
            if !is_name(&text) {
                let message = format!("{text:?} cannot be the name of a label");
                let help = "names consist of the letters a-z and A-Z, digits, and `_`, and are no keywords";
                self.error(Diagnostic::error("bad-graph", span, message).with_help(help));
                continue;
            }
            labels.push(Label { name: text, expr: one_of(known), ty: Type::Bool, nested: false, span });
        }
        labels
    }
}

/// The node is one of these.
fn one_of(mut positions: Vec<u32>) -> Expr<Leaf> {
    positions.sort_unstable();
    positions.dedup();
    let node = Expr::Leaf(Leaf::Var(NODE));
    match positions.as_slice() {
        [] => Expr::FALSE,
        [only] => Expr::Compare(Comparison::Eq, Box::new(node), Box::new(Expr::Const(Value::Enum(*only)))),
        several => {
            let tuples = several.iter().map(|position| Box::from([i64::from(*position)]));
            Expr::Member(vec![node], Arc::new(TupleSet::new(tuples.collect())))
        }
    }
}
