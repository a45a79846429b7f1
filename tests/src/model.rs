//! Problems as explicit tables and trees, and how they are written in the problem language.

use std::fmt::{self, Display, Formatter};

/// The type of a state variable, with the number of its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `0..n-1`
    Range(usize),
    /// `bool`, false first
    Bool,
    /// `{v0, v1, ...}`
    Enum(usize),
    /// `int`, of which only `0..n-1` are reached
    Int(usize),
    /// `real`, of which only `0, 1/2, ..., (n-1)/2` are reached
    Real(usize),
}

impl Kind {
    /// Number of values.
    #[must_use]
    pub fn size(self) -> usize {
        match self {
            Kind::Range(n) | Kind::Enum(n) | Kind::Int(n) | Kind::Real(n) => n,
            Kind::Bool => 2,
        }
    }

    /// A value as written.
    #[must_use]
    pub fn value(self, value: usize) -> String {
        match self {
            Kind::Range(_) | Kind::Int(_) => value.to_string(),
            Kind::Real(_) => format!("{value}/2"),
            Kind::Bool => (value == 1).to_string(),
            Kind::Enum(_) => format!("v{value}"),
        }
    }
}

/// A clause for one state: these actions lead to these values of each variable, in all combinations. Values that
/// are none of the variable's are printed, and lead nowhere.
#[derive(Clone, Debug)]
pub struct Rule {
    /// The state.
    pub from: usize,
    /// The actions.
    pub actions: Vec<usize>,
    /// The choices for each variable; `None` where it is not mentioned.
    pub choices: Vec<Option<Vec<usize>>>,
}

/// What all transitions with some actions from some states do besides: a variable gets one of these values.
#[derive(Clone, Debug)]
pub struct Also {
    /// The actions.
    pub actions: Vec<usize>,
    /// The states.
    pub from: Vec<usize>,
    /// The variable.
    pub var: usize,
    /// Its values, some perhaps none of its own.
    pub choices: Vec<usize>,
}

/// A system: states are numbered in mixed radix, the first variable counting most.
#[derive(Clone, Debug)]
pub struct System {
    /// Names and types of the state variables.
    pub vars: Vec<(&'static str, Kind)>,
    /// Names of the actions.
    pub actions: Vec<&'static str>,
    /// The clauses.
    pub rules: Vec<Rule>,
    /// What transitions do besides.
    pub also: Vec<Also>,
    /// What a step costs that is no loop of an absorbing state, by state and action; none where it is empty.
    pub costs: Vec<Vec<usize>>,
    /// Initial states, if restricted.
    pub init: Option<Vec<usize>>,
    /// Labels `l0`, `l1`, ... by their states.
    pub labels: Vec<Vec<usize>>,
    /// Absorbing states.
    pub absorb: Vec<usize>,
    /// Pairs of states between which no action leads, but for absorbing ones; `trans` says so.
    pub forbidden: Vec<(usize, usize)>,
    /// Whether rules of the same actions are written as one clause, with choices that depend on the state.
    pub merged: bool,
    /// Whether `obs` sees the first variable only, or a label's states.
    pub observe: Observe,
}

/// What an observer sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observe {
    /// The first variable.
    First,
    /// Whether label `l0` holds.
    Label,
}

/// An atom; paths, variables, labels and actions by number.
#[derive(Clone, Debug)]
pub enum Atom {
    /// `l0[p]`
    Label(usize, usize),
    /// A variable has a value.
    Is(usize, usize, usize),
    /// `x[p] + k < x[q]`, of a range.
    Less(usize, usize, usize, usize),
    /// `x[p] == x[q]`
    SameValue(usize, usize, usize),
    /// `action[p] == a`
    Took(usize, usize),
    /// `action[p] == action[q]`
    SameAction(usize, usize),
    /// `state[p] == state[q]`
    SameState(usize, usize),
    /// `obs[p] == obs[q]`
    SameObs(usize, usize),
    /// `a in enabled[p]`
    Enabled(usize, usize),
    /// `if action[p] == a then l0[p] else l1[p]`
    Choice(usize, usize, usize, usize),
    /// `x[p] == (if action[p] == a then 1 else 0)`, of a range.
    Coded(usize, usize, usize),
    /// `cost c[p] <= k`
    Costs(usize, usize),
    /// `cost c[p] + k < cost c[q]`
    Cheaper(usize, usize, usize),
}

