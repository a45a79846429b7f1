//! Of the paths that a strategy copes with: those that come closest to defeating it.
//!
//! What comes close is said by deadlines. If every `U` that counts for the strategy had to be over d steps earlier, the
//! objective would ask for more, the more the larger d is. So there is a least d at which it fails, if any, and the paths
//! that defeat the strategy then are its *worst*: no others use up more of the time that there is. Where no deadline
//! matters, paths that satisfy what the objective assumes of them stand for all.

use crate::check::check;
use crate::graph::Graph;
use crate::outcomes::{differs_at, is};
use crate::report::{Budget, Check, Defeat, Error, Stop};
use hyperplan_problem::{
    ActionId, Expr, Formula, FormulaId, Interval, Mode, Node, Objective, PathId, PathLeaf, Problem, State,
    Strategy, SystemId, Trace,
};
use std::collections::BTreeMap;

/// What a path of the block after the leading one begins with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Beginning {
    /// Its first state, if that is given.
    pub start: Option<State>,
    /// Its first actions.
    pub actions: Vec<ActionId>,
}

/// The worst paths of the block after the leading one, of those that begin as said; `None` if there are none, or they were
/// not found within the budget (each of a few checks may use it up). For a strategy that fails, what defeats it.
///
/// # Errors
/// If the strategy or the problem is malformed.
pub fn worst(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
    beginning: Option<(PathId, &Beginning)>,
    budget: &Budget,
) -> Result<Option<Vec<Trace>>, Error> {
    match find(problem, objective, strategy, beginning, budget) {
        Ok(found) => Ok(found),
        Err(Stop::Budget) => Ok(None),
        Err(Stop::Error(error)) => Err(error),
    }
}

fn find(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
    beginning: Option<(PathId, &Beginning)>,
    budget: &Budget,
) -> Result<Option<Vec<Trace>>, Stop> {
    let others = Others::of(objective);
    if others.conjuncts.is_empty() {
        return Ok(None);
    }
    let defeat = |formula: Formula| {
        let mut asked = Objective { formula, ..objective.clone() };
        if let Some((path, beginning)) = beginning {
            begin(problem, &mut asked, path, beginning);
        }
        match check(problem, &asked, strategy, budget) {
            Ok(Check::Holds) => Ok(None),
            Ok(Check::Fails(Defeat::Paths(traces))) => Ok(Some(traces)),
            // Where paths end at their horizon, that of earlier deadlines is another.
            Ok(_) | Err(Error::WrongLength { .. }) => Err(Stop::Budget),
            Err(error) => Err(Stop::Error(error)),
        }
    };
    if let Some(already) = defeat(others.tightened(0))? {
        return Ok(Some(already));
    }
    let longest = others.longest();
    let Some(mut found) = defeat(others.tightened(longest))? else {
        return defeat(others.impossible());
    };
    // The least number of steps by which deadlines cannot come earlier, by bisection: the larger, the harder.
    let (mut holds, mut fails) = (0, longest);
    while fails - holds > 1 {
        let middle = holds + (fails - holds) / 2;
        match defeat(others.tightened(middle))? {
            Some(traces) => (fails, found) = (middle, traces),
            None => holds = middle,
        }
    }
    Ok(Some(found))
}

/// The first so many initial states of a system; `None` if they are not found within the budget.
#[must_use]
pub fn starts(problem: &Problem, system: SystemId, most: usize, budget: &Budget) -> Option<Vec<State>> {
    let limit = usize::try_from(budget.states).unwrap_or(usize::MAX);
    let mut graph = Graph::new(problem.systems.get(system)?, limit);
    let states = graph.initial_states().ok()?;
    Some(states.into_iter().take(most).map(|id| graph.values(id).iter().copied().collect()).collect())
}

/// Adds to the formula: or the path does not begin so.
fn begin(problem: &Problem, objective: &mut Objective, path: PathId, beginning: &Beginning) {
    let mut parts = vec![objective.formula.root()];
    let variables = problem.systems[objective.paths[path].system].vars.keys();
    if let Some(state) = &beginning.start {
        let agrees = variables.map(|var| is(path, var, state[usize::from(var)])).collect();
        parts.push(differs_at(objective, 0, agrees));
    }
    for (step, action) in beginning.actions.iter().enumerate() {
        let agrees = vec![Expr::Leaf(PathLeaf::Took(path, *action))];
        parts.push(differs_at(objective, step + 1, agrees));
    }
    objective.formula.push(Node::Or(parts), objective.span);
}

