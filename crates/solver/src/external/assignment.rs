//! What SAT and QBF solvers say: an answer, and literals that are true.

/// What was heard so far.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Heard {
    /// Satisfiable, unsatisfiable, or (`None` inside) given up.
    pub(super) answer: Option<Option<bool>>,
    /// What is true: literals as in DIMACS.
    pub(super) literals: Vec<i32>,
}

impl Heard {
    /// Takes a line; whether it contradicts an earlier one. Programs say much else, which does not matter.
    pub(super) fn line(&mut self, line: &str) -> Result<(), ()> {
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words.as_slice() {
            ["s" | "S", "cnf", answer, ..] => self.said(match *answer {
                "1" => Some(true),
                "0" => Some(false),
                _ => None,
            }),
            ["s", answer] | [answer] if answer_of(answer).is_some() => {
                self.said(answer_of(answer).unwrap_or_default())
            }
            ["v" | "V", literals @ ..] | literals => {
                // Some give the literals of the outermost block and nothing else.
                if let Some(literals) = numbers(literals) {
                    self.literals.extend(literals.into_iter().filter(|&literal| literal != 0));
                }
                Ok(())
            }
        }
    }

    /// Forgets literals of variables that there are not, and those heard twice, once they are many: a program that never ends
    /// fills no memory.
    pub(super) fn within(&mut self, variables: usize) {
        if self.literals.len() > 4 * variables + 64 {
            self.literals.retain(|literal| literal.unsigned_abs() as usize <= variables);
            self.literals.sort_unstable();
            self.literals.dedup();
        }
    }

    /// Takes the exit status, where nothing else was said.
    pub(super) fn exit(&mut self, status: &str) -> Result<(), ()> {
        match status.rsplit(' ').next() {
            Some("10") if status.starts_with("exit") => self.said(Some(true)),
            Some("20") if status.starts_with("exit") => self.said(Some(false)),
            _ => Ok(()),
        }
    }

    fn said(&mut self, answer: Option<bool>) -> Result<(), ()> {
        let known = *self.answer.get_or_insert(answer);
        if known == answer { Ok(()) } else { Err(()) }
    }
}

/// What a word says of satisfiability, if it is about that.
fn answer_of(word: &str) -> Option<Option<bool>> {
    match word {
        "SATISFIABLE" | "SAT" => Some(Some(true)),
        "UNSATISFIABLE" | "UNSAT" => Some(Some(false)),
        "UNKNOWN" | "INDETERMINATE" => Some(None),
        _ => None,
    }
}

/// Literals, if all words are. Those of variables of the program's own, such as Qute's `-16.e`, count as 0.
fn numbers(words: &[&str]) -> Option<Vec<i32>> {
    let number = |word: &&str| {
        let number = word.split_once('.').map_or(*word, |(number, _)| number);
        let literal = number.parse().ok().filter(|&literal: &i32| literal != i32::MIN)?;
        Some(if number == *word { literal } else { 0 })
    };
    words.iter().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(text: &str, status: &str) -> Result<Heard, ()> {
        let mut heard = Heard::default();
        text.lines().try_for_each(|line| heard.line(line))?;
        heard.exit(status).map(|()| heard)
    }

    fn is(answer: Option<bool>, literals: &[i32]) -> Result<Heard, ()> {
        Ok(Heard { answer: Some(answer), literals: literals.to_vec() })
    }

    #[test]
    fn what_programs_say() {
        // DepQBF and CAQE, RAReQS, Qute, competition SAT solvers, MiniSat's file of results.
        assert_eq!(heard("s cnf 1 3 3\nV 1 0\nV -7 0", "exit status: 10"), is(Some(true), &[1, -7]));
        assert_eq!(heard("c pure 1\nV  +1 -3\ns cnf 1", "exit status: 10"), is(Some(true), &[1, -3]));
        assert_eq!(heard("SAT\n1 -2 0", "exit status: 10"), is(Some(true), &[1, -2]));
        assert_eq!(
            heard("c x\ns SATISFIABLE\nv -1 2\nv 3 0", "exit status: 10"),
            is(Some(true), &[-1, 2, 3])
        );
        assert_eq!(heard("SAT\n-1 2 0\nSATISFIABLE", "exit status: 10"), is(Some(true), &[-1, 2]));
        assert_eq!(heard("SAT\n-1 2 -3.e 0", "exit status: 10"), is(Some(true), &[-1, 2]));
        assert_eq!(heard("s cnf 0 3 3", "exit status: 20"), is(Some(false), &[]));
        assert_eq!(heard("s UNSATISFIABLE", "exit status: 0"), is(Some(false), &[]));
        assert_eq!(heard("c Satisfiable", "exit status: 10"), is(Some(true), &[]));
        assert_eq!(heard("s cnf -1 3 3", "exit status: 0"), is(None, &[]));
        assert_eq!(heard("s UNKNOWN", "exit status: 0"), is(None, &[]));
    }

    #[test]
    fn what_is_no_answer() {
        let nothing = Ok(Heard::default());
        for (text, status) in [
            ("", "exit status: 1"),
            ("10", "killed"),
            ("error in line 10", "exit status: 110"),
            ("", "signal: 10 (SIGUSR1)"),
        ] {
            let mut known = heard(text, status);
            if let Ok(heard) = &mut known {
                heard.literals.clear();
            }
            assert_eq!(known, nothing, "{text} {status}");
        }
    }

    #[test]
    fn contradictions() {
        assert_eq!(heard("s cnf 1 3 3", "exit status: 20"), Err(()));
        assert_eq!(heard("s SATISFIABLE\ns UNSATISFIABLE", ""), Err(()));
    }

    #[test]
    fn what_does_not_end_fills_no_memory() {
        let mut heard = Heard::default();
        for _ in 0..10_000 {
            heard.line("v 1 -2 3 4 5 6 7 8 9 4000000").expect("it contradicts nothing");
            heard.within(3);
        }
        assert!(heard.literals.len() <= 4 * 3 + 64 + 10, "{}", heard.literals.len());
        assert!(heard.literals.contains(&1) && heard.literals.contains(&-2));
    }
}
