//! Which nodes are losing, which are certain, and what follows for the moves of the leading path.

use super::explore::{Facts, LOST, Stage};

/// Closes moves until nothing changes; with slack, once more with late nodes as losing. Whether that cut anything.
pub(super) fn play(stages: &mut [Stage], slack: Option<u32>) -> bool {
    settle(stages);
    let mut cut = false;
    if let (Some(slack), Some(value)) = (slack, value(stages)) {
        let bound = value.saturating_add(slack).min(u32::MAX - 1);
        cut = stages
            .iter()
            .flat_map(|stage| &stage.facts)
            .any(|facts| facts.reached && (bound + 1..u32::MAX).contains(&facts.value));
        if cut {
            stages.iter_mut().for_each(|stage| stage.bound = bound);
            settle(stages);
        }
    }
    mark_danger(stages);
    cut
}

fn settle(stages: &mut [Stage]) {
    loop {
        evaluate(stages);
        if !follow(stages) {
            return;
        }
    }
}

/// The value at the start; `None` if there is no start left.
pub(super) fn value(stages: &[Stage]) -> Option<u32> {
    let first = &stages[0];
    let worst = |state| first.facts[first.nodes_of(state)].iter().map(|facts| facts.value).max().unwrap_or(0);
    first.living().map(worst).min()
}

/// Gives nodes their values, from the end on, and gives up states without moves.
fn evaluate(stages: &mut [Stage]) {
    for time in (0..stages.len() - 1).rev() {
        let [stage, next] = &mut stages[time..=time + 1] else { return };
        for state in 0..stage.states.len() {
            let turns = stage.turns_of(state);
            for turn in &mut stage.turns[turns.clone()] {
                turn.open &= next.alive[turn.to as usize];
            }
            stage.alive[state] &= stage.turns[turns].iter().any(|turn| turn.open);
            for at in stage.nodes_of(state) {
                let values =
                    (stage.turns(state).iter().enumerate()).filter(|(_, turn)| turn.open).map(|(k, _)| {
                        let answers = stage.answers(at, k).iter();
                        let worst = answers.map(|&a| value_of(next, a)).max();
                        worst.unwrap_or(0).max(time as u32 + 1)
                    });
                let value = values.min().filter(|_| stage.alive[state]);
                stage.facts[at].value = value.unwrap_or(u32::MAX);
            }
        }
    }
}

fn value_of(stage: &Stage, node: u32) -> u32 {
    if node == LOST { u32::MAX } else { stage.facts[node as usize].value }
}

/// Finds the nodes that are certain and those that are reached, from the start on. Whether that closed a move or gave up
/// a state.
fn follow(stages: &mut [Stage]) -> bool {
    let mut changed = false;
    let first = &mut stages[0];
    for facts in &mut first.facts {
        (facts.certain, facts.reached) = (true, true);
    }
    for time in 0..stages.len() - 1 {
        let [stage, next] = &mut stages[time..=time + 1] else { return changed };
        let mut arriving = Arriving::new(next);
        for state in 0..stage.states.len() {
            if stage.alive[state] {
                changed |= arriving.leave(stage, next, state);
            }
        }
        changed |= arriving.arrive(next);
    }
    let last = stages.last_mut().expect("there is a time 0");
    for state in 0..last.states.len() {
        let lost = last.nodes_of(state).any(|at| last.facts[at].certain && last.loses(at as u32));
        if last.alive[state] && lost {
            last.alive[state] = false;
            changed = true;
        }
    }
    changed
}

/// What is known of one time while the moves that lead there are followed.
struct Arriving {
    /// How many moves lead to each state.
    moves: Vec<u32>,
    /// By how many of them each node is certain, and the last one.
    certain: Vec<(u32, u32)>,
    last: u32,
}

impl Arriving {
    fn new(next: &mut Stage) -> Arriving {
        for facts in &mut next.facts {
            (facts.certain, facts.reached) = (false, false);
        }
        Arriving { moves: vec![0; next.states.len()], certain: vec![(0, 0); next.nodes.len()], last: 0 }
    }

    /// Follows the moves of a state. Whether one of them was closed.
    fn leave(&mut self, stage: &mut Stage, next: &mut Stage, state: usize) -> bool {
        let mut changed = false;
        for (k, at) in stage.turns_of(state).enumerate() {
            if !stage.turns[at].open {
                continue;
            }
            let mut nodes = stage.nodes_of(state);
            if nodes.any(|node| stage.facts[node].certain && lost_at(stage, next, node, k)) {
                stage.turns[at].open = false;
                changed = true;
                continue;
            }
            self.moves[stage.turns[at].to as usize] += 1;
            self.last += 1;
            for node in stage.nodes_of(state) {
                let Facts { certain, reached, value, .. } = stage.facts[node];
                let loses = value > stage.bound;
                if !reached || loses || lost_at(stage, next, node, k) {
                    continue;
                }
                for &answer in stage.answers(node, k) {
                    next.facts[answer as usize].reached = true;
                    let (count, last) = &mut self.certain[answer as usize];
                    if certain && *last != self.last {
                        (*count, *last) = (*count + 1, self.last);
                    }
                }
            }
        }
        changed
    }

    /// Marks what is certain. Whether a state was given up that nothing leads to.
    fn arrive(&self, next: &mut Stage) -> bool {
        let mut changed = false;
        for state in 0..next.states.len() {
            let moves = self.moves[state];
            for at in next.nodes_of(state) {
                next.facts[at].certain = moves > 0 && self.certain[at].0 == moves;
            }
            if next.alive[state] && moves == 0 {
                next.alive[state] = false;
                changed = true;
            }
        }
        changed
    }
}

/// Whether a move from a node has an answer that is losing.
fn lost_at(stage: &Stage, next: &Stage, node: usize, turn: usize) -> bool {
    stage.answers(node, turn).iter().any(|&a| next.loses(a))
}

/// Marks the nodes from which a wrong move leads to where the other player wins.
fn mark_danger(stages: &mut [Stage]) {
    for time in (0..stages.len() - 1).rev() {
        let [stage, next] = &mut stages[time..=time + 1] else { return };
        for state in 0..stage.states.len() {
            for at in stage.nodes_of(state) {
                let wrong = |&a: &u32| next.loses(a) || next.facts[a as usize].danger;
                let mut open = stage.turns(state).iter().enumerate().filter(|(_, turn)| turn.open);
                let danger = open.any(|(k, _)| stage.answers(at, k).iter().any(wrong));
                stage.facts[at].danger = danger;
            }
        }
    }
}
