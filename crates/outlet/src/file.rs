//! Files are there whole, or as they were before, whenever this process or the machine ends and however full the disk is.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Writes a file, or leaves what was there; what is no regular file, such as a device, is written as it comes. How many
/// bytes it has.
///
/// # Errors
/// When it cannot be written, or `print` fails.
pub fn write(path: &Path, print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<u64> {
    let known = std::fs::metadata(path).ok();
    if known.as_ref().is_some_and(|known| !known.is_file()) {
        let mut device = BufWriter::new(File::create(path)?);
        print(&mut device)?;
        return device.flush().map(|()| 0);
    }
    // A link stays a link.
    let path = &if known.is_some() { path.canonicalize()? } else { path.to_owned() };
    let file = printed(folder_of(path), print)?;
    if let Some(known) = known {
        file.as_file().set_permissions(known.permissions())?;
    }
    file.as_file().sync_data()?;
    let bytes = file.as_file().metadata()?.len();
    file.persist(path)?;
    Ok(bytes)
}

/// Writes a new file under the first of those names in a folder that is free, and says which that was. There is nothing
/// old to lose, so that nobody has to wait for the disk.
///
/// # Errors
/// When it cannot be written, `print` fails, or no name is free.
pub fn create(
    folder: &Path,
    names: impl IntoIterator<Item = impl AsRef<Path>>,
    print: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<PathBuf> {
    let mut file = printed(folder, print)?;
    for name in names {
        let path = folder.join(name);
        file = match file.persist_noclobber(&path) {
            Ok(_) => return Ok(path),
            Err(failed) if failed.error.kind() == io::ErrorKind::AlreadyExists => failed.file,
            Err(failed) => return Err(failed.error),
        };
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

/// Where a file is.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A temporary file with what is to be written. It goes if it is not given a name.
fn printed(folder: &Path, print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<NamedTempFile> {
    let mut options = tempfile::Builder::new();
    #[cfg(unix)]
    options.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = options.tempfile_in(folder)?;
    let mut buffer = BufWriter::new(file.as_file_mut());
    print(&mut buffer)?;
    buffer.flush()?;
    drop(buffer);
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the folder is ours").flatten();
        let mut names: Vec<String> =
            entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn what_fails_leaves_what_was_there() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a");
        let cut = |to: &mut dyn Write| {
            to.write_all(&[0; 100_000])?;
            Err(io::ErrorKind::StorageFull.into())
        };
        assert_eq!(write(&path, cut).map_err(|e| e.kind()), Err(io::ErrorKind::StorageFull));
        assert!(create(folder.path(), ["b"], cut).is_err());
        assert_eq!(names(folder.path()), [""; 0]);
        assert_eq!(write(&path, |to| to.write_all(b"old")).ok(), Some(3));
        assert!(write(&path, cut).is_err());
        assert_eq!(
            (names(folder.path()), fs::read(&path).ok()),
            (vec!["a".to_owned()], Some(b"old".to_vec()))
        );
        assert_eq!(write(&path, |to| to.write_all(b"newer")).ok(), Some(5));
        assert_eq!(fs::read(&path).ok(), Some(b"newer".to_vec()));
    }

    #[test]
    fn a_new_file_replaces_none() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let first = |text: &'static [u8]| create(folder.path(), ["a", "b"], |to| to.write_all(text));
        assert_eq!(first(b"1").ok(), Some(folder.path().join("a")));
        assert_eq!(first(b"2").ok(), Some(folder.path().join("b")));
        assert_eq!(first(b"3").map_err(|e| e.kind()), Err(io::ErrorKind::AlreadyExists));
        let read = |name: &str| fs::read(folder.path().join(name)).ok();
        assert_eq!((read("a"), read("b")), (Some(b"1".to_vec()), Some(b"2".to_vec())));
        assert_eq!(names(folder.path()), ["a", "b"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_device_a_device() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").expect("the folder is ours");
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("ours");
        symlink(&file, &link).expect("ours");
        assert_eq!(write(&link, |to| to.write_all(b"new")).ok(), Some(3));
        assert!(link.is_symlink() && fs::read(&file).is_ok_and(|bytes| bytes == b"new"));
        assert_eq!(fs::metadata(&file).map(|data| data.permissions().mode() & 0o777).ok(), Some(0o640));
        assert_eq!(write(Path::new("/dev/null"), |to| to.write_all(b"gone")).ok(), Some(0));
    }
}
