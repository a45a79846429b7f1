//! Paths as they are walked: a picture for each time, an animated SVG, a GIF.

use crate::drawing::Drawing;
use crate::mover::Mover;
use crate::panel::Purpose;
use crate::paper::{self, pixmap};
use crate::style::{MARGIN, number};
use crate::{Error, Scene};
use resvg::tiny_skia::{IntRect, Pixmap, PixmapPaint, Transform};
use std::time::Duration;
use svg::Document;
use svg::node::element::{Animate, AnimateTransform, Group, Text};

/// The most pictures, one for each time.
const MOST_PICTURES: usize = 2_000;
/// The most pictures of a GIF, and positions in an animated SVG; of longer paths there is one for some steps.
const MOST_IN_ONE: usize = 300;
/// The most points of a GIF's side.
const GIF_SIDE: f32 = 800.0;
/// How long a film may take, how long a step, and how long its end can be seen.
const LONGEST: Duration = Duration::from_secs(30);
const LONGEST_STEP: Duration = Duration::from_millis(600);
const END: Duration = Duration::from_millis(1800);

/// What is the same at all times, and what is not.
#[derive(Debug)]
pub struct Film {
    document: Document,
    movers: Vec<Mover>,
    /// The last time.
    last: usize,
}

impl Film {
    /// The film of a scene.
    ///
    /// # Errors
    /// As [`crate::svg`], and if nothing in it moves.
    pub fn of(scene: Scene<'_>) -> Result<Film, Error> {
        let drawing = Drawing::of(scene)?;
        let last = drawing.last_time();
        let (document, movers) = drawing.document(Purpose { film: true, ..Purpose::default() });
        if movers.is_empty() { Err(Error::NothingMoves) } else { Ok(Film { document, movers, last }) }
    }

