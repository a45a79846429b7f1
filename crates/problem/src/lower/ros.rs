//! Maps of the ROS `map_server`: a YAML file that names a picture and says what its shades mean.

use super::env::Env;
use super::fractions::number;
use super::grid::picture::Picture;
use super::grid::{MAX_READ, Occupancy, Raster, formats};
use crate::expr::{Rational, Value};
use crate::names::names;
use crate::place::Place;
use hyperplan_syntax::{Diagnostic, SourceId, Span};
use serde::Deserialize;
use serde_saphyr::{Location, Spanned};

/// The color that map savers give to unknown cells.
const UNKNOWN: [u8; 4] = [205, 205, 205, 255];

/// Most metres along the side of a cell: what is more was meant as something else.
const MAX_RESOLUTION: f64 = 100.0;
/// Most metres from the origin of the world.
const MAX_DISTANCE: f64 = 1e9;

/// What the YAML file says, of what matters here.
#[derive(Debug, Deserialize)]
struct File {
    image: Spanned<String>,
    resolution: Option<Spanned<f64>>,
    origin: Option<Spanned<Vec<f64>>>,
    negate: Option<Spanned<Switch>>,
    occupied_thresh: Option<Spanned<f64>>,
    free_thresh: Option<Spanned<f64>>,
    mode: Option<Spanned<String>>,
}

/// `map_server` takes 0 and 1, and people write `true` and `false`.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Switch {
    Bool(bool),
    Number(i64),
}

/// How `map_server` makes an occupancy of a shade.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Mode {
    /// Free, occupied or unknown, by the thresholds.
    #[default]
    Trinary,
    /// The same, but what lies between the thresholds is a percentage of the way from one to the other, and what is not
    /// opaque is unknown.
    Scale,
    /// Shades up to 100 are percentages themselves, others unknown.
    Raw,
}

names!(Mode: Trinary "trinary", Scale "scale", Raw "raw");

/// What shades mean.
#[derive(Clone, Copy, Debug)]
struct Shades {
    mode: Mode,
    negate: bool,
    /// A cell is an obstacle if it is occupied with a probability above this.
    occupied: f64,
    /// A cell is free if its probability is below this.
    free: f64,
}

/// Reads the picture that the YAML text of `source` names; `None` after a message. The picture's last row is row 0.
/// Whether it was said that unknown cells are free, `frees`, matters for a warning.
pub(super) fn read(
    (path, span): (&str, Span),
    source: SourceId,
    yaml: &str,
    frees: bool,
    env: &mut Env,
) -> Option<Raster> {
    let (file, shades, lies) = settings(source, yaml).map_err(|wrong| env.diagnostics.push(*wrong)).ok()?;
    let (named, at) = (&file.image.value, place(source, yaml, file.image.referenced));
    let folder = path.rfind('/').map_or("", |end| &path[..=end]);
    let image = if named.starts_with('/') { named.clone() } else { format!("{folder}{named}") };
    let bytes = match env.loader.load(&image) {
        Ok(bytes) => bytes,
        Err(reason) => {
            let message = format!("cannot read `{image}`, the picture of `{path}`: {reason}");
            return env.diagnostics.refuse(Diagnostic::error("cannot-read", at, message));
        }
    };
    let picture = match formats::read(&bytes, MAX_READ) {
        Ok(picture) => picture,
        Err(message) => {
            let code = if formats::is_picture(&bytes) { "bad-map" } else { "not-supported" };
            return env.diagnostics.refuse(Diagnostic::error(code, at, format!("`{image}`: {message}")));
        }
    };
    let mut map = Raster::new(picture.width, picture.height);
    map.place = lies;
    // How many cells that were unknown to those who saved the map are free by what they wrote.
    let mut freed = 0_usize;
    let pixels = (0..picture.height).rev().flat_map(|row| (0..picture.width).map(move |x| (x, row)));
    for (cell, (x, row)) in map.cells.iter_mut().zip(pixels) {
        *cell = shades.occupancy(&picture, x, row);
        freed += usize::from(*cell == Occupancy::Free && picture.color(x, row) == UNKNOWN);
    }
    if freed > 0 && !frees && shades.mode == Mode::Trinary {
        let limit = file.free_thresh.as_ref().map_or(shades.free, |limit| limit.value);
        warn_of_unknown(freed, limit, span, env);
    }
    Some(map)
}

/// Savers write unknown cells in one shade, and some thresholds make it free, with `map_server` as here.
fn warn_of_unknown(count: usize, limit: f64, span: Span, env: &mut Env) {
    let shade = UNKNOWN[0];
    let message = format!(
        "{count} cells have the shade {shade}, which map savers give to cells that are unknown; `free_thresh: {limit}` \
         makes them free"
    );
    let help = "with 0.196, the default of ROS, they are unknown, and taken for obstacles here; `unknown free;` says that \
                they are meant to be free";
    env.diagnostics.push(Diagnostic::warning("unknown-is-free", span, message).with_help(help));
}

