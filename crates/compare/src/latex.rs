//! Tables in LaTeX, as pdfTeX takes it with the fonts that it has by itself (LaTeX of 2020 or later).

use crate::table::Sheet;

/// More rows than this are not for one page.
const PAGE: usize = 40;

/// The packages that a table needs.
pub(crate) fn packages(sheet: &Sheet) -> &'static str {
    if is_long(sheet) { "booktabs,longtable" } else { "booktabs" }
}

fn is_long(sheet: &Sheet) -> bool {
    sheet.rows.len() > PAGE
}

/// A table in LaTeX, with the rules of the package `booktabs`; one that is too long for a page goes on on the next, by the
/// package `longtable`.
pub fn latex(sheet: &Sheet) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| latex_text(cell)).collect();
        // After the end of a line these would be an argument of it.
        let apart = if cells.first().is_some_and(|cell| cell.starts_with(['[', '*'])) { "{}" } else { "" };
        format!("  {apart}{} \\\\\n", cells.join(" & "))
    };
    let columns: String = sheet.text.iter().map(|text| if *text { 'l' } else { 'r' }).collect();
    let head = format!("  \\toprule\n{}  \\midrule\n", line(&sheet.head));
    let (name, ends) = if is_long(sheet) {
        ("longtable", "  \\endhead\n  \\bottomrule\n  \\endfoot\n")
    } else {
        ("tabular", "")
    };
    let mut text = format!("\\begin{{{name}}}{{{columns}}}\n{head}{ends}");
    for row in &sheet.rows {
        // The virtual best solver has no place.
        if row.first().is_some_and(String::is_empty) {
            text.push_str("  \\midrule\n");
        }
        text.push_str(&line(row));
    }
    if ends.is_empty() {
        text.push_str("  \\bottomrule\n");
    }
    text.push_str(&format!("\\end{{{name}}}\n"));
    text
}

/// What LaTeX sets as the same characters.
fn latex_text(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '#' | '$' | '%' | '&' | '_' | '{' | '}' => escaped.extend(['\\', c]),
            '\\' => escaped.push_str(r"\textbackslash{}"),
            '~' => escaped.push_str(r"\textasciitilde{}"),
            '^' => escaped.push_str(r"\textasciicircum{}"),
            '<' => escaped.push_str(r"\textless{}"),
            '>' => escaped.push_str(r"\textgreater{}"),
            // TeX's first fonts have a dash and curved quotes in these places.
            '|' => escaped.push_str(r"\textbar{}"),
            '\'' => escaped.push_str(r"\textquotesingle{}"),
            '`' => escaped.push_str(r"\textasciigrave{}"),
            '"' => escaped.push_str(r#"\texttt{"}"#),
            // Two would become a dash or a quote.
            '-' | ',' if escaped.ends_with(c) => escaped.extend(['{', '}', c]),
            ' '..='~' => escaped.push(c),
            _ => escaped.push_str(&beyond_ascii(c)),
        }
    }
    escaped
}

/// Lower-case Greek letters, from alpha on.
const GREEK: [&str; 25] = [
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu",
    "nu", "xi", "o", "pi", "rho", "varsigma", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega",
];
/// Upper-case ones, which TeX has where there is no Latin letter of that form; a gap where the final sigma is.
const GREEK_CAPITALS: [&str; 25] = [
    "A", "B", "Gamma", "Delta", "E", "Z", "H", "Theta", "I", "K", "Lambda", "M", "N", "Xi", "O", "Pi", "P",
    "", "Sigma", "T", "Upsilon", "Phi", "X", "Psi", "Omega",
];
/// Of Latin-1 and Latin Extended-A, what the first fonts have no way to compose.
const NOT_COMPOSED: &str = "«»ÐÞðþĄąĐđĘęĦħĮįĸĿŀŉŊŋŦŧŲųſ";

/// Letters with accents are known to LaTeX, Greek ones are for formulas; of others there is the code point.
fn beyond_ascii(c: char) -> String {
    let formula = |name: &str| match name.len() {
        1 => format!(r"\ensuremath{{\mathrm{{{name}}}}}"),
        _ => format!(r"\ensuremath{{\{name}}}"),
    };
    let letter = |from: char, names: &[&'static str]| {
        let place = u32::from(c).checked_sub(u32::from(from))?;
        names.get(usize::try_from(place).ok()?).copied().filter(|name| !name.is_empty())
    };
    let known = matches!(c, '\u{a0}'..='\u{17f}' | '–' | '—' | '‘' | '’' | '“' | '”' | '…' | '€');
    match c {
        '≤' => formula("le"),
        '≥' => formula("ge"),
        '∀' => formula("forall"),
        '∃' => formula("exists"),
        _ if known && !NOT_COMPOSED.contains(c) => c.to_string(),
        _ => match letter('α', &GREEK).or_else(|| letter('Α', &GREEK_CAPITALS)) {
            Some(name) => formula(name),
            None => format!(r"\textless{{}}U+{:04X}\textgreater{{}}", u32::from(c)),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::latex_text;

    #[test]
    fn beyond_ascii() {
        assert_eq!(latex_text("é–š"), "é–š");
        assert_eq!(latex_text("Ωσ"), r"\ensuremath{\Omega}\ensuremath{\sigma}");
        assert_eq!(latex_text("Ρο"), r"\ensuremath{\mathrm{P}}\ensuremath{\mathrm{o}}");
        assert_eq!(latex_text("ς\u{3a2}"), r"\ensuremath{\varsigma}\textless{}U+03A2\textgreater{}");
        assert_eq!(latex_text("đ漢"), r"\textless{}U+0111\textgreater{}\textless{}U+6F22\textgreater{}");
    }

    #[test]
    fn nothing_is_drawn_together() {
        assert_eq!(latex_text("--a|b,,"), r"-{}-a\textbar{}b,{},");
        assert_eq!(
            latex_text("'a`\"\n"),
            "\\textquotesingle{}a\\textasciigrave{}\\texttt{\"}\\textless{}U+000A\\textgreater{}"
        );
    }
}
