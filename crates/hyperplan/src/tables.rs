//! Models and formulas of other tools in a comparison: on the command line, or in tables. They are imported first, into
//! the folder of the comparison, so that what is run is there to be read, and run again.

use crate::args;
use crate::explain::advise;
use crate::failure::{Failure, Result};
use crate::files::{cannot_write, read_source, write_bytes};
use crate::gather::{known_semantics, options, together};
use crate::output::Output;
use crate::report;
use hyperplan::foreign::{Foreign, is_foreign, text};
use hyperplan_import::{Known, Options};
use hyperplan_problem::Overrides;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Where the problems that were imported are, in the folder of a comparison.
const FOLDER: &str = "imported";

/// The files of a comparison, with problem files in place of models, formulas and tables.
pub(crate) fn imported(args: &args::Compare, out: &Output) -> Result<Vec<String>> {
    let is_table = |name: &String| Path::new(name).extension().is_some_and(|ending| ending == "tsv");
    let is_foreign = |name: &String| is_foreign(Path::new(name));
    let mut entries = Vec::new();
    let direct: Vec<PathBuf> =
        args.asked.files.iter().filter(|name| is_foreign(name)).map(PathBuf::from).collect();
    if direct.is_empty() && args.asked.reading.bound.is_some() {
        return Err(Failure::input(
            "--bound is for models and formulas on the command line; tables have bounds",
        ));
    }
    if !direct.is_empty() {
        entries.push(Entry { family: None, files: direct, options: options(&args.asked.reading)? });
    }
    for table in args.asked.files.iter().filter(|name| is_table(name)) {
        entries.extend(Entry::of_table(Path::new(table), args)?);
    }
    let others = args.asked.files.iter().filter(|name| !is_table(name) && !is_foreign(name));
    let mut files: Vec<String> = others.cloned().collect();
    let folder = args.benchexec.as_deref().unwrap_or(&args.out).join(FOLDER);
    let mut names = BTreeSet::new();
    let mut bad = 0;
    for entry in &entries {
        match entry.import(&folder, &mut names, args.asked.skip_bad, out) {
            Ok(file) => files.push(file),
            Err(failure) => {
                bad += 1;
                if args.asked.skip_bad {
                    out.remark(format_args!("left out: {}", failure.message));
                } else {
                    out.failure(&failure);
                }
            }
        }
    }
    if bad > 0 && (!args.asked.skip_bad || bad == entries.len()) {
        let how = if args.asked.skip_bad { "" } else { ": correct them, or leave them out with --skip-bad" };
        let all = entries.len();
        return Err(Failure::input(format_args!("{bad} of {all} problems cannot be imported{how}")));
    }
    Ok(files)
}

/// Models with a formula.
struct Entry {
    family: Option<String>,
    files: Vec<PathBuf>,
    options: Options,
}

impl Entry {
    /// The rows of a table: family, models, formula, bound, what is known, and whatever follows, separated by tabs.
    fn of_table(table: &Path, args: &args::Compare) -> Result<Vec<Entry>> {
        let text = read_source(table)?;
        let folder = table.parent().unwrap_or(Path::new(""));
        let rows =
            text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
        let entry = |(number, line): (usize, &str)| {
            let wrong =
                |why: String| Failure::input(format_args!("{}:{}: {why}", table.display(), number + 1));
            let cells: Vec<&str> = line.split('\t').map(str::trim).collect();
            let [family, models, formula, bound, known, ..] = cells[..] else {
                let why = "expected family, models, formula, bound and what is known, separated by tabs";
                return Err(wrong(why.to_owned()));
            };
            let files = models.split_whitespace().chain([formula]).map(|file| folder.join(file)).collect();
            let (steps, semantics) = match bound.split_whitespace().collect::<Vec<_>>()[..] {
                [steps] => (steps, None),
                [steps, semantics] => (steps, Some(semantics.to_owned())),
                _ => ("", None),
            };
            let why = || wrong(format!("`{bound}` is no bound, such as `20` or `20 hpes`"));
            let bound = steps.parse().map_err(|_| why())?;
            if let Some(semantics) = &semantics {
                known_semantics("", semantics).map_err(|_| why())?;
            }
            let status = match known {
                "" | "-" | "unknown" => None,
                word => Some(Known::of_word(word).ok_or_else(|| {
                    wrong(format!("`{word}` is none of realizable, unrealizable, holds, violated and `-`"))
                })?),
            };
            let family = Some(family.to_owned()).filter(|family| !family.is_empty());
            let options =
                Options { bound: Some(bound), semantics, dialect: args.asked.reading.dialect, status };
            Ok(Entry { family, files, options })
        };
        rows.map(entry).collect()
    }

    /// Writes the problem file; where.
    fn import(
        &self,
        folder: &Path,
        names: &mut BTreeSet<PathBuf>,
        brief: bool,
        out: &Output,
    ) -> Result<String> {
        let foreign: Foreign = together(self.files.iter().map(PathBuf::as_path), self.options.clone())?;
        let (mut lowered, sources, imported) = foreign.read(&Overrides::default());
        if lowered.has_errors() {
            if brief {
                let first = lowered.diagnostics.iter().find(|diagnostic| diagnostic.is_error());
                let why = first.map_or("", |diagnostic| diagnostic.message.as_str());
                let place = first.and_then(|diagnostic| diagnostic.span).map_or(String::new(), |span| {
                    let (line, column) = sources.position(span);
                    format!("{}:{line}:{column}: ", sources.get(span.source).name)
                });
                return Err(Failure::input(format_args!("{place}{why}")));
            }
            advise(&mut lowered.diagnostics);
            report::diagnostics(&sources, &lowered.diagnostics, out);
            return Err(Failure::said());
        }
        let path = self.place(folder, names);
        let parent = path.parent().unwrap_or(folder);
        fs::create_dir_all(parent).map_err(|error| cannot_write(parent, &error))?;
        write_bytes(&path, text(&imported).as_bytes())?;
        Ok(path.display().to_string())
    }

    /// A file of its own: family, first model, formula and bound.
    fn place(&self, folder: &Path, names: &mut BTreeSet<PathBuf>) -> PathBuf {
        let stem = |path: &PathBuf| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let harmless = |name: &str| -> String {
            name.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect()
        };
        let mut words: Vec<String> =
            self.files.first().into_iter().chain(self.files.last()).map(stem).collect();
        words.extend(self.options.bound.map(|bound| bound.to_string()));
        words.extend(self.options.semantics.clone());
        // A folder of that name would lead elsewhere.
        let family = self.family.as_deref().map(harmless).filter(|name| !name.starts_with('.'));
        let folder = folder.join(family.unwrap_or_default());
        let name = harmless(&words.join("-"));
        let mut path = folder.join(format!("{name}.hp"));
        let mut number = 1;
        while !names.insert(path.clone()) {
            number += 1;
            path = folder.join(format!("{name}-{number}.hp"));
        }
        path
    }
}