impl Atom {
    /// Whether it has no connective and reads the actions taken.
    #[must_use]
    pub fn reads_actions(&self) -> bool {
        matches!(self, Atom::Took(..) | Atom::SameAction(..) | Atom::Coded(..))
    }

    /// What it stands for, where it has connectives and reads the actions taken.
    #[must_use]
    pub fn parts(&self) -> Option<Formula> {
        let Atom::Choice(p, a, yes, no) = *self else { return None };
        let took = || Formula::Atom(Atom::Took(p, a));
        let label = |l| Formula::Atom(Atom::Label(p, l));
        let then = Formula::And(vec![took(), label(yes)]);
        let otherwise = Formula::And(vec![Formula::Not(Box::new(took())), label(no)]);
        Some(Formula::Or(vec![then, otherwise]))
    }
}

/// How a path stands for infinite ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Semantics {
    Pes,
    Opt,
    Hpes,
    Hopt,
}

impl Semantics {
    /// In an order in which what holds under one holds under the next.
    pub const ALL: [Semantics; 4] = [Semantics::Pes, Semantics::Hpes, Semantics::Hopt, Semantics::Opt];
}

impl Display for Semantics {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Semantics::Pes => "pes",
            Semantics::Opt => "opt",
            Semantics::Hpes => "hpes",
            Semantics::Hopt => "hopt",
        })
    }
}

/// `[lo,hi]`; `None` only where the objective says `within`.
pub type Interval = Option<(u32, u32)>;

/// A formula.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum Formula {
    Atom(Atom),
    Not(Box<Formula>),
    And(Vec<Formula>),
    Or(Vec<Formula>),
    Implies(Box<Formula>, Box<Formula>),
    Iff(Box<Formula>, Box<Formula>),
    Next(Box<Formula>),
    WeakNext(Box<Formula>),
    Finally(Interval, Box<Formula>),
    Globally(Interval, Box<Formula>),
    Until(Interval, Box<Formula>, Box<Formula>),
    Release(Interval, Box<Formula>, Box<Formula>),
    WeakUntil(Interval, Box<Formula>, Box<Formula>),
    StrongRelease(Interval, Box<Formula>, Box<Formula>),
}

impl Formula {
    /// Whether some atom reads the actions taken.
    #[must_use]
    pub fn reads_actions(&self) -> bool {
        match self {
            Formula::Atom(atom) => atom.reads_actions() || atom.parts().is_some(),
            Formula::And(fs) | Formula::Or(fs) => fs.iter().any(Formula::reads_actions),
            Formula::Not(a)
            | Formula::Next(a)
            | Formula::WeakNext(a)
            | Formula::Finally(_, a)
            | Formula::Globally(_, a) => a.reads_actions(),
            Formula::Implies(a, b)
            | Formula::Iff(a, b)
            | Formula::Until(_, a, b)
            | Formula::Release(_, a, b)
            | Formula::WeakUntil(_, a, b)
            | Formula::StrongRelease(_, a, b) => a.reads_actions() || b.reads_actions(),
        }
    }
}

/// A system and an objective.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The system of all paths.
    pub system: System,
    /// One entry a path variable, outermost first: whether it is `exists`.
    pub exists: Vec<bool>,
    /// `within K`.
    pub within: Option<u32>,
    /// `semantics S`, only with `within`.
    pub semantics: Option<Semantics>,
    /// How many steps the formula looks ahead at most, without `within`.
    pub look: u32,
    /// The formula.
    pub formula: Formula,
}

