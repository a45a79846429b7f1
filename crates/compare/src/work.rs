//! Work that machines take from a folder which they share.
//!
//! Each piece of work is a file, in one of three folders: `todo`, `taken` (with the name of who has it) and `done`.
//! It goes from one to the next by renaming, which a file system does for one of several who try at the same time, and for
//! no other. Who has a piece touches its file now and then; a file that nobody has touched for long is of somebody who has
//! died, and goes back. Whoever comes first makes the folder, under another name, and renames it too.
//!
//! If somebody was only thought to be dead, runs are done twice; nothing is lost, and putting logs together notices.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

const TODO: &str = "todo";
const TAKEN: &str = "taken";
const DONE: &str = "done";
/// What a piece has behind its number that somebody had before.
const AGAIN: char = '+';

/// A folder of work, as one of those sees it who do it.
#[derive(Clone, Debug)]
pub struct Work {
    folder: PathBuf,
    who: String,
    /// After how long without a sign of life somebody is taken for dead.
    patience: Duration,
}

/// A piece of work that is ours; it goes back when it is dropped.
#[derive(Debug)]
pub struct Piece {
    /// Its number, from 0.
    pub number: usize,
    /// Whether somebody had it before, and may have done a part of it.
    pub again: bool,
    file: PathBuf,
    folder: PathBuf,
    life: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Work {
    /// Opens a folder of work with so many pieces, which is made if there is none.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn open(folder: &Path, pieces: usize, who: &str, patience: Duration) -> io::Result<Work> {
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
        let who: String = who.chars().map(plain).collect();
        let work = Work { folder: folder.to_owned(), who, patience };
        if folder.is_dir() {
            return Ok(work);
        }
        let mut name = folder.as_os_str().to_owned();
        name.push(format!(".{}", work.who));
        let making = PathBuf::from(name);
        for part in [TODO, TAKEN, DONE] {
            fs::create_dir_all(making.join(part))?;
        }
        for number in 0..pieces {
            File::create(making.join(TODO).join(format!("{number:06}")))?;
        }
        match fs::rename(&making, folder) {
            // Somebody else was first.
            Err(_) if folder.is_dir() => fs::remove_dir_all(&making)?,
            renamed => renamed?,
        }
        Ok(work)
    }

    /// Takes a piece, the first that there is; `None` where all are taken or done.
    ///
    /// # Errors
    /// When the folder cannot be read or written.
    pub fn take(&self) -> io::Result<Option<Piece>> {
        self.return_lost()?;
        for name in names(&self.folder.join(TODO))? {
            let from = self.folder.join(TODO).join(&name);
            let again = name.ends_with(AGAIN);
            let Ok(number) = name.trim_end_matches(AGAIN).parse() else { continue };
            let file = self.folder.join(TAKEN).join(format!("{number:06}.{}", self.who));
            // Before it is ours: from then on it has to look alive.
            if touch(&from).and_then(|()| fs::rename(&from, &file)).is_err() {
                if from.exists() {
                    fs::rename(&from, &file)?;
                } else {
                    // Somebody else was first.
                    continue;
                }
            }
            let life = sign_of_life(&file, self.patience / 8)?;
            let folder = self.folder.clone();
            return Ok(Some(Piece { number, again, file, folder, life: Some(life) }));
        }
        Ok(None)
    }

    /// Whether pieces are with others.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn is_going_on(&self) -> io::Result<bool> {
        Ok(!names(&self.folder.join(TAKEN))?.is_empty())
    }

    /// Returns the pieces of those who have died.
    fn return_lost(&self) -> io::Result<()> {
        let taken = names(&self.folder.join(TAKEN))?;
        if taken.is_empty() {
            return Ok(());
        }
        // The clock of the file system, which is that of all files.
        let clock = self.folder.join(format!("clock.{}", self.who));
        let now = File::create(&clock)?.metadata()?.modified()?;
        fs::remove_file(&clock)?;
        for name in taken {
            let file = self.folder.join(TAKEN).join(&name);
            // It may have been finished meanwhile.
            let Ok(touched) = file.metadata().and_then(|data| data.modified()) else { continue };
            if now.duration_since(touched).is_ok_and(|quiet| quiet > self.patience) {
                return_to(&self.folder, &file)?;
            }
        }
        Ok(())
    }
}

impl Piece {
    /// Says that it is done.
    ///
    /// # Errors
    /// When that cannot be written.
    pub fn finish(mut self) -> io::Result<()> {
        self.rest();
        let done = self.folder.join(DONE).join(format!("{:06}", self.number));
        // Who was taken for dead has it no longer.
        if self.file.exists() { fs::rename(&self.file, done) } else { Ok(()) }
    }

    /// Ends the signs of life.
    fn rest(&mut self) {
        if let Some((stop, life)) = self.life.take() {
            drop(stop);
            let _ = life.join();
        }
    }
}

