//! Answers as JSON objects: what `solve --format json` prints and `verify` and `plot` read.
//!
//! `docs/answer.schema.json` is made from these types by a test. Fields stand in the order of the structs; names of
//! paths, actions and variables are those of the problem file.

pub mod plans;
mod witness;

pub use witness::{StateFault, WitnessError, to_strategy, to_witness, write_state};

use crate::distinct::Difference;
use crate::names::names;
#[cfg(test)]
use schemars::JsonSchema;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::marker::PhantomData;

/// What `hyperplan solve --format json` prints, one object a line for each objective, and what `hyperplan verify` and
/// `hyperplan plot` read. For reading, `witness` is enough.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(title = "hyperplan answer", extend("required" = ["witness"])))]
pub struct Answer {
    /// The problem file, as the user named it.
    pub file: String,
    /// The objective.
    pub objective: String,
    /// Whether it can be had.
    pub verdict: Verdict,
    /// Why not known, or what is remarkable about the answer.
    pub reason: Option<String>,
    /// The same in a word that stays what it is.
    #[serde(default)]
    pub reason_code: Option<ReasonCode>,
    /// Steps of each path that matter, in the order of quantification; `null` where none does.
    pub horizon: Ordered<Option<u32>>,
    /// The paths of the leading block: a plan or a counterexample; `null` where there is none.
    pub witness: Option<Vec<WitnessPath>>,
    /// How the witness was checked.
    pub verified: Option<Verified>,
    /// Who answered.
    pub solver: Solver,
    /// How quantifiers were decided.
    pub quantifiers: Quantifiers,
    /// How states were written.
    pub states: States,
    /// The logic of the largest query; none of the builtin solver, which gets no text.
    #[serde(default)]
    pub logic: Option<String>,
    /// Rounds of the counterexample loop; 1 for a single query.
    pub iterations: u32,
    /// The largest query; nothing if no solver was asked.
    #[serde(default)]
    pub size: Size,
    /// Wall time of each stage.
    pub seconds: Seconds,
    /// What is known of the least value of a constant, where that was asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimized: Option<Minimized>,
    /// What was to be as small as possible, under the strategy found, what counts most first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub costs: Vec<CostValue>,
    /// Strategies or counterexamples besides the witness, where several were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub several: Option<Several>,
    /// Files with certificates of what is impossible, where these were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub certificates: Vec<String>,
    /// The case that the verdict is about, where it is not about the whole objective.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub case: Option<Case>,
    /// Where it is not known whether there is a plan, one that fails against few choices of the other player only, if the search
    /// met such a one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closest: Option<Closest>,
}

/// A plan that fails against some choices of the other player, by the checker: it wins against all paths that make none of them,
/// and of each some path that makes it, and no other of them, defeats the plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Closest {
    /// The paths of the leading block.
    pub witness: Vec<WitnessPath>,
    /// The choices.
    pub spared: Choices,
}

/// Choices of the other player.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Choices {
    /// States in which a path begins.
    pub starts: Vec<Start>,
    /// Steps in which a path does something else than another.
    pub replaced: Vec<Replaced>,
}

/// A state in which a path may begin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Start {
    /// The path.
    pub path: String,
    /// The value of each variable.
    pub state: Ordered<Scalar>,
}

/// A step in which a path does something else than another.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Replaced {
    /// The path.
    pub path: String,
    /// The other path.
    pub from: String,
    /// The time of the step, from 0.
    pub time: usize,
}

/// What was found where several strategies, or counterexamples, were asked for, the witness of the answer being the first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Several {
    /// In what they differ, each from each, until their paths are at rest.
    pub differ: Difference,
    /// How many were asked for, the first included.
    pub wanted: u32,
    /// Whether there are others than those found.
    pub more: More,
    /// Those found after the first.
    pub others: Vec<Other>,
}

/// Whether there are strategies that differ from all those found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum More {
    /// There are none.
    None,
    /// As many as wanted were found, and no other was looked for.
    Unasked,
    /// The search for another did not end.
    Unknown,
}

/// A strategy besides the first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Other {
    /// The paths of the leading block.
    pub witness: Vec<WitnessPath>,
    /// How they were checked.
    pub verified: Option<Verified>,
    /// As in the answer; what is preferred is the least of strategies that differ from those before.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub costs: Vec<CostValue>,
}

/// One of several cases that together are all of an objective.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Case {
    /// Which it is, from 1.
    pub index: u32,
    /// How many there are.
    pub of: u32,
    /// The verdict that is that of the objective where one case has it; the objective has the other where all cases do.
    pub decides: Verdict,
}

/// The value of a sum of costs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CostValue {
    /// The sum.
    pub expression: String,
    /// Its value under the strategy, by the checker.
    pub value: i64,
    /// No strategy is below this, given the values before: the strategy is the cheapest where the two agree.
    pub least: i64,
}

