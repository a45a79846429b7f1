//! Command lines of solvers, and lists of them.

use std::path::Path;

/// The parts between commas that are outside of quotes.
pub(crate) fn split_list(text: &str) -> Vec<&str> {
    let mut quote = None;
    let separates = |c: char| {
        match quote {
            Some(open) if c == open => quote = None,
            None if c == '"' || c == '\'' => quote = Some(c),
            _ => {}
        }
        c == ',' && quote.is_none()
    };
    text.split(separates).collect()
}

/// Whether a command line is a program alone, with the name of this one or that name and a version.
pub(super) fn is_kind(line: &str, program: &str) -> bool {
    // Parts of the names of what is downloaded.
    const SYSTEMS: &str = "linux macos osx windows win win64 x64 x86 arm64 aarch64 glibc static shared gpl";
    let (words, plain) = (split_words(line), |name: &str| name.to_lowercase().replace('_', "-"));
    let [word] = words.as_slice() else { return false };
    let [name, program] = [word.as_str(), program].map(|path| {
        let name = Path::new(path).file_name().unwrap_or_default().to_string_lossy();
        let name = plain(&name);
        name.strip_suffix(".exe").unwrap_or(&name).to_owned()
    });
    let part = |part: &str| {
        let number = part.strip_prefix('v').unwrap_or(part);
        number.starts_with(|c: char| c.is_ascii_digit()) || SYSTEMS.split(' ').any(|system| system == part)
    };
    match name.strip_prefix(&program) {
        Some("") => true,
        Some(rest) => rest.strip_prefix(['-', '.']).is_some_and(|rest| rest.split(['-', '.']).all(part)),
        None => false,
    }
}

/// Words between blanks; single or double quotes keep blanks together.
pub(super) fn split_words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in line.chars() {
        match quote {
            Some(q) if c == q => quote = None,
            None if c == '"' || c == '\'' => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            None if c.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_of_a_kind() {
        for (line, program) in [
            ("/usr/bin/z3", "z3"),
            ("./z3-4.8", "z3"),
            ("z3-4.8.12-x64-glibc", "z3-4.8.12-x64-glibc"),
            ("z3_4_8_12", "z3"),
            ("'/opt/my solvers/Z3.EXE'", "/opt/z3/bin/z3"),
            ("cvc5-v1.2-Linux-static", "cvc5"),
            ("cvc5-Win64.exe", "cvc5"),
            ("/x/yices_smt2", "yices-smt2"),
            ("yices-smt2.2.6.5", "yices-smt2"),
        ] {
            assert!(is_kind(line, program), "{line}");
        }
        for line in ["z3 -in", "/z3/fake", "z3x", "z33", "z3-wrapper", "z3.sh", "z3-", "my-z3", "", "''"] {
            assert!(!is_kind(line, "z3"), "{line}");
        }
        // It has a language of its own.
        assert!(!is_kind("/usr/bin/yices", "yices-smt2"));
    }
}
