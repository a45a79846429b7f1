//! Which known name was probably meant.

/// Names of so many letters and more are no slips of the pen, and take long to compare.
const LONGEST: usize = 65;
/// No more candidates are looked at: files made by programs may have thousands of names, and as many mistakes.
const MOST: usize = 1000;

/// The candidate that is spelled most like `name`, if one is close enough to be a slip of the pen.
///
/// Distance is Damerau-Levenshtein, case counting as half an error at most: one slip in names of up
/// to four letters, two up to eight, three beyond. Of equally close candidates the first is taken.
/// A name is never similar to itself. Names of more than 64 letters, and candidates beyond the first thousand, are not
/// compared.
#[must_use]
pub fn similar<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let length = name.chars().count();
    let allowed = match length {
        0 | LONGEST.. => return None,
        1..=4 => 1,
        5..=8 => 2,
        _ => 3,
    };
    let lower = name.to_lowercase();
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates.take(MOST) {
        let other = candidate.chars().count();
        // One letter for another says nothing.
        if candidate == name || other.abs_diff(length) > allowed || (length.max(other) == 1) {
            continue;
        }
        let plain = strsim::damerau_levenshtein(name, candidate) * 2;
        let folded = strsim::damerau_levenshtein(&lower, &candidate.to_lowercase()) * 2 + 1;
        let distance = plain.min(folded);
        // Half of the letters must be right.
        if distance > allowed * 2 + 1
            || distance >= length.max(other) * 2 - 1
            || distance > length.max(other) + 1
        {
            continue;
        }
        if best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::similar;

    #[test]
    fn finds_slips() {
        let known = ["start", "goal", "crash", "x", "y", "objective"];
        let find = |name| similar(name, known.into_iter());
        assert_eq!(find("gaol"), Some("goal"));
        assert_eq!(find("goa"), Some("goal"));
        assert_eq!(find("Goal"), Some("goal"));
        assert_eq!(find("GOAL"), Some("goal"));
        assert_eq!(find("strat"), Some("start"));
        assert_eq!(find("objectiv"), Some("objective"));
        assert_eq!(find("water"), None);
        assert_eq!(find("z"), None);
        assert_eq!(find(""), None);
        assert_eq!(find("goal"), None);
    }
}
