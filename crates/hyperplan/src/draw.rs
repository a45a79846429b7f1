//! Pictures of a map, of a strategy's paths, and of those that it has to cope with.

use crate::others::{Shown, Undrawn, shown, variants};
use hyperplan_horizon::horizons;
use hyperplan_problem::{Objective, Problem, Strategy};
use hyperplan_render::{Error, Film, Page, Scene, TextStyle, page, pdf, png, svg, text_map};

/// The kinds of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// An SVG in which paths move.
    Animated,
    /// A film.
    Gif,
    /// A page with a slider for the time, and menus.
    Html,
    /// PDF.
    Pdf,
    /// PNG.
    Png,
    /// SVG.
    Svg,
    /// Text for a terminal, without colours.
    Text,
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The objective whose paths they are; without one, the first system is drawn alone.
    pub objective: Option<&'a Objective>,
    /// The paths.
    pub strategy: Option<&'a Strategy>,
    /// Only these paths, if some are named.
    pub named: &'a [String],
}

impl Subject<'_> {
    /// The bytes of a picture.
    ///
    /// # Errors
    /// When it is too large, nothing moves in a film, or a path that is named cannot be drawn.
    pub fn draw(&self, kind: Kind) -> Result<Vec<u8>, Undrawn> {
        if let (Kind::Html, Some(objective), Some(strategy)) = (kind, self.objective, self.strategy) {
            return self.page(objective, strategy).map(String::into_bytes);
        }
        self.with_scene(|scene| match kind {
            Kind::Animated => Film::of(scene).map(|film| film.animated().into_bytes()),
            Kind::Gif => Film::of(scene)?.gif(),
            Kind::Html => Err(Error::NothingMoves),
            Kind::Pdf => pdf(scene),
            Kind::Png => png(scene),
            Kind::Svg => svg(scene).map(String::into_bytes),
            Kind::Text => text_map(scene, TextStyle::default()).map(String::into_bytes),
        })
    }

    /// The picture as text for a terminal.
    ///
    /// # Errors
    /// Those of [`Subject::draw`].
    pub fn text(&self, style: TextStyle) -> Result<String, Undrawn> {
        self.with_scene(|scene| text_map(scene, style))
    }

    /// Draws the paths in some way.
    ///
    /// # Errors
    /// Those of drawing, and when a path that is named cannot be drawn.
    pub fn with_scene<T>(&self, draw: impl FnOnce(Scene<'_>) -> Result<T, Error>) -> Result<T, Undrawn> {
        let shown = match (self.objective, self.strategy) {
            (Some(objective), Some(strategy)) => shown(self.problem, objective, strategy, self.named)?,
            _ => Shown { traces: Vec::new(), note: "" },
        };
        let (problem, objective) = (self.problem, self.objective);
        Ok(draw(Scene { problem, objective, traces: &shown.traces, note: shown.note })?)
    }

    fn page(&self, objective: &Objective, strategy: &Strategy) -> Result<String, Undrawn> {
        let reads = objective.paths.iter().zip(horizons(objective)).map(|(path, horizon)| {
            let steps = horizon.steps.map_or_else(|| "not at all".to_owned(), |steps| steps.to_string());
            format!("{} {steps}", path.name)
        });
        let horizon =
            format!("horizon, the last step that is read: {}", reads.collect::<Vec<_>>().join(", "));
        let variants = variants(self.problem, objective, strategy, self.named)?;
        Ok(page(&Page { problem: self.problem, objective, facts: vec![horizon], variants })?)
    }
}
