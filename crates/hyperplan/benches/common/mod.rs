//! What the benchmarks share: the paper's case studies.

use hyperplan_problem::{Overrides, Problem, read};
use hyperplan_syntax::SourceMap;
use std::path::{Path, PathBuf};

pub(crate) const OBJECTIVES: [&str; 5] = ["sp", "isr", "ar", "iso", "cso"];

/// The size that `HYPERPLAN_BENCH_SIZE` asks for.
pub(crate) fn wanted_size() -> Option<u32> {
    std::env::var("HYPERPLAN_BENCH_SIZE").ok().and_then(|n| n.parse().ok())
}

/// A case study: the text of its file, and the folder of its map.
pub(crate) struct Case {
    name: String,
    text: String,
    folder: PathBuf,
}

impl Case {
    pub(crate) fn new(objective: &str, size: u32) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs/case-studies");
        let name = format!("{objective}-{size}.hp");
        let text = std::fs::read_to_string(folder.join(&name)).expect("the specs are part of the repository");
        Case { name, text, folder }
    }

    pub(crate) fn read(&self) -> Problem {
        let loader = |path: &str| std::fs::read(self.folder.join(path)).map_err(|e| e.to_string());
        let lowered = read(&mut SourceMap::new(), &self.name, &self.text, &loader, &Overrides::none());
        assert!(!lowered.has_errors(), "{}: {:?}", self.name, lowered.diagnostics);
        lowered.problem
    }
}
