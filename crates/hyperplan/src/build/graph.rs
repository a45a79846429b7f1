//! States and transitions that are listed one by one.

use hyperplan_syntax::is_name;
use rustc_hash::FxHashMap;
use serde_json::{Map, Value, json};

/// A graph: its states and actions have names of any kind, its labels words. States are numbered in the order in which they
/// were named first.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    states: Vec<String>,
    numbers: FxHashMap<String, usize>,
    actions: Vec<String>,
    known: FxHashMap<String, usize>,
    initial: Vec<usize>,
    edges: Vec<Edge>,
    labels: Vec<(String, Vec<usize>)>,
    places: Vec<(usize, f64, f64)>,
}

#[derive(Clone, Debug)]
struct Edge {
    from: usize,
    action: usize,
    to: usize,
    attributes: Vec<(String, i64)>,
}

/// What JSON calls its own.
const OWN: [&str; 3] = ["from", "action", "to"];

impl Graph {
    /// One without states.
    #[must_use]
    pub fn new() -> Graph {
        Graph::default()
    }

    /// The number of the state of that name, which is added if there is none.
    pub fn state(&mut self, name: impl Into<String>) -> usize {
        numbered(name.into(), &mut self.states, &mut self.numbers)
    }

    /// How many states there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// A transition, with integers that it carries, such as a length.
    pub fn edge(&mut self, from: usize, action: impl Into<String>, to: usize, attributes: &[(&str, i64)]) {
        let action = numbered(action.into(), &mut self.actions, &mut self.known);
        let attributes = attributes.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        self.edges.push(Edge { from, action, to, attributes });
    }

    /// Paths begin there. Where no state is initial, all are.
    pub fn initial(&mut self, state: usize) {
        self.initial.push(state);
    }

    /// A label that holds of these states, and of those for which it was said before; perhaps of none.
    pub fn label(&mut self, name: &str, states: impl IntoIterator<Item = usize>) {
        match self.labels.iter_mut().find(|(known, _)| known == name) {
            Some((_, known)) => known.extend(states),
            None => self.labels.push((name.to_owned(), states.into_iter().collect())),
        }
    }

    /// Where a state lies in the plane. If all lie somewhere, pictures draw them there, and transitions have a `distance`.
    pub fn place(&mut self, state: usize, x: f64, y: f64) {
        self.places.push((state, x, y));
    }

    /// As the language reads it.
    pub(super) fn json(&self) -> Result<Vec<u8>, String> {
        let name = |state: usize| {
            let none =
                || format!("there is no state with the number {state}: there are {}", self.states.len());
            self.states.get(state).ok_or_else(none)
        };
        let names = |states: &[usize]| states.iter().map(|state| name(*state)).collect::<Result<Vec<_>, _>>();
        let mut all = Map::new();
        all.insert("states".to_owned(), json!(self.states));
        all.insert("actions".to_owned(), json!(self.actions));
        if !self.initial.is_empty() {
            all.insert("initial".to_owned(), json!(names(&self.initial)?));
        }
        let edges = self.edges.iter().map(|edge| {
            let (from, to, action) = (name(edge.from)?, name(edge.to)?, &self.actions[edge.action]);
            if edge.attributes.is_empty() {
                return Ok(json!([from, action, to]));
            }
            let mut one = Map::from_iter(
                [("from", from), ("action", action), ("to", to)]
                    .map(|(key, value)| (key.to_owned(), Value::from(value.as_str()))),
            );
            for (key, value) in &edge.attributes {
                if OWN.contains(&key.as_str()) {
                    return Err(format!(
                        "transitions cannot have an attribute `{key}`: it has a meaning already"
                    ));
                }
                one.insert(key.clone(), Value::from(*value));
            }
            Ok(Value::Object(one))
        });
        all.insert("transitions".to_owned(), Value::Array(edges.collect::<Result<_, String>>()?));
        let labels = self.labels.iter().map(|(label, states)| {
            if is_name(label) { Ok((label.clone(), json!(names(states)?))) } else { Err(no_word(label)) }
        });
        all.insert("labels".to_owned(), Value::Object(labels.collect::<Result<_, String>>()?));
        if !self.places.is_empty() {
            let place = |(state, x, y): &(usize, f64, f64)| match x.is_finite() && y.is_finite() {
                true => Ok((name(*state)?.clone(), json!([x, y]))),
                false => Err(format!("state {} lies nowhere: {x}, {y} are no numbers", name(*state)?)),
            };
            let places = self.places.iter().map(place).collect::<Result<Map<_, _>, String>>()?;
            // A picture needs the places of all.
            if places.len() == self.states.len() {
                all.insert("coordinates".to_owned(), Value::Object(places));
            }
        }
        serde_json::to_vec(&all).map_err(|error| error.to_string())
    }
}

fn no_word(label: &str) -> String {
    format!("the label `{label}` is no word: letters, digits and `_`")
}

fn numbered(name: String, names: &mut Vec<String>, numbers: &mut FxHashMap<String, usize>) -> usize {
    if let Some(number) = numbers.get(&name) {
        return *number;
    }
    let number = names.len();
    names.push(name.clone());
    numbers.insert(name, number);
    number
}
