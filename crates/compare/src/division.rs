//! The divisions of SMT-COMP 2026, single query track, and the scores that its rules give in each.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use serde::Serialize;

use crate::contest::{Cell, Contest, allowed, is_query};
use crate::score::Parallel;
use crate::table::Sheet;

/// Each division with its logics.
const DIVISIONS: [(&str, &str); 19] = [
    ("QF_Datatypes", "QF_DT QF_UFDT"),
    ("QF_Equality", "QF_AX QF_UF"),
    ("QF_Equality+LinearArith", "QF_ALIA QF_AUFLIA QF_UFDTLIA QF_UFDTLIRA QF_UFIDL QF_UFLIA QF_UFLRA"),
    ("QF_Equality+NonLinearArith", "QF_ANIA QF_AUFNIA QF_UFDTNIA QF_UFNIA QF_UFNRA"),
    ("QF_Equality+Bitvec", "QF_ABV QF_AUFBV QF_UFBV QF_UFBVDT"),
    ("QF_LinearIntArith", "QF_IDL QF_LIA QF_LIRA"),
    ("QF_LinearRealArith", "QF_LRA QF_RDL"),
    ("QF_Bitvec", "QF_BV"),
    ("QF_FPArith", "QF_ABVFP QF_ABVFPLRA QF_AUFBVFP QF_BVFP QF_BVFPLRA QF_FP QF_FPLRA QF_UFFP QF_UFFPDTNIRA"),
    ("QF_NonLinearIntArith", "QF_NIA QF_NIRA"),
    ("QF_NonLinearRealArith", "QF_NRA"),
    ("QF_Strings", "QF_S QF_SLIA QF_SNIA"),
    ("Equality", "UF UFDT"),
    ("Equality+LinearArith", "ALIA AUFDTLIA AUFDTLIRA AUFLIA AUFLIRA UFDTLIA UFDTLIRA UFIDL UFLIA UFLRA"),
    (
        "Equality+MachineArith",
        "ABV ABVFP ABVFPLRA AUFBV AUFBVDTLIA AUFBVDTNIA AUFBVDTNIRA AUFBVFP AUFFPDTNIRA UFBV UFBVDT UFBVFP \
         UFBVLIA UFFPDTNIRA",
    ),
    ("Equality+NonLinearArith", "ANIA AUFDTNIRA AUFNIA AUFNIRA UFDTNIA UFDTNIRA UFNIA UFNIRA"),
    ("Arith", "LIA LRA NIA NRA"),
    ("Bitvec", "BV"),
    ("FPArith", "BVFP BVFPLRA FP FPLRA"),
];

/// The division of a logic, if it has one.
#[must_use]
pub fn division(logic: &str) -> Option<&'static str> {
    let has = |(_, logics): &&(&str, &str)| logics.split(' ').any(|other| other == logic);
    DIVISIONS.iter().find(has).map(|(division, _)| *division)
}

/// The rankings of a division, each of which has a winner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Kind {
    /// Wall time limited.
    Parallel,
    /// What took no more CPU time than was allowed of wall time.
    Sequential,
    /// What is satisfiable.
    Sat,
    /// What is unsatisfiable.
    Unsat,
    /// What ended within 24 s of wall time.
    #[serde(rename = "24")]
    TwentyFour,
}

impl Kind {
    /// All of them, in the rules' order.
    pub const ALL: [Kind; 5] = [Kind::Parallel, Kind::Sequential, Kind::Sat, Kind::Unsat, Kind::TwentyFour];

    fn name(self) -> &'static str {
        match self {
            Kind::Parallel => "parallel",
            Kind::Sequential => "sequential",
            Kind::Sat => "sat",
            Kind::Unsat => "unsat",
            Kind::TwentyFour => "24 s",
        }
    }

    /// Whether a run counts, on an instance with that answer.
    fn counts(self, cell: &Cell<'_>, answer: &str) -> bool {
        let run = cell.median;
        match self {
            Kind::Parallel => true,
            Kind::Sequential => allowed(run).is_none_or(|limit| run.cpu_s <= limit),
            Kind::Sat => answer == "sat",
            Kind::Unsat => answer == "unsat",
            Kind::TwentyFour => run.wall_s <= 24.0,
        }
    }
}

/// What a contestant got in one ranking.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// The ranking.
    pub kind: Kind,
    /// The place, from 1; shared by equals.
    pub rank: usize,
    /// What decides it. By the sequential score the CPU time does, and no wall time.
    pub score: Parallel,
}

/// A division of a contest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Division {
    /// Its name.
    pub name: &'static str,
    /// How many of its instances count.
    pub instances: usize,
    /// How many are left out, since answers to them contradict each other.
    pub disputed: usize,
    /// Contestants that took part, with their places in the order of [`Kind::ALL`]; the best by the parallel score first.
    pub contestants: Vec<(String, Vec<Place>)>,
}