/// The search for the least value of a constant for which an objective is realizable. The rest of the answer is about
/// that value; if there is none in the range, about the last that was asked.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Minimized {
    /// The constant.
    pub constant: String,
    /// Where the search began, and where it would have ended.
    pub range: (i64, i64),
    /// The value of the strategy or property found; `null` where none was.
    pub value: Option<i64>,
    /// What is known of smaller values of the range.
    pub below: Below,
}

/// What is known of the values of the range below the one found, or below its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Below {
    /// There is none.
    OutOfRange,
    /// All are unrealizable.
    Unrealizable,
    /// Some are undecided, so the value found need not be the least.
    Unknown,
}

/// Whether an objective can be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The objective holds.
    Realizable,
    /// Its negation holds.
    Unrealizable,
    /// Undecided.
    Unknown,
}

/// Why an objective is undecided, or failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ReasonCode {
    /// The time was up.
    Timeout,
    /// A signal, or another search that was faster, ended it.
    Interrupted,
    /// A solver had not enough memory.
    OutOfMemory,
    /// The solver's methods do not decide the query.
    Incomplete,
    /// The solver gave up for a reason of its own, or said none.
    SolverGaveUp,
    /// A system is too large to tell which of its paths go on for ever.
    DeadEnds,
    /// A search by counterexamples over infinitely many choices found no end.
    NoEnd,
    /// Numbers grew beyond 64 bits.
    LargeNumbers,
    /// What was found could not be verified.
    Unverified,
    /// Several solvers were asked, and none decided, for reasons of their own.
    Several,
    /// It is not supported.
    Unsupported,
    /// It is too large to be written as asked.
    TooLarge,
    /// A solver failed, or is missing.
    SolverFailed,
    /// A solver's model does not satisfy what it was asked.
    WrongModel,
    /// Two solvers contradict each other.
    Disagreement,
    /// A file could not be read or written.
    Io,
    /// A bug in hyperplan.
    Bug,
}

/// An objective without an answer, where failures are wanted as JSON too.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failed {
    /// The objective.
    pub objective: String,
    /// Why.
    pub reason: String,
    /// The same in a word.
    pub reason_code: ReasonCode,
}

/// How quantifiers are decided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Quantifiers {
    /// hyperplan chooses.
    #[default]
    Auto,
    /// The solver gets them, as in the paper's formula (16).
    Keep,
    /// Universal ones become conjunctions over finitely many cases.
    Expand,
    /// Universal ones by counterexamples.
    Cegis,
    /// Without a solver: by a search over what the other player may be doing.
    Explicit,
}

/// How states are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum States {
    /// A Boolean for each state that can matter at a time.
    Onehot,
    /// A bit-vector for each variable.
    Bitvec,
    /// An integer for each variable, a real for each that is one.
    Int,
    /// A value of a datatype, one for each state of the system, at each time.
    Enum,
    /// A real for each variable.
    Real,
}

impl States {
    /// Whether states are written one by one.
    #[must_use]
    pub fn is_enumerated(self) -> bool {
        matches!(self, States::Onehot | States::Enum)
    }

    /// Whether variables are integers or reals.
    #[must_use]
    pub fn is_arithmetic(self) -> bool {
        matches!(self, States::Int | States::Real)
    }
}

names!(pub Quantifiers: Auto "auto", Keep "keep", Expand "expand", Cegis "cegis", Explicit "explicit");
names!(pub Verified: BySearch "by-search", BySolver "by-solver");
names!(pub Verdict: Realizable "realizable", Unrealizable "unrealizable", Unknown "unknown");
names!(pub ReasonCode: Timeout "timeout", Interrupted "interrupted", OutOfMemory "out-of-memory", Incomplete "incomplete",
    SolverGaveUp "solver-gave-up", DeadEnds "dead-ends", NoEnd "no-end", LargeNumbers "large-numbers",
    Unverified "unverified", Several "several", Unsupported "unsupported", TooLarge "too-large",
    SolverFailed "solver-failed", WrongModel "wrong-model", Disagreement "disagreement", Io "io", Bug "bug");
names!(pub States: Onehot "onehot", Bitvec "bitvec", Int "int", Enum "enum", Real "real");

/// How a witness was checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Verified {
    /// By the independent checker, exactly.
    BySearch,
    /// By a solver, where the checker's search would be too large.
    BySolver,
}

/// A solver and its version.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Solver {
    /// Its name, e.g. `builtin` or `z3`.
    pub name: String,
    /// Its version, as it tells.
    pub version: String,
}

/// How large a query was, as the solver got it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Size {
    /// SAT variables of the builtin solver; of others, declared symbols.
    pub variables: usize,
    /// Clauses of the builtin solver; of others, assertions.
    pub clauses: usize,
    /// Bytes of SMT-LIB; none of the builtin solver, which gets no text.
    #[serde(default)]
    pub bytes: Option<usize>,
}

/// Wall time in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Seconds {
    /// Reading and checking the file.
    pub read: f64,
    /// Building queries.
    pub encode: f64,
    /// Waiting for the solver.
    pub solve: f64,
    /// Checking the witness.
    pub verify: f64,
    /// From first to last.
    pub total: f64,
}

