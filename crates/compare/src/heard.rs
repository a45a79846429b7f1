//! What a solver said to a query, command by command.

use hyperplan_smt::Request;
use hyperplan_solver::{Said, responses};

use crate::query::Query;
use crate::record::RunStatus;

/// The replies of a solver, as far as they matter.
#[derive(Debug, Default)]
pub(crate) struct Heard {
    /// The answers to its checks, in order.
    pub(crate) answers: Vec<RunStatus>,
    /// An answer beyond these that differs from the last of them.
    pub(crate) contradicts: bool,
    /// The first error before the last check was answered: what was answered then is something else than was asked.
    pub(crate) early: Option<String>,
    /// The first error after it that is about a model, or about nothing that was asked for.
    pub(crate) late: Option<String>,
    /// What was printed of models after the first check.
    pub(crate) model: String,
}

impl Heard {
    pub(crate) fn new(query: &Query, output: &str) -> Heard {
        let mut heard = Heard::default();
        let asked = |to: Option<usize>| to.and_then(|to| query.requests.get(to));
        for response in responses(&query.requests, output) {
            let all = !query.checks.is_empty() && heard.answers.len() == query.checks.len();
            let answer = match response.said {
                Said::Answer(Some(true)) => RunStatus::Sat,
                Said::Answer(Some(false)) => RunStatus::Unsat,
                Said::Answer(None) => RunStatus::Unknown,
                Said::Timeout => RunStatus::Timeout,
                Said::Error(_) if !all => {
                    heard.early.get_or_insert(response.text);
                    continue;
                }
                Said::Error(message) => {
                    if matches!(asked(response.to), None | Some(Request::Model | Request::Values)) {
                        heard.late.get_or_insert(message);
                    }
                    continue;
                }
                Said::Other => {
                    let of_model = matches!(asked(response.to), Some(Request::Model | Request::Values));
                    if of_model && !heard.answers.is_empty() {
                        heard.model += &response.text;
                        heard.model.push('\n');
                    }
                    continue;
                }
            };
            match response.to {
                Some(_) => heard.answers.push(answer),
                None => heard.contradicts |= heard.answers.last().is_some_and(|last| *last != answer),
            }
        }
        heard
    }
}
