//! What a page of `docs/` holds: fenced blocks, contexts and pictures.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The folder of the pages.
pub(crate) const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");

/// What the page holds, in its order.
#[derive(Default)]
pub(crate) struct Page {
    pub(crate) contexts: BTreeMap<String, String>,
    pub(crate) blocks: Vec<Block>,
    /// The names of the files in `docs/pictures/` that it shows.
    pub(crate) pictures: Vec<String>,
}

/// A fenced block.
pub(crate) struct Block {
    /// The line of its opening fence.
    pub(crate) line: usize,
    pub(crate) info: String,
    pub(crate) text: String,
}

impl Block {
    pub(crate) fn words(&self) -> Vec<&str> {
        self.info.split_whitespace().collect()
    }
}

/// The README and all pages below `docs/`, by their names.
pub(crate) fn pages() -> Vec<(String, PathBuf)> {
    let docs = Path::new(DOCS);
    let mut pages = vec![("readme".to_owned(), docs.join("../README.md"))];
    for (folder, first) in [(docs.to_owned(), "introduction"), (docs.join("tutorials"), "tutorials")] {
        let entries = std::fs::read_dir(folder).expect("it is there");
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
        paths.retain(|path| path.extension() == Some("md".as_ref()));
        paths.sort();
        for path in paths {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            pages.push((if stem == "README" { first.to_owned() } else { stem }, path));
        }
    }
    pages
}

/// Takes the page apart.
pub(crate) fn page(text: &str) -> Result<Page, String> {
    let mut page = Page::default();
    let mut lines = (1..).zip(text.lines());
    while let Some((line, content)) = lines.next() {
        let mut until = |end: &str| -> Result<String, String> {
            let mut body = String::new();
            for (_, inner) in lines.by_ref() {
                if inner.trim() == end {
                    return Ok(body);
                }
                body += inner;
                body.push('\n');
            }
            Err(format!("what begins in line {line} does not end"))
        };
        if let Some(info) = content.trim_start().strip_prefix("```") {
            page.blocks.push(Block { line, info: info.trim().to_owned(), text: until("```")? });
        } else if let Some(name) = content.strip_prefix("<!-- context ") {
            if page.contexts.insert(name.trim().to_owned(), until("-->")?).is_some() {
                return Err(format!("line {line}: a second context of that name"));
            }
        } else {
            let links = content.split("](").skip(1).filter_map(|link| link.split(')').next());
            page.pictures.extend(links.filter_map(|link| {
                let link = Path::new(link);
                let shown = link.parent().is_some_and(|folder| folder.ends_with("pictures"));
                Some(link.file_name().filter(|_| shown)?.to_string_lossy().into_owned())
            }));
        }
    }
    Ok(page)
}

impl Page {
    /// The fragment in its context.
    pub(crate) fn wrapped(&self, context: &str, fragment: &str) -> Result<String, String> {
        let around = self.contexts.get(context).ok_or_else(|| format!("no context `{context}`"))?;
        match around.split_once("...\n") {
            Some((before, after)) => Ok(format!("{before}{fragment}{after}")),
            None => Err(format!("the context `{context}` has no line `...`")),
        }
    }
}

/// That the text is a part of the file, but for how far it is indented.
pub(crate) fn is_part(text: &str, file: &Path) -> Result<(), String> {
    let whole = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let (whole, shown): (Vec<&str>, Vec<&str>) = (whole.lines().collect(), text.lines().collect());
    let found = whole.windows(shown.len().max(1)).any(|part| {
        let indent = &part[0][..part[0].len() - part[0].trim_start().len()];
        part.iter().zip(&shown).all(|(line, shown)| line.strip_prefix(indent).unwrap_or(line) == *shown)
    });
    if found { Ok(()) } else { Err(format!("this is no part of {}:\n{text}", file.display())) }
}
