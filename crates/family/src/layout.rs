//! Where the files of a submission are.

/// The names of a submission.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    set: String,
}

/// Why a name cannot be that of a folder.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no name for a folder: expected letters, digits and hyphens")]
pub struct NameError(String);

impl Layout {
    /// A set of benchmarks: its date as `YYYY-MM-DD`, its name, and who submits it.
    ///
    /// # Errors
    /// If a name has other characters than letters, digits and hyphens.
    pub fn new(date: &str, family: &str, submitter: &str) -> Result<Self, NameError> {
        for name in [date, family, submitter] {
            let plain = |c: char| c.is_ascii_alphanumeric() || c == '-';
            if name.is_empty() || name.starts_with('-') || !name.chars().all(plain) {
                return Err(NameError(name.to_owned()));
            }
        }
        Ok(Layout { set: format!("{}-{family}-{submitter}", date.replace('-', "")) })
    }

    /// The path of a benchmark, with `/`, as submissions have it: folder of the track, logic, set, objective, size and name.
    #[must_use]
    pub fn benchmark(&self, folder: &str, logic: &str, case: &crate::Case, instance: &str) -> String {
        format!("{folder}/{logic}/{}/{}/{}/{instance}.smt2", self.set, case.source(), case.size())
    }

    /// The path of a problem.
    #[must_use]
    pub fn problem(name: &str) -> String {
        format!("problems/{name}.hp")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Case, Kind, Objective, Parameters};

    #[test]
    fn paths_are_those_of_submissions() {
        let case = Case {
            objective: Objective::Ar,
            map: Parameters { kind: Kind::Random, size: 8, density: 10, seed: 3 },
        };
        let layout = Layout::new("2026-02-28", "random-maps", "robot").expect("good names");
        assert_eq!(
            layout.benchmark("non-incremental", "QF_UF", &case, "one"),
            "non-incremental/QF_UF/20260228-random-maps-robot/ar/8x8/one.smt2"
        );
    }

    #[test]
    fn names_are_plain() {
        for name in ["", "a b", "a/b", "..", "-a", "\u{e9}"] {
            assert_eq!(Layout::new("2026-02-28", name, "robot"), Err(NameError(name.to_owned())));
            assert_eq!(Layout::new("2026-02-28", "maps", name), Err(NameError(name.to_owned())));
        }
    }
}
