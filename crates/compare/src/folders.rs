//! Where a run puts what it needs and what it leaves.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::plan::{Kind, Run};
use crate::query::Query;

/// The folder for what runs leave that went wrong.
const EVIDENCE: &str = "evidence";

/// Folders of a run, relative to that of the comparison.
pub(crate) struct Folders {
    base: PathBuf,
    /// Where its queries are kept.
    pub(crate) queries: Option<String>,
    /// For temporary files, which are kept where something went wrong: there may be evidence among them.
    pub(crate) temporary: String,
}

impl Folders {
    /// Makes them anew, in the folder of the comparison.
    pub(crate) fn new(run: &Run, base: &Path, queries: bool) -> io::Result<Folders> {
        let problem = matches!(run.instance.kind, Kind::Problem { .. });
        let folders = Folders {
            base: base.to_owned(),
            queries: (queries && problem).then(|| format!("queries/{}", run.key)),
            temporary: format!("{EVIDENCE}/{}", run.key),
        };
        // Of a run that was interrupted.
        for folder in folders.queries.iter().chain([&folders.temporary]) {
            match fs::remove_dir_all(folders.base.join(folder)) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
            fs::create_dir_all(folders.base.join(folder))?;
        }
        Ok(folders)
    }

    /// A copy of a query that says nothing of its status, sets the seed, and has a name that no solver takes for an option;
    /// `None` where the file can serve itself.
    pub(crate) fn copy(&self, run: &Run) -> io::Result<Option<String>> {
        let file = Path::new(&run.instance.file);
        // What cannot be read is told of by the run.
        let Ok(bytes) = fs::read(file) else { return Ok(None) };
        let standalone = run.solver.standalone.as_ref().filter(|_| run.seed != 0);
        let seed = standalone.and_then(|standalone| standalone.seed(run.seed));
        let without = Query::without_status(&bytes);
        // By some versions of z3 whatever has a `=` is.
        let strange = run.instance.file.starts_with('-') || run.instance.file.contains('=');
        if seed.is_none() && without.is_none() && !strange {
            return Ok(None);
        }
        let name = file.file_name().filter(|_| !strange).unwrap_or("query.smt2".as_ref());
        let copy = Path::new(&self.full(&self.temporary)).join(name);
        let text = [seed.unwrap_or_default().into_bytes(), without.unwrap_or(bytes)].concat();
        fs::write(&copy, text)?;
        Ok(Some(copy.display().to_string()))
    }

    /// One of them as a path that does not depend on the current folder.
    pub(crate) fn full(&self, folder: &str) -> String {
        self.base.join(folder).display().to_string()
    }

    /// Removes temporary files, unless they are to be kept.
    pub(crate) fn tidy(&self, keep: bool) -> io::Result<()> {
        let temporary = self.base.join(&self.temporary);
        if !keep {
            fs::remove_dir_all(&temporary)?;
        }
        // Where it is empty.
        let _ = fs::remove_dir(&temporary);
        Ok(())
    }

    /// The largest query that was kept.
    pub(crate) fn largest(&self) -> Option<Query> {
        let folder = self.base.join(self.queries.as_ref()?);
        let files = fs::read_dir(folder).ok()?.flatten();
        let sized = files.filter_map(|file| Some((file.metadata().ok()?.len(), file.path())));
        let (_, path): (u64, PathBuf) = sized.max()?;
        Some(Query::scan(&fs::read_to_string(path).ok()?))
    }
}

/// Removes the folder for evidence, unless there is some.
pub(crate) fn remove_if_empty(base: &Path) {
    let _ = fs::remove_dir(base.join(EVIDENCE));
}
