//! The machine that runs are done on.

use std::io;

/// The model of the processors, as the system calls it.
#[must_use]
pub fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let named = |line: &str| {
        let (name, value) = line.split_once(':')?;
        // On ARM the system says no more than numbers.
        ["model name", "cpu model", "cpu"].contains(&name.trim()).then(|| value.trim().to_owned())
    };
    text.lines().find_map(named).filter(|model| !model.is_empty())
}

/// One CPU of each core that this process may use, in order: two threads of one core slow each other down.
///
/// # Errors
/// Where the system does not say.
#[cfg(target_os = "linux")]
pub fn cores() -> io::Result<Vec<usize>> {
    let allowed = rustix::thread::sched_getaffinity(None)?;
    let mut cores = Vec::new();
    let mut taken = std::collections::BTreeSet::new();
    for cpu in (0..rustix::thread::CpuSet::MAX_CPU).filter(|&cpu| allowed.is_set(cpu)) {
        let siblings = format!("/sys/devices/system/cpu/cpu{cpu}/topology/thread_siblings_list");
        // Where that is not told each is taken for a core.
        let core = std::fs::read_to_string(siblings).unwrap_or_else(|_| cpu.to_string());
        if taken.insert(core) {
            cores.push(cpu);
        }
    }
    Ok(cores)
}

/// Keeps this process, and all that it starts, on one CPU.
///
/// # Errors
/// When that is not allowed.
#[cfg(target_os = "linux")]
pub(crate) fn pin(cpu: usize) -> io::Result<()> {
    let mut only = rustix::thread::CpuSet::new();
    only.set(cpu);
    Ok(rustix::thread::sched_setaffinity(None, &only)?)
}

/// As on Linux.
///
/// # Errors
/// Always: here nobody can say.
#[cfg(not(target_os = "linux"))]
pub fn cores() -> io::Result<Vec<usize>> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn pin(_: usize) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn there_is_a_core() {
        let cores = cores().expect("the system says");
        assert!(!cores.is_empty() && cores.is_sorted(), "{cores:?}");
    }
}
