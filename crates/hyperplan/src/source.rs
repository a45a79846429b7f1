//! Where a problem comes from: a text with the files that it names, or files of other tools.

use crate::disk::Beside;
use crate::foreign::{self, Foreign};
use hyperplan_problem::lower::uses;
use hyperplan_problem::{Loader, Lowered, Overrides, lower, read};
use hyperplan_syntax::{Diagnostic, SourceMap, ast, parse};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files that a problem names: some in memory, the others in a folder, if there is one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Files {
    pub(crate) folder: Option<PathBuf>,
    pub(crate) memory: BTreeMap<String, Vec<u8>>,
}

impl Loader for Files {
    fn load(&self, path: &str) -> Result<Vec<u8>, String> {
        match (self.memory.get(path), &self.folder) {
            (Some(bytes), _) => Ok(bytes.clone()),
            (None, Some(folder)) => Beside(folder.clone()).load(path),
            (None, None) => Err("a problem without a folder reads no files".to_owned()),
        }
    }
}

/// The same, which keeps what is read.
struct Kept<'a> {
    files: &'a Files,
    read: RefCell<BTreeMap<String, Vec<u8>>>,
}

impl Loader for Kept<'_> {
    fn load(&self, path: &str) -> Result<Vec<u8>, String> {
        let bytes = self.files.load(path)?;
        self.read.borrow_mut().insert(path.to_owned(), bytes.clone());
        Ok(bytes)
    }
}

/// What a problem is read from.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    Text {
        /// How messages call it.
        name: String,
        text: String,
        files: Files,
    },
    Foreign(Foreign),
}

impl Source {
    /// What it means with some constants replaced, and the texts that it was read from.
    pub(crate) fn lower(&self, overrides: &Overrides) -> (Lowered, SourceMap) {
        let mut sources = SourceMap::new();
        match self {
            Source::Text { name, text, files } => {
                let lowered = read(&mut sources, name, text, files, overrides);
                (lowered, sources)
            }
            Source::Foreign(foreign) => foreign.lower(overrides),
        }
    }

    /// How messages call it.
    pub(crate) fn name(&self) -> &str {
        match self {
            Source::Text { name, .. } => name,
            Source::Foreign(foreign) => foreign.inputs.first().map_or("", |input| &input.name),
        }
    }

    /// For many values of a constant: the text is parsed once.
    pub(crate) fn parsed(&self) -> Option<Parsed<'_>> {
        let Source::Text { name, text, files } = self else { return None };
        let mut sources = SourceMap::new();
        let source = sources.add(name.as_str(), text.as_str());
        Some(Parsed { file: parse(source, text).0, sources, files })
    }

    /// It as a text of its own, with the files that this names: files of other tools are what they became.
    pub(crate) fn whole(&self) -> (String, BTreeMap<String, Vec<u8>>) {
        match self {
            Source::Text { name, text, files } => {
                let kept = Kept { files, read: RefCell::default() };
                // Which files it names is known once they were read.
                let _ = read(&mut SourceMap::new(), name, text, &kept, &Overrides::none());
                (text.clone(), kept.read.into_inner())
            }
            Source::Foreign(foreign) => {
                let (_, _, imported) = foreign.read(&Overrides::none());
                (foreign::text(&imported), BTreeMap::new())
            }
        }
    }

    /// The folder in which files are that it names.
    pub(crate) fn folder_of(path: &Path) -> PathBuf {
        path.parent().unwrap_or(Path::new("")).to_owned()
    }
}

/// A text that was parsed.
pub(crate) struct Parsed<'a> {
    file: ast::File,
    /// With the text alone.
    sources: SourceMap,
    files: &'a Files,
}

impl Parsed<'_> {
    /// What it means with some constants replaced.
    pub(crate) fn lower(&self, overrides: &Overrides) -> (Lowered, SourceMap) {
        let mut sources = self.sources.clone();
        let lowered = lower(&self.file, &mut sources, self.files, overrides);
        (lowered, sources)
    }

    /// Whether anything depends on a name.
    pub(crate) fn uses(&self, name: &str) -> bool {
        uses(&self.file, name)
    }
}

/// Those that are errors, or those that are not.
pub(crate) fn of_kind(diagnostics: &[Diagnostic], errors: bool) -> Vec<Diagnostic> {
    diagnostics.iter().filter(|diagnostic| diagnostic.is_error() == errors).cloned().collect()
}
