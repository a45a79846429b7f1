//! A picture: a panel for each system, or for each path where states lie nowhere.

use crate::board::Board;
use crate::mover::{Mover, Point};
use crate::panel::{Entry, Panel, Purpose, arranged, arranged_below};
use crate::roadmap::Roadmap;
use crate::sheet::Sheet;
use crate::style::{FONT, definitions};
use crate::table::steps_to_rest;
use crate::track::{self, Area, Sizes, Track};
use crate::{Error, Scene, timeline};
use hyperplan_outlet::one_line;
use hyperplan_problem::{SystemId, Trace};
use svg::Document;
use svg::node::element::{Rectangle, Style, Title};

/// The systems of a scene, each with its paths and a legend: a map or a graph, or for each path a timeline.
///
/// # Errors
/// If there is nothing to draw, or too much.
pub fn svg(scene: Scene<'_>) -> Result<String, Error> {
    Ok(Drawing::of(scene)?.text(Purpose { bitmaps: true, ..Purpose::default() }))
}

/// What is found once and drawn as often as there are moments.
pub(crate) struct Drawing<'a> {
    scene: Scene<'a>,
    grounds: Vec<(SystemId, Ground<'a>)>,
    labels: usize,
}

/// On what a system's paths are drawn.
enum Ground<'a> {
    Map(Board),
    Graph(Box<Roadmap<'a>>),
    Nothing,
}

impl<'a> Drawing<'a> {
    pub(crate) fn of(scene: Scene<'a>) -> Result<Self, Error> {
        scene.bounded()?;
        let mut grounds = Vec::new();
        for system in scene.systems()? {
            let ground = match Roadmap::of(&scene.problem.systems[system]) {
                Some(roadmap) => Ground::Graph(Box::new(roadmap)),
                None => match Board::of(&scene.problem.systems[system]) {
                    Ok(board) => Ground::Map(board),
                    // A timeline takes paths.
                    Err(Error::Unsupported { .. }) if !scene.traces_of(system).is_empty() => Ground::Nothing,
                    Err(error) => return Err(error),
                },
            };
            grounds.push((system, ground));
        }
        let labels = grounds.iter().map(|(_, ground)| ground.labels()).max().unwrap_or(0);
        Ok(Drawing { scene, grounds, labels })
    }

    /// The last time of any path at which something still changes.
    pub(crate) fn last_time(&self) -> usize {
        let all = self.grounds.iter().flat_map(|(system, ground)| self.tracks(*system, ground));
        all.map(|(track, _)| track.rest).max().unwrap_or(0)
    }

    pub(crate) fn text(&self, purpose: Purpose) -> String {
        format!("{}\n", self.document(purpose).0)
    }

    /// The picture, and what moves on it in films.
    pub(crate) fn document(&self, purpose: Purpose) -> (Document, Vec<Mover>) {
        let mut all = self.panel(purpose);
        if purpose.film {
            // Room for the time.
            all = arranged_below(all);
        }
        let title = self.scene.objective.map_or("map", |o| o.name.as_str());
        let (width, height) = (all.width.ceil(), all.height.ceil());
        let style = format!(
            "text {{ font-family: {FONT}; fill: #222 }} .axis {{ font-size: 10px }} .axis text {{ fill: #555 }}"
        );
        let background = Rectangle::new().set("class", "ground").set("width", width).set("height", height);
        let document = Document::new()
            .set("viewBox", (0, 0, width, height))
            .set("width", width)
            .set("height", height)
            .set("role", "img")
            .set("aria-label", self.words())
            .add(Title::new(title))
            .add(Style::new(style))
            .add(definitions(self.labels))
            .add(background.set("fill", "#ffffff"))
            .add(all.group);
        (document, all.movers)
    }

