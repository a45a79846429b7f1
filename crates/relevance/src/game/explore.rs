//! The nodes of a game and the moves between them, stored once: values are computed over them again and again.

use crate::reach::{Exploration, Place, Question};
use crate::residual::{FALSE, Residual, Residuals, TRUE};
use hyperplan_space::{Letter, StateIx};
use rustc_hash::{FxHashMap, FxHashSet};

/// Residuals of one time beyond which a game, or runs that are followed all at once, are left to other methods.
pub const MAX_RESIDUALS: usize = 512;

/// What is left of the other player's goal, and the other path's state.
pub type Pair = (Residual, StateIx);

/// A node, as an answer, in which the other player has met the goal.
pub(super) const LOST: u32 = u32::MAX;

/// The budget of nodes, times this, is that of moves.
const MOVES_PER_NODE: usize = 16;

/// A move of the leading path.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// The letter; `None` where the path is not read any more.
    pub letter: Option<Letter>,
    /// The position of the state that it leads to, among those of the next time.
    pub(super) to: u32,
    /// Whether a winning run can have it.
    pub(super) open: bool,
}

/// What is left of the other player's goal, and the states of both paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Node {
    /// The position of the leading path's state, among those of the time.
    pub(super) state: u32,
    pub(super) residual: Residual,
    pub(super) other: StateIx,
}

impl Node {
    pub(super) fn pair(&self) -> Pair {
        (self.residual, self.other)
    }
}

/// What was found of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Facts {
    /// The time by which the leading path can have won; [`u32::MAX`] if it cannot.
    pub(super) value: u32,
    /// Every run of the leading path into the state can be in the node.
    pub(super) certain: bool,
    /// Some run can be in the node that has not been in a losing one.
    pub(super) reached: bool,
    /// The other player can win from here, if the leading path makes the wrong moves.
    pub(super) danger: bool,
}

/// All there is at one time.
#[derive(Debug)]
pub(super) struct Stage {
    /// The leading path's states, sorted.
    pub(super) states: Vec<StateIx>,
    /// Whether a winning run can have them.
    pub(super) alive: Vec<bool>,
    /// Where the moves of each state start, and the end.
    turn_starts: Vec<u32>,
    pub(super) turns: Vec<Turn>,
    /// Sorted, so those of a state are neighbors.
    pub(super) nodes: Vec<Node>,
    /// Where the nodes of each state start, and the end.
    node_starts: Vec<u32>,
    pub(super) facts: Vec<Facts>,
    /// Values beyond this are losing.
    pub(super) bound: u32,
    /// Where the answers to the first move from each node start, in `spans`.
    firsts: Vec<u32>,
    /// Where the answers to each move from each node start, in `answers`, and the end.
    spans: Vec<u32>,
    /// Nodes of the next time.
    answers: Vec<u32>,
}

impl Stage {
    fn new(states: Vec<StateIx>, mut nodes: Vec<Node>) -> Stage {
        nodes.sort_unstable();
        let node_starts = (0..=states.len() as u32)
            .map(|state| nodes.partition_point(|node| node.state < state) as u32)
            .collect();
        Stage {
            alive: vec![true; states.len()],
            states,
            turn_starts: vec![0],
            turns: Vec::new(),
            node_starts,
            facts: vec![Facts::default(); nodes.len()],
            nodes,
            bound: u32::MAX - 1,
            firsts: Vec::new(),
            spans: vec![0],
            answers: Vec::new(),
        }
    }

    /// How many different residuals its nodes have.
    fn residuals(&self) -> usize {
        let residuals: FxHashSet<Residual> = self.nodes.iter().map(|node| node.residual).collect();
        residuals.len()
    }

    /// The moves of a state.
    pub(super) fn turns(&self, state: usize) -> &[Turn] {
        &self.turns[self.turns_of(state)]
    }

    pub(super) fn turns_of(&self, state: usize) -> std::ops::Range<usize> {
        self.turn_starts[state] as usize..self.turn_starts[state + 1] as usize
    }

    /// The nodes of a state.
    pub(super) fn nodes_of(&self, state: usize) -> std::ops::Range<usize> {
        self.node_starts[state] as usize..self.node_starts[state + 1] as usize
    }