/// What an objective says of paths that are not the strategy's.
struct Others<'a> {
    objective: &'a Objective,
    /// Whether each part of the formula reads such a path.
    reads: Vec<bool>,
    /// The conjuncts that do.
    conjuncts: Vec<FormulaId>,
}

impl<'a> Others<'a> {
    fn of(objective: &'a Objective) -> Self {
        let leading = objective.leading_block();
        let nodes = &objective.formula.nodes;
        let mut reads: Vec<bool> = Vec::with_capacity(nodes.len());
        for node in nodes {
            let mut read = node.children().iter().any(|child| reads[usize::from(*child)]);
            if let Node::Atom(expr) = node {
                expr.for_each_leaf(&mut |leaf| {
                    read |= leaf.paths().into_iter().flatten().any(|path| !leading.contains(&path));
                });
            }
            reads.push(read);
        }
        let mut conjuncts = Vec::new();
        let mut stack: Vec<FormulaId> = nodes.last_key().into_iter().collect();
        while let Some(id) = stack.pop() {
            match &nodes[id] {
                Node::And(parts) => stack.extend(parts.iter().rev()),
                _ if reads[usize::from(id)] => conjuncts.push(id),
                _ => {}
            }
        }
        Others { objective, reads, conjuncts }
    }

    /// No deadline is longer.
    fn longest(&self) -> u32 {
        let last =
            |interval: &Interval| interval.hi.or(self.end()).map_or(0, |hi| hi.saturating_sub(interval.lo));
        let deadline = |node: &Node| match node {
            Node::Until(interval, ..) => last(interval),
            _ => 0,
        };
        self.objective.formula.nodes.iter().map(deadline).max().unwrap_or(0)
    }

    fn end(&self) -> Option<u32> {
        match self.objective.mode {
            Mode::Within(k) => Some(k),
            Mode::Bounded => None,
        }
    }

    /// The conjuncts with every deadline that counts for the strategy so many steps earlier, though not before the first
    /// step of its interval.
    fn tightened(&self, by: u32) -> Formula {
        let earlier = |interval: Interval| match interval.hi.or(self.end()) {
            Some(hi) if by > 0 => {
                Interval { lo: interval.lo, hi: Some(hi.saturating_sub(by).max(interval.lo)) }
            }
            _ => interval,
        };
        self.rebuilt(&earlier)
    }

    /// The conjuncts without what they ask of paths that satisfy their assumptions: nobody can do that.
    fn impossible(&self) -> Formula {
        let formula = &self.objective.formula;
        let mut all = formula.clone();
        let assumed = |id: &FormulaId| formula.implication(*id).map(|(assumption, _)| assumption);
        let parts: Vec<FormulaId> = self.conjuncts.iter().filter_map(assumed).collect();
        let none = all.push(Node::And(parts), self.objective.span);
        all.push(Node::Not(none), self.objective.span);
        all
    }

    /// The formula again, with other intervals where `U` stands under an even number of negations and reads other paths.
    fn rebuilt(&self, interval: &dyn Fn(Interval) -> Interval) -> Formula {
        let span = self.objective.span;
        let (nodes, mut out) = (&self.objective.formula.nodes, Formula::default());
        // Each part as it is, and with deadlines changed where it counts for the strategy and where its negation does.
        let mut made: BTreeMap<(FormulaId, Sign), FormulaId> = BTreeMap::new();
        for (id, node) in nodes.iter_enumerated() {
            for sign in [Sign::Kept, Sign::For, Sign::Against] {
                let changed = self.reads[usize::from(id)] && sign != Sign::Kept;
                if !changed && sign != Sign::Kept {
                    made.insert((id, sign), made[&(id, Sign::Kept)]);
                    continue;
                }
                let below = match (node, sign) {
                    (Node::Iff(..), _) => Sign::Kept,
                    (Node::Not(_), sign) => sign.turned(),
                    (_, sign) => sign,
                };
                let mut new = node.map_children(|child| made[&(child, below)]);
                match &mut new {
                    Node::Until(i, ..) if sign == Sign::For => *i = interval(*i),
                    _ => {}
                }
                made.insert((id, sign), out.push(new, span));
            }
        }
        let conjuncts = self.conjuncts.iter().map(|id| made[&(*id, Sign::For)]).collect();
        out.push(Node::And(conjuncts), span);
        out
    }
}

/// For whom a part of a formula counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Sign {
    Kept,
    For,
    Against,
}

impl Sign {
    fn turned(self) -> Self {
        match self {
            Sign::Kept => Sign::Kept,
            Sign::For => Sign::Against,
            Sign::Against => Sign::For,
        }
    }
}
