//! The game without time: for how many steps a chance lasts at least, whatever the leading paths do.
//!
//! The leading paths see what the other player does, and move first; its answers are as they come. Residuals are relaxed: deadlines
//! are lifted, and what must always hold is forgotten ([`Residuals::relax`](crate::residual::Residuals)). So places are the same at
//! all times, and few where there are many times. The value of a lead and a chance is the number of steps after which the leading paths,
//! however the other player answers, can have come to owe nothing but safety, themselves and as regards the chance. It is found
//! backwards, as the attractor of a reachability game (Grädel, Thomas, Wilke 2002, section 2.2), level by level.
//!
//! It is a lower bound for what they need if they must not see the other player, and must meet deadlines. By the end of the
//! horizon nothing is owed but safety where the goal is met, so a chance that lasts beyond it loses.
//!
//! *First times.* A place is entered with the least number of steps that lead there. The leading paths may go on to states
//! that matter at that time or later, and the other player to where its path lasts long enough even then, so that more of the former
//! and fewer of the latter are allowed than at any time when the place is met. Nothing is known of a place that is met before
//! that.

use super::joint::{Numbers, States, joint};
use super::presence::Presence;
use crate::reach::{Bits, Place, Product};
use crate::residual::{FALSE, Residual, TRUE};
use crate::task::Error;
use hyperplan_space::{Graph, Letter, StateIx, sources};
use rustc_hash::FxHashMap;
use std::ops::Range;
use std::rc::Rc;

/// Answers beyond which the rest is not looked at: they take some hundred MB.
const MOST_ANSWERS: usize = 20_000_000;

/// Nodes between two questions whether to stop.
const STRIDE: usize = 1 << 12;

/// The number of steps where the leading paths lose.
const NEVER: u32 = u32::MAX;

/// In place of a chance: it is gone.
const GONE: u32 = u32::MAX;

/// States of one player's paths, and what is left, as those who ask have it.
pub(super) type Half<const N: usize> = (States<N>, Residual);

/// A step of one player's paths: the places that they enter, and the number of their states there.
type Step<const N: usize> = ([Place; N], u32);

/// What is known of one player's paths.
#[derive(Debug)]
struct Side<const N: usize> {
    paths: Range<usize>,
    states: Numbers<States<N>>,
    /// The steps from each of these, once they were asked for.
    steps: Vec<Option<Rc<[Step<N>]>>>,
    /// States by number, with what is left, relaxed.
    halves: Numbers<(u32, Residual)>,
    relaxed: FxHashMap<Residual, Residual>,
    /// The halves that the numbers of those who ask stand for.
    asked: Vec<Option<Option<u32>>>,
}

impl<const N: usize> Side<N> {
    fn new(paths: Range<usize>) -> Self {
        Side {
            paths,
            states: Numbers::new(),
            steps: Vec::new(),
            halves: Numbers::new(),
            relaxed: FxHashMap::default(),
            asked: Vec::new(),
        }
    }

    fn relax(&mut self, product: &mut Product<'_, N>, left: Residual) -> Residual {
        *self.relaxed.entry(left).or_insert_with(|| product.residuals.relax(left, None))
    }

    /// The number of a half, which is new perhaps.
    fn enter(&mut self, product: &mut Product<'_, N>, (states, left): Half<N>) -> u32 {
        let (states, left) = (self.states.of(states), self.relax(product, left));
        self.halves.of((states, left))
    }

    /// The number of a half that those who ask call `asked`, if it was met.
    fn find(&mut self, product: &mut Product<'_, N>, asked: u32, (states, left): Half<N>) -> Option<u32> {
        let at = asked as usize;
        if self.asked.len() <= at {
            self.asked.resize(at + 1, None);
        }
        if let Some(known) = self.asked[at] {
            return known;
        }
        let left = self.relax(product, left);
        let states = self.states.find(&states);
        let found = states.and_then(|states| self.halves.find(&(states, left)));
        self.asked[at] = Some(found);
        found
    }

    /// Every joint step from these states.
    fn steps(&mut self, graphs: &[&Graph; N], from: u32) -> Rc<[Step<N>]> {
        let at = from as usize;
        if self.steps.len() <= at {
            self.steps.resize(at + 1, None);
        }
        if let Some(known) = &self.steps[at] {
            return known.clone();
        }
        let from = self.states.get(from);
        let single = |at: usize| -> Vec<Place> {
            let step = |&(letter, to): &(Letter, StateIx)| (to, Some(graphs[at].letters[letter as usize].0));
            graphs[at].successors(from[at]).iter().map(step).collect()
        };
        let all = joint(self.paths.clone(), single).into_iter();
        let all: Rc<[Step<N>]> =
            all.map(|places| (places, self.states.of(places.map(|place| place.0)))).collect();
        self.steps[at] = Some(all.clone());
        all
    }
}

