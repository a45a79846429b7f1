//! Diagnostics as text for people (through miette) and as data for programs.

use std::fmt;

use hyperplan_outlet::one_line;
use miette::{Diagnostic as Report, GraphicalReportHandler, GraphicalTheme, LabeledSpan, SourceCode};
use serde::Serialize;

use crate::diagnostic::{Diagnostic, Severity};
use crate::excerpt::{Excerpt, Mark};
use crate::span::{SourceMap, Span};

/// The diagnostics as text, each with its place, the line marked, and advice.
///
/// With `color`, for a terminal: colors and box-drawing characters. Without, for logs: what frames
/// the message is ASCII. The text depends on nothing but the arguments.
#[must_use]
pub fn render(sources: &SourceMap, diagnostics: &[Diagnostic], color: bool, width: usize) -> String {
    let theme = if color { GraphicalTheme::unicode() } else { GraphicalTheme::none() };
    let handler = GraphicalReportHandler::new_themed(theme).with_links(false).with_width(width.max(20));
    let mut out = String::new();
    for diagnostic in diagnostics {
        let shown = Shown::new(sources, diagnostic, width);
        if !out.is_empty() {
            out.push('\n');
        }
        // Writing to a string fails only if an excerpt cannot be read; then the message must do.
        let before = out.len();
        if handler.render_report(&mut out, &shown).is_err() {
            out.truncate(before);
            out.push_str(&shown.message);
            out.push('\n');
        }
    }
    let lines: Vec<&str> = out.lines().map(str::trim_end).collect();
    lines.join("\n") + if lines.is_empty() { "" } else { "\n" }
}

/// A diagnostic in the shape that miette renders.
#[derive(Debug)]
struct Shown {
    message: String,
    code: Option<&'static str>,
    severity: miette::Severity,
    help: Option<String>,
    excerpt: Option<Excerpt>,
    labels: Vec<LabeledSpan>,
    /// Places in other sources.
    elsewhere: Vec<Shown>,
}

impl Shown {
    fn new(sources: &SourceMap, diagnostic: &Diagnostic, width: usize) -> Shown {
        let severity = match diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
            Severity::Note => miette::Severity::Advice,
        };
        let mut places: Vec<(Span, &str)> = Vec::new();
        let mut elsewhere = Vec::new();
        places.extend(diagnostic.span.map(|span| (span, diagnostic.label.as_str())));
        for (span, words) in &diagnostic.related {
            if diagnostic.span.is_some_and(|main| main.source == span.source) {
                places.push((*span, words));
            } else {
                elsewhere.push(Shown::place(sources, *span, words, width));
            }
        }
        let mut shown = Shown::marked(sources, &diagnostic.message, severity, &places, width);
        shown.code = Some(diagnostic.code);
        shown.help = diagnostic.help.as_deref().map(|help| one_line(help).into_owned());
        shown.elsewhere = elsewhere;
        shown
    }

    fn place(sources: &SourceMap, span: Span, words: &str, width: usize) -> Shown {
        Shown::marked(sources, words, miette::Severity::Advice, &[(span, "")], width)
    }

    /// A message with places of one source marked; the first is the one the message is about.
    fn marked(
        sources: &SourceMap,
        message: &str,
        severity: miette::Severity,
        places: &[(Span, &str)],
        width: usize,
    ) -> Shown {
        let spans: Vec<Span> = places.iter().map(|(span, _)| *span).collect();
        let excerpt = spans.first().map(|main| Excerpt::new(sources.get(main.source), &spans, width));
        let marks = excerpt.iter().flat_map(|excerpt| &excerpt.marks);
        let label = |(nth, ((_, words), mark)): (usize, (&(Span, &str), &Mark))| {
            let words = (!words.is_empty()).then(|| one_line(words).into_owned());
            let span = (mark.offset, mark.length);
            match nth {
                0 => LabeledSpan::new_primary_with_span(words, span),
                _ => LabeledSpan::new_with_span(words, span),
            }
        };
        let labels = places.iter().zip(marks).enumerate().map(label).collect();
        let message = one_line(message).into_owned();
        Shown { message, code: None, severity, help: None, excerpt, labels, elsewhere: Vec::new() }
    }
}

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Shown {}

impl Report for Shown {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let severity = match self.severity {
            miette::Severity::Error => "error",
            miette::Severity::Warning => "warning",
            miette::Severity::Advice => "note",
        };
        self.code.map(|code| Box::new(format!("{severity}[{code}]")) as _)
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(self.severity)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help.as_ref().map(|help| Box::new(help) as _)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.excerpt.as_ref().map(|excerpt| excerpt as _)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        (!self.labels.is_empty()).then(|| Box::new(self.labels.iter().cloned()) as _)
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Report> + 'a>> {
        (!self.elsewhere.is_empty())
            .then(|| Box::new(self.elsewhere.iter().map(|shown| shown as &dyn Report)) as _)
    }
}

/// A place for programs: lines and columns from 1, columns in characters, ends exclusive.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct JsonSpan {
    /// Line of the first character.
    pub line: usize,
    /// Column of the first character.
    pub column: usize,
    /// Line of the place behind the last character.
    pub end_line: usize,
    /// Column of the place behind the last character.
    pub end_column: usize,
    /// The first byte, from 0, in the whole file.
    pub start: u32,
    /// The byte behind the last one.
    pub end: u32,
}

/// Another place that matters.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct JsonRelated {
    /// The name of the source.
    pub file: String,
    /// A few words.
    pub message: String,
    /// The place.
    pub span: JsonSpan,
}

/// A diagnostic for programs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct JsonDiagnostic {
    /// The name of the source that the place is in; of the problem file where there is no place.
    pub file: String,
    /// `error`, `warning` or `note`.
    pub severity: &'static str,
    /// See [`Diagnostic::code`].
    pub code: &'static str,
    /// One sentence.
    pub message: String,
    /// The place, or null where the message is about no particular one.
    pub span: Option<JsonSpan>,
    /// Words beside the place, or null.
    pub label: Option<String>,
    /// Advice, or null.
    pub help: Option<String>,
    /// Other places.
    pub related: Vec<JsonRelated>,
}

/// The diagnostic as data; `file` is the name of the problem file.
#[must_use]
pub fn to_json(sources: &SourceMap, file: &str, diagnostic: &Diagnostic) -> JsonDiagnostic {
    let name = |span: Span| sources.get(span.source).name.clone();
    let place = |span: Span| {
        let end = span.end.max(span.start);
        let (line, column) = sources.position(span);
        let (end_line, end_column) = sources.position(Span { start: end, ..span });
        JsonSpan { line, column, end_line, end_column, start: span.start, end }
    };
    let related = diagnostic.related.iter();
    JsonDiagnostic {
        file: diagnostic.span.map_or_else(|| file.to_owned(), name),
        severity: match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        },
        code: diagnostic.code,
        message: diagnostic.message.clone(),
        span: diagnostic.span.map(place),
        label: (!diagnostic.label.is_empty()).then(|| diagnostic.label.clone()),
        help: diagnostic.help.clone(),
        related: related
            .map(|(span, words)| JsonRelated {
                file: name(*span),
                message: words.clone(),
                span: place(*span),
            })
            .collect(),
    }
}
