//! The list of a selection's benchmarks.

use crate::record::Head;
use crate::select::{Chosen, Criteria};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// What was chosen of a family, and by what.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Selected {
    /// The family.
    #[serde(flatten)]
    pub head: Head,
    /// What was asked for.
    #[serde(flatten)]
    pub criteria: Criteria,
    /// The solvers that were run, with their versions.
    pub solvers: BTreeMap<String, String>,
    /// The benchmarks.
    pub benchmarks: Vec<Chosen>,
    /// How many candidates were not chosen, by the reason.
    pub left_out: BTreeMap<&'static str, usize>,
}

impl Selected {
    /// As JSON.
    ///
    /// # Errors
    /// None: it is plain data.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|text| text + "\n")
    }

    /// The benchmarks as a table, comma-separated, with a column for each solver: the seconds that it took, or in a word why
    /// it has no answer, or that it is wrong.
    ///
    /// # Errors
    /// None: it is written to memory.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut table = csv::Writer::from_writer(Vec::new());
        let columns = ["file", "sha256", "bytes", "logic", "status", "bin", "slowest"];
        let solvers: Vec<&str> = self.solvers.keys().map(String::as_str).collect();
        table.write_record(columns.iter().chain(&solvers))?;
        for Chosen { entry, bin, slowest, runs } in &self.benchmarks {
            let slowest = slowest.map_or_else(String::new, |seconds| seconds.to_string());
            let fixed = [
                &entry.file,
                &entry.sha256,
                &entry.bytes.to_string(),
                &entry.logic,
                &entry.status,
                bin,
                &slowest,
            ];
            let times = solvers
                .iter()
                .map(|solver| runs.get(*solver).map_or_else(String::new, |run| run.to_string()));
            table.write_record(fixed.into_iter().cloned().chain(times))?;
        }
        table.into_inner().map_err(|e| e.into_error().into())
    }

    /// How many there are of each logic and status, by difficulty, as a table in Markdown.
    #[must_use]
    pub fn table(&self) -> String {
        let bins: Vec<String> =
            (0..=self.criteria.edges().len()).map(|bin| self.criteria.name(bin)).collect();
        let mut counts: BTreeMap<(&str, &str, &str), usize> = BTreeMap::new();
        for Chosen { entry, bin, .. } in &self.benchmarks {
            *counts.entry((&entry.logic, &entry.status, bin)).or_default() += 1;
        }
        let rows: BTreeSet<(&str, &str)> = counts.keys().map(|&(logic, status, _)| (logic, status)).collect();
        let line = |first: &str, second: &str, cells: Vec<String>| {
            format!("| {first} | {second} | {} |\n", cells.join(" | "))
        };
        let mut table = line("logic", "status", bins.iter().cloned().chain(["all".to_owned()]).collect());
        table += &line("---", "---", vec!["---:".to_owned(); bins.len() + 1]);
        let cells = |wanted: &dyn Fn(&str, &str) -> bool| {
            let of = |bin: Option<&str>| -> usize {
                let meant = |&(&(logic, status, other), _): &(&(&str, &str, &str), &usize)| {
                    wanted(logic, status) && bin.is_none_or(|bin| bin == other)
                };
                counts.iter().filter(meant).map(|(_, count)| count).sum()
            };
            let each = bins.iter().map(|bin| of(Some(bin)).to_string());
            each.chain([of(None).to_string()]).collect::<Vec<_>>()
        };
        for &(logic, status) in &rows {
            table += &line(logic, status, cells(&|other, answer| other == logic && answer == status));
        }
        table + &line("all", "", cells(&|_, _| true))
    }
}