    /// Where the other path may be after a move from a node: nodes of the next time.
    pub(super) fn answers(&self, node: usize, turn: usize) -> &[u32] {
        let at = self.firsts[node] as usize + turn;
        &self.answers[self.spans[at] as usize..self.spans[at + 1] as usize]
    }

    /// Whether a node, as an answer, is losing.
    pub(super) fn loses(&self, node: u32) -> bool {
        node == LOST || self.facts[node as usize].value > self.bound
    }

    /// The positions of the states that a winning run can have.
    pub(super) fn living(&self) -> impl Iterator<Item = usize> {
        (0..self.states.len()).filter(|&state| self.alive[state])
    }

    /// The nodes that are open: a winning run can be in them, and something can go wrong.
    pub(super) fn open_nodes(&self) -> impl Iterator<Item = usize> {
        (0..self.nodes.len()).filter(|&at| {
            let facts = self.facts[at];
            facts.reached && facts.danger && facts.value <= self.bound
        })
    }
}

/// The stages of a game, with values only at the end, and the residuals.
pub(super) fn stages(question: &Question<'_, 2>) -> Option<(Vec<Stage>, Residuals)> {
    let mut explorer = Explorer { exploration: Exploration::new(question), question, nodes: 0, moves: 0 };
    let task = &question.arena.task;
    if !explorer.exploration.product.knows_all() || explorer.exploration.product.initial <= FALSE {
        return None;
    }
    let mut stage = explorer.start()?;
    let mut stages = Vec::new();
    for time in 0..explorer.exploration.product.horizon {
        task.go_on().ok()?;
        let next = explorer.advance(&mut stage, time + 1)?;
        if explorer.exploration.product.residuals.count() > task.limits.residuals
            || next.residuals() > MAX_RESIDUALS
        {
            return None;
        }
        stages.push(std::mem::replace(&mut stage, next));
    }
    explorer.end(&mut stage)?;
    stages.push(stage);
    Some((stages, explorer.exploration.product.residuals))
}

struct Explorer<'q, 'a> {
    exploration: Exploration<'a, 2>,
    question: &'q Question<'a, 2>,
    /// How many nodes there were, and moves of both paths from them.
    nodes: usize,
    moves: usize,
}

impl Explorer<'_, '_> {
    /// `None` where the goal is met at once.
    fn start(&mut self) -> Option<Stage> {
        let within = self.question.within[0]?;
        let mut nodes = Vec::new();
        for (residual, [own, other]) in self.exploration.start() {
            let state = within.at[0].binary_search(&own).ok()?;
            nodes.push(Node { state: state as u32, residual, other });
        }
        Some(Stage::new(within.at[0].clone(), nodes))
    }

    /// The stage after one, whose moves are filled in. `None` beyond the budget.
    fn advance(&mut self, stage: &mut Stage, time: u32) -> Option<Stage> {
        let states = self.turns(stage, time);
        let mut found = Found::default();
        for at in 0..stage.nodes.len() {
            self.spend()?;
            let node = stage.nodes[at];
            stage.firsts.push(stage.spans.len() as u32 - 1);
            for k in stage.turns_of(node.state as usize) {
                let turn = stage.turns[k];
                let own = self.place(0, states[turn.to as usize], turn.letter);
                self.answer(node, (turn.to, own), time, &mut stage.answers, &mut found);
                stage.spans.push(stage.answers.len() as u32);
            }
        }
        let ranks = found.ranks();
        for answer in stage.answers.iter_mut().filter(|answer| **answer != LOST) {
            *answer = ranks[*answer as usize];
        }
        Some(Stage::new(states, found.nodes))
    }

    /// Counts a node. `None` if there were too many, or too many moves.
    fn spend(&mut self) -> Option<()> {
        self.nodes += 1;
        let budget = self.question.budget;
        (self.nodes <= budget && self.moves <= budget * MOVES_PER_NODE).then_some(())
    }