/// Names of path variables.
pub const PATHS: [&str; 4] = ["p", "q", "r", "s2"];

impl System {
    /// Number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.vars.iter().map(|(_, kind)| kind.size()).product()
    }

    /// The value of each variable in a state.
    #[must_use]
    pub fn values(&self, mut state: usize) -> Vec<usize> {
        let mut values = Vec::new();
        for (_, kind) in self.vars.iter().rev() {
            values.push(state % kind.size());
            state /= kind.size();
        }
        values.reverse();
        values
    }

    /// The state with these values, if they are values of the variables.
    #[must_use]
    pub fn state(&self, values: &[usize]) -> Option<usize> {
        self.vars.iter().zip(values).try_fold(0, |state, ((_, kind), &value)| {
            (value < kind.size()).then_some(state * kind.size() + value)
        })
    }

    /// All transitions `(from, action, to)`, sorted.
    #[must_use]
    pub fn edges(&self) -> Vec<(usize, usize, usize)> {
        let mut edges = Vec::new();
        for rule in self.rules.iter().filter(|r| !self.absorb.contains(&r.from)) {
            let mut targets = vec![Vec::new()];
            for (choices, here) in rule.choices.iter().zip(self.values(rule.from)) {
                let choices = choices.clone().unwrap_or_else(|| vec![here]);
                targets = targets
                    .iter()
                    .flat_map(|target| choices.iter().map(move |&c| [target.as_slice(), &[c]].concat()))
                    .collect();
            }
            for &action in &rule.actions {
                let all = self.with_also(rule.from, action, &targets);
                let all = all.iter().filter_map(|values| self.state(values));
                let allowed = all.filter(|to| !self.forbidden.contains(&(rule.from, *to)));
                edges.extend(allowed.map(|to| (rule.from, action, to)));
            }
        }
        edges.extend(self.absorb.iter().flat_map(|&s| (0..self.actions.len()).map(move |a| (s, a, s))));
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// The targets of a transition, with what it does besides.
    fn with_also(&self, from: usize, action: usize, targets: &[Vec<usize>]) -> Vec<Vec<usize>> {
        let mut all = targets.to_vec();
        for also in self.also.iter().filter(|a| a.actions.contains(&action) && a.from.contains(&from)) {
            let with = |values: &Vec<usize>, choice: usize| {
                let mut values = values.clone();
                values[also.var] = choice;
                values
            };
            all = all.iter().flat_map(|values| also.choices.iter().map(|&c| with(values, c))).collect();
        }
        all
    }

    /// The costs as they are written: a sum of which one part counts for a step.
    fn cost(&self) -> String {
        let mut parts = Vec::new();
        for (state, costs) in self.costs.iter().enumerate() {
            for (action, &cost) in costs.iter().enumerate().filter(|(_, cost)| **cost > 0) {
                let (there, name) = (self.is_state(state), self.actions[action]);
                parts.push(format!("(if action == {name} & {there} then {cost} else 0)"));
            }
        }
        if parts.is_empty() { "0".into() } else { parts.join(" + ") }
    }

    /// What a path costs in its first steps.
    #[must_use]
    pub fn cost_of(&self, states: &[usize], actions: &[usize], steps: usize) -> usize {
        let counts = |step: &usize| !self.absorb.contains(&states[*step]);
        (0..steps).filter(counts).map(|step| self.costs[states[step]][actions[step]]).sum()
    }

    fn named(&self, actions: &[usize]) -> String {
        let names: Vec<&str> = actions.iter().map(|&a| self.actions[a]).collect();
        if names.len() == self.actions.len() { "*".into() } else { names.join(" | ") }
    }

    fn is_state(&self, state: usize) -> String {
        self.is_state_of(state, "")
    }

    /// The same of the variables with a mark behind their names.
    fn is_state_of(&self, state: usize, mark: &str) -> String {
        let equal = self.vars.iter().zip(self.values(state)).map(|((name, kind), value)| match kind {
            Kind::Bool if value == 1 => format!("{name}{mark}"),
            Kind::Bool => format!("!{name}{mark}"),
            _ => format!("{name}{mark} == {}", kind.value(value)),
        });
        equal.collect::<Vec<_>>().join(" & ")
    }

    /// The rules as written: each alone, or those of the same actions in different states together.
    fn clauses(&self) -> Vec<Vec<&Rule>> {
        let mut clauses: Vec<Vec<&Rule>> = Vec::new();
        for rule in &self.rules {
            let fits = |clause: &&mut Vec<&Rule>| {
                // What a clause changes, no other may change besides where it applies.
                let mentions =
                    |r: &Rule| self.also.iter().map(|a| r.choices[a.var].is_some()).collect::<Vec<_>>();
                let fits = |r: &&Rule| {
                    r.actions == rule.actions && r.from != rule.from && mentions(r) == mentions(rule)
                };
                self.merged && clause.iter().all(fits)
            };
            match clauses.iter_mut().find(fits) {
                Some(clause) => clause.push(rule),
                None => clauses.push(vec![rule]),
            }
        }
        clauses
    }

    /// What becomes of a variable by rules in different states.
    fn conditional(&self, rules: &[&Rule], var: usize) -> String {
        let (name, kind) = self.vars[var];
        let choice = |rule: &Rule| match &rule.choices[var] {
            None => format!("{{{name}}}"),
            Some(values) => {
                let values: Vec<String> = values.iter().map(|&v| kind.value(v)).collect();
                format!("{{{}}}", values.join(", "))
            }
        };
        if rules[0].choices[var].is_none() && self.also.iter().any(|also| also.var == var) {
            return String::new();
        }
        let (last, rest) = rules.split_last().expect("a clause has rules");
        let mut text = format!(" {name}' in ");
        for rule in rest {
            text += &format!("if {} then {} else ", self.is_state(rule.from), choice(rule));
        }
        text + &choice(last) + ";"
    }

    /// What a clause of `also` asks and does; where it may, with its guard in the choice.
    fn besides(&self, also: &Also) -> String {
        let (name, kind) = self.vars[also.var];
        let values: Vec<String> = also.choices.iter().map(|&c| kind.value(c)).collect();
        let value = match values.as_slice() {
            [one] => format!("= {one}"),
            _ => format!("in {{{}}}", values.join(", ")),
        };
        if also.from.len() == self.states() {
            return format!("{{ {name}' {value}; }}");
        }
        let guard = self.is_one_of(&also.from);
        let shares = |actions: &[usize]| also.actions.iter().any(|a| actions.contains(a));
        let by_rule = self.rules.iter().any(|r| shares(&r.actions) && r.choices[also.var].is_some());
        let changing = self.also.iter().filter(|other| other.var == also.var && shares(&other.actions));
        if self.merged && !by_rule && changing.count() == 1 {
            return format!("{{ {name}' in if {guard} then {{{}}} else {{{name}}}; }}", values.join(", "));
        }
        format!("when {guard} {{ {name}' {value}; }}")
    }

    fn is_one_of(&self, states: &[usize]) -> String {
        if states.is_empty() {
            return "false".into();
        }
        if let ([(name, kind @ (Kind::Range(_) | Kind::Int(_) | Kind::Real(_)))], true) =
            (self.vars.as_slice(), states.len() > 1)
        {
            let values: Vec<String> = states.iter().map(|&state| kind.value(state)).collect();
            return format!("{name} in {{{}}}", values.join(", "));
        }
        states.iter().map(|&s| format!("({})", self.is_state(s))).collect::<Vec<_>>().join(" | ")
    }
}