/// The values of leads and chances.
#[derive(Debug)]
pub(super) struct Untimed<const N: usize> {
    leads: Side<N>,
    others: Side<N>,
    nodes: Numbers<(u32, u32)>,
    /// By node: the first time, and the value.
    first: Vec<u32>,
    steps: Vec<u32>,
}

/// The two parts of the goal, as products with all paths: what is asked of the leading paths alone, and the rest.
pub(super) struct Goals<'s, 'a, const N: usize> {
    pub(super) own: &'s mut Product<'a, N>,
    pub(super) rest: &'s mut Product<'a, N>,
}

impl<const N: usize> Untimed<N> {
    /// From these starts on, each the places of all paths. `present` is when each path can matter where. What is beyond `budget` steps is taken to be
    /// over at once.
    pub(super) fn new(
        mut goals: Goals<'_, '_, N>,
        leading: usize,
        present: &[Presence],
        starts: &[(Half<N>, Option<Half<N>>)],
        budget: usize,
    ) -> Result<Self, Error> {
        let untimed = Untimed {
            leads: Side::new(0..leading),
            others: Side::new(leading..N),
            nodes: Numbers::new(),
            first: Vec::new(),
            steps: Vec::new(),
        };
        let end = goals.own.question.arena.task.end();
        let each = present.iter().zip(goals.rest.graphs);
        let until = each.map(|(present, graph)| present.until(graph.len(), end));
        let mut search = Search {
            until: until.collect(),
            untimed,
            leading,
            lead_moves: Vec::new(),
            recent: Vec::new(),
            moves: Vec::new(),
            answers: Vec::new(),
            looked: 0,
        };
        for &(lead, chance) in starts {
            let lead = search.untimed.leads.enter(goals.own, lead);
            let chance = chance.map(|chance| search.untimed.others.enter(goals.rest, chance));
            search.enter(lead, chance.unwrap_or(GONE), 0);
        }
        let expanded = search.explore(&mut goals, budget)?;
        search.measure(&goals, expanded);
        Ok(search.untimed)
    }

    /// For how many steps from a time on a chance, or only what is asked of the leading paths, lasts at least. Both are told by their
    /// number, to those who ask, and what it stands for.
    pub(super) fn steps(
        &mut self,
        goals: Goals<'_, '_, N>,
        lead: (u32, Half<N>),
        chance: Option<(u32, Half<N>)>,
        time: u32,
    ) -> u32 {
        let Some(lead) = self.leads.find(goals.own, lead.0, lead.1) else { return 0 };
        let chance = match chance {
            None => Some(GONE),
            Some((asked, half)) => self.others.find(goals.rest, asked, half),
        };
        let node = chance.and_then(|chance| self.nodes.find(&(lead, chance)));
        node.map(|node| node as usize)
            .filter(|&node| self.first[node] <= time)
            .map_or(0, |node| self.steps[node])
    }
}

struct Search<const N: usize> {
    untimed: Untimed<N>,
    leading: usize,
    /// By path and state: the first time from which on it cannot matter any more.
    until: Vec<Vec<u32>>,
    /// By half of the leading paths: the places that a move enters, and the half after it.
    lead_moves: Vec<Option<Rc<[Step<N>]>>>,
    /// What became of the chance that is looked at: many steps are alike.
    recent: Vec<(Bits, Residual)>,
    /// The node that each move is made from, and how many of the answers to it are not known to be good for the leading paths.
    moves: Vec<(u32, u32)>,
    /// A move and a node that answers it.
    answers: Vec<(u32, u32)>,
    /// Joint steps looked at.
    looked: usize,
}

impl<const N: usize> Search<N> {
    fn enter(&mut self, lead: u32, chance: u32, time: u32) -> u32 {
        let node = self.untimed.nodes.of((lead, chance));
        if self.untimed.first.len() < self.untimed.nodes.len() {
            self.untimed.first.push(time);
        }
        node
    }

    /// Explores breadth first; how many nodes were expanded.
    fn explore(&mut self, goals: &mut Goals<'_, '_, N>, budget: usize) -> Result<usize, Error> {
        let end = goals.own.question.arena.task.end();
        let mut at = 0;
        while at < self.untimed.nodes.len() && self.looked < budget && self.answers.len() < MOST_ANSWERS {
            if !self.is_over(goals, at) && self.untimed.first[at] < end {
                self.expand(goals, at);
            }
            at += 1;
            if at.is_multiple_of(STRIDE) {
                goals.own.question.arena.task.go_on()?;
            }
        }
        Ok(at)
    }

