//! `hyperplan emit`: queries as SMT-LIB 2.

use super::emit_family;
use crate::args;
use crate::config;
use crate::failure::{Failure, Outcome, Status};
use crate::load::Loaded;
use crate::output::{Output, cannot_write, check_writable};
use hyperplan_plan::{EmitConfig, Emitted, emit};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &args::Emit, out: &mut Output) -> Outcome {
    let Some(file) = &args.file else { return emit_family::run(args, out) };
    let config = EmitConfig {
        solver: args.solver.as_deref().map(config::solver).transpose()?,
        quantifiers: config::quantifiers(args.encoding.quantifiers),
        states: config::states(args.encoding.states),
        deadline: config::deadline(args.encoding.timeout)?,
    };
    let problem = args::Problem { file: file.clone(), set: args.set.clone() };
    let loaded = Loaded::read(&problem, out)?;
    let objectives = loaded.selected(args.selection.objective.as_deref(), false)?;
    let target = Target::new(args.output.as_deref(), objectives.len())?;
    for objective in objectives {
        let emitted = emit(&loaded.problem, objective, &config);
        let emitted = emitted.map_err(|e| Failure {
            status: Status::from_code(e.exit_code()),
            message: format!("{}: {e}", objective.name),
        })?;
        emitted.notes.iter().for_each(|note| out.remark(format_args!("note: {note}")));
        target.write(&objective.name, &emitted, out)?;
    }
    Ok(Status::Good)
}

/// Where the queries go.
enum Target {
    Standard,
    File(PathBuf),
    Folder(PathBuf),
}

impl Target {
    fn new(output: Option<&Path>, objectives: usize) -> Outcome<Self> {
        let Some(path) = output else {
            if objectives > 1 {
                return Err(Failure::input("several objectives need a directory: -o DIR"));
            }
            return Ok(Target::Standard);
        };
        let ends_like_folder = path.as_os_str().to_string_lossy().ends_with(std::path::MAIN_SEPARATOR);
        if objectives > 1 || path.is_dir() || ends_like_folder {
            std::fs::create_dir_all(path).map_err(|e| cannot_write(path, &e))?;
            return Ok(Target::Folder(path.to_owned()));
        }
        check_writable(path)?;
        Ok(Target::File(path.to_owned()))
    }

    fn write(&self, objective: &str, emitted: &Emitted, out: &mut Output) -> Outcome<()> {
        match self {
            Target::Standard => out.write(|w| print(emitted, w)),
            Target::File(path) => write_to(path, emitted),
            Target::Folder(folder) => write_to(&folder.join(format!("{objective}.smt2")), emitted),
        }
    }
}

fn write_to(path: &Path, emitted: &Emitted) -> Outcome<()> {
    let write = || {
        let mut file = BufWriter::new(File::create(path)?);
        print(emitted, &mut file)?;
        file.flush()
    };
    write().map_err(|e| cannot_write(path, &e))
}

fn print(emitted: &Emitted, mut to: &mut dyn Write) -> io::Result<()> {
    emitted.write(&mut to)
}
