//! Which commands of a script have an answer, and what it is.

/// A command that has an answer.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Request {
    /// Whether what was asserted is satisfiable.
    Check,
    /// `echo`: this text, as it stands between the quotes.
    Echo(String),
    /// `get-model`: what symbols are, in a list or one by one.
    Model,
    /// `get-value`: pairs of a term and its value.
    Values,
    /// `get-info`: keywords with what is known of them.
    Info,
    /// What is there only if the last check was unsatisfiable: cores, proofs, interpolants.
    Refutation,
    /// Something else.
    Other,
}

impl Request {
    /// What a command asks for, by its first words; `None` of a command that has no answer.
    #[must_use]
    pub fn of(words: &[&str]) -> Option<Request> {
        let (command, rest) = words.split_first()?;
        Some(match *command {
            "assert" | "assert-soft" | "exit" | "maximize" | "minimize" | "pop" | "push" | "reset"
            | "reset-assertions" => return None,
            command if ["declare-", "define-", "set-"].iter().any(|start| command.starts_with(start)) => {
                return None;
            }
            command if command.starts_with("check-sat") => Request::Check,
            "echo" => {
                let text = rest.first().copied().unwrap_or_default();
                let inner = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
                Request::Echo(inner.unwrap_or(text).to_owned())
            }
            "get-model" => Request::Model,
            "get-value" => Request::Values,
            "get-info" => Request::Info,
            "get-unsat-core"
            | "get-unsat-assumptions"
            | "get-proof"
            | "get-interpolant"
            | "get-interpolants" => Request::Refutation,
            _ => Request::Other,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_and_their_answers() {
        for words in [
            &["set-logic", "QF_LIA"][..],
            &["declare-fun", "f"],
            &["define-sort", "S"],
            &["assert", "x"],
            &["push", "1"],
            &["exit"],
            &[],
        ] {
            assert_eq!(Request::of(words), None, "{words:?}");
        }
        let echo = |text: &str| Request::Echo(text.to_owned());
        for (words, expected) in [
            (&["check-sat"][..], Request::Check),
            (&["check-sat-assuming"], Request::Check),
            (&["check-sat-using", "smt"], Request::Check),
            (&["echo", "\"a\"\"b\""], echo("a\"\"b")),
            (&["echo", "\"\""], echo("")),
            (&["echo"], echo("")),
            (&["get-model"], Request::Model),
            (&["get-value"], Request::Values),
            (&["get-info", ":name"], Request::Info),
            (&["get-unsat-core"], Request::Refutation),
            (&["get-assignment"], Request::Other),
            (&["eval", "x"], Request::Other),
        ] {
            assert_eq!(Request::of(words), Some(expected), "{words:?}");
        }
    }
}
