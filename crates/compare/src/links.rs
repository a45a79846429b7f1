//! Links from the page to files beside it: whatever a record says, they are relative, and lead to what is there.

use std::ffi::OsStr;
use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};
use std::{fs, path};

use crate::paths::relative;

/// So many files are linked one by one.
const FEW: usize = 6;

/// A link and what it is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) href: String,
}

/// Where links begin.
pub(crate) struct Links<'a> {
    folder: PathBuf,
    log: &'a str,
}

impl<'a> Links<'a> {
    /// Of a page in that folder; `log` leads from there to the log, where the records' queries are.
    pub(crate) fn new(folder: &Path, log: &'a str) -> Self {
        Self { folder: folder.canonicalize().unwrap_or_else(|_| folder.to_owned()), log }
    }

    /// To the largest query of a run; to their folder where that cannot be read.
    pub(crate) fn largest(&self, queries: &str) -> String {
        let largest = self.files(queries).into_iter().max();
        self.kept(queries, largest.as_ref().map(|(_, name)| name.as_str()))
    }

    /// To the queries of a run, or the largest of many and the folder of all.
    pub(crate) fn queries(&self, queries: &str) -> Vec<Link> {
        let mut files = self.files(queries);
        files.sort_by(|a, b| a.1.cmp(&b.1));
        let link = |name: &str, file| Link { name: name.to_owned(), href: self.kept(queries, file) };
        match files.iter().max() {
            None => vec![link("all", None)],
            Some((_, name)) if files.len() > FEW => {
                vec![link(name, Some(name)), link(&format!("all {}", files.len()), None)]
            }
            Some(_) => files.iter().map(|(_, name)| link(name, Some(name))).collect(),
        }
    }

    /// To the file of an instance, be it a query or an objective of a problem file, where it can still be found from the
    /// current folder.
    pub(crate) fn instance(&self, name: &str) -> Option<String> {
        let problem = name.rsplit_once('#').map(|(file, _)| file);
        let file = [name].into_iter().chain(problem).map(Path::new).find(|file| {
            let is_input = |extension: &OsStr| ["hp", "smt2", "smt"].iter().any(|input| extension == *input);
            file.extension().is_some_and(is_input) && file.is_file()
        })?;
        let file = path::absolute(file).ok()?;
        let folder = file.parent()?.canonicalize().ok()?;
        Some(encoded(&[relative(&self.folder, &folder.join(file.file_name()?)).to_str()?]))
    }

    /// The files in a folder of queries, with their lengths; nothing of a folder that is not below the log's.
    fn files(&self, queries: &str) -> Vec<(u64, String)> {
        if !Path::new(queries).components().all(|part| matches!(part, Component::Normal(_))) {
            return Vec::new();
        }
        let entries = fs::read_dir(self.folder.join(self.log).join(queries)).into_iter().flatten().flatten();
        let sized = entries.filter_map(|entry| {
            let data = entry.metadata().ok().filter(fs::Metadata::is_file)?;
            Some((data.len(), entry.file_name().into_string().ok()?))
        });
        sized.collect()
    }

    fn kept(&self, queries: &str, file: Option<&str>) -> String {
        encoded(&[self.log, queries, file.unwrap_or_default()])
    }
}

/// A relative link, whatever its parts look like.
fn encoded(parts: &[&str]) -> String {
    let mut link = String::from("./");
    for part in parts.iter().filter(|part| !part.is_empty()) {
        if !link.ends_with('/') {
            link.push('/');
        }
        for byte in part.bytes() {
            match byte {
                b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                    link.push(char::from(byte))
                }
                _ => write!(link, "%{byte:02X}").unwrap_or(()),
            }
        }
    }
    link
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_relative() {
        assert_eq!(encoded(&["..", "", "a b/ü%#?"]), "./../a%20b/%C3%BC%25%23%3F");
        assert_eq!(encoded(&["javascript:alert(1)"]), "./javascript%3Aalert%281%29");
    }

    #[test]
    fn queries_and_instances() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let (page, kept) = (dir.path().join("out"), dir.path().join("out/queries/k"));
        fs::create_dir_all(&kept).expect("ours");
        let links = Links::new(&page, "");
        assert_eq!(links.largest("queries/k"), "./queries/k");
        assert_eq!(
            links.queries("queries/k"),
            [Link { name: "all".to_owned(), href: "./queries/k".to_owned() }]
        );
        for (name, text) in [("1 a.smt2", "longest"), ("2.smt2", "short")] {
            fs::write(kept.join(name), text).expect("ours");
        }
        assert_eq!(links.largest("queries/k"), "./queries/k/1%20a.smt2");
        let names =
            |links: &[Link]| links.iter().map(|link| link.name.clone()).collect::<Vec<_>>().join(", ");
        assert_eq!(names(&links.queries("queries/k")), "1 a.smt2, 2.smt2");
        for i in 3..9 {
            fs::write(kept.join(format!("{i}.smt2")), "short").expect("ours");
        }
        assert_eq!(names(&links.queries("queries/k")), "1 a.smt2, all 8");
        // Not somewhere else.
        assert_eq!(links.largest("../out/queries/k"), "./../out/queries/k");

        let problem = dir.path().join("a#b ü.hp");
        fs::write(&problem, "").expect("ours");
        let name = |suffix: &str| format!("{}{suffix}", problem.display());
        assert_eq!(links.instance(&name("#o")).as_deref(), Some("./../a%23b%20%C3%BC.hp"));
        assert_eq!(links.instance(&name("")).as_deref(), Some("./../a%23b%20%C3%BC.hp"));
        assert_eq!(links.instance(&name("x#o")), None);
        assert_eq!(links.instance("/etc/passwd#o"), None);
    }
}
