//! Problems built in code. What is built is a text of the problem language, and files in memory for graphs and grids: so it
//! means what the language reference says, errors have places in a text that can be shown, and it can be saved.

mod graph;
mod grid;
mod system;

pub use graph::Graph;
pub use grid::{Cell, Grid};
pub use system::System;

use crate::error::Error;
use crate::source::{Files, Source};
use std::fmt::Display;
use std::path::PathBuf;

/// How messages call a text without a name.
const NAME: &str = "<problem>";

/// A problem that is being built. Items are in the order in which they were added, which does not matter to the language.
#[derive(Debug, Default)]
pub struct Builder {
    name: Option<String>,
    text: String,
    files: Files,
    wrong: Option<Error>,
}

impl Builder {
    /// How messages call the text.
    #[must_use]
    pub fn name(self, name: impl Into<String>) -> Builder {
        Builder { name: Some(name.into()), ..self }
    }

    /// Items of the problem language: constants, definitions, templates, whatever has no method here. Of a text that comes
    /// first messages have the right lines.
    #[must_use]
    pub fn text(mut self, text: impl Into<String>) -> Builder {
        let text = text.into();
        if self.text.is_empty() {
            self.text = text;
        } else {
            self.line(&text);
        }
        self
    }

    /// The folder in which files are that the text names. Without it the text reads no files but those in memory.
    #[must_use]
    pub fn folder(mut self, folder: impl Into<PathBuf>) -> Builder {
        self.files.folder = Some(folder.into());
        self
    }

    /// A file in memory, by the name that the text has for it.
    #[must_use]
    pub fn file(mut self, name: impl Into<String>, contents: impl Into<Vec<u8>>) -> Builder {
        self.files.memory.insert(name.into(), contents.into());
        self
    }

    /// `const NAME = VALUE;`, where the value is an expression too.
    #[must_use]
    pub fn constant(mut self, name: &str, value: impl Display) -> Builder {
        self.line(&format!("const {name} = {value};"));
        self
    }

    /// A system.
    #[must_use]
    pub fn system(mut self, name: &str, system: System) -> Builder {
        // What is a keyword is told by the parser, with its place.
        let is_word = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || "_.".contains(c));
        if !is_word {
            return self.refused(name, "its name is no word: letters, digits and `_`".to_owned());
        }
        match system.written(name) {
            Ok((text, files)) => {
                self.line(&text);
                self.files.memory.extend(files);
                self
            }
            Err(why) => self.refused(name, why),
        }
    }

    /// `objective NAME { FORMULA }`, with its quantifiers; the formula may also be an instance of a template, such as
    /// `shortest_path(start, goal, T)`. What follows the name in the language may follow it here: `NAME within 4`.
    #[must_use]
    pub fn objective(mut self, name: &str, formula: &str) -> Builder {
        let head = formula.trim_start();
        let is_formula = ["exists", "forall", "define"].iter().any(|word| head.starts_with(word));
        match is_formula {
            true => self.line(&format!("objective {name} {{\n  {formula}\n}}")),
            false => self.line(&format!("objective {name} = {formula};")),
        }
        self
    }

    /// What was built, to be read.
    pub(crate) fn source(self) -> Result<Source, Error> {
        let Builder { name, text, files, wrong } = self;
        if let Some(wrong) = wrong {
            return Err(wrong);
        }
        let name = name.unwrap_or_else(|| NAME.to_owned());
        Ok(Source::Text { name, text, files })
    }

    fn line(&mut self, text: &str) {
        if !self.text.is_empty() && !self.text.ends_with('\n') {
            self.text.push('\n');
        }
        self.text += text;
        self.text.push('\n');
    }

    /// The first error is the one that is told.
    fn refused(mut self, system: &str, why: String) -> Builder {
        self.wrong.get_or_insert_with(|| Error::Built { system: system.to_owned(), why });
        self
    }
}