impl Display for System {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let vars = self.vars.iter().map(|(name, kind)| match kind {
            Kind::Range(n) => format!("{name}: 0..{}", n - 1),
            Kind::Bool => format!("{name}: bool"),
            Kind::Int(_) => format!("{name}: int"),
            Kind::Real(_) => format!("{name}: real"),
            Kind::Enum(n) => {
                format!("{name}: {{{}}}", (0..*n).map(|v| kind.value(v)).collect::<Vec<_>>().join(", "))
            }
        });
        writeln!(f, "system M {{\n  state {};", vars.collect::<Vec<_>>().join(", "))?;
        writeln!(f, "  action {};", self.actions.join(", "))?;
        for rules in self.clauses() {
            let rule = rules[0];
            let actions = self.named(&rule.actions);
            let from: Vec<usize> = rules.iter().map(|rule| rule.from).collect();
            if rules.len() > 1 {
                let updates = (0..self.vars.len()).map(|var| self.conditional(&rules, var));
                let guard = self.is_one_of(&from);
                writeln!(f, "  on {actions} when {guard} {{{} }}", updates.collect::<String>())?;
                continue;
            }
            write!(f, "  on {actions} when {} {{", self.is_state(rule.from))?;
            for ((name, kind), choices) in self.vars.iter().zip(&rule.choices) {
                let values: Vec<String> = choices.iter().flatten().map(|&c| kind.value(c)).collect();
                match values.as_slice() {
                    [] => {}
                    [one] => write!(f, " {name}' = {one};")?,
                    [first, .., last] if *kind == Kind::Int(kind.size()) && is_run(choices) => {
                        write!(f, " {name}' in {first}..{last};")?;
                    }
                    _ => write!(f, " {name}' in {{{}}};", values.join(", "))?,
                }
            }
            writeln!(f, " }}")?;
        }
        for also in &self.also {
            writeln!(f, "  also on {} {}", self.named(&also.actions), self.besides(also))?;
        }
        if !self.costs.is_empty() {
            writeln!(f, "  cost c = {};", self.cost())?;
        }
        for (from, to) in &self.forbidden {
            writeln!(f, "  trans {} -> !({});", self.is_state(*from), self.is_state_of(*to, "'"))?;
        }
        if let Some(init) = &self.init {
            writeln!(f, "  init {};", self.is_one_of(init))?;
        }
        for (i, states) in self.labels.iter().enumerate() {
            writeln!(f, "  label l{i} = {};", self.is_one_of(states))?;
        }
        if !self.absorb.is_empty() {
            writeln!(f, "  absorb {};", self.is_one_of(&self.absorb))?;
        }
        let seen = if self.observe == Observe::First { self.vars[0].0 } else { "l0" };
        writeln!(f, "  observe {seen};\n}}")
    }
}

