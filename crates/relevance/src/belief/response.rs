//! The other player's answers to what the leading paths do, step by step.
//!
//! The other player chooses its paths with the leading paths before it. Here it sees of them only what they did so far, and
//! answers at once: if it wins even so, it wins. That it does not says nothing, as it may have to know what is to come. This is
//! the usual sufficient test for "for all there is": a simulation, as a game of two players who take turns.
//!
//! Searched is for one answer to each move, depth first; of the answers those are tried first that are nearest to what the other
//! player wants. What was found of a pair of places at a time is kept.

use super::chances::{After, ChanceIx, Chances, LeadIx, LeadStep};
use crate::task::Error;
use rustc_hash::FxHashMap;

/// A time, where the leading paths are if anything is still read of them, and what the other player is up to.
type Place = (u32, Option<LeadIx>, ChanceIx);

/// A place where an answer to each move is looked for.
struct Frame<const N: usize> {
    place: Place,
    /// Of the leading paths; the last one is answered now.
    moves: Vec<LeadStep<N>>,
    /// The answers to it that were not tried.
    answers: Vec<ChanceIx>,
}

/// Whether the other player, whose chances these are, is found to win.
///
/// # Errors
/// [`Error::Interrupted`].
pub(super) fn is_won<const N: usize>(chances: &mut Chances<'_, N>, budget: usize) -> Result<bool, Error> {
    let mut search = Search { chances, budget, known: FxHashMap::default() };
    let Some(starts) = search.chances.starts(budget)? else { return Ok(false) };
    for (lead, mut starts) in starts {
        search.chances.nearest_last(&mut starts);
        let mut won = false;
        while let Some(start) = starts.pop() {
            won = search.wins(lead, start)?;
            if won {
                break;
            }
        }
        if !won {
            return Ok(false);
        }
    }
    Ok(true)
}

struct Search<'s, 'a, const N: usize> {
    chances: &'s mut Chances<'a, N>,
    budget: usize,
    known: FxHashMap<Place, bool>,
}

impl<const N: usize> Search<'_, '_, N> {
    fn wins(&mut self, lead: LeadIx, start: ChanceIx) -> Result<bool, Error> {
        let place = self.place(0, lead, start);
        let Some(first) = self.frame(place, lead) else { return Ok(false) };
        let mut stack = vec![first];
        while let Some(frame) = stack.last_mut() {
            let Some(&step) = frame.moves.last() else {
                // Every move has an answer.
                let won = frame.place;
                self.known.insert(won, true);
                stack.pop();
                self.answered(&mut stack);
                continue;
            };
            let (time, _, _) = frame.place;
            let Some(answer) = frame.answers.pop() else {
                let lost = frame.place;
                self.known.insert(lost, false);
                stack.pop();
                continue;
            };
            let next = self.place(time + 1, step.to, answer);
            match self.known.get(&next) {
                Some(true) => self.answered(&mut stack),
                Some(false) => {}
                None => match self.frame(next, step.to) {
                    Some(frame) => stack.push(frame),
                    None => drop(self.known.insert(next, false)),
                },
            }
            self.chances.go_on()?;
            if self.chances.work > self.budget {
                return Ok(false);
            }
        }
        Ok(self.known.get(&place) == Some(&true))
    }

    fn place(&mut self, time: u32, lead: LeadIx, chance: ChanceIx) -> Place {
        (time, self.chances.reads_leads(chance).then_some(lead), chance)
    }

    /// A place with the first of its moves that takes an answer; `None` at the end of the horizon.
    fn frame(&mut self, place: Place, lead: LeadIx) -> Option<Frame<N>> {
        let (time, read, _) = place;
        if time == self.chances.end {
            return None;
        }
        let moves = match read {
            Some(lead) => self.chances.lead_steps(lead, time + 1),
            None => vec![self.chances.unread_step(lead, time + 1)],
        };
        let mut frame = Frame { place, moves, answers: Vec::new() };
        self.ask(&mut frame);
        Some(frame)
    }

    /// Goes on to a move that is not won at once, and finds the answers to it.
    fn ask(&mut self, frame: &mut Frame<N>) {
        while let Some(&step) = frame.moves.last() {
            if let After::Left(range) = self.chances.after(step, frame.place.2) {
                frame.answers = self.chances.left(range).to_vec();
                self.chances.nearest_last(&mut frame.answers);
                return;
            }
            frame.moves.pop();
        }
    }

    /// The move that the last place asks about has an answer.
    fn answered(&mut self, stack: &mut [Frame<N>]) {
        if let Some(frame) = stack.last_mut() {
            frame.moves.pop();
            self.ask(frame);
        }
    }
}
