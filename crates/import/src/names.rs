//! Names in the problem language: those of the original wherever they can be names there too.

use hyperplan_syntax::is_name;
use rustc_hash::FxHashSet;

/// Names that mean something of their own in objectives.
const RESERVED: [&str; 5] = ["action", "state", "obs", "enabled", "none"];

/// Gives names that differ.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names {
    taken: FxHashSet<String>,
}

impl Names {
    /// A name for what is called so in the original.
    pub(crate) fn name(&mut self, original: &str) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '.' | '[' | ']') { c } else { '_' };
        let mut name: String = original.chars().map(plain).collect();
        if name.starts_with(|c: char| !c.is_ascii_alphabetic() && c != '_') {
            name.insert(0, '_');
        }
        if !is_name(&name) && name.contains(['.', '[']) {
            name = name.replace(['.', '[', ']'], "_");
        }
        while !is_name(&name) || RESERVED.contains(&name.as_str()) || self.taken.contains(&name) {
            name.push('_');
        }
        self.taken.insert(name.clone());
        name
    }
}
