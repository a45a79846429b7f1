//! The table of operators: each is found by its name, and the reference page describes each.

mod common;

use common::{faults, formula};
use hyperplan_syntax::is_name;
use hyperplan_syntax::operator::{Fixity, Row, TABLE};
use std::fmt::Write as _;

const PAGE: &str = include_str!("../../../docs/language.md");

/// How an operator is used, as `f U[a,b] g`.
fn usage(row: &Row) -> String {
    let interval = if row.interval { "[a,b]" } else { "" };
    match row.fixity {
        Fixity::Prefix if row.name.starts_with(char::is_alphabetic) => format!("{}{interval} f", row.name),
        Fixity::Prefix => format!("{}f", row.name),
        _ => format!("f {}{interval} g", row.name),
    }
}

/// The table as the page shows it.
fn documented() -> String {
    let mut table = String::from("| operator | says | short for | binds | chains | also |\n");
    table += "| --- | --- | --- | --- | --- | --- |\n";
    for row in TABLE {
        let means = row.means.map(|means| format!("`{means}`")).unwrap_or_default();
        let chains = match row.fixity {
            Fixity::Prefix | Fixity::Unchained => "",
            Fixity::Left => "left",
            Fixity::Right => "right",
            Fixity::Flat => "list",
        };
        let cells = [&format!("`{}`", usage(row)), row.says, &means, &row.level.to_string(), chains];
        let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        writeln!(table, "| {} | {} |", cells.join(" | "), row.signs.join(" ")).expect("a string takes it");
    }
    table
}

#[test]
fn the_page_has_the_table() {
    let table = documented();
    assert!(PAGE.contains(&table), "docs/language.md should say:\n\n{table}");
}

#[test]
fn every_operator_is_read_by_its_name_and_signs() {
    for row in TABLE {
        for name in [row.name].iter().chain(row.signs) {
            let interval = if row.interval { "[0,1]" } else { "" };
            let operand = if row.name == "in" { "{b}" } else { "b" };
            let (text, own) = match row.fixity {
                Fixity::Prefix => (format!("{name}{interval} {operand}"), format!("{interval} b)")),
                _ => (format!("a {name}{interval} {operand}"), format!("{interval} {operand})")),
            };
            let read = formula(&text);
            assert!(read.contains(row.name) && read.ends_with(own.trim_start()), "{text} is read as {read}");
        }
    }
}

#[test]
fn what_is_advised_against_is_not_the_language() {
    for row in TABLE {
        for slip in row.slips {
            let text = match row.fixity {
                Fixity::Prefix => format!("objective o {{ {slip} (a == b) }}"),
                _ => format!("objective o {{ a {slip} b }}"),
            };
            let expected = format!("wrong-operator: `{slip}` is not an operator here @ {slip}");
            assert_eq!(faults(&text), [expected], "{text}");
        }
    }
}

#[test]
fn words_are_names_only_where_the_table_says_so() {
    for row in TABLE.iter().filter(|row| row.name.starts_with(char::is_alphabetic)) {
        assert_eq!(is_name(row.name), row.contextual, "{}", row.name);
    }
}
