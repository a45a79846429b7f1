//! A checker of refutations in LRAT form, without the part that is for clauses that do not follow ("RAT").
//!
//! A *step* adds a clause with hints: clauses that are there, given by their numbers. It is right if the literals of the clause
//! being false, each hint in turn leaves a single literal that is not false, which then has to be true, until one leaves none.
//! So each clause added follows from those before, and where the empty one is added, the first ones are unsatisfiable. A
//! deletion takes clauses away, which cannot make anything follow.

use crate::error::Error;
use rustc_hash::FxHashMap;
use std::io::{BufRead, Read as _};

/// No clause has this number.
const NOWHERE: u32 = u32::MAX;

/// Clauses by number, and the truth of literals in a step.
#[derive(Default)]
pub struct Checker {
    /// All literals, a 0 behind each clause.
    literals: Vec<i32>,
    /// Where the first clauses start, which are numbered from 1 on without a gap.
    first: Vec<u32>,
    /// Where the others do.
    others: FxHashMap<u64, u32>,
    /// How many literals belong to clauses that were deleted.
    garbage: usize,
    /// 1 where a variable is true, -1 where it is false.
    values: Vec<i8>,
    assigned: Vec<u32>,
    refuted: bool,
    steps: u64,
}

impl Checker {
    /// Adds one of the clauses that are to be refuted.
    ///
    /// # Errors
    /// If they are too many.
    pub fn clause(&mut self, literals: &[i32]) -> Result<(), Error> {
        self.refuted |= literals.is_empty();
        let start = self.store(literals)?;
        self.first.push(start);
        Ok(())
    }

    fn store(&mut self, literals: &[i32]) -> Result<u32, Error> {
        let start = u32::try_from(self.literals.len()).ok().filter(|start| *start < NOWHERE);
        let start = start.ok_or_else(|| Error::TooLarge { what: "the clauses are too many".to_owned() })?;
        for &literal in literals {
            let variable = literal.unsigned_abs() as usize;
            if variable >= self.values.len() {
                self.values.resize(variable + 1, 0);
            }
        }
        self.literals.extend_from_slice(literals);
        self.literals.push(0);
        Ok(start)
    }

    /// Whether a contradiction was reached.
    #[must_use]
    pub fn is_refuted(&self) -> bool {
        self.refuted
    }

    /// How many steps were checked.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Checks a refutation as text, a step a line, up to the contradiction.
    ///
    /// # Errors
    /// If a step is wrong, or there is no contradiction at the end.
    pub fn check(&mut self, proof: &mut dyn BufRead, stop: &dyn Fn() -> bool) -> Result<(), Error> {
        let mut line = Vec::new();
        while !self.refuted {
            line.clear();
            if take_line(proof, &mut line)? == 0 {
                return Err(Error::Incomplete);
            }
            self.steps += 1;
            if self.steps.is_multiple_of(1 << 12) && stop() {
                return Err(Error::Stopped);
            }
            self.step(&line)?;
        }
        Ok(())
    }

    fn wrong(&self, what: &'static str) -> Error {
        Error::Step { step: self.steps, what }
    }

    fn step(&mut self, line: &[u8]) -> Result<(), Error> {
        let text = std::str::from_utf8(line).map_err(|_| self.wrong("it is no text"))?;
        let mut words = text.split_ascii_whitespace();
        let number = words.next().and_then(|word| word.parse::<u64>().ok());
        let number = number.ok_or_else(|| self.wrong("it has no number"))?;
        let mut rest = words.peekable();
        let deletes = rest.next_if_eq(&"d").is_some();
        let mut numbers = Vec::new();
        for word in rest {
            numbers.push(word.parse::<i64>().map_err(|_| self.wrong("it has something that is no number"))?);
        }
        if numbers.pop() != Some(0) {
            return Err(self.wrong("it does not end with 0"));
        }
        if deletes {
            return numbers.into_iter().try_for_each(|number| self.delete(number));
        }
        let end = numbers.iter().position(|number| *number == 0);
        let end = end.ok_or_else(|| self.wrong("it has no hints"))?;
        let mut clause = Vec::with_capacity(end);
        for &literal in &numbers[..end] {
            let known =
                i32::try_from(literal).ok().filter(|l| (l.unsigned_abs() as usize) < self.values.len());
            clause.push(known.ok_or_else(|| self.wrong("it has a variable that no clause has"))?);
        }
        let follows = self.follows(&clause, &numbers[end + 1..]);
        for variable in self.assigned.drain(..) {
            self.values[variable as usize] = 0;
        }
        follows?;
        if self.find(number).is_some() {
            return Err(self.wrong("its number is that of another clause"));
        }
        self.refuted = clause.is_empty();
        let start = self.store(&clause)?;
        self.others.insert(number, start);
        Ok(())
    }