impl Drop for Piece {
    fn drop(&mut self) {
        if self.life.is_some() {
            self.rest();
            // Else it goes back once it looks dead.
            let _ = return_to(&self.folder, &self.file);
        }
    }
}

fn return_to(folder: &Path, file: &Path) -> io::Result<()> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let number = name.split('.').next().unwrap_or_default();
    match fs::rename(file, folder.join(TODO).join(format!("{number}{AGAIN}"))) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

/// The names in a folder, in order.
fn names(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        names.push(entry?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

/// By writing: then the time is that of the file system, not of this machine.
fn touch(file: &Path) -> io::Result<()> {
    File::options().write(true).open(file)?.write_all(b".")
}

/// Touches a file now and then, until the sender is dropped.
fn sign_of_life(file: &Path, every: Duration) -> io::Result<(Sender<()>, JoinHandle<()>)> {
    let (stop, stopped) = mpsc::channel();
    let file = file.to_owned();
    let life = thread::Builder::new().name("life".into()).spawn(move || {
        while stopped.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
            // Where it has gone, somebody else has it.
            if touch(&file).is_err() {
                return;
            }
        }
    })?;
    Ok((stop, life))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyperplan_random::property;
    use std::collections::BTreeSet;

    impl Piece {
        /// As if the machine had lost its power.
        fn die(mut self) {
            self.rest();
        }
    }

    #[test]
    fn each_piece_is_done_whoever_dies_or_gives_up() {
        property(12, 200, |random| {
            let top = tempfile::tempdir().expect("a temporary folder");
            let folder = top.path().join("work");
            // Long enough that whoever lives is heard of on a machine with other things to do.
            let (pieces, patience) = (1 + random.below(6), Duration::from_millis(120));
            let open = |who: &str| Work::open(&folder, pieces, who, patience).expect("the folder is ours");
            let workers = ["a", "b.c", "d/e"].map(open);
            let (mut held, mut done, mut lost) = (Vec::new(), BTreeSet::new(), BTreeSet::new());
            while done.len() < pieces {
                match workers[random.below(3)].take().expect("the folder is ours") {
                    Some(piece) => {
                        // Nobody has what another has, and what comes again was lost.
                        assert!(held.iter().all(|other: &Piece| other.number != piece.number));
                        assert!(!done.contains(&piece.number));
                        assert_eq!(piece.again, lost.contains(&piece.number));
                        held.push(piece);
                    }
                    None => std::thread::sleep(patience / 2),
                }
                if !held.is_empty() && random.flip() {
                    let piece = held.swap_remove(random.below(held.len()));
                    let number = piece.number;
                    match random.below(3) {
                        0 if lost.insert(number) => piece.die(),
                        1 if lost.insert(number) => drop(piece),
                        _ => {
                            piece.finish().expect("the folder is ours");
                            done.insert(number);
                        }
                    }
                }
            }
            assert!(workers[0].take().expect("the folder is ours").is_none());
            assert_eq!(names(&folder.join(DONE)).expect("it is there").len(), pieces);
            assert_eq!(names(top.path()).expect("it is there"), ["work"]);
        });
    }

    #[test]
    fn who_was_taken_for_dead_has_nothing_any_more() {
        let top = tempfile::tempdir().expect("a temporary folder");
        let folder = top.path().join("work");
        let work = |who| Work::open(&folder, 1, who, Duration::from_millis(20)).expect("the folder is ours");
        let mut slow = work("slow").take().expect("the folder is ours").expect("there is one");
        slow.rest();
        slow.life = Some((mpsc::channel().0, thread::spawn(|| ())));
        std::thread::sleep(Duration::from_millis(60));
        let other = work("other").take().expect("the folder is ours").expect("it came back");
        assert!(other.again);
        slow.finish().expect("that is no failure");
        assert!(work("third").is_going_on().expect("the folder is ours"));
        other.finish().expect("the folder is ours");
        assert!(!work("third").is_going_on().expect("the folder is ours"));
    }

    #[test]
    fn one_of_many_at_the_same_time_has_each() {
        let top = tempfile::tempdir().expect("a temporary folder");
        let folder = top.path().join("work");
        let taken: Vec<usize> = thread::scope(|scope| {
            let workers: Vec<_> = (0..6)
                .map(|index| {
                    let folder = &folder;
                    scope.spawn(move || {
                        let who = format!("worker-{index}");
                        let work = Work::open(folder, 40, &who, Duration::from_secs(60)).expect("ours");
                        let mut own = Vec::new();
                        while let Some(piece) = work.take().expect("ours") {
                            own.push(piece.number);
                            piece.finish().expect("ours");
                        }
                        own
                    })
                })
                .collect();
            workers.into_iter().flat_map(|worker| worker.join().expect("it did not panic")).collect()
        });
        assert_eq!(taken.len(), 40);
        assert_eq!(taken.into_iter().collect::<BTreeSet<_>>().len(), 40);
    }
}
