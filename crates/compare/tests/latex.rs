//! Tables as LaTeX sets them. Skipped where `pdflatex` is missing, unless `HYPERPLAN_REQUIRE_SOLVERS` is set.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

mod sample;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use hyperplan_compare::report::write_all;
use hyperplan_compare::{Record, RunStatus};
use sample::{run, sample};

fn has_latex() -> bool {
    let mut command = Command::new("pdflatex");
    command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    let found = command.status().is_ok_and(|status| status.success());
    if !found {
        assert!(std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_none(), "pdflatex is missing");
        eprintln!("skipped: pdflatex is missing");
    }
    found
}

/// Writes the reports, and has LaTeX set their tables, with the packages that these name.
fn set(records: &[Record]) {
    let dir = tempfile::tempdir().expect("a temporary folder");
    write_all(records, dir.path()).expect("a folder that can be written");
    for name in ["table", "instances"] {
        let table = fs::read_to_string(dir.path().join(name).with_extension("tex")).expect("it was written");
        let packages = table.lines().next().and_then(|line| line.strip_prefix("% ")).expect("it names them");
        let text = format!(
            "\\documentclass{{article}}\n{packages}\n\\begin{{document}}\n\\input{{{name}}}\n\\end{{document}}\n"
        );
        compile(dir.path(), &text);
    }
}

fn compile(dir: &Path, text: &str) {
    fs::write(dir.join("paper.tex"), text).expect("ours");
    let options = ["-interaction=nonstopmode", "-halt-on-error", "paper.tex"];
    let output = Command::new("pdflatex").args(options).current_dir(dir).output().expect("it is there");
    let log = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{log}");
    let log = fs::read(dir.join("paper.log")).expect("it was written");
    let log = String::from_utf8_lossy(&log);
    assert!(!log.contains("Missing character") && !log.contains("invalid in math mode"), "{log}");
}

/// What means something to LaTeX, what its fonts lack, and what a file's name can have all the same.
const NASTY: [&str; 8] = [
    "100%_of #1 & {more} ~ ^ \\end{tabular} \\\\ $x$",
    "\"quoted\" 'quoted' `quoted` ``twice''",
    "<tag> a|b --dash ---, ,,x?`!`",
    "éàüßñçøåÆŒœłšžő Łódź «guillemets» Ðð Þþ Đđ Ąą",
    "Ω αβγδεζηθικλμνξοπρστυφχψως ΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨ",
    "漢字 \u{1f916} e\u{301} \u{feff}\u{ad}\u{a0}\u{fffd} ≤≥∀∃→−×",
    "line\nbreak\ttab\r\u{1b}[31m\u{2028}\u{202e}\u{0}\u{7f}\u{85}",
    "[brackets]*",
];

#[test]
fn of_the_sample() {
    if has_latex() {
        set(&sample());
    }
}

#[test]
fn whatever_names_have() {
    if !has_latex() {
        return;
    }
    let mut records = Vec::new();
    for (i, name) in NASTY.iter().enumerate() {
        for (solver, quantifiers) in [("z3", "auto"), ("./solver_x --a=%,#", NASTY[i % 4]), ("é Ω", "keep")]
        {
            let mut record = run(solver, name, RunStatus::Sat, 1.0);
            record.family = name.chars().rev().collect();
            record.quantifiers = Some(quantifiers.to_owned());
            record.set = vec![(*name).to_owned()];
            records.push(record);
        }
    }
    set(&records);
}

/// More than a page has room for, with a virtual best solver or without.
#[test]
fn long_ones() {
    if !has_latex() {
        return;
    }
    let records: Vec<Record> =
        (0..150).map(|i| run("z3", &format!("specs/{i}_%.hp#o"), RunStatus::Sat, f64::from(i))).collect();
    set(&records);
}
