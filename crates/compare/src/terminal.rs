//! What a terminal shows: as much of the tables as fits beside each other.

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use unicode_width::{UnicodeWidthChar as _, UnicodeWidthStr as _};

use crate::contest::Contest;
use crate::judge::Judgement;
use crate::score::scores;
use crate::table::{SEQUENTIAL, SOLVER_UNIQUE, Sheet, instances, notes, sheet};

/// So many instances are listed on a terminal.
const FEW: usize = 40;
/// Between two columns.
const GAP: usize = 2;
/// Names are not made shorter than this.
const LEAST: usize = 12;
/// Nor are they longer, where there is no end to a line: comfy-table counts to 65,535.
const MOST: usize = 10_000;
/// Columns of scores that a narrow terminal does without, the least important first.
const DISPENSABLE: [&str; 15] = [
    SOLVER_UNIQUE,
    "fastest",
    "counted",
    "unsupported",
    "unknown",
    SEQUENTIAL,
    "CPU",
    "memout",
    "error",
    "unique",
    "timeout",
    "sat",
    "unsat",
    "wall",
    "PAR-2",
];

/// The tables for a terminal so many columns wide, after what is wrong. Without a width everything is shown.
pub(crate) fn summary(contest: &Contest<'_>, judgement: &Judgement, width: Option<usize>) -> String {
    if contest.instances.is_empty() {
        return "no runs\n".to_owned();
    }
    let all = scores(contest, |_| true);
    let mut text = judgement.to_string();
    if !text.is_empty() {
        text.push('\n');
    }
    let width = width.unwrap_or(usize::MAX);
    if contest.instances.len() <= FEW {
        let mut sheet = instances(contest, &all);
        let more = fit_instances(&mut sheet, width);
        text.push_str(&terminal(&sheet));
        if more > 0 {
            text.push_str(&format!("and {more} more; report.html has all\n"));
        }
        text.push('\n');
    }
    let mut sheet = sheet(&all, "all");
    let left_out = fit_scores(&mut sheet, width);
    text.push_str(&terminal(&sheet));
    text.push('\n');
    if !left_out.is_empty() {
        text.push_str(&format!("Not shown here, but in report.html: {}.\n", left_out.join(", ")));
    }
    for note in notes(contest, &all) {
        text.push_str(&note);
        text.push('\n');
    }
    text
}

