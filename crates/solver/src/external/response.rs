//! What a solver printed for a script that it was given as a whole: each reply with the command that it belongs to.
//!
//! Replies come in the order of the commands, but not every command need have one: solvers end at an error, and may pass
//! over what they do not know. So a reply is that of the next command whose kind of reply it is. No check is passed over
//! on the way: what is echoed after it, or quoted in an error, is not its answer.

use hyperplan_smt::{Request, parts};

use super::reply::{self, Meaning, Reply, Splitter};

/// A reply.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Response {
    /// The command that it belongs to, by its place among those that have an answer; of an error, the one that it may
    /// stand for.
    pub to: Option<usize>,
    /// What it says.
    pub said: Said,
    /// How it was printed.
    pub text: String,
}

/// What a reply says.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Said {
    /// `sat`, `unsat` or (`None`) `unknown`.
    Answer(Option<bool>),
    /// The solver's own time limit.
    Timeout,
    /// An error, with its message.
    Error(String),
    /// Anything else.
    Other,
}

/// What a solver printed, given the commands of its script that have an answer.
#[must_use]
pub fn responses(requests: &[Request], output: &str) -> Vec<Response> {
    let mut order = Order { requests, next: 0, after_errors: 0, listed: None };
    let (mut responses, mut splitter) = (Vec::new(), Splitter::default());
    let mut rest = output.as_bytes();
    loop {
        rest = rest.trim_ascii_start();
        if let Some((to, length)) = order.echo(rest) {
            let text = String::from_utf8_lossy(&rest[..length]).into_owned();
            responses.push(Response { to: Some(to), said: Said::Other, text });
            rest = &rest[length..];
            continue;
        }
        if rest.is_empty() {
            return responses;
        }
        // What is echoed may come after a comment.
        if rest[0] == b';' {
            rest = &rest[rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len())..];
            continue;
        }
        let length = rest.iter().position(|&byte| {
            splitter.feed(&[byte]);
            splitter.unread() > 0
        });
        rest = length.map_or(&[], |length| &rest[length + 1..]);
        if length.is_none() {
            splitter.finish();
        }
        responses.extend(std::iter::from_fn(|| splitter.next()).map(|reply| order.response(&reply)));
    }
}

/// Which commands have been answered.
struct Order<'r> {
    requests: &'r [Request],
    /// The first that is not known to be.
    next: usize,
    /// The first for which no error stood either: an error may be a reply, or come from a command that has none.
    after_errors: usize,
    /// The `get-model` whose definitions are coming, one by one.
    listed: Option<usize>,
}

