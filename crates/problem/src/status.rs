//! What a problem file says is known of its objectives, in comments such as `// fastest: realizable`.

/// What is known of an objective, as `:status` says it of an SMT-LIB benchmark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KnownStatus {
    /// The objective.
    pub objective: String,
    /// The constants that it takes, as `--set` takes them; the others are those of the file.
    pub set: Vec<(String, String)>,
    /// Whether it is realizable.
    pub realizable: bool,
    /// The solvers that find out; none where all do.
    pub by: Vec<String>,
}

impl KnownStatus {
    /// Those that a text has, in order. A line says one if it is a comment and nothing but a comment:
    /// `// OBJECTIVE [NAME=VALUE ...]: realizable|unrealizable [by SOLVER, ...]`.
    pub fn of_text(text: &str) -> impl Iterator<Item = KnownStatus> {
        text.lines().filter_map(KnownStatus::of_line)
    }

    fn of_line(line: &str) -> Option<KnownStatus> {
        let (question, answer) = line.trim().strip_prefix("//")?.split_once(':')?;
        let mut words = question.split_whitespace();
        let objective = words.next()?.to_owned();
        let set = words.map(|word| {
            let (name, value) = word.split_once('=')?;
            Some((name.to_owned(), value.to_owned()))
        });
        let mut answer = answer.trim().splitn(2, " by ");
        let realizable = match answer.next()? {
            "realizable" => true,
            "unrealizable" => false,
            _ => return None,
        };
        let by = answer.flat_map(|solvers| solvers.split(',')).map(|name| name.trim().to_owned()).collect();
        Some(KnownStatus { objective, set: set.collect::<Option<_>>()?, realizable, by })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_say_what_is_known() {
        let text = "// sp: realizable\n  //  sp T=15 N=1/2:unrealizable by z3, cvc5\nconst T = 1; // sp: realizable\n\
                    // sp: realizable, perhaps\n// sp T: realizable\n// : realizable\n// a note: see below\n";
        let known: Vec<KnownStatus> = KnownStatus::of_text(text).collect();
        let set = [("T", "15"), ("N", "1/2")].map(|(name, value)| (name.to_owned(), value.to_owned()));
        let expected = [
            KnownStatus { objective: "sp".to_owned(), set: Vec::new(), realizable: true, by: Vec::new() },
            KnownStatus {
                objective: "sp".to_owned(),
                set: set.to_vec(),
                realizable: false,
                by: vec!["z3".to_owned(), "cvc5".to_owned()],
            },
        ];
        assert_eq!(known, expected);
    }
}
