//! Ways between files.

use std::path::{Component, Path, PathBuf};

/// The way from a folder to a file, both absolute: they may be moved together.
pub(crate) fn relative(from: &Path, to: &Path) -> PathBuf {
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return to.to_owned();
    }
    let up = from.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(to.components().skip(shared)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_to_a_file() {
        let way = |folder: &str, file: &str| relative(Path::new(folder), Path::new(file));
        assert_eq!(way("/a/b", "/a/b/c.hp"), Path::new("c.hp"));
        assert_eq!(way("/a/b/out", "/a/specs/c.hp"), Path::new("../../specs/c.hp"));
        assert_eq!(way("/a", "/b/c d.hp"), Path::new("../b/c d.hp"));
    }
}
