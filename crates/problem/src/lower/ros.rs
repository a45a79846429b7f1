//! Maps of the ROS `map_server`: a YAML file that names a picture and says what its shades mean.

use super::env::Env;
use super::grid::{GridMap, MAX_CELLS, formats, picture};
use hyperplan_syntax::{Diagnostic, SourceId, Span};
use serde::Deserialize;
use serde_saphyr::{Location, Spanned};

/// The shade that map savers give to unknown cells, where white is 255.
const UNKNOWN: u16 = 205;

/// What the YAML file says, of what matters here.
#[derive(Debug, Deserialize)]
struct File {
    image: Spanned<String>,
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

/// What shades mean.
#[derive(Clone, Copy, Debug)]
struct Shades {
    negate: bool,
    /// A cell is an obstacle if it is occupied with a probability above this.
    occupied: f64,
    /// A cell is free if its probability is below this; what lies between is unknown, and taken for an obstacle.
    free: f64,
}

/// Reads the picture that the YAML text of `source` names; `None` after a message. The picture's last row is row 0.
pub(super) fn read(path: &str, span: Span, source: SourceId, yaml: &str, env: &mut Env) -> Option<GridMap> {
    let (file, shades) = settings(source, yaml).map_err(|wrong| env.diagnostics.push(*wrong)).ok()?;
    let (named, place) = (&file.image.value, place(source, yaml, file.image.referenced));
    let folder = path.rfind('/').map_or("", |end| &path[..=end]);
    let image = if named.starts_with('/') { named.clone() } else { format!("{folder}{named}") };
    let bytes = match env.loader.load(&image) {
        Ok(bytes) => bytes,
        Err(reason) => {
            let message = format!("cannot read `{image}`, the picture of `{path}`: {reason}");
            return env.diagnostics.refuse(Diagnostic::error("cannot-read", place, message));
        }
    };
    let picture = match formats::read(&bytes, MAX_CELLS) {
        Ok(picture) => picture,
        Err(message) => {
            let code = if formats::is_picture(&bytes) { "bad-map" } else { "not-supported" };
            return env.diagnostics.refuse(Diagnostic::error(code, place, format!("`{image}`: {message}")));
        }
    };
    let map = to_map(&picture, shades);
    if map.obstacles.len() == picture.shades.len() {
        let message = format!("`{image}`: the map has no free cell");
        return env.diagnostics.refuse(Diagnostic::error("bad-map", place, message));
    }
    warn_of_unknown(&picture, shades, &file, span, env);
    Some(map)
}

/// Savers write unknown cells in one shade, and some thresholds make it free, with `map_server` as here.
fn warn_of_unknown(picture: &picture::Picture, shades: Shades, file: &File, span: Span, env: &mut Env) {
    let count = picture.shades.iter().filter(|shade| **shade == UNKNOWN).count();
    if picture.white != 255 || count == 0 || !shades.is_free(UNKNOWN, 255) {
        return;
    }
    let limit = file.free_thresh.as_ref().map_or(shades.free, |limit| limit.value);
    let message = format!(
        "{count} cells have the shade {UNKNOWN}, which map savers give to cells that are unknown; `free_thresh: {limit}` \
         makes them free"
    );
    let help = "with 0.196, the default of ROS, they are unknown, and taken for obstacles here";
    env.diagnostics.push(Diagnostic::warning("unknown-is-free", span, message).with_help(help));
}

/// What the YAML text says, or the message about what is wrong with it.
fn settings(source: SourceId, yaml: &str) -> Result<(File, Shades), Box<Diagnostic>> {
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
    if let Some(mode) = file.mode.as_ref().filter(|mode| mode.value != "trinary") {
        let message = format!("mode `{}` is not supported, only `trinary`", mode.value);
        return Err(bad(mode.referenced, message));
    }
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
    Ok((file, Shades { negate, occupied, free }))
}

/// The place of a part of the YAML text; its beginning, where that is not known.
fn place(source: SourceId, yaml: &str, location: Location) -> Span {
    let span = location.span();
    let at = |offset: u64| yaml.floor_char_boundary(usize::try_from(offset).unwrap_or(usize::MAX));
    let start = span.byte_offset().unwrap_or(0);
    Span::new(source, at(start)..at(start.saturating_add(span.byte_len().unwrap_or(0))))
}

impl Shades {
    fn is_free(self, shade: u16, white: u16) -> bool {
        let brightness = f64::from(shade) / f64::from(white);
        let occupied = if self.negate { brightness } else { 1.0 - brightness };
        occupied <= self.occupied && occupied < self.free
    }
}

fn to_map(picture: &picture::Picture, shades: Shades) -> GridMap {
    let mut obstacles = Vec::new();
    for x in 0..picture.width {
        for y in 0..picture.height {
            if !shades.is_free(picture.at(x, picture.height - 1 - y), picture.white) {
                obstacles.push((x, y));
            }
        }
    }
    GridMap { width: picture.width, height: picture.height, obstacles, labels: Vec::new() }
}
