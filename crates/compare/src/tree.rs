//! All that a process has started, directly or not: what it takes, and its end.
//!
//! On Linux this process adopts whatever is left by a parent that ended ([`adopt`]), so that nothing
//! leaves the tree, in whatever group or session it puts itself. Elsewhere there is only the group of the first process.
//!
//! Not by `procfs`, which was tried: it reads a `status` file only if all of some twenty fields are there, where sandboxes
//! such as gVisor leave some out, so that memory would be measured as nothing; and what is longest here, to find the tree
//! with or without the kernel's lists of children, stays as long.

use rustix::process::{Pid, Signal};

/// What a tree takes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Load {
    /// CPU time of what is running now, and of what that has waited for, in seconds.
    pub(crate) cpu_s: f64,
    /// Memory in use now, all processes together, in bytes.
    pub(crate) memory: u64,
    /// The most that one process has used by itself at any time, in bytes.
    pub(crate) largest: u64,
}

#[cfg(target_os = "linux")]
pub(crate) use linux::{adopt, kill, load, own_peak};

#[cfg(target_os = "linux")]
mod linux {
    use super::{Load, Pid, Signal};
    use std::collections::BTreeMap;
    use std::fs;

    /// Makes this process the parent of whatever in its tree loses its own.
    pub(crate) fn adopt() {
        // It cannot fail; if it did, only a process that has left its parent's group would get away.
        let _ = rustix::process::set_child_subreaper(Some(rustix::process::getpid()));
    }

    /// What the processes below this one take.
    pub(crate) fn load() -> Load {
        let mut load = Load::default();
        for pid in descendants() {
            // One that has just ended is in the numbers of who waited for it.
            if let Some(own) =
                fs::read_to_string(format!("/proc/{pid}/stat")).ok().and_then(|stat| cpu(&stat))
            {
                load.cpu_s += own;
            }
            if let Ok(status) = fs::read_to_string(format!("/proc/{pid}/status")) {
                load.memory += bytes(&status, "VmRSS:");
                load.largest = load.largest.max(bytes(&status, "VmHWM:"));
            }
        }
        load
    }

    /// The most memory that this process has used.
    pub(crate) fn own_peak() -> u64 {
        fs::read_to_string("/proc/self/status").map_or(0, |status| bytes(&status, "VmHWM:"))
    }

    /// Kills everything below this process.
    pub(crate) fn kill(_first: Pid) {
        for pid in descendants() {
            if let Some(pid) = i32::try_from(pid).ok().and_then(Pid::from_raw) {
                // It may just have ended.
                let _ = rustix::process::kill_process(pid, Signal::KILL);
            }
        }
    }

    /// Processes below this one, parents first.
    fn descendants() -> Vec<u32> {
        let mut found = vec![std::process::id()];
        let mut next = 0;
        let mut parents = None;
        while let Some(pid) = found.get(next).copied() {
            next += 1;
            let children = listed(pid).unwrap_or_else(|| {
                let all = parents.get_or_insert_with(by_parent);
                all.get(&pid).cloned().unwrap_or_default()
            });
            found.extend(children.into_iter().filter(|child| *child != pid));
        }
        found.remove(0);
        found
    }

    /// The children of a process, as the kernel lists them for each of its threads; `None` where this kernel does not.
    fn listed(pid: u32) -> Option<Vec<u32>> {
        let mut children = Vec::new();
        // A process that has ended has no children.
        let Ok(threads) = fs::read_dir(format!("/proc/{pid}/task")) else { return Some(children) };
        for thread in threads.flatten() {
            match fs::read_to_string(thread.path().join("children")) {
                Ok(list) => {
                    children.extend(list.split_whitespace().filter_map(|pid| pid.parse::<u32>().ok()))
                }
                // The thread may have ended, or the kernel may have no such file for anybody.
                Err(_) if !fs::exists("/proc/thread-self/children").unwrap_or(false) => return None,
                Err(_) => {}
            }
        }
        Some(children)
    }

    /// The children of every process.
    pub(super) fn by_parent() -> BTreeMap<u32, Vec<u32>> {
        let mut all: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
        for pid in entries.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok()) {
            let stat = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
            if let Some(parent) = field(&stat, 4).and_then(|parent| u32::try_from(parent).ok()) {
                all.entry(parent).or_default().push(pid);
            }
        }
        all
    }

    /// User and system time, with that of children waited for.
    fn cpu(stat: &str) -> Option<f64> {
        let ticks: u64 = (14..=17).map(|number| field(stat, number)).sum::<Option<u64>>()?;
        Some(ticks as f64 / rustix::param::clock_ticks_per_second() as f64)
    }

    /// A field of a `stat` file, counted from 1. The second is a name in parentheses, which may have any characters.
    pub(super) fn field(stat: &str, number: usize) -> Option<u64> {
        let (_, rest) = stat.rsplit_once(')')?;
        rest.split_whitespace().nth(number.checked_sub(3)?)?.parse().ok()
    }

    /// A size in a `status` file, where it is in KiB.
    pub(super) fn bytes(status: &str, name: &str) -> u64 {
        let line = status.lines().find_map(|line| line.strip_prefix(name));
        let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
        kib.unwrap_or(0) << 10
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use std::process::{Command, Stdio};

        #[test]
        fn fields_after_a_strange_name() {
            let stat = "12 (a) b (c) S 7 12 12 0 -1 4194560 1 2 3 4 50 60 70 80 20 0";
            assert_eq!((field(stat, 4), field(stat, 14), field(stat, 17)), (Some(7), Some(50), Some(80)));
            let second = rustix::param::clock_ticks_per_second() as f64;
            assert_eq!(cpu(stat), Some(260.0 / second));
            assert_eq!(cpu("12 (a"), None);
            assert_eq!(bytes("VmPeak:\t 9 kB\nVmRSS:\t  20 kB\n", "VmRSS:"), 20 << 10);
        }

        #[test]
        fn both_ways_to_find_children() {
            // The shell has two children, whatever it does with the last command.
            let script = "sleep 300 & sleep 300 & wait";
            let mut shell = Command::new("sh")
                .args(["-c", script])
                .stdout(Stdio::null())
                .spawn()
                .expect("every Unix has sh");
            let end = std::time::Instant::now() + std::time::Duration::from_secs(20);
            let mut found = Vec::new();
            while found.len() < 2 && std::time::Instant::now() < end {
                found = by_parent().remove(&shell.id()).unwrap_or_default();
            }
            assert_eq!(found.len(), 2);
            if let Some(mut listed) = listed(shell.id()) {
                listed.sort_unstable();
                found.sort_unstable();
                assert_eq!(listed, found);
            }
            for pid in found {
                let pid = i32::try_from(pid).ok().and_then(Pid::from_raw).expect("it is a process");
                let _ = rustix::process::kill_process(pid, Signal::KILL);
            }
            shell.wait().expect("it ends");
        }
    }
}

#[cfg(not(target_os = "linux"))]
pub(crate) use elsewhere::{adopt, kill, load, own_peak};

#[cfg(not(target_os = "linux"))]
mod elsewhere {
    use super::{Load, Pid, Signal};

    pub(crate) fn adopt() {}

    /// Not known while it runs.
    pub(crate) fn load() -> Load {
        Load::default()
    }

    pub(crate) fn own_peak() -> u64 {
        0
    }

    /// Kills the group. What has left it is the business of who started it.
    pub(crate) fn kill(first: Pid) {
        let _ = rustix::process::kill_process_group(first, Signal::KILL);
    }
}