/// Whether the choices are successive numbers.
fn is_run(choices: &Option<Vec<usize>>) -> bool {
    choices.iter().all(|choices| choices.windows(2).all(|pair| pair[0] + 1 == pair[1]))
}

impl Display for Problem {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}objective o", self.system)?;
        if let Some(k) = self.within {
            write!(f, " within {k}")?;
        }
        if let Some(semantics) = self.semantics {
            write!(f, " semantics {semantics}")?;
        }
        write!(f, " {{\n  ")?;
        for (exists, name) in self.exists.iter().zip(PATHS) {
            write!(f, "{} {name}. ", if *exists { "exists" } else { "forall" })?;
        }
        writeln!(f, "\n  {}\n}}", Shown(&self.formula, &self.system))
    }
}

/// A formula with all its parentheses.
struct Shown<'a>(&'a Formula, &'a System);

impl Display for Shown<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Shown(formula, system) = *self;
        let many = |gs: &[Formula], sign: &str| {
            gs.iter().map(|g| Shown(g, system).to_string()).collect::<Vec<_>>().join(&format!(" {sign} "))
        };
        let at = |i: &Interval| match i {
            None => String::new(),
            Some((0, hi)) if hi % 2 == 0 => format!("[{hi}]"),
            Some((lo, hi)) => format!("[{lo},{hi}]"),
        };
        match formula {
            Formula::Atom(atom) => write!(f, "({})", atom.show(system)),
            Formula::Not(a) => write!(f, "(!{})", Shown(a, system)),
            Formula::And(gs) => write!(f, "({})", many(gs, "&")),
            Formula::Or(gs) => write!(f, "({})", many(gs, "|")),
            Formula::Implies(a, b) => write!(f, "({} -> {})", Shown(a, system), Shown(b, system)),
            Formula::Iff(a, b) => write!(f, "({} <-> {})", Shown(a, system), Shown(b, system)),
            Formula::Next(a) => write!(f, "(X {})", Shown(a, system)),
            Formula::WeakNext(a) => write!(f, "(N {})", Shown(a, system)),
            Formula::Finally(i, a) => write!(f, "(F{} {})", at(i), Shown(a, system)),
            Formula::Globally(i, a) => write!(f, "(G{} {})", at(i), Shown(a, system)),
            Formula::Until(i, a, b) => write!(f, "({} U{} {})", Shown(a, system), at(i), Shown(b, system)),
            Formula::Release(i, a, b) => write!(f, "({} R{} {})", Shown(a, system), at(i), Shown(b, system)),
            Formula::WeakUntil(i, a, b) => {
                write!(f, "({} W{} {})", Shown(a, system), at(i), Shown(b, system))
            }
            Formula::StrongRelease(i, a, b) => {
                write!(f, "({} M{} {})", Shown(a, system), at(i), Shown(b, system))
            }
        }
    }
}

