//! Maps of the ROS map_server: a YAML file that names a picture and says what its shades mean.

use super::env::Env;
use super::grid::{GridMap, MAX_CELLS, pgm};
use hyperplan_syntax::{Diagnostic, Span};

/// What the YAML file says.
#[derive(Debug)]
struct Settings {
    image: String,
    negate: bool,
    /// A cell is an obstacle if it is occupied with a probability above this.
    occupied: f64,
    /// A cell is free if its probability is below this; what lies between is unknown, and taken for an obstacle.
    free: f64,
}

/// Reads the picture that the YAML text names; `None` after a message. The picture's last row is row 0.
pub(super) fn read(path: &str, span: Span, yaml: &str, env: &mut Env) -> Option<GridMap> {
    let settings = match settings(yaml) {
        Ok(settings) => settings,
        Err(message) => {
            return env.diagnostics.refuse(Diagnostic::error(
                "bad-map",
                span,
                format!("`{path}`: {message}"),
            ));
        }
    };
    let folder = path.rfind('/').map_or("", |end| &path[..=end]);
    let image = if settings.image.starts_with('/') {
        settings.image.clone()
    } else {
        format!("{folder}{}", settings.image)
    };
    let bytes = match env.loader.load(&image) {
        Ok(bytes) => bytes,
        Err(reason) => {
            let message = format!("cannot read `{image}`, the picture of `{path}`: {reason}");
            return env.diagnostics.refuse(Diagnostic::error("cannot-read", span, message));
        }
    };
    match pgm::read(&bytes, MAX_CELLS).and_then(|picture| to_map(&picture, &settings)) {
        Ok(map) => Some(map),
        Err(message) => {
            let code = if bytes.starts_with(b"\x89PNG") { "not-supported" } else { "bad-map" };
            env.diagnostics.refuse(Diagnostic::error(code, span, format!("`{image}`: {message}")))
        }
    }
}

/// The few keys that matter. Every map_server file is a flat list of `key: value` lines.
fn settings(yaml: &str) -> Result<Settings, String> {
    let value = |key: &str| {
        yaml.lines().find_map(|line| {
            let (name, rest) = line.split_once(':')?;
            let rest = rest.split(" #").next().unwrap_or("").trim();
            (name.trim() == key).then(|| rest.trim_matches(['"', '\'']).to_owned())
        })
    };
    let number = |key: &str, default: f64| match value(key) {
        None => Ok(default),
        Some(text) => match text.parse::<f64>() {
            Ok(n) if n.is_finite() => Ok(n),
            _ => Err(format!("`{key}` is no number: `{text}`")),
        },
    };
    if let Some(mode) = value("mode").filter(|mode| mode != "trinary") {
        return Err(format!("mode `{mode}` is not supported, only `trinary`"));
    }
    let negate = match value("negate").as_deref() {
        None | Some("0" | "false") => false,
        Some("1" | "true") => true,
        Some(other) => return Err(format!("`negate` must be 0 or 1, not `{other}`")),
    };
    Ok(Settings {
        image: value("image").filter(|image| !image.is_empty()).ok_or("no `image`")?,
        negate,
        occupied: number("occupied_thresh", 0.65)?,
        free: number("free_thresh", 0.196)?,
    })
}

fn to_map(picture: &pgm::Picture, settings: &Settings) -> Result<GridMap, String> {
    let mut obstacles = Vec::new();
    for x in 0..picture.width {
        for y in 0..picture.height {
            let row = picture.height - 1 - y;
            let shade = f64::from(picture.at(x, row)) / f64::from(picture.white);
            let occupied = if settings.negate { shade } else { 1.0 - shade };
            if occupied > settings.occupied || occupied >= settings.free {
                obstacles.push((x, y));
            }
        }
    }
    if obstacles.len() == picture.width as usize * picture.height as usize {
        return Err("the map has no free cell".into());
    }
    Ok(GridMap { width: picture.width, height: picture.height, obstacles, labels: Vec::new() })
}
