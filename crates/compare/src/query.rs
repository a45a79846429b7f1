//! What an SMT-LIB file says of itself, read without understanding its terms.

use std::ops::Range;

use hyperplan_smt::{Request, Token, tokens};

use crate::record::Answer;

/// An SMT-LIB 2 file, from outside.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Query {
    /// The logic that it sets.
    pub logic: Option<String>,
    /// Its checks in order, each with the `:status` said before it.
    pub checks: Vec<Option<Answer>>,
    /// Its commands that have an answer, in order.
    pub requests: Vec<Request>,
    /// Whether it takes a solver that can be asked again: assertions are taken back, or there are several checks.
    pub incremental: bool,
    /// Symbols that it declares.
    pub variables: u64,
    /// Its assertions.
    pub assertions: u64,
    /// Its length.
    pub bytes: u64,
}

impl Query {
    /// Reads the text of a file. Text that is no SMT-LIB has no checks.
    #[must_use]
    pub fn scan(text: &str) -> Query {
        let mut query = Query { bytes: text.len() as u64, ..Query::default() };
        let (mut status, mut ended) = (None, false);
        commands(text, |_, words| {
            ended |= words == ["exit"];
            if !ended {
                query.command(words, &mut status);
            }
        });
        query.incremental |= query.checks.len() > 1;
        query
    }

    /// The text with blanks in place of what it says of its status: some solvers check themselves by that, and one could
    /// read the answer there. Lines and columns stay the same. `None` where it says nothing.
    pub(crate) fn without_status(bytes: &[u8]) -> Option<Vec<u8>> {
        // As long as the bytes, whatever they encode.
        let text: String =
            bytes.iter().map(|byte| if byte.is_ascii() { char::from(*byte) } else { 'x' }).collect();
        let mut scrubbed = None;
        commands(&text, |place, words| {
            if words.starts_with(&["set-info", ":status"]) {
                let command = &mut scrubbed.get_or_insert_with(|| bytes.to_vec())[place];
                command.iter_mut().filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
            }
        });
        scrubbed
    }

    fn command(&mut self, words: &[&str], status: &mut Option<Answer>) {
        match words {
            ["set-logic", logic, ..] => self.logic = Some((*logic).to_owned()),
            ["set-info", ":status", said, ..] => {
                *status = match *said {
                    "sat" => Some(Answer::Sat),
                    "unsat" => Some(Answer::Unsat),
                    _ => None,
                };
            }
            ["declare-fun" | "declare-const", ..] => self.variables += 1,
            ["assert", ..] => self.assertions += 1,
            ["push" | "pop" | "reset" | "reset-assertions", ..] => self.incremental = true,
            _ => {}
        }
        let Some(request) = Request::of(words) else { return };
        if request == Request::Check {
            self.incremental |= words[0] != "check-sat";
            self.checks.push(status.take());
        }
        self.requests.push(request);
    }

    /// What it asks for of a model after its first check: all of it, or the values of some terms.
    pub(crate) fn of_model(&self) -> Option<&Request> {
        let check = self.requests.iter().position(|request| *request == Request::Check)?;
        let asked = |wanted: Request| self.requests[check..].iter().find(|request| **request == wanted);
        asked(Request::Model).or_else(|| asked(Request::Values))
    }
}

/// Tells of each command: where it is, and its first words.
fn commands(text: &str, mut each: impl FnMut(Range<usize>, &[&str])) {
    let (mut depth, mut start, mut words) = (0_usize, 0, Vec::new());
    for (place, token) in tokens(text) {
        match token {
            Token::Open => {
                depth += 1;
                if depth == 1 {
                    start = place.start;
                    words.clear();
                }
            }
            Token::Close => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    each(start..place.end, &words);
                    words.clear();
                }
            }
            _ if depth == 1 && words.len() < 3 => words.push(&text[place]),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_file_says_of_itself() {
        let text = "; (check-sat) (set-logic ALL)\n(set-logic QF_LIA)(set-info :source |\n(check-sat) |)\n\
                    (set-info :note \"(assert \"\"x\"\")\")(set-info :status unsat)\n(declare-fun x () Int) \
                    (declare-const |a b| Bool)\n(assert (and |a b| (> x 0)));)\n(assert (< x 0))\n(check-sat)\n";
        let query = Query::scan(text);
        let expected = Query {
            logic: Some("QF_LIA".to_owned()),
            checks: vec![Some(Answer::Unsat)],
            requests: vec![Request::Check],
            incremental: false,
            variables: 2,
            assertions: 2,
            bytes: text.len() as u64,
        };
        assert_eq!(query, expected);
    }

    #[test]
    fn a_status_is_that_of_the_next_check() {
        let text = "(check-sat)(set-info :status sat)(push 1)(check-sat)(check-sat-assuming (p))";
        let query = Query::scan(text);
        assert_eq!(query.checks, [None, Some(Answer::Sat), None]);
        assert!(query.incremental);
    }

    #[test]
    fn a_model_is_asked_for_after_a_check() {
        let request = |text: &str| Query::scan(text).of_model().cloned();
        assert_eq!(request("(get-model)(check-sat)(get-info :name)"), None);
        assert_eq!(request("(check-sat)(get-value (x))"), Some(Request::Values));
        assert_eq!(request("(check-sat)(get-value (x))(get-model)(exit)"), Some(Request::Model));
        assert_eq!(request("(check-sat)(exit)(get-model)"), None);
    }

    #[test]
    fn commands_that_have_an_answer() {
        let text = "(echo \"(check-sat)\"\"\")(set-logic ALL)(get-info :name)(check-sat)(exit)(check-sat)";
        let query = Query::scan(text);
        let echo = Request::Echo("(check-sat)\"\"".to_owned());
        assert_eq!(query.requests, [echo, Request::Info, Request::Check]);
        assert_eq!((query.checks.len(), query.incremental), (1, false));
    }

    #[test]
    fn a_status_is_taken_out() {
        let scrub = |text: &[u8]| Query::without_status(text);
        let text = b"(set-logic ALL) (set-info\n:status unsat) ; \xff(set-info :status sat)\n(echo \"(set-info :status)\")";
        let expected =
            b"(set-logic ALL)          \n               ; \xff(set-info :status sat)\n(echo \"(set-info :status)\")";
        assert_eq!(scrub(text).expect("there is one"), expected);
        assert_eq!(scrub(b"\xff(set-info :source |(set-info :status sat)|)(check-sat)"), None);
        for text in ["", ")", "(set-info :status", "(set-info :status |", "((set-info :status sat))"] {
            assert_eq!(scrub(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn damage_does_no_harm() {
        for text in
            ["", ")", "((((", "(assert \"", "(set-info :status |", "(set-info :status)", "é|", "(check-sat"]
        {
            assert_eq!(Query::scan(text).checks, [], "{text}");
        }
    }
}