impl Atom {
    fn show(&self, system: &System) -> String {
        let p = |i: &usize| PATHS[*i];
        match self {
            Atom::Label(i, l) => format!("l{l}[{}]", p(i)),
            Atom::Is(i, v, value) => {
                let (name, kind) = system.vars[*v];
                match (kind, value) {
                    (Kind::Bool, 1) => format!("{name}[{}]", p(i)),
                    (Kind::Bool, _) => format!("!{name}[{}]", p(i)),
                    _ => format!("{name}[{}] == {}", p(i), kind.value(*value)),
                }
            }
            Atom::Less(i, k, j, v) => {
                let (name, kind) = system.vars[*v];
                format!("{name}[{}] + {} < {name}[{}]", p(i), kind.value(*k), p(j))
            }
            Atom::SameValue(i, j, v) => {
                let (name, kind) = system.vars[*v];
                let sign = if kind == Kind::Bool { "<->" } else { "==" };
                format!("{name}[{}] {sign} {name}[{}]", p(i), p(j))
            }
            Atom::Took(i, a) => format!("action[{}] == {}", p(i), system.actions[*a]),
            Atom::SameAction(i, j) => format!("action[{}] == action[{}]", p(i), p(j)),
            Atom::SameState(i, j) => format!("state[{}] == state[{}]", p(i), p(j)),
            Atom::SameObs(i, j) => format!("obs[{}] == obs[{}]", p(i), p(j)),
            Atom::Enabled(i, a) => format!("{} in enabled[{}]", system.actions[*a], p(i)),
            Atom::Choice(i, a, yes, no) => {
                let (p, action) = (p(i), system.actions[*a]);
                format!("if action[{p}] == {action} then l{yes}[{p}] else l{no}[{p}]")
            }
            Atom::Coded(i, v, a) => {
                let (p, (name, kind), action) = (p(i), system.vars[*v], system.actions[*a]);
                let (one, zero) = (kind.value(1), kind.value(0));
                format!("{name}[{p}] == (if action[{p}] == {action} then {one} else {zero})")
            }
            Atom::Costs(i, most) => format!("cost c[{}] <= {most}", p(i)),
            Atom::Cheaper(i, less, j) => format!("cost c[{}] + {less} < cost c[{}]", p(i), p(j)),
        }
    }
}
