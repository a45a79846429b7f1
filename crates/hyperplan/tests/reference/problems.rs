//! The problems of a page: accepted or refused, and decided, as it says.

use super::common::{Run, command};
use hyperplan_problem::KnownStatus;
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;

pub(crate) fn hyperplan(folder: &Path, arguments: &[&str]) -> Run {
    let mut command = command(arguments);
    Run::new(command.current_dir(folder).stderr(Stdio::piped()).output().expect("the command was built"))
}

pub(crate) fn is_refused(folder: &Path, file: &str, code: &str) -> Result<(), String> {
    let run = hyperplan(folder, &["check", file]);
    if run.status == 2 && run.stderr.contains(&format!("error[{code}]")) {
        return Ok(());
    }
    Err(format!("expected error[{code}] and exit status 2, found {}\n{}", run.status, run.stderr))
}

/// Accepted, with a warning only if it is doubtful, and every objective is decided as each known status says.
pub(crate) fn is_known(folder: &Path, file: &str, doubtful: bool, text: &str) -> Result<(), String> {
    let run = hyperplan(folder, &["check", file]);
    if run.status != 0 || run.stderr.is_empty() == doubtful {
        return Err(format!("exit status {}\n{}", run.status, run.stderr));
    }
    let known: Vec<KnownStatus> = KnownStatus::of_text(text).collect();
    for objective in text.lines().filter_map(|line| line.strip_prefix("objective ")) {
        if !known.iter().any(|status| objective.starts_with(&status.objective)) {
            return Err(format!("nothing is said of {objective}"));
        }
    }
    for KnownStatus { objective, set, realizable, .. } in known {
        let set: Vec<String> = set.iter().map(|(name, value)| format!("--set={name}={value}")).collect();
        let mut arguments = vec!["solve", "--quiet", "--objective", &objective, file];
        arguments.extend(set.iter().map(String::as_str));
        let run = hyperplan(folder, &arguments);
        if run.status != i32::from(!realizable) {
            return Err(format!("{arguments:?}: {}{}", run.stdout, run.stderr));
        }
    }
    Ok(())
}

/// Accepted, and every objective is decided as a comment says.
pub(crate) fn holds(folder: &Path, file: &str, text: &str) -> Result<(), String> {
    let run = hyperplan(folder, &["check", file]);
    if run.status != 0 {
        return Err(format!("exit status {}\n{}", run.status, run.stderr));
    }
    let objectives = text.lines().filter_map(|line| line.trim().strip_prefix("objective "));
    for objective in objectives {
        let name: String = objective.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let mark = format!("// {name}: ");
        let mut said = text.lines().filter_map(|line| Some(line.trim_end().split_once(&mark)?.1));
        let (Some(answer), None) = (said.next(), said.next()) else {
            return Err(format!("no line ends with `// {name}: VERDICT`, or several do"));
        };
        let (verdict, solvers) = answer.split_once(" by ").unwrap_or((answer, "builtin"));
        let status = match verdict {
            "realizable" => 0,
            "unrealizable" => 1,
            other => return Err(format!("`{other}` is no verdict")),
        };
        for solver in solvers.split(", ") {
            let run =
                hyperplan(folder, &["solve", "--quiet", "--objective", &name, "--solver", solver, file]);
            let required = std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_some();
            if run.status == 4 && run.stderr.contains("not found") && !required {
                say_skipped(solver);
                continue;
            }
            // What a cheapest strategy costs stands behind the verdict.
            let told = run.stdout.trim_end().split(" with ").next().unwrap_or_default();
            if run.status != status || told != format!("{name}: {verdict}") {
                let (found, status, messages) = (run.stdout, run.status, run.stderr);
                return Err(format!("expected {verdict}, {solver} found {found} ({status})\n{messages}"));
            }
        }
    }
    Ok(())
}

fn say_skipped(solver: &str) {
    let _ = writeln!(std::io::stderr(), "{solver} is missing: skipped");
}