impl Order<'_> {
    /// The text of an `echo` that is due, whatever it looks like; also its length. What comes before it may have had no
    /// reply: for a model without symbols some print nothing, and errors are not counted.
    fn echo(&mut self, rest: &[u8]) -> Option<(usize, usize)> {
        let due = |notation: &str, lists: bool, lines: bool| {
            let ended = rest.get(notation.len()).is_none_or(u8::is_ascii_whitespace);
            // Else it would be the reply to what comes before it.
            let own = !(lists && notation.starts_with('(') || lines && !notation.contains('\n'));
            own && ended && !notation.is_empty() && rest.starts_with(notation.as_bytes())
        };
        let (mut lists, mut lines) = (false, false);
        for at in self.after_errors..self.requests.len() {
            match &self.requests[at] {
                Request::Echo(text) => {
                    let found = notations(text).into_iter().find(|notation| due(notation, lists, lines));
                    if let Some(notation) = found {
                        self.answered(at);
                        return Some((at, notation.len()));
                    }
                    // What is blank shows only if it has quotes.
                    if !text.trim().is_empty() {
                        return None;
                    }
                }
                Request::Model | Request::Values | Request::Refutation | Request::Info => lists = true,
                Request::Other => (lists, lines) = (true, true),
                Request::Check => return None,
            }
        }
        None
    }

    fn response(&mut self, reply: &Reply) -> Response {
        let meaning = reply::meaning(reply);
        let to = match &meaning {
            Meaning::Error(_) => self.error(),
            _ => self.place(reply, &meaning),
        };
        let said = match meaning {
            Meaning::Answer(answer) if self.is_answer(to) => Said::Answer(answer),
            Meaning::Timeout if self.is_answer(to) => Said::Timeout,
            Meaning::Error(message) => Said::Error(message),
            _ => Said::Other,
        };
        Response { to, said, text: reply.text().to_owned() }
    }

    /// Whether what looks like an answer is one, if only to a question that nobody asked.
    fn is_answer(&self, to: Option<usize>) -> bool {
        to.is_none_or(|to| self.requests[to] == Request::Check)
    }

    /// What an error may stand for.
    fn error(&mut self) -> Option<usize> {
        let blank = |request: &Request| matches!(request, Request::Echo(text) if text.trim().is_empty());
        let ahead = self.requests.get(self.after_errors..)?;
        let at = self.after_errors + ahead.iter().position(|request| !blank(request))?;
        self.after_errors = at + usize::from(self.requests[at] != Request::Check);
        Some(at)
    }

    /// The command that a reply belongs to.
    fn place(&mut self, reply: &Reply, meaning: &Meaning) -> Option<usize> {
        if let Some(at) = self.listed.filter(|_| is_definition(reply)) {
            return Some(at);
        }
        let ahead = &self.requests[self.after_errors..];
        let check = ahead.iter().position(|request| *request == Request::Check);
        let end = self.after_errors + check.map_or(ahead.len(), |check| check + 1);
        let candidates = (self.after_errors..end).chain(self.next..self.after_errors);
        let mut candidates = candidates.filter(|&at| fits(&self.requests[at], reply, meaning));
        let (first, second) = (candidates.next()?, candidates.next());
        // What could be many things is rather the reply to what has few.
        let closer = |at: &usize| {
            let pair = (&self.requests[first], &self.requests[*at]);
            matches!(pair, (Request::Model, Request::Values) | (Request::Other, Request::Echo(_)))
        };
        let at = second.filter(closer).unwrap_or(first);
        self.answered(at);
        self.listed = Some(at).filter(|&at| self.requests[at] == Request::Model && is_definition(reply));
        Some(at)
    }

    fn answered(&mut self, at: usize) {
        self.next = at + 1;
        self.after_errors = self.after_errors.max(self.next);
        self.listed = None;
    }
}

/// Whether a command could have that reply.
fn fits(request: &Request, reply: &Reply, meaning: &Meaning) -> bool {
    let list = matches!((reply, meaning), (Reply::Expression(_), Meaning::Other));
    let keywords = reply.text().starts_with("(:");
    let unsupported = reply.text() == "unsupported";
    match request {
        Request::Check => matches!(meaning, Meaning::Answer(_) | Meaning::Timeout),
        Request::Echo(text) => notations(text).iter().any(|notation| notation == reply.text()),
        Request::Model => list && !keywords,
        Request::Values => list && reply::values(reply).is_some_and(|values| !values.is_empty()),
        Request::Info => list && keywords || unsupported,
        Request::Refutation => list,
        Request::Other => *meaning == Meaning::Other || unsupported,
    }
}

/// How an `echo` may be printed: with its quotes or without, with doubled quotes in it or these made one.
fn notations(text: &str) -> [String; 4] {
    let plain = text.replace("\"\"", "\"");
    [format!("\"{text}\""), format!("\"{plain}\""), plain, text.to_owned()].map(|text| text.trim().to_owned())
}

/// Whether it says what one symbol is: some solvers print a model so.
fn is_definition(reply: &Reply) -> bool {
    let heads = ["=", "function", "define-fun", "define-fun-rec"];
    let parts = parts(reply.text()).unwrap_or_default();
    parts.first().is_some_and(|head| heads.contains(head))
}

#[cfg(test)]
mod tests {
    use super::*;
    use Request::{Check, Info, Model, Other, Refutation, Values};

    fn echo(text: &str) -> Request {
        Request::Echo(text.to_owned())
    }