/// The divisions that instances of a contest belong to: SMT-LIB files, of which the logic is their own.
#[must_use]
pub fn divisions(contest: &Contest<'_>) -> Vec<Division> {
    let of = |i: usize| {
        let runs = contest.cells[i].iter().flatten().flat_map(|cell| &cell.runs);
        runs.filter(|run| is_query(run)).filter_map(|run| run.logic.as_deref()).find_map(division)
    };
    let names: Vec<Option<&str>> = (0..contest.instances.len()).map(of).collect();
    let known: BTreeSet<&'static str> = (0..contest.instances.len()).filter_map(of).collect();
    let own = |name: &'static str| {
        let all: Vec<usize> = (0..names.len()).filter(|&i| names[i] == Some(name)).collect();
        let counted: Vec<usize> = all.iter().copied().filter(|&i| !contest.disputed[i]).collect();
        let took_part =
            |c: &usize| counted.iter().any(|&i| contest.cells[i][*c].as_ref().is_some_and(Cell::counts));
        let who: Vec<usize> = (0..contest.contestants.len()).filter(took_part).collect();
        let places = Kind::ALL.map(|kind| ranking(contest, &counted, &who, kind));
        let mut contestants: Vec<(String, Vec<Place>)> = (0..who.len())
            .map(|at| {
                (
                    contest.contestants[who[at]].label.clone(),
                    places.iter().map(|kind| kind[at].clone()).collect(),
                )
            })
            .collect();
        contestants.sort_by_key(|(_, places)| places[0].rank);
        Division { name, instances: counted.len(), disputed: all.len() - counted.len(), contestants }
    };
    known.into_iter().map(own).collect()
}

/// The places of some contestants on some instances.
fn ranking(contest: &Contest<'_>, counted: &[usize], who: &[usize], kind: Kind) -> Vec<Place> {
    let score = |&c: &usize| {
        let mut score = Parallel::default();
        for &i in counted {
            let Some(cell) = contest.cells[i][c].as_ref() else { continue };
            if !cell.counts() || !kind.counts(cell, &contest.answer(i)) {
                continue;
            }
            score.errors += usize::from(cell.wrong);
            if cell.solved().is_some() {
                score.correct += 1;
                score.wall_s += if kind == Kind::Sequential { 0.0 } else { cell.median.wall_s };
                score.cpu_s += cell.median.cpu_s;
            }
        }
        score
    };
    let scores: Vec<Parallel> = who.iter().map(score).collect();
    let rank =
        |own: &Parallel| 1 + scores.iter().filter(|other| other.compare(own) == Ordering::Less).count();
    scores.iter().map(|score| Place { kind, rank: rank(score), score: *score }).collect()
}

/// The places of a division, as a table: correct answers, wrong ones if there are any, and the place.
#[must_use]
pub fn sheet(division: &Division) -> Sheet {
    let cell = |Place { rank, score, .. }: &Place| {
        let wrong = if score.errors > 0 { format!(", {} wrong", score.errors) } else { String::new() };
        format!("{}{wrong} ({rank})", score.correct)
    };
    let disputed = match division.disputed {
        0 => String::new(),
        number => format!(", {number} in dispute"),
    };
    Sheet {
        caption: format!("{}: {} instances{disputed}", division.name, division.instances),
        head: ["solver"].into_iter().chain(Kind::ALL.map(Kind::name)).map(str::to_owned).collect(),
        text: (0..=Kind::ALL.len()).map(|column| column == 0).collect(),
        rows: division
            .contestants
            .iter()
            .map(|(name, places)| [name.clone()].into_iter().chain(places.iter().map(cell)).collect())
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::tests::record;
    use crate::{Answer, Limit, Record, RunStatus};

    fn run(instance: &str, solver: &str, status: RunStatus, [wall_s, cpu_s]: [f64; 2]) -> Record {
        let expected = Some(if instance.contains("yes") { Answer::Sat } else { Answer::Unsat });
        let limit = Limit { wall_s: Some(60.0), ..Limit::default() };
        Record {
            instance: instance.to_owned(),
            sha256: instance.to_owned(),
            logic: Some("QF_BV".to_owned()),
            solver: solver.to_owned(),
            states: None,
            quantifiers: None,
            ..Record { status, expected, limit, wall_s, cpu_s, ..record(&format!("{instance} {solver}")) }
        }
    }

    #[test]
    fn logics_are_in_one_division_each() {
        let all: Vec<&str> = DIVISIONS.iter().flat_map(|(_, logics)| logics.split(' ')).collect();
        let unique: BTreeSet<&&str> = all.iter().collect();
        assert_eq!(unique.len(), all.len());
        assert_eq!(
            [division("QF_UF"), division("UF"), division("ALL")],
            [Some("QF_Equality"), Some("Equality"), None]
        );
    }

    #[test]
    fn each_ranking_counts_its_own() {
        use RunStatus::{Sat, Timeout, Unsat};
        // One uses four cores, one is slow, and one is wrong once.
        let records = [
            run("yes-1", "broad", Sat, [20.0, 80.0]),
            run("yes-1", "slow", Sat, [30.0, 30.0]),
            run("yes-1", "rash", Unsat, [1.0, 1.0]),
            run("no-1", "broad", Unsat, [1.0, 4.0]),
            run("no-1", "slow", Timeout, [60.0, 60.0]),
            run("no-1", "rash", Unsat, [2.0, 2.0]),
        ];
        let contest = Contest::new(&records);
        let all = divisions(&contest);
        assert_eq!(all.len(), 1);
        assert_eq!((all[0].name, all[0].instances, all[0].disputed), ("QF_Bitvec", 2, 0));
        let rows = sheet(&all[0]).rows;
        let row = |name: &str| rows.iter().find(|row| row[0] == name).expect("it took part")[1..].join("; ");
        assert_eq!(row("broad"), "2 (1); 1 (1); 1 (1); 1 (1); 2 (1)");
        assert_eq!(row("slow"), "1 (2); 1 (2); 1 (2); 0 (3); 0 (2)");
        assert_eq!(row("rash"), "1, 1 wrong (3); 1, 1 wrong (3); 0, 1 wrong (3); 1 (2); 1, 1 wrong (3)");
    }
}