/// What the YAML text says, or the message about what is wrong with it.
fn settings(source: SourceId, yaml: &str) -> Result<(File, Shades, Option<Place>), Box<Diagnostic>> {
    let bad = |location: Location, message: String| {
        Box::new(Diagnostic::error("bad-map", place(source, yaml, location), message))
    };
    let file: File = serde_saphyr::from_str(yaml).map_err(|error| {
        let error = error.without_snippet();
        let words = error.to_string();
        // Some messages go on with lines of advice for programmers.
        let words = words.lines().next().unwrap_or_default();
        bad(error.location().unwrap_or(Location::UNKNOWN), format!("this is no map of ROS: {words}"))
    })?;
    let mode = match &file.mode {
        None => Mode::default(),
        Some(given) => given.value.parse().map_err(|_| {
            let message = format!("no mode `{}`; there are `trinary`, `scale` and `raw`", given.value);
            bad(given.referenced, message)
        })?,
    };
    if file.image.value.is_empty() {
        return Err(bad(file.image.referenced, "`image` is empty".into()));
    }
    let negate = match &file.negate {
        None => false,
        Some(Spanned { value: Switch::Bool(value), .. }) => *value,
        Some(Spanned { value: Switch::Number(value @ 0..=1), .. }) => *value == 1,
        Some(other) => return Err(bad(other.referenced, "`negate` must be 0 or 1".into())),
    };
    let threshold = |name: &str, given: &Option<Spanned<f64>>, default: f64| match given {
        None => Ok(default),
        Some(given) if (0.0..=1.0).contains(&given.value) => Ok(given.value),
        Some(given) => Err(bad(given.referenced, format!("`{name}` is a probability, from 0 to 1"))),
    };
    let occupied = threshold("occupied_thresh", &file.occupied_thresh, 0.65)?;
    let free = threshold("free_thresh", &file.free_thresh, 0.196)?;
    if free > occupied {
        let location = file.free_thresh.as_ref().map_or(Location::UNKNOWN, |given| given.referenced);
        return Err(bad(location, format!("`free_thresh` ({free}) is above `occupied_thresh` ({occupied})")));
    }
    let lies = lies(&file).map_err(|(location, message)| bad(location, message))?;
    Ok((file, Shades { mode, negate, occupied, free }, lies))
}

/// Where the map lies; nothing where the file does not say how large its cells are.
fn lies(file: &File) -> Result<Option<Place>, (Location, String)> {
    let Some(given) = &file.resolution else { return Ok(None) };
    let Some(resolution) = resolution(given.value) else {
        let message = format!("`resolution` is the side of a cell in metres, not {}", given.value);
        return Err((given.referenced, message));
    };
    let (x, y, yaw) = match &file.origin {
        None => (0.0, 0.0, 0.0),
        Some(given) => match given.value.as_slice() {
            &[x, y, yaw] if [x, y, yaw].iter().all(|n| n.abs() <= MAX_DISTANCE) => (x, y, yaw),
            _ => return Err((given.referenced, "`origin` is `[x, y, yaw]`, in metres and radians".into())),
        },
    };
    Ok(Some(Place { resolution, origin: (x, y), yaw }))
}

/// A resolution as it was meant: the shortest decimal fraction that reads as it, also where it was first rounded to 32 bits.
fn resolution(metres: f64) -> Option<Rational> {
    if !(1e-6..=MAX_RESOLUTION).contains(&metres) {
        return None;
    }
    let short = metres as f32;
    let text = if f64::from(short) == metres { short.to_string() } else { metres.to_string() };
    match number(&text) {
        Some(Value::Int(n)) => Some(Rational::from(n)),
        Some(Value::Real(exact)) if *exact.denom() <= NANO => Some(exact),
        // Nobody has measured more digits.
        _ => Some(Rational::new((metres * NANO as f64).round() as i64, NANO)),
    }
}

/// Nanometres of a metre.
const NANO: i64 = 1_000_000_000;

/// The place of a part of the YAML text; its beginning, where that is not known.
fn place(source: SourceId, yaml: &str, location: Location) -> Span {
    let span = location.span();
    let at = |offset: u64| yaml.floor_char_boundary(usize::try_from(offset).unwrap_or(usize::MAX));
    let start = span.byte_offset().unwrap_or(0);
    Span::new(source, at(start)..at(start.saturating_add(span.byte_len().unwrap_or(0))))
}

impl Shades {
    /// What a pixel says of its cell. Percentages are of certainty that it is occupied: all of it is, none of it is free; of
    /// those between, where shades are no percentages themselves, nothing is known.
    fn occupancy(self, picture: &Picture, x: u32, row: u32) -> Occupancy {
        let brightness = picture.brightness(x, row, self.mode == Mode::Trinary);
        let occupied = if self.negate { brightness } else { 1.0 - brightness };
        match self.mode {
            Mode::Scale if !picture.is_opaque(x, row) => Occupancy::Unknown,
            Mode::Trinary | Mode::Scale if occupied > self.occupied => Occupancy::Obstacle,
            Mode::Trinary | Mode::Scale if occupied < self.free => Occupancy::Free,
            Mode::Trinary => Occupancy::Unknown,
            Mode::Scale => {
                let percent = (occupied - self.free) / (self.occupied - self.free) * 100.0;
                match percent.round_ties_even() {
                    0.0 => Occupancy::Free,
                    100.0 => Occupancy::Obstacle,
                    _ => Occupancy::Unknown,
                }
            }
            // As those who save maps turn percentages into shades.
            Mode::Raw => match (brightness * 255.0).round() {
                percent if percent > 100.0 => Occupancy::Unknown,
                percent if percent <= (self.free * 100.0).round_ties_even() => Occupancy::Free,
                percent if percent >= (self.occupied * 100.0).round_ties_even() => Occupancy::Obstacle,
                _ => Occupancy::Unknown,
            },
        }
    }
}
