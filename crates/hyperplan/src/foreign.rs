//! Files of other tools, in place of a problem file: what they mean.

use crate::disk::{self, read_bytes, reason};
use hyperplan_import::{Imported, Input, Kind, Options, ascii, import};
use hyperplan_problem::{Lowered, NoFiles, Overrides, lower};
use hyperplan_syntax::{Diagnostic, SourceMap, print};
use std::path::Path;

/// Models and formulas, with their texts.
#[derive(Clone, Debug)]
pub struct Foreign {
    /// The files.
    pub inputs: Vec<Input>,
    /// How formulas are read.
    pub options: Options,
}

impl Foreign {
    /// What the files mean, and what is wrong with them.
    #[must_use]
    pub fn lower(&self, overrides: &Overrides) -> (Lowered, SourceMap) {
        let (lowered, sources, _) = self.read(overrides);
        (lowered, sources)
    }

    /// The same, with what the files became.
    #[must_use]
    pub fn read(&self, overrides: &Overrides) -> (Lowered, SourceMap, Imported) {
        let mut sources = SourceMap::new();
        let mut imported = import(&self.inputs, &self.options, &mut sources);
        let mut diagnostics = std::mem::take(&mut imported.diagnostics);
        if diagnostics.iter().any(Diagnostic::is_error) {
            return (Lowered { diagnostics, ..Lowered::default() }, sources, imported);
        }
        let mut lowered = lower(&imported.file, &mut sources, &NoFiles, overrides);
        diagnostics.append(&mut lowered.diagnostics);
        // What stands in a model is not there for one formula alone: nothing of it is called unused.
        let unused = std::mem::take(&mut imported.doubts);
        (Lowered { diagnostics, unused, ..lowered }, sources, imported)
    }
}

/// How the text of a file of another tool begins, where its name alone does not say what it is.
const HEAD: usize = 4096;

/// Whether a file is one of another tool. How it begins decides where its name does not; one that cannot be read is told of
/// where it is used.
#[must_use]
pub fn is_foreign(path: &Path) -> bool {
    let begins = || {
        read_bytes(path).map(|bytes| String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD)]).into_owned())
    };
    let by_content = path.extension().is_some_and(|ending| ending == "txt" || ending == "pddl");
    let text = if by_content { begins().unwrap_or_default() } else { String::new() };
    path.to_str().and_then(|name| Kind::of(name, &text)).is_some()
}

/// The text of a file of another tool.
///
/// # Errors
/// In words, why it cannot be read.
pub fn text_of(path: &Path) -> Result<String, String> {
    let bytes = read_bytes(path).map_err(|error| reason(&error))?;
    if path.extension().is_some_and(|ending| ending == "aig") { ascii(&bytes) } else { disk::text(bytes) }
}

/// What files became, as a problem file that says where things come from.
#[must_use]
pub fn text(imported: &Imported) -> String {
    format!("{}\n{}", imported.about, print(&imported.file, ""))
}
