//! Systems: by clauses, maps and graphs.

use super::Whole;
use super::expression::{Scope, proposition, quantity, range};
use hyperplan_random::Random;

/// The type of a variable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Bool,
    /// Integers, with their ends.
    Range(usize, usize),
    /// The values, as written.
    Enum(Vec<String>),
    Int,
    Real,
}

impl Kind {
    pub(super) fn is_number(&self) -> bool {
        matches!(self, Kind::Range(..) | Kind::Int | Kind::Real)
    }
}

/// What expressions may name of a system.
#[derive(Clone, Debug)]
pub(super) struct System {
    pub(super) number: usize,
    pub(super) name: String,
    pub(super) vars: Vec<(String, Kind)>,
    pub(super) labels: Vec<String>,
    /// As written in clauses.
    pub(super) actions: Vec<String>,
    /// Whether there is something that `obs` sees.
    pub(super) observes: bool,
    /// Whether steps cost something, `c`.
    pub(super) costs: bool,
    /// Whether there is a definition of two of its paths.
    pub(super) defined: bool,
}

impl System {
    /// One more system of a file.
    pub(super) fn random(random: &mut Random, number: usize, whole: &mut Whole) -> System {
        let mut system = System {
            number,
            name: format!("S{number}"),
            vars: Vec::new(),
            labels: Vec::new(),
            actions: Vec::new(),
            observes: false,
            costs: false,
            defined: false,
        };
        let (head, items) = match random.below(4) {
            0 | 1 => (String::new(), system.plain(random)),
            2 => system.map(random, whole),
            _ => {
                let (head, numbered) = system.graph(random, whole);
                let items = system.fuel(random, numbered);
                (head, items)
            }
        };
        let items = items + &system.further(random);
        whole.text += &format!("system {} {head}{{\n{items}}}\n", system.name);
        system
    }

    /// Variables and actions.
    fn plain(&mut self, random: &mut Random) -> String {
        let infinite = random.once_in(12);
        for name in &["x", "y", "e"][..1 + random.below(3)] {
            let kind = match random.below(if infinite { 7 } else { 5 }) {
                0 | 1 => Kind::Range(0, 1 + random.below(3)),
                2 => Kind::Range(1, 2 + random.below(2)),
                3 => Kind::Bool,
                4 => Kind::Enum(
                    ["v0", "v1", "v2"][..2 + random.below(2)].iter().map(|v| (*v).into()).collect(),
                ),
                5 => Kind::Int,
                _ => Kind::Real,
            };
            self.vars.push(((*name).to_owned(), kind));
        }
        // Numbers of one system are all real or none is.
        if self.vars.iter().any(|(_, kind)| *kind == Kind::Real) {
            let numbers = self.vars.iter_mut().filter(|(_, kind)| kind.is_number());
            numbers.for_each(|(_, kind)| *kind = Kind::Real);
        }
        let mut items = declared(&self.vars);
        let actions = random.below(4);
        self.actions = ["a", "b2", "c"][..actions].iter().map(|name| (*name).to_owned()).collect();
        if self.actions.is_empty() {
            self.actions.push("step".to_owned());
        } else {
            items += &format!("  action {};\n", self.actions.join(", "));
        }
        items
    }

