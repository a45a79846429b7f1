//! Pictures of a map, of a strategy's paths, and of those that it has to cope with, as files.

use crate::failure::{Failure, Result};
use crate::files::write_bytes;
use crate::others::{Shown, shown, variants};
use crate::plans::with_name;
use hyperplan_horizon::horizons;
use hyperplan_problem::{Objective, Problem, Strategy};
use hyperplan_render::{Film, Page, Scene, TextStyle, page, pdf, png, svg, text_map};
use std::fs;
use std::path::{Path, PathBuf};

/// A file to draw into, its kind known from its name.
#[derive(Clone)]
pub(crate) struct Picture {
    path: PathBuf,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Animated,
    Gif,
    Html,
    Pdf,
    Png,
    Svg,
    Text,
}

impl Picture {
    /// Refuses names that do not end in a known way.
    pub(crate) fn new(path: &Path) -> Result<Self> {
        let kind = match path.extension().and_then(|e| e.to_str()) {
            Some("gif") => Kind::Gif,
            Some("html") => Kind::Html,
            Some("pdf") => Kind::Pdf,
            Some("png") => Kind::Png,
            Some("svg") => Kind::Svg,
            Some("txt") => Kind::Text,
            _ => {
                let message = format!(
                    "cannot draw into {}: only .svg, .png, .pdf, .gif, .html and .txt are supported",
                    path.display()
                );
                return Err(Failure::input(message));
            }
        };
        Ok(Picture { path: path.to_owned(), kind })
    }

    /// The same file as one that moves.
    pub(crate) fn animated(self) -> Result<Self> {
        match self.kind {
            Kind::Svg => Ok(Picture { kind: Kind::Animated, ..self }),
            _ => Err(Failure::input("--animate is for .svg files; .gif and .html move without it")),
        }
    }

    /// The file for one of several: a name goes before the extension.
    pub(crate) fn with_name(&self, name: &str) -> Self {
        Picture { path: with_name(&self.path, name), kind: self.kind }
    }

    /// Whether it is an SVG, moving or not.
    pub(crate) fn is_svg(&self) -> bool {
        matches!(self.kind, Kind::Animated | Kind::Svg)
    }
}

/// What is drawn.
pub(crate) struct Subject<'a> {
    pub(crate) problem: &'a Problem,
    /// The objective whose paths they are; without one, the first system is drawn alone.
    pub(crate) objective: Option<&'a Objective>,
    pub(crate) strategy: Option<&'a Strategy>,
    /// Only these paths, if some are named.
    pub(crate) named: &'a [String],
}

impl Subject<'_> {
    /// Draws into a file.
    pub(crate) fn draw(&self, picture: &Picture) -> Result<()> {
        let drawn = match (picture.kind, self.objective, self.strategy) {
            (Kind::Html, Some(objective), Some(strategy)) => self.page(objective, strategy)?.into_bytes(),
            _ => self.with_scene(|scene| match picture.kind {
                Kind::Animated => Film::of(scene).map(|film| film.animated().into_bytes()),
                Kind::Gif => Film::of(scene)?.gif(),
                Kind::Html => Err(hyperplan_render::Error::NothingMoves),
                Kind::Pdf => pdf(scene),
                Kind::Png => png(scene),
                Kind::Svg => svg(scene).map(String::into_bytes),
                Kind::Text => text_map(scene, TextStyle::default()).map(String::into_bytes),
            })?,
        };
        write_bytes(&picture.path, &drawn)
    }

    /// The picture as text for a terminal.
    pub(crate) fn text(&self, style: TextStyle) -> Result<String> {
        self.with_scene(|scene| text_map(scene, style))
    }

    /// Draws a picture for each time into a folder, which is made if it is not there.
    pub(crate) fn frames(&self, folder: &Path, as_svg: bool) -> Result<usize> {
        let film = self.with_scene(Film::of)?;
        let pictures: Box<dyn Iterator<Item = _>> = if as_svg {
            Box::new(film.svgs().map_err(Failure::input)?)
        } else {
            Box::new(film.pngs().map_err(Failure::input)?)
        };
        fs::create_dir_all(folder)
            .map_err(|error| Failure::input(format_args!("cannot make {}: {error}", folder.display())))?;
        let extension = if as_svg { "svg" } else { "png" };
        let mut count = 0;
        for (time, picture) in pictures.enumerate() {
            write_bytes(&folder.join(format!("{time:04}.{extension}")), &picture.map_err(Failure::input)?)?;
            count += 1;
        }
        Ok(count)
    }

    fn with_scene<T>(&self, draw: impl FnOnce(Scene<'_>) -> Result<T, hyperplan_render::Error>) -> Result<T> {
        let shown = match (self.objective, self.strategy) {
            (Some(objective), Some(strategy)) => shown(self.problem, objective, strategy, self.named)?,
            _ => Shown { traces: Vec::new(), note: "" },
        };
        let (problem, objective) = (self.problem, self.objective);
        draw(Scene { problem, objective, traces: &shown.traces, note: shown.note }).map_err(Failure::input)
    }

    fn page(&self, objective: &Objective, strategy: &Strategy) -> Result<String> {
        let reads = objective.paths.iter().zip(horizons(objective)).map(|(path, horizon)| {
            let steps = horizon.steps.map_or_else(|| "not at all".to_owned(), |steps| steps.to_string());
            format!("{} {steps}", path.name)
        });
        let horizon =
            format!("horizon, the last step that is read: {}", reads.collect::<Vec<_>>().join(", "));
        let variants = variants(self.problem, objective, strategy, self.named)?;
        let shown = Page { problem: self.problem, objective, facts: vec![horizon], variants };
        page(&shown).map_err(Failure::input)
    }
}