    /// A picture for each time, as SVG.
    ///
    /// # Errors
    /// If there are too many.
    pub fn svgs(&self) -> Result<impl Iterator<Item = Result<Vec<u8>, Error>> + '_, Error> {
        self.bounded()?;
        let picture = |time| format!("{}\n", self.document.clone().add(self.moment(time))).into_bytes();
        Ok((0..=self.last).map(move |time| Ok(picture(time))))
    }

    /// A picture for each time, as PNG.
    ///
    /// # Errors
    /// If there are too many, or the first cannot be drawn.
    pub fn pngs(&self) -> Result<impl Iterator<Item = Result<Vec<u8>, Error>> + '_, Error> {
        self.bounded()?;
        let still = self.still(paper::DENSITY, paper::MOST_POINTS, "PNG")?;
        Ok((0..=self.last).map(move |time| {
            let picture = self.at(&still, time, "PNG")?;
            picture.encode_png().map_err(|error| Error::Format { format: "PNG", reason: error.to_string() })
        }))
    }

    /// All in one GIF, which begins again at its end.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub fn gif(&self) -> Result<Vec<u8>, Error> {
        let failed =
            |error: &dyn std::fmt::Display| Error::Format { format: "GIF", reason: error.to_string() };
        let still = self.still(1.0, GIF_SIDE, "GIF")?;
        let (width, height) = (still.width() as u16, still.height() as u16);
        let mut file = Vec::new();
        let mut encoder = gif::Encoder::new(&mut file, width, height, &[]).map_err(|error| failed(&error))?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(|error| failed(&error))?;
        let hundredths = |time: Duration| u16::try_from(time.as_millis() / 10).unwrap_or(u16::MAX);
        let mut before: Option<Pixmap> = None;
        for time in self.times() {
            let picture = self.at(&still, time, "GIF")?;
            // Only what has changed.
            let (left, top, width, height) = match &before {
                Some(before) => changed(before, &picture),
                None => (0, 0, picture.width(), picture.height()),
            };
            let part = IntRect::from_xywh(left as i32, top as i32, width, height);
            let part = part.and_then(|part| picture.clone_rect(part));
            let mut points = part.ok_or_else(|| failed(&"there is nothing to see"))?.take();
            before = Some(picture);
            // What is learned of colours is as good from some of the points.
            let mut frame = gif::Frame::from_rgba_speed(width as u16, height as u16, &mut points, 10);
            (frame.left, frame.top) = (left as u16, top as u16);
            frame.delay = hundredths(if time == self.last { END } else { self.step() });
            encoder.write_frame(&frame).map_err(|error| failed(&error))?;
        }
        drop(encoder);
        Ok(file)
    }

    /// One SVG that moves by itself and begins again at its end.
    #[must_use]
    pub fn animated(&self) -> String {
        let times: Vec<usize> = self.times().collect();
        let all = self.step() * times.len() as u32 + END;
        let seconds = format!("{}s", number(all.as_secs_f64()));
        let part = |steps: usize| (self.step() * steps as u32).as_secs_f64() / all.as_secs_f64();
        let mut group = Group::new();
        for mover in &self.movers {
            // It stays where it is for a part of each step, so that steps can be told apart.
            let (mut values, mut keys) = (Vec::new(), Vec::new());
            for (i, time) in times.iter().enumerate() {
                let (x, y) = position(mover, *time);
                let at = format!("{x} {y}");
                values.extend([at.clone(), at]);
                keys.extend([part(i), if i + 1 == times.len() { 1.0 } else { part(i) + part(1) * 0.35 }]);
            }
            let keys: Vec<String> = keys.iter().map(|key| format!("{key:.5}")).collect();
            let moves = AnimateTransform::new().set("attributeName", "transform").set("type", "translate");
            let moves = moves.set("values", values.join(";")).set("keyTimes", keys.join(";"));
            let moves = moves.set("dur", seconds.as_str()).set("repeatCount", "indefinite");
            group = group.add(Group::new().add(mover.drawn()).add(moves));
        }
        for (i, time) in times.iter().enumerate() {
            let (from, to) = (part(i), if i + 1 == times.len() { 1.0 } else { part(i + 1) });
            let (values, keys) = match (i, i + 1 == times.len()) {
                (0, true) => ("1".to_owned(), "0".to_owned()),
                (0, false) => ("1;0".to_owned(), format!("0;{to:.5}")),
                (_, true) => ("0;1".to_owned(), format!("0;{from:.5}")),
                (_, false) => ("0;1;0".to_owned(), format!("0;{from:.5};{to:.5}")),
            };
            let shows = Animate::new().set("attributeName", "opacity").set("calcMode", "discrete");
            let shows = shows.set("values", values).set("keyTimes", keys).set("dur", seconds.as_str());
            let opacity = usize::from(i == 0);
            group = group
                .add(self.time(*time).set("opacity", opacity).add(shows.set("repeatCount", "indefinite")));
        }
        format!("{}\n", self.document.clone().add(group))
    }

    fn bounded(&self) -> Result<(), Error> {
        if self.last < MOST_PICTURES {
            return Ok(());
        }
        Err(Error::TooManyPictures { pictures: self.last + 1, limit: MOST_PICTURES })
    }

    /// The times that are in a film, the last always.
    fn times(&self) -> impl Iterator<Item = usize> + '_ {
        let every = self.last.div_ceil(MOST_IN_ONE).max(1);
        (0..self.last).step_by(every).chain([self.last])
    }

    /// How long a time can be seen.
    fn step(&self) -> Duration {
        let steps = u32::try_from(self.times().count()).unwrap_or(u32::MAX);
        (LONGEST / steps.max(1)).min(LONGEST_STEP).max(Duration::from_millis(60))
    }

    fn time(&self, time: usize) -> Text {
        let text = Text::new(format!("time {time} of {}", self.last)).set("class", "time");
        text.set("x", MARGIN).set("y", 22).set("font-size", 16)
    }

    /// What is not the same at all times.
    fn moment(&self, time: usize) -> Group {
        let moved = |mover: &Mover| {
            let (x, y) = position(mover, time);
            Group::new().set("transform", format!("translate({x} {y})")).add(mover.drawn())
        };
        self.movers.iter().map(moved).fold(Group::new().add(self.time(time)), Group::add)
    }

    fn still(&self, density: f32, most: f32, format: &'static str) -> Result<Pixmap, Error> {
        pixmap(&self.document.to_string(), density, most, format)
    }

    fn at(&self, still: &Pixmap, time: usize, format: &'static str) -> Result<Pixmap, Error> {
        let mut frame = Document::new().set("xmlns", "http://www.w3.org/2000/svg");
        for name in ["viewBox", "width", "height"] {
            if let Some(value) = self.document.get_attributes().get(name) {
                frame = frame.set(name, value.clone());
            }
        }
        let over = paper::pixmap_of(&frame.add(self.moment(time)).to_string(), still, format)?;
        let mut picture = still.clone();
        picture.draw_pixmap(0, 0, over.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
        Ok(picture)
    }
}

/// The least rectangle with all points in which two pictures of one size differ: its left upper corner, width and height.
fn changed(before: &Pixmap, now: &Pixmap) -> (u32, u32, u32, u32) {
    let width = now.width() as usize;
    let differ = before.pixels().iter().zip(now.pixels()).enumerate().filter(|(_, (a, b))| a != b);
    let (mut left, mut right, mut top, mut bottom) = (width, 0, usize::MAX, 0);
    for (i, _) in differ {
        let (x, y) = (i % width, i / width);
        (left, right, top, bottom) = (left.min(x), right.max(x), top.min(y), bottom.max(y));
    }
    if top == usize::MAX {
        // A picture has a point at least.
        return (0, 0, 1, 1);
    }
    (left as u32, top as u32, (right - left + 1) as u32, (bottom - top + 1) as u32)
}

fn position(mover: &Mover, time: usize) -> (f64, f64) {
    let at = mover.at();
    at.get(time).or(at.last()).copied().unwrap_or_default()
}