    /// A map, in the file or in one of its own, with what may stand in maps only.
    fn map(&mut self, random: &mut Random, whole: &mut Whole) -> (String, String) {
        let (width, height) = (1 + random.below(3), 1 + random.below(3));
        let row = |random: &mut Random| -> String {
            (0..width).map(|_| random.one(&[".", ".", "S", "G", "#", "W"])).collect()
        };
        let mut rows: Vec<String> = (0..height).map(|_| row(random)).collect();
        // Some cell has to be free, and letters that are there have to be explained.
        rows[0].replace_range(..1, "S");
        let (changes, width, height) = changed(random, width, height);
        for (name, last) in [("x", width - 1), ("y", height - 1)] {
            self.vars.push((name.to_owned(), Kind::Range(0, last)));
        }
        self.labels.push("start".to_owned());
        if rows.iter().any(|row| row.contains('G')) {
            self.labels.push("goal".to_owned());
        }
        let mut items = format!("  legend 'W' = water;\n{changes}");
        if rows.iter().any(|row| row.contains('W')) {
            self.labels.push("water".to_owned());
        }
        let moves = ["up", "right", "down", "left", "stay", "up_left", "down_right"];
        let own = ["up", "right"].into_iter().chain(moves[2..].iter().copied().filter(|_| random.flip()));
        self.actions = own.map(str::to_owned).collect();
        items += &format!("  moves {};\n", self.actions.join(", "));
        let mut crashes = false;
        for place in ["obstacle", "edge", "corner"] {
            let rule = random.one(&["", "undefined", "stay", "crash"]);
            crashes |= rule == "crash";
            if !rule.is_empty() {
                items += &format!("  {place} {rule};\n");
            }
        }
        if crashes {
            self.vars.push(("crash".to_owned(), Kind::Bool));
        }
        items += &self.additions(random);
        let head = if random.once_in(3) {
            let path = format!("m{}.txt", self.number);
            whole.files.insert(path.clone(), rows.join("\n"));
            format!("= grid(\"{path}\") ")
        } else {
            let rows: Vec<String> = rows.iter().map(|row| format!("\"{row}\"")).collect();
            format!("= grid {{ {} }} ", rows.join(" "))
        };
        items += &self.fuel(random, false);
        (head, items)
    }

    /// Something that goes with the moves, and what the moves do to it.
    fn fuel(&mut self, random: &mut Random, numbered: bool) -> String {
        if random.flip() {
            return String::new();
        }
        self.vars.push(("fuel".to_owned(), Kind::Range(0, 3)));
        let goal = if self.labels.iter().any(|label| label == "goal") { "goal" } else { "fuel < 1" };
        let action = &self.actions[0];
        let by = if numbered { "length div 3" } else { "1" };
        "  state fuel: 0..3;\n".to_owned()
            + &match random.below(5) {
                4 => "  state last: action;\n  also on * { last' = action; }\n  cost again = if action == last then 0 else 1;\n"
                    .to_owned(),
                0 => format!("  also on * {{ fuel' = fuel - {by}; }}\n"),
                1 => format!(
                    "  also on * when !{goal} {{ fuel' = fuel - (if action == {action} then 2 else 1); }}\n  \
                     also on * when {goal} {{ fuel' in {{fuel, 3}}; }}\n"
                ),
                2 => format!(
                    "  also on * {{ fuel' in if {goal} then {{fuel, 3}} else fuel - {by}..fuel; }}\n  trans fuel' >= fuel - 1;\n"
                ),
                _ => format!("  also on {action} {{ fuel' in fuel - 1..fuel; }}\n"),
            }
    }

    /// A graph in a file of its own; whether its transitions carry numbers.
    fn graph(&mut self, random: &mut Random, whole: &mut Whole) -> (String, bool) {
        let nodes = &["n0", "n1", "17", "room A"][..2 + random.below(3)];
        let actions = &["go", "turn left", "wait"][..1 + random.below(3)];
        let edge = |random: &mut Random| {
            let (from, to) = (random.one(nodes), random.one(nodes));
            format!("[\"{from}\", \"{}\", \"{to}\"]", random.one(actions))
        };
        if random.once_in(3) {
            return (self.roadmap(random, whole, nodes), false);
        }
        let described = |random: &mut Random| {
            let (from, to) = (random.one(nodes), random.one(nodes));
            // The number follows from the ends, so that there are no two of one transition.
            let length = from.len() + to.len();
            let action = random.one(actions);
            format!(
                "{{\"from\": \"{from}\", \"action\": \"{action}\", \"to\": \"{to}\", \"length\": {length}}}"
            )
        };
        let numbered = random.once_in(3);
        let edges: Vec<String> = (0..1 + random.below(7))
            .map(|_| if numbered { described(random) } else { edge(random) })
            .collect();
        let some = random.one(nodes);
        let text = format!(
            "{{\"states\": {nodes:?}, \"actions\": {actions:?}, {} \"transitions\": [{}], \"labels\": {{\"goal\": [{some:?}]}}}}",
            random.one(&["", "\"initial\": [\"n0\"],"]),
            edges.join(", "),
        );
        let path = format!("g{}.json", self.number);
        let head = format!("= graph(\"{path}\") ");
        whole.files.insert(path, text);
        self.vars.push(("node".to_owned(), Kind::Enum(nodes.iter().map(|node| quoted(node)).collect())));
        self.labels.push("goal".to_owned());
        self.actions = actions.iter().map(|name| quoted(name)).collect();
        (head, numbered)
    }

