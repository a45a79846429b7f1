//! The book: every page below `docs/` is a chapter, no chapter is empty, and every link of it and of the other pages
//! leads somewhere. What the pages show is run by `crates/hyperplan/tests/reference.rs`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::nothing;
use crate::sources::{normal, top};

/// The list of chapters, which is no chapter.
const SUMMARY: &str = "docs/SUMMARY.md";

/// Pages that belong to no book, but link into it.
const OTHERS: [&str; 3] = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md"];

/// A chapter has at least so many words outside of blocks.
const WORDS: usize = 40;

/// A page without its fenced blocks and comments.
struct Page {
    /// From the top of the repository.
    file: PathBuf,
    /// The lines that are left, with their numbers.
    lines: Vec<(usize, String)>,
}

impl Page {
    fn read(file: &Path) -> Page {
        let text = fs::read_to_string(top().join(file)).expect("it is readable");
        let (mut lines, mut end) = (Vec::new(), None);
        for (number, line) in (1..).zip(text.lines()) {
            let begin = line.trim_start();
            match end {
                Some(mark) if begin.starts_with(mark) || line.ends_with(mark) => end = None,
                Some(_) => {}
                None if begin.starts_with("```") => end = Some("```"),
                None if begin.starts_with("<!--") && !begin.ends_with("-->") => end = Some("-->"),
                None => lines.push((number, line.to_owned())),
            }
        }
        Page { file: file.to_owned(), lines }
    }

    fn headings(&self) -> impl Iterator<Item = &str> {
        let headings = self.lines.iter().filter(|(_, line)| line.starts_with('#'));
        headings.map(|(_, line)| line.trim_start_matches('#').trim())
    }

    /// What links to headings are called: as mdBook does it, and those who show Markdown beside sources.
    fn anchors(&self) -> BTreeSet<String> {
        let (mut anchors, mut seen) = (BTreeSet::new(), BTreeMap::new());
        for heading in self.headings() {
            let kept = heading.to_lowercase();
            let kept = kept.chars().filter(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | ' '));
            let name: String = kept.map(|c| if c == ' ' { '-' } else { c }).collect();
            let times = seen.entry(name.clone()).and_modify(|times| *times += 1).or_insert(0_usize);
            anchors.insert(if *times == 0 { name } else { format!("{name}-{times}") });
        }
        anchors
    }

    /// The links to files and headings, each with the words that are the link, and its line.
    fn links(&self) -> Vec<(usize, String, String)> {
        let mut found = Vec::new();
        for (number, line) in &self.lines {
            let parts: Vec<&str> = line.split("](").collect();
            for pair in parts.windows(2) {
                let words = pair[0].rsplit('[').next().unwrap_or_default();
                let target = pair[1].split(')').next().unwrap_or_default();
                if !target.contains("://") {
                    found.push((*number, words.to_owned(), target.to_owned()));
                }
            }
        }
        found
    }
}

/// All Markdown files below a folder.
fn below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(top().join(folder)).expect("it is there");
    let mut names: Vec<_> = entries.map(|entry| entry.expect("readable").file_name()).collect();
    names.sort();
    let files = names
        .iter()
        .map(|name| folder.join(name))
        .flat_map(|file| if top().join(&file).is_dir() { below(&file) } else { vec![file] });
    files.filter(|file| file.extension().is_some_and(|end| end == "md")).collect()
}

#[test]
fn every_page_is_a_chapter() {
    let summary = Page::read(Path::new(SUMMARY));
    let mut chapters: BTreeMap<PathBuf, Vec<String>> = BTreeMap::new();
    for (_, title, target) in summary.links() {
        chapters.entry(Path::new("docs").join(target)).or_default().push(title);
    }
    let mut found = Vec::new();
    for file in below(Path::new("docs")).into_iter().filter(|file| file != Path::new(SUMMARY)) {
        let (shown, page) = (file.display(), Page::read(&file));
        match chapters.get(&file).map(Vec::as_slice) {
            Some([title]) if page.headings().next() == Some(title) => {}
            Some([title]) => {
                found.push(format!("{shown}: {SUMMARY} calls it `{title}`: begin it with that heading"))
            }
            Some(_) => found.push(format!("{SUMMARY}: {shown} is a chapter more than once")),
            None => found.push(format!("{shown}: make it a chapter of {SUMMARY}")),
        }
        let text = page.lines.iter().filter(|(_, line)| !line.starts_with('#'));
        if text.flat_map(|(_, line)| line.split_whitespace()).count() < WORDS {
            found.push(format!("{shown}: hardly a word: write it, or take it out of {SUMMARY}"));
        }
    }
    nothing(found);
}

#[test]
fn links_lead_somewhere() {
    let mut pages = below(Path::new("docs"));
    pages.extend(OTHERS.iter().map(PathBuf::from));
    let pages: BTreeMap<PathBuf, Page> =
        pages.into_iter().map(|file| (file.clone(), Page::read(&file))).collect();
    let anchors: BTreeMap<&PathBuf, BTreeSet<String>> =
        pages.iter().map(|(file, page)| (file, page.anchors())).collect();
    let mut found = Vec::new();
    for page in pages.values() {
        for (line, _, target) in page.links() {
            let place = format!("{}:{line}", page.file.display());
            let (path, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let folder = page.file.parent().expect("a file lies in a folder");
            let file = if path.is_empty() { page.file.clone() } else { normal(&folder.join(path)) };
            if !top().join(&file).exists() {
                found.push(format!("{place}: there is no {}", file.display()));
            } else if page.file.starts_with("docs") && !file.starts_with("docs") {
                // The book has only what is below `docs/`.
                found.push(format!("{place}: {} is not in the book: name it without a link", file.display()));
            } else if !anchor.is_empty() && !anchors.get(&file).is_some_and(|known| known.contains(anchor)) {
                found.push(format!("{place}: {} has no heading for #{anchor}", file.display()));
            }
        }
    }
    nothing(found);
}