    /// The picture in a sentence.
    pub(crate) fn words(&self) -> String {
        let paths = self.grounds.iter().flat_map(|(system, ground)| self.tracks(*system, ground));
        let paths: Vec<String> = paths.map(|(track, trace)| self.said(&track, trace)).collect();
        let systems =
            self.grounds.iter().map(|(system, _)| self.scene.problem.systems[*system].name.as_str());
        let systems: Vec<&str> = systems.collect();
        match paths.as_slice() {
            [] => one_line(&systems.join(", ")).into_owned(),
            paths => one_line(&format!("{}: {}", systems.join(", "), paths.join("; "))).into_owned(),
        }
    }

    fn panel(&self, purpose: Purpose) -> Panel {
        let mut panels = Vec::new();
        for (system, ground) in &self.grounds {
            let name = &self.scene.problem.systems[*system].name;
            for panel in self.panels(*system, ground, purpose) {
                panels.push(if self.grounds.len() > 1 { panel.with_title(&one_line(name)) } else { panel });
            }
        }
        arranged(panels)
    }

    fn panels(&self, system: SystemId, ground: &Ground<'_>, purpose: Purpose) -> Vec<Panel> {
        let tracks = self.tracks(system, ground);
        let entry = |(track, trace): &(Track<'_>, &Trace)| Entry::Path(track.index, self.said(track, trace));
        let entries: Vec<Entry> = tracks.iter().map(entry).collect();
        let drawn = |sizes: Sizes, taken: Vec<Area>| {
            let tracks: Vec<Track<'_>> = tracks.iter().map(|(track, _)| track.clone()).collect();
            (track::draw(&tracks, sizes, purpose.film, taken), track::movers(&tracks, sizes))
        };
        match ground {
            Ground::Map(board) => {
                let sheet = Sheet::new(board, purpose);
                vec![sheet.panel(drawn(sheet.sizes(), sheet.taken()), entries)]
            }
            Ground::Graph(roadmap) => vec![roadmap.panel(drawn(roadmap.sizes(), roadmap.taken()), entries)],
            Ground::Nothing => {
                let (problem, of) = (self.scene.problem, &self.scene.problem.systems[system]);
                let paths = tracks.iter().zip(entries);
                paths
                    .map(|((track, trace), entry)| timeline::panel(problem, of, (track, trace), vec![entry]))
                    .collect()
            }
        }
    }

    /// The paths of a system, as they lie on its ground.
    fn tracks(&self, system: SystemId, ground: &Ground<'_>) -> Vec<(Track<'a>, &'a Trace)> {
        let Some(objective) = self.scene.objective else { return Vec::new() };
        let track = |(index, name, trace): (usize, &'a str, &'a Trace)| {
            let (places, crash) = match ground {
                Ground::Map(board) => {
                    let sheet = Sheet::new(board, Purpose::default());
                    let number = |(x, y): (u32, u32)| y as usize * board.width as usize + x as usize;
                    let places =
                        board.cells_of(trace).into_iter().map(|cell| (number(cell), sheet.middle(cell)));
                    (places.collect(), board.crash_time(trace))
                }
                Ground::Graph(roadmap) => (roadmap.places_of(trace), None),
                Ground::Nothing => (Vec::new(), None),
            };
            let rest = steps_to_rest(self.scene.problem, objective, trace).min(crash.unwrap_or(usize::MAX));
            let places: Vec<(usize, Point)> = places;
            (Track { name, index, places, rest, crashed: crash.is_some() }, trace)
        };
        self.scene.traces_of(system).into_iter().map(track).collect()
    }

    /// A path in words: how long it is, and what is known of it.
    fn said(&self, track: &Track<'_>, trace: &Trace) -> String {
        let steps = format!("{} step{}", track.rest, if track.rest == 1 { "" } else { "s" });
        let how = if track.crashed { format!("crashes after {steps}") } else { steps };
        let note = self.scene.note(trace).map(|note| format!(", {note}")).unwrap_or_default();
        format!("{}: {how}{note}", track.name)
    }
}

impl Ground<'_> {
    fn labels(&self) -> usize {
        match self {
            Ground::Map(board) => board.marks.len(),
            Ground::Graph(roadmap) => roadmap.labels(),
            Ground::Nothing => 0,
        }
    }
}