    fn find(&self, number: u64) -> Option<u32> {
        let at = usize::try_from(number).ok()?.checked_sub(1)?;
        let start = self.first.get(at).copied().or_else(|| self.others.get(&number).copied());
        start.filter(|start| *start != NOWHERE)
    }

    fn of(&self, start: u32) -> &[i32] {
        let own = &self.literals[start as usize..];
        let end = own.iter().position(|literal| *literal == 0).unwrap_or(own.len());
        &own[..end]
    }

    /// What a literal is: 1 for true, -1 for false, 0 for neither.
    fn value(&self, literal: i32) -> i8 {
        let value = self.values[literal.unsigned_abs() as usize];
        if literal < 0 { -value } else { value }
    }

    fn assign(&mut self, literal: i32) {
        let variable = literal.unsigned_abs();
        self.values[variable as usize] = if literal < 0 { -1 } else { 1 };
        self.assigned.push(variable);
    }

    /// Whether a clause follows by the hints.
    fn follows(&mut self, clause: &[i32], hints: &[i64]) -> Result<(), Error> {
        for &literal in clause {
            match self.value(literal) {
                // It says that something is true or false.
                1 => return Ok(()),
                -1 => {}
                _ => self.assign(-literal),
            }
        }
        for &hint in hints {
            let start = u64::try_from(hint).ok().and_then(|hint| self.find(hint));
            let start = start.ok_or_else(|| self.wrong("a hint is no clause"))?;
            let mut open = None;
            for &literal in self.of(start) {
                match self.value(literal) {
                    -1 => {}
                    _ if open.is_none_or(|other| other == literal) => open = Some(literal),
                    _ => return Err(self.wrong("a hint leaves more than one literal")),
                }
            }
            match open {
                // It may have been true before.
                Some(literal) if self.value(literal) == 0 => self.assign(literal),
                Some(_) => {}
                None => return Ok(()),
            }
        }
        Err(self.wrong("its hints lead to no contradiction"))
    }

    fn delete(&mut self, number: i64) -> Result<(), Error> {
        let number = u64::try_from(number).map_err(|_| self.wrong("what it deletes is no clause"))?;
        let start = self.find(number).ok_or_else(|| self.wrong("what it deletes is no clause"))?;
        self.garbage += self.of(start).len() + 1;
        let at = usize::try_from(number).unwrap_or(usize::MAX);
        match self.first.get_mut(at.wrapping_sub(1)) {
            Some(first) => *first = NOWHERE,
            None => drop(self.others.remove(&number)),
        }
        if self.garbage > self.literals.len() / 2 + (1 << 16) {
            self.collect();
        }
        Ok(())
    }

    /// Moves the clauses that are left together.
    fn collect(&mut self) {
        let mut starts: Vec<(u32, bool, u64)> = Vec::with_capacity(self.first.len() + self.others.len());
        let left = (0..).zip(&self.first).filter(|(_, start)| **start != NOWHERE);
        starts.extend(left.map(|(at, start)| (*start, true, at)));
        // In the order in which they lie, which is not that of the table.
        #[allow(clippy::iter_over_hash_type)]
        for (number, start) in &self.others {
            starts.push((*start, false, *number));
        }
        starts.sort_unstable();
        let mut end = 0_u32;
        for (start, is_first, number) in starts {
            let length = self.of(start).len() + 1;
            let start = start as usize;
            self.literals.copy_within(start..start + length, end as usize);
            if is_first {
                self.first[usize::try_from(number).unwrap_or(usize::MAX)] = end;
            } else {
                self.others.insert(number, end);
            }
            // It is at most where it was, which was below 2^32.
            end += length as u32;
        }
        self.literals.truncate(end as usize);
        self.garbage = 0;
    }
}

/// The longest line that is read.
const LINE: u64 = 1 << 30;

/// Reads a line; 0 at the end.
fn take_line(proof: &mut dyn BufRead, line: &mut Vec<u8>) -> Result<usize, Error> {
    let read = proof.take(LINE).read_until(b'\n', line);
    read.map_err(|error| Error::Unreadable(error.to_string()))
}

#[cfg(test)]
mod tests;