    /// Fills in the moves of the leading path and gives its states after them.
    fn turns(&self, stage: &mut Stage, time: u32) -> Vec<StateIx> {
        let layer = self.question.within[0].and_then(|layers| layers.at.get(time as usize));
        let states = layer.unwrap_or(&stage.states).clone();
        for (at, &state) in stage.states.iter().enumerate() {
            if layer.is_none() {
                // Beyond its horizon the path stays where it is.
                stage.turns.push(Turn { letter: None, to: at as u32, open: true });
            } else {
                for &(letter, next) in self.exploration.product.graphs[0].successors(state) {
                    if let Ok(to) = states.binary_search(&next) {
                        stage.turns.push(Turn { letter: Some(letter), to: to as u32, open: true });
                    }
                }
            }
            stage.turn_starts.push(stage.turns.len() as u32);
        }
        states
    }

    fn place(&self, path: usize, state: StateIx, letter: Option<Letter>) -> Place {
        (state, letter.map(|letter| self.exploration.product.graphs[path].letters[letter as usize].0))
    }

    /// The answers to a move from a node.
    fn answer(
        &mut self,
        from: Node,
        (state, own): (u32, Place),
        time: u32,
        answers: &mut Vec<u32>,
        found: &mut Found,
    ) {
        self.moves += 1 + self.exploration.product.graphs[1].successors(from.other).len();
        let start = answers.len();
        let graph = self.exploration.product.graphs[1];
        let stays = time > self.question.arena.task.horizon(self.question.paths[1]);
        let mut enter = |other: Place| match self.exploration.enter(from.residual, &[own, other], time) {
            None => {}
            Some(TRUE) => answers.push(LOST),
            Some(residual) => answers.push(found.number(Node { state, residual, other: other.0 })),
        };
        if stays {
            enter((from.other, None));
        } else {
            for &(letter, next) in graph.successors(from.other) {
                if self.question.arena.task.lasts(graph, next, time) {
                    enter((next, Some(graph.letters[letter as usize].0)));
                }
            }
        }
        answers[start..].sort_unstable();
        let mut kept = start;
        for at in start..answers.len() {
            if at == start || answers[at] != answers[kept - 1] {
                answers[kept] = answers[at];
                kept += 1;
            }
        }
        answers.truncate(kept);
        if answers[start..].last() == Some(&LOST) {
            // Nothing else matters then.
            answers.truncate(start);
            answers.push(LOST);
        }
    }

    /// The values at the end, where no path is read any more.
    fn end(&mut self, stage: &mut Stage) -> Option<()> {
        let mut known: FxHashMap<Residual, bool> = FxHashMap::default();
        let horizon = self.exploration.product.horizon;
        for (node, facts) in stage.nodes.iter().zip(&mut stage.facts) {
            let met = match known.get(&node.residual) {
                Some(&met) => met,
                None => {
                    let places = [(stage.states[node.state as usize], None), (node.other, None)];
                    let met = self.outcome(node.residual, &places)?;
                    known.insert(node.residual, met);
                    met
                }
            };
            facts.value = if met { u32::MAX } else { horizon };
        }
        Some(())
    }

    /// Whether what reads no path any more comes to the goal being met.
    fn outcome(&mut self, residual: Residual, places: &[Place; 2]) -> Option<bool> {
        let mut residual = residual;
        for time in self.exploration.product.horizon + 1..self.question.arena.task.limits.horizon as u32 {
            match residual {
                TRUE => return Some(true),
                FALSE => return Some(false),
                _ => residual = self.exploration.enter(residual, places, time).unwrap_or(FALSE),
            }
        }
        None
    }
}

/// Nodes by the order in which they were found.
#[derive(Default)]
struct Found {
    nodes: Vec<Node>,
    index: FxHashMap<Node, u32>,
}

impl Found {
    fn number(&mut self, node: Node) -> u32 {
        *self.index.entry(node).or_insert_with(|| {
            self.nodes.push(node);
            self.nodes.len() as u32 - 1
        })
    }

    /// The place of each node once they are sorted.
    fn ranks(&self) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.nodes.len() as u32).collect();
        order.sort_unstable_by_key(|&at| self.nodes[at as usize]);
        let mut ranks = vec![0; order.len()];
        for (rank, at) in (0u32..).zip(order) {
            ranks[at as usize] = rank;
        }
        ranks
    }
}