/// One path of a witness. There is one more state than there are actions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct WitnessPath {
    /// The path variable.
    pub path: String,
    /// Its system; may be left out when reading.
    #[serde(default)]
    pub system: String,
    /// The actions taken.
    pub actions: Vec<String>,
    /// The states passed, from time 0: the value of each variable. When reading, the first alone or none where the
    /// actions decide the others.
    #[serde(default)]
    pub states: Vec<Ordered<Scalar>>,
    /// Where each state is in the plane, `[x, y]`, where the system says so: in metres on a map that says how large its
    /// cells are, and as given for the nodes of a graph. Passed over when reading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub positions: Option<Vec<(f64, f64)>>,
}

/// The value of a variable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
pub enum Scalar {
    /// A truth value.
    Bool(bool),
    /// An integer.
    Int(i64),
    /// A decimal number, which stands for the shortest decimal fraction that reads as it.
    Decimal(f64),
    /// An enumeration value, or a fraction such as `1/4`.
    Name(String),
}

impl fmt::Display for Scalar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Scalar::Bool(b) => b.fmt(f),
            Scalar::Int(n) => n.fmt(f),
            Scalar::Decimal(x) => x.fmt(f),
            Scalar::Name(s) => write!(f, "\"{s}\""),
        }
    }
}

/// The part of an answer that a strategy is read from: other tools need to write no more than this.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct StrategyFile {
    /// The objective that it is for; may be left out.
    pub objective: Option<String>,
    /// What was claimed.
    pub verdict: Option<Verdict>,
    /// The paths.
    #[serde(default)]
    pub witness: Option<Vec<WitnessPath>>,
}

/// A strategy as it is saved, perhaps with others for the same objective.
#[derive(Deserialize)]
struct Saved {
    objective: Option<String>,
    verdict: Option<Verdict>,
    #[serde(default)]
    witness: Option<Vec<WitnessPath>>,
    #[serde(default)]
    several: Option<SavedOthers>,
}

#[derive(Deserialize)]
struct SavedOthers {
    #[serde(default)]
    others: Vec<SavedOther>,
}

#[derive(Deserialize)]
struct SavedOther {
    witness: Vec<WitnessPath>,
}

impl StrategyFile {
    /// Reads one JSON object, or several, one after another.
    ///
    /// # Errors
    /// If the text is not such a sequence; the message has line and column.
    pub fn read_all(text: &str) -> Result<Vec<StrategyFile>, serde_json::Error> {
        let mut all = Vec::new();
        for saved in serde_json::Deserializer::from_str(text).into_iter() {
            let Saved { objective, verdict, witness, several } = saved?;
            let others = several.into_iter().flat_map(|several| several.others);
            let witnesses = [witness].into_iter().chain(others.map(|other| Some(other.witness)));
            all.extend(witnesses.map(|witness| StrategyFile {
                objective: objective.clone(),
                verdict,
                witness,
            }));
        }
        Ok(all)
    }
}

/// A JSON object that keeps its order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ordered<V>(pub Vec<(String, V)>);

impl<V> Ordered<V> {
    /// The value under that key.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&V> {
        self.0.iter().find(|(k, _)| k == key).map(|(_, v)| v)
    }
}

#[cfg(test)]
impl<V: JsonSchema> JsonSchema for Ordered<V> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("object_of_{}", V::schema_name()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "object", "additionalProperties": generator.subschema_for::<V>() })
    }
}

impl<V: Serialize> Serialize for Ordered<V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(k, v)| (k, v)))
    }
}

impl<'de, V: Deserialize<'de>> Deserialize<'de> for Ordered<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(OrderedVisitor(PhantomData))
    }
}

struct OrderedVisitor<V>(PhantomData<V>);

impl<'de, V: Deserialize<'de>> Visitor<'de> for OrderedVisitor<V> {
    type Value = Ordered<V>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut entries: Vec<(String, V)> = Vec::new();
        while let Some((key, value)) = map.next_entry::<String, V>()? {
            if entries.iter().any(|(k, _)| *k == key) {
                return Err(A::Error::custom(format!("`{key}` is given twice")));
            }
            entries.push((key, value));
        }
        Ok(Ordered(entries))
    }
}

#[cfg(test)]
mod tests {
    use super::Answer;
    use std::fs;

    /// `UPDATE=1` writes the schema anew.
    #[test]
    fn the_schema_is_that_of_the_types() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/answer.schema.json");
        let schema = schemars::schema_for!(Answer).to_value();
        if std::env::var_os("UPDATE").is_some() {
            fs::write(file, format!("{schema:#}\n")).expect("it can be written");
        }
        let committed = fs::read_to_string(file).expect("it can be read");
        let committed: serde_json::Value = serde_json::from_str(&committed).expect("it is JSON");
        assert!(committed == schema, "docs/answer.schema.json is not that of the types; UPDATE=1 writes it");
    }
}