    /// For each reply the place of its command, -1 if none, and a letter for what it says.
    fn of(requests: &[Request], output: &str) -> Vec<(i64, char)> {
        let letter = |said: Said| match said {
            Said::Answer(Some(true)) => 's',
            Said::Answer(Some(false)) => 'u',
            Said::Answer(None) => '?',
            Said::Timeout => 't',
            Said::Error(_) => 'e',
            Said::Other => '.',
        };
        let place = |to: Option<usize>| to.map_or(-1, |to| i64::try_from(to).expect("there are few"));
        responses(requests, output).into_iter().map(|r| (place(r.to), letter(r.said))).collect()
    }

    #[test]
    fn what_is_echoed_is_no_answer() {
        let requests = [echo("unsat"), Check, echo("sat")];
        for output in ["unsat\nsat\nsat\n", "\"unsat\"\nsat\n\"sat\"", "success\nunsat\n\nsat\nsat"] {
            let replies = of(&requests, output).into_iter().filter(|(to, _)| *to >= 0);
            assert_eq!(replies.collect::<Vec<_>>(), [(0, '.'), (1, 's'), (2, '.')], "{output}");
        }
        // The check was not answered.
        assert_eq!(of(&requests, "unsat\n(error \"no\")\n"), [(0, '.'), (1, 'e')]);
        assert_eq!(of(&[Check, echo("sat")], "unknown\nsat"), [(0, '?'), (1, '.')]);
        // Whatever it looks like.
        let strange = [echo("a \"\"(\nsat"), echo(""), echo("; ("), Check];
        for output in ["a \"(\nsat\n; (\nunsat\n", "\"a \"\"(\nsat\"\n\"\"\n\"; (\"\nunsat\n"] {
            let replies = of(&strange, output).into_iter().filter(|(to, _)| *to != 1);
            assert_eq!(replies.collect::<Vec<_>>(), [(0, '.'), (2, '.'), (3, 'u')], "{output}");
        }
        // A solver that does not echo has answered nothing else.
        assert_eq!(of(&[echo("sat"), Check], "sat\n"), [(0, '.')]);
        assert_eq!(of(&[echo("hello"), Check], "sat\n"), [(1, 's')]);
    }

    #[test]
    fn errors_stand_for_replies_or_not() {
        assert_eq!(of(&[Check], "(error \"line 1:\nsat\nunsat\n\")\nunsat"), [(0, 'e'), (0, 'u')]);
        assert_eq!(
            of(&[Check, Refutation, Model], "sat\n(error \"no core\")\n((define-fun x () Int 1))"),
            [(0, 's'), (1, 'e'), (2, '.')]
        );
        // One that comes between.
        assert_eq!(
            of(&[Check, Model], "sat\n(error \"an invalid model\")\n(model)"),
            [(0, 's'), (1, 'e'), (1, '.')]
        );
        assert_eq!(of(&[Check], "sat\n(error \"an invalid model\")"), [(0, 's'), (-1, 'e')]);
    }

    #[test]
    fn models_in_pieces() {
        let requests = [Check, Model, Other, Values];
        let pieces = "sat\n(= x 4)\n(= f @f)\n(function @f\n (default 0))\n((big true))\n((x 4))\n";
        assert_eq!(of(&requests, pieces), [(0, 's'), (1, '.'), (1, '.'), (1, '.'), (2, '.'), (3, '.')]);
        // Nothing may be printed for a model without symbols.
        assert_eq!(of(&[Check, Model, echo("unsat")], "sat\n\nunsat"), [(0, 's'), (2, '.')]);
        assert_eq!(of(&[Info, Check], "(:name \"sat\")\nunsat"), [(0, '.'), (1, 'u')]);
        assert_eq!(of(&[Info, Check], "unsupported\n; sat\nunsat"), [(0, '.'), (1, 'u')]);
    }

    #[test]
    fn several_checks_and_answers_to_none() {
        assert_eq!(of(&[Check, Check], "sat\nunsat\n"), [(0, 's'), (1, 'u')]);
        assert_eq!(of(&[Check], "sat\nunsat\n"), [(0, 's'), (-1, 'u')]);
        assert_eq!(of(&[Check], "timeout"), [(0, 't')]);
        assert_eq!(of(&[], "satisfiable"), [(-1, '.')]);
    }
}