/// A table in plain characters. It is as wide as it is: what is piped to a file is not to depend on a terminal.
pub(crate) fn terminal(sheet: &Sheet) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled);
    let cells = |row: &[String]| row.iter().map(|cell| end_of(cell, MOST)).collect::<Vec<_>>();
    table.set_header(cells(&sheet.head)).add_rows(sheet.rows.iter().map(|row| cells(row)));
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if !sheet.text[i] {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// Leaves as many contestants as fit, the best, but one at least; how many it took away. Names of instances get a third of
/// the width, and what the others leave.
fn fit_instances(sheet: &mut Sheet, width: usize) -> usize {
    let all = sheet.head.len();
    for label in sheet.head.iter_mut().skip(2) {
        *label = end_of(label, (width / 6).max(LEAST));
    }
    let others = total(&widths(sheet)[1..]) + GAP;
    shorten(sheet, 0, width.saturating_sub(others).max(width / 3));
    let widths = widths(sheet);
    let fitting = (3..=all).take_while(|&count| total(&widths[..count]) <= width).last();
    keep(sheet, |i, _| i < fitting.unwrap_or(3));
    let others = total(&widths[1..sheet.head.len().max(1)]) + GAP;
    shorten(sheet, 0, width.saturating_sub(others));
    all - sheet.head.len()
}

/// Leaves the columns that fit, the most important ones; which ones it took away.
fn fit_scores(sheet: &mut Sheet, width: usize) -> Vec<String> {
    let mut left_out = Vec::new();
    let names = |sheet: &Sheet| total(&widths(sheet)).saturating_sub(widths(sheet)[1]);
    for dispensable in DISPENSABLE {
        // A solver that is a whole command line need not push out everything else.
        if names(sheet) + widths(sheet)[1].min(width / 3) <= width {
            break;
        }
        if sheet.head.iter().any(|name| name == dispensable) {
            keep(sheet, |_, name| name != dispensable);
            left_out.push(dispensable.to_owned());
        }
    }
    let others = names(sheet);
    shorten(sheet, 1, width.saturating_sub(others));
    left_out
}

/// How wide each column is.
fn widths(sheet: &Sheet) -> Vec<usize> {
    let cells = |i: usize| std::iter::once(&sheet.head[i]).chain(sheet.rows.iter().map(move |row| &row[i]));
    (0..sheet.head.len()).map(|i| cells(i).map(|cell| cell.width()).max().unwrap_or(0)).collect()
}

/// How wide columns are beside each other.
fn total(widths: &[usize]) -> usize {
    widths.iter().sum::<usize>() + GAP * widths.len().saturating_sub(1)
}

/// Leaves the columns of which that is true.
fn keep(sheet: &mut Sheet, is_kept: impl Fn(usize, &str) -> bool) {
    let kept: Vec<usize> = (0..sheet.head.len()).filter(|&i| is_kept(i, &sheet.head[i])).collect();
    let cells = |row: &[String]| kept.iter().map(|&i| row[i].clone()).collect();
    sheet.rows = sheet.rows.iter().map(|row| cells(row)).collect();
    sheet.text = kept.iter().map(|&i| sheet.text[i]).collect();
    sheet.head = cells(&sheet.head);
}

/// Shortens the cells of a column to so many characters.
fn shorten(sheet: &mut Sheet, column: usize, width: usize) {
    for row in &mut sheet.rows {
        row[column] = end_of(&row[column], width.max(LEAST));
    }
}

/// The end of a text, which tells names better apart than the beginning.
fn end_of(text: &str, width: usize) -> String {
    if text.width() <= width {
        return text.to_owned();
    }
    let mut left = width.saturating_sub(1);
    let fits = |c: &char| {
        let fits = c.width().unwrap_or(0) <= left;
        left = left.saturating_sub(c.width().unwrap_or(0));
        fits
    };
    let mut end: Vec<char> = text.chars().rev().take_while(fits).collect();
    end.push('…');
    end.into_iter().rev().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(head: &[&str], row: &[&str]) -> Sheet {
        let owned = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect::<Vec<_>>();
        Sheet {
            caption: String::new(),
            head: owned(head),
            text: vec![true; head.len()],
            rows: vec![owned(row)],
        }
    }

    #[test]
    fn the_best_that_fit_are_left() {
        let whole =
            table(&["instance", "answer", "a", "bb", "ccc"], &["specs/x.hp#o", "sat", "1.000", "2", "3"]);
        let fitted = |width| {
            let mut sheet = whole.clone();
            let more = fit_instances(&mut sheet, width);
            (sheet.head[2..].join(" "), more, terminal(&sheet).lines().map(|line| line.width()).max())
        };
        assert_eq!(fitted(usize::MAX), ("a bb ccc".to_owned(), 0, Some(36)));
        assert_eq!(fitted(36), ("a bb ccc".to_owned(), 0, Some(36)));
        assert_eq!(fitted(35), ("a bb".to_owned(), 1, Some(31)));
        assert_eq!(fitted(27), ("a".to_owned(), 2, Some(27)));
        // One is always shown.
        assert_eq!(fitted(5), ("a".to_owned(), 2, Some(27)));
    }

    #[test]
    fn long_names_leave_room() {
        let long = format!("{}/é/name.hp#o", "folder/".repeat(20));
        let mut sheet = table(&["instance", "answer", "a", "b"], &[&long, "sat", "1.000", "2.000"]);
        assert_eq!(fit_instances(&mut sheet, 60), 0);
        assert_eq!(sheet.rows[0][0].width(), 60 - 22);
        assert!(sheet.rows[0][0].starts_with('…') && sheet.rows[0][0].ends_with("/é/name.hp#o"));
        assert_eq!(end_of("漢字漢字", 4), "…字");
        assert_eq!(end_of("漢字", 4), "漢字");
    }

    #[test]
    fn less_important_columns_go_first() {
        let head = ["#", "solver", "counted", "wrong", "solved", "PAR-2", "CPU", "fastest"];
        let whole = table(&head, &["1", "z3", "10", "0", "9", "0.1", "0.2", "1"]);
        let fitted = |width| {
            let mut sheet = whole.clone();
            let left_out = fit_scores(&mut sheet, width).join(" ");
            (left_out, terminal(&sheet).lines().map(|line| line.width()).max().unwrap_or(0))
        };
        assert_eq!(fitted(80), (String::new(), 54));
        assert_eq!(fitted(54), (String::new(), 54));
        assert_eq!(fitted(53), ("fastest".to_owned(), 45));
        assert_eq!(fitted(31), ("fastest counted CPU".to_owned(), 31));
        let (left_out, width) = fitted(1);
        assert_eq!((left_out.as_str(), width), ("fastest counted CPU PAR-2", 24));
        let mut command = table(&head, &["1", &"x".repeat(100), "10", "0", "9", "0.1", "0.2", "1"]);
        assert!(fit_scores(&mut command, 80).is_empty());
        assert_eq!(total(&widths(&command)), 80);
    }
}
