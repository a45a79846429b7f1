//! How far a comparison is: a bar on a terminal, a line for each run elsewhere.

use crate::output::Output;
use hyperplan_compare::{Record, RunStatus, checked};
use hyperplan_outlet::one_line;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, IsTerminal as _};
use std::time::{Duration, Instant};

/// Tells what was done and what is left.
pub(crate) struct Progress<'a> {
    out: &'a Output,
    verbose: bool,
    bar: Option<ProgressBar>,
    start: Instant,
    done: usize,
    all: usize,
}

impl<'a> Progress<'a> {
    pub(crate) fn new(all: usize, verbose: bool, out: &'a Output) -> Self {
        let bar = (io::stderr().is_terminal() && !out.is_quiet() && all > 0).then(|| {
            let bar = ProgressBar::new(all as u64);
            let template = "{bar:30} {pos}/{len}, {elapsed} so far, {eta} left  {wide_msg}";
            bar.set_style(
                ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()),
            );
            bar.enable_steady_tick(Duration::from_millis(500));
            bar
        });
        Progress { out, verbose, bar, start: Instant::now(), done: 0, all }
    }

    /// A run has begun.
    pub(crate) fn started(&self, label: &str) {
        if let Some(bar) = &self.bar {
            bar.set_message(label.to_owned());
        }
    }

    /// A run has ended.
    pub(crate) fn finished(&mut self, label: &str, record: &Record) {
        self.done += 1;
        let mut line = format!("{label}: {} {:.2} s", record.status, record.wall_s);
        if let (RunStatus::Error, Some(message), false) = (record.status, &record.message, self.verbose) {
            line.push_str(&format!(" ({})", one_line(message)));
        }
        let below = if self.verbose { details(record) } else { String::new() };
        match &self.bar {
            None => {
                if !self.out.is_quiet() {
                    self.out.lines(format_args!("[{}/{}] {line}{}{below}", self.done, self.all, self.left()));
                }
            }
            Some(bar) => {
                // What went wrong stays to be read.
                if self.verbose || record.status == RunStatus::Error {
                    bar.println(line + &below);
                }
                bar.inc(1);
            }
        }
    }

    /// An estimate, once it is worth something.
    fn left(&self) -> String {
        let each = self.start.elapsed().as_secs_f64() / self.done.max(1) as f64;
        let seconds = each * self.all.saturating_sub(self.done) as f64;
        match seconds {
            s if s >= 3600.0 => format!(", about {:.1} h left", s / 3600.0),
            s if s >= 60.0 => format!(", about {:.0} min left", s / 60.0),
            s if s >= 1.0 => format!(", about {s:.0} s left"),
            _ => String::new(),
        }
    }
}

impl Drop for Progress<'_> {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// How a run was verified, what it took and what it said, on lines of their own.
fn details(record: &Record) -> String {
    let verified = record.verified.as_deref().map(|how| format!("{}; ", checked(how))).unwrap_or_default();
    let mut text = format!("\n    {verified}CPU {:.2} s, memory {:.1} MiB", record.cpu_s, record.memory_mib);
    for line in record.message.iter().flat_map(|message| message.lines()) {
        text.push_str(&format!("\n    {}", one_line(line)));
    }
    text
}
