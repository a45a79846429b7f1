//! Instances by how hard they are: what each contestant solved of those that are about as hard.

use crate::contest::{Cell, Contest};
use crate::table::Sheet;

/// How many instances there are of each difficulty, and how many of these each contestant solved.
///
/// An instance is as hard as it was for the slowest contestant for which it counts; difficulties are told apart by powers of
/// ten of seconds, and what one of them did not solve is in the last row.
#[must_use]
pub fn sheet(contest: &Contest<'_>) -> Sheet {
    let mut rows: Vec<Vec<usize>> = Vec::new();
    for (instance, cells) in contest.cells.iter().enumerate().filter(|(i, _)| !contest.disputed[*i]) {
        let Some(bin) = bin(cells) else { continue };
        if rows.len() <= bin {
            rows.resize(bin + 1, vec![0; 1 + contest.contestants.len()]);
        }
        rows[bin][0] += 1;
        for (contestant, cell) in contest.cells[instance].iter().enumerate() {
            rows[bin][1 + contestant] +=
                usize::from(cell.as_ref().is_some_and(|cell| cell.solved().is_some()));
        }
    }
    let numbers = rows.iter().enumerate().filter(|(_, row)| row[0] > 0);
    let labels = contest.contestants.iter().map(|who| who.label.clone());
    Sheet {
        caption: "By difficulty".to_owned(),
        head: ["slowest", "instances"].map(str::to_owned).into_iter().chain(labels).collect(),
        text: (0..2 + contest.contestants.len()).map(|column| column == 0).collect(),
        rows: numbers
            .map(|(bin, row)| [name(bin)].into_iter().chain(row.iter().map(usize::to_string)).collect())
            .collect(),
    }
}

/// The bin of what one contestant did not solve.
const UNSOLVED: usize = 7;

/// Where an instance belongs; nowhere where it counts for nobody.
fn bin(cells: &[Option<Cell<'_>>]) -> Option<usize> {
    let of = |cell: &Cell<'_>| match cell.solved() {
        // A day and more are one bin.
        Some(_) => {
            [1.0, 10.0, 100.0, 1e3, 1e4, 1e5].iter().filter(|edge| cell.median.wall_s >= **edge).count()
        }
        None => UNSOLVED,
    };
    cells.iter().flatten().filter(|cell| cell.counts()).map(of).max()
}

fn name(bin: usize) -> String {
    match bin {
        0 => "under 1 s".to_owned(),
        UNSOLVED => "not solved".to_owned(),
        6 => "100000 s and more".to_owned(),
        // Between two powers of ten.
        bin => format!("1{} to 10{} s", "0".repeat(bin - 1), "0".repeat(bin - 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::tests::record;
    use crate::{Record, RunStatus};

    #[test]
    fn the_slowest_says_how_hard_it_is() {
        let run = |instance: &str, solver: &str, status, wall_s| Record {
            instance: instance.to_owned(),
            solver: solver.to_owned(),
            ..Record { status, wall_s, ..record(&format!("{instance} {solver}")) }
        };
        let records = [
            run("a", "fast", RunStatus::Sat, 0.1),
            run("a", "slow", RunStatus::Sat, 9.0),
            run("b", "fast", RunStatus::Sat, 0.2),
            run("b", "slow", RunStatus::Timeout, 60.0),
            run("c", "fast", RunStatus::Sat, 10.0),
            run("c", "slow", RunStatus::Unsupported, 0.0),
            run("d", "slow", RunStatus::Unsupported, 0.0),
        ];
        let sheet = sheet(&Contest::new(&records));
        assert_eq!(sheet.head, ["slowest", "instances", "fast", "slow"]);
        let rows: Vec<String> = sheet.rows.iter().map(|row| row.join(" ")).collect();
        assert_eq!(rows, ["1 to 10 s 1 1 1", "10 to 100 s 1 1 0", "not solved 1 1 0"]);
    }
}