    /// A graph as networkx or Nav2 have it, with these nodes.
    fn roadmap(&mut self, random: &mut Random, whole: &mut Whole, nodes: &[&str]) -> String {
        let edges: Vec<(&str, &str)> =
            (0..1 + random.below(5)).map(|_| (random.one(nodes), random.one(nodes))).collect();
        let named = random.flip();
        let is_route = random.flip();
        let id = |at: usize| if named { format!("\"id\": \"e{at}\", ") } else { String::new() };
        let (mut parts, mut links) = (Vec::new(), Vec::new());
        for (at, node) in nodes.iter().enumerate() {
            let goal = if at == 0 { ", \"goal\": true" } else { "" };
            parts.push(if is_route {
                format!("{{\"properties\": {{\"id\": \"{node}\"{goal}}}, \"geometry\": {{\"type\": \"Point\", \"coordinates\": [{at}, 0]}}}}")
            } else {
                format!("{{\"id\": \"{node}\", \"x\": {at}, \"y\": 1{goal}}}")
            });
        }
        for (at, (from, to)) in edges.iter().enumerate() {
            links.push(if is_route {
                format!("{{\"properties\": {{{}\"startid\": \"{from}\", \"endid\": \"{to}\"}}, \"geometry\": {{\"type\": \"LineString\"}}}}", id(at))
            } else {
                format!("{{{}\"source\": \"{from}\", \"target\": \"{to}\"}}", id(at))
            });
            let action = if named { format!("e{at}") } else { format!("go_{to}") };
            let action = quoted(&action);
            if !self.actions.contains(&action) {
                self.actions.push(action);
            }
        }
        let (parts, links) = (parts.join(", "), links.join(", "));
        let text = if is_route {
            format!("{{\"type\": \"FeatureCollection\", \"features\": [{parts}, {links}]}}")
        } else {
            let directed = random.flip();
            format!("{{\"directed\": {directed}, \"nodes\": [{parts}], \"links\": [{links}]}}")
        };
        let path = format!("g{}.json", self.number);
        let head = format!("= graph(\"{path}\") ");
        whole.files.insert(path, text);
        self.vars.push(("node".to_owned(), Kind::Enum(nodes.iter().map(|node| quoted(node)).collect())));
        self.labels.push("goal".to_owned());
        head
    }

    /// Variables and actions besides those of a map.
    fn additions(&mut self, random: &mut Random) -> String {
        if !random.once_in(3) {
            return String::new();
        }
        self.vars.push(("b".to_owned(), Kind::Bool));
        self.actions.push("pick".to_owned());
        "  state b: bool;\n  action pick;\n".to_owned()
    }