    /// Whether nothing but safety is owed.
    fn is_over(&self, goals: &Goals<'_, '_, N>, node: usize) -> bool {
        let (lead, chance) = self.untimed.nodes.get(node as u32);
        goals.own.residuals.owes_nothing(self.untimed.leads.halves.get(lead).1)
            && (chance == GONE || goals.rest.residuals.owes_nothing(self.untimed.others.halves.get(chance).1))
    }

    fn expand(&mut self, goals: &mut Goals<'_, '_, N>, node: usize) {
        let (lead, chance) = self.untimed.nodes.get(node as u32);
        let time = self.untimed.first[node] + 1;
        let mut found = Vec::new();
        self.recent.clear();
        for (places, to) in self.moves_of(goals, lead).iter() {
            let leading = 0..self.leading;
            if !leading.clone().all(|at| self.until[at][places[at].0 as usize] > time) {
                continue;
            }
            found.clear();
            if chance != GONE && !self.answer(goals, chance, places, time, &mut found) {
                continue;
            }
            found.sort_unstable();
            found.dedup();
            if found.is_empty() {
                found.push(GONE);
            }
            let number = self.moves.len() as u32;
            self.moves.push((node as u32, found.len() as u32));
            for &chance in &found {
                let answer = self.enter(*to, chance, time);
                self.answers.push((number, answer));
            }
        }
    }

    /// The moves of the leading paths that leave the goal possible as far as they alone are concerned.
    fn moves_of(&mut self, goals: &mut Goals<'_, '_, N>, lead: u32) -> Rc<[Step<N>]> {
        let at = lead as usize;
        if self.lead_moves.len() <= at {
            self.lead_moves.resize(at + 1, None);
        }
        if let Some(known) = &self.lead_moves[at] {
            return known.clone();
        }
        let leads = &mut self.untimed.leads;
        let (states, before) = leads.halves.get(lead);
        let mut moves = Vec::new();
        for (places, to) in leads.steps(&goals.own.graphs, states).iter() {
            let bits = goals.own.own_bits(places);
            let left = goals.own.relaxed(before, bits);
            if left != FALSE {
                moves.push((*places, leads.halves.of((*to, left))));
            }
        }
        let moves: Rc<[Step<N>]> = moves.into();
        self.lead_moves[at] = Some(moves.clone());
        moves
    }

    /// What a move to a time may make of a chance; `false` where it may come true.
    fn answer(
        &mut self,
        goals: &mut Goals<'_, '_, N>,
        chance: u32,
        lead: &[Place; N],
        time: u32,
        found: &mut Vec<u32>,
    ) -> bool {
        let (states, before) = self.untimed.others.halves.get(chance);
        let Goals { rest, .. } = goals;
        let all = self.untimed.others.steps(&rest.graphs, states);
        self.looked += all.len();
        for (places, to) in all.iter() {
            let allowed = |at: usize| {
                let state = places[at].0;
                // Where a path does not matter any more it does no harm.
                self.until[at][state as usize] > time
                    && rest.question.arena.task.lasts(rest.graphs[at], state, time)
            };
            if !(self.leading..N).all(allowed) {
                continue;
            }
            let together = std::array::from_fn(|at| if at < self.leading { lead[at] } else { places[at] });
            let bits = rest.own_bits(&together);
            let known = self.recent.iter().find(|known| known.0 == bits).map(|known| known.1);
            let left = known.unwrap_or_else(|| {
                let left = rest.relaxed(before, bits);
                self.recent.push((bits, left));
                left
            });
            match left {
                FALSE => return false,
                TRUE => {}
                left => found.push(self.untimed.others.halves.of((*to, left))),
            }
        }
        true
    }

    /// Goes backwards from where nothing is owed, or nothing is known.
    fn measure(&mut self, goals: &Goals<'_, '_, N>, expanded: usize) {
        let count = self.untimed.nodes.len();
        self.untimed.steps = vec![NEVER; count];
        let mut queue = Vec::new();
        for node in 0..count {
            if node >= expanded || self.is_over(goals, node) {
                self.untimed.steps[node] = 0;
                queue.push(node as u32);
            }
        }
        let (starts, moves) = sources(count, self.answers.iter().copied());
        let mut next = 0;
        while next < queue.len() {
            let answer = queue[next] as usize;
            next += 1;
            for &number in &moves[starts[answer] as usize..starts[answer + 1] as usize] {
                let (node, left) = &mut self.moves[number as usize];
                *left -= 1;
                // Values are met in their order, so this is the worst answer to the best move.
                if *left == 0 && self.untimed.steps[*node as usize] == NEVER {
                    self.untimed.steps[*node as usize] = self.untimed.steps[answer] + 1;
                    queue.push(*node);
                }
            }
        }
    }
}
