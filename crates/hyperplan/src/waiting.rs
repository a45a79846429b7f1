//! How far a search is, for those who wait: a line that changes on a terminal, now and then a line elsewhere.

use crate::output::Output;
use hyperplan_plan::Watch;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, IsTerminal as _, Write as _};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// When the first word is said on a terminal, and how often it changes.
const SOON: Duration = Duration::from_secs(1);
const TICK: Duration = Duration::from_millis(200);

/// When the first line is said elsewhere, and for those who want to know more; each later one takes twice as long.
const PATIENCE: Duration = Duration::from_secs(5);
const EAGER: Duration = Duration::from_secs(1);

/// Says how far a search is, until it is dropped.
pub(crate) struct Waiting {
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Waiting {
    /// Begins to say it on standard error, unless nothing but results is wanted. Where there is no thread to be had, nobody
    /// is told.
    pub(crate) fn begin(watch: &Watch, verbose: bool, out: &Output) -> Waiting {
        let none = Waiting { end: None, thread: None };
        if out.is_quiet() {
            return none;
        }
        let watch = watch.clone();
        let (end, ended) = mpsc::channel();
        let tell = move || {
            let over = |time| !matches!(ended.recv_timeout(time), Err(RecvTimeoutError::Timeout));
            if io::stderr().is_terminal() {
                on_terminal(&watch, &over);
            } else {
                elsewhere(&watch, if verbose { EAGER } else { PATIENCE }, &over);
            }
        };
        match thread::Builder::new().name("waiting".to_owned()).spawn(tell) {
            Ok(thread) => Waiting { end: Some(end), thread: Some(thread) },
            Err(_) => none,
        }
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn on_terminal(watch: &Watch, over: &dyn Fn(Duration) -> bool) {
    if over(SOON) {
        return;
    }
    let style = ProgressStyle::with_template("{spinner} {elapsed} {wide_msg}");
    let bar =
        ProgressBar::new_spinner().with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    bar.set_elapsed(SOON);
    loop {
        bar.set_message(watch.standing().to_string());
        bar.tick();
        if over(TICK) {
            break;
        }
    }
    bar.finish_and_clear();
}

fn elsewhere(watch: &Watch, first: Duration, over: &dyn Fn(Duration) -> bool) {
    let start = Instant::now();
    let mut next = first;
    while !over(next.saturating_sub(start.elapsed())) {
        // Nobody has to read it.
        let _ = writeln!(io::stderr(), "after {} s: {}", next.as_secs(), watch.standing());
        next *= 2;
    }
}