    /// Clauses, and items that all systems may have.
    fn further(&mut self, random: &mut Random) -> String {
        // Rules of maps and transitions of graphs are there already.
        let is_plain = self.labels.is_empty();
        let own: Vec<(String, Kind)> = self
            .vars
            .iter()
            .filter(|(name, _)| !["crash", "fuel"].contains(&name.as_str()))
            .cloned()
            .collect();
        let mut items = String::new();
        for _ in 0..if is_plain { 1 + random.below(5) } else { random.below(2) } {
            let action = self.actions[random.below(self.actions.len())].clone();
            let clause = self.clause(random, &own, &action);
            items += &clause;
        }
        if is_plain && random.once_in(3) {
            items += "  on * {}\n";
        }
        let before = self.clone();
        let scope = [Scope::of_state(&before)];
        if random.once_in(2) {
            items += &format!("  init {};\n", proposition(random, &scope, 1));
        }
        for name in &["l0", "l1"][..1 + random.below(2)] {
            // Labels may use those before them.
            let before = self.clone();
            let depth = random.below(3);
            items +=
                &format!("  label {name} = {};\n", proposition(random, &[Scope::of_state(&before)], depth));
            self.labels.push((*name).to_owned());
        }
        if random.once_in(3) {
            items += &format!("  absorb {};\n", proposition(random, &scope, 1));
        }
        let finite = self.vars.iter().all(|(_, kind)| !matches!(kind, Kind::Int | Kind::Real));
        if finite && random.once_in(2) {
            let action = &self.actions[0];
            let there = proposition(random, &scope, 1);
            items += &random
                .one(&[
                    "  cost c = 2;\n",
                    "  cost c = if ACTION then 3 else 0;\n",
                    "  cost c = if THERE then 2 else 1;\n",
                ])
                .replace("ACTION", &format!("action == {action}"))
                .replace("THERE", &there);
            self.costs = true;
        }
        if random.once_in(4) {
            items += &format!("  trans l0' -> {};\n", proposition(random, &scope, 1));
        }
        if random.flip() {
            self.observes = true;
            items += &format!("  observe {}, l0;\n", self.vars[0].0);
        }
        items
    }

    fn clause(&self, random: &mut Random, own: &[(String, Kind)], action: &str) -> String {
        let scope = [Scope::of_state(self)];
        let action = if random.once_in(6) { "*" } else { action };
        let guard =
            if random.flip() { format!(" when {}", proposition(random, &scope, 1)) } else { String::new() };
        let mut updates = String::new();
        for (name, kind) in own {
            if random.once_in(3) {
                continue;
            }
            let value = match kind {
                Kind::Bool if random.once_in(4) => "in {true, false}".to_owned(),
                Kind::Bool => format!("= {}", proposition(random, &scope, 1)),
                Kind::Enum(values) if random.flip() => format!("in {{{}}}", values.join(", ")),
                Kind::Enum(values) => format!("= {}", values[random.below(values.len())]),
                Kind::Range(..) | Kind::Int if random.once_in(5) => {
                    let (condition, set) = (proposition(random, &scope, 1), quantity(random, &scope, 1));
                    format!("in if {condition} then {{{set}, {name}}} else {}", range(random, &scope))
                }
                Kind::Range(..) | Kind::Int if random.once_in(4) => format!("in {}", range(random, &scope)),
                Kind::Range(..) | Kind::Int | Kind::Real => format!("= {}", quantity(random, &scope, 1)),
            };
            updates += &format!(" {name}' {value};");
        }
        format!("  on {action}{guard} {{{updates} }}\n")
    }
}

/// What is done to a map of that size, and its size then.
fn changed(random: &mut Random, width: usize, height: usize) -> (String, usize, usize) {
    let (mut items, mut width, mut height) = (String::new(), width, height);
    if random.once_in(6) {
        items += &format!("  inflate {};\n", random.one(&["0", "1/2", "T - 2"]));
    }
    if random.once_in(4) && width.max(height) > 1 {
        items += "  scale T;\n";
        (width, height) = (width.div_ceil(2), height.div_ceil(2));
    }
    if random.once_in(6) {
        // The first row has the free cell.
        let first = random.below(height);
        items += &format!("  crop 0..{}, {first}..{};\n", width - 1, height - 1);
        height -= first;
    }
    if random.once_in(6) {
        items += "  clearance gap T + 1;\n";
    }
    (items, width, height)
}

fn declared(vars: &[(String, Kind)]) -> String {
    let one = |(name, kind): &(String, Kind)| match kind {
        Kind::Bool => format!("{name}: bool"),
        Kind::Range(lo, hi) => format!("{name}: {lo}..{hi}"),
        Kind::Enum(values) => format!("{name}: {{{}}}", values.join(", ")),
        Kind::Int => format!("{name}: int"),
        Kind::Real => format!("{name}: real"),
    };
    format!("  state {};\n", vars.iter().map(one).collect::<Vec<_>>().join(", "))
}

/// A name as expressions write it.
fn quoted(name: &str) -> String {
    if hyperplan_syntax::is_name(name) { name.to_owned() } else { format!("{name:?}") }
}
