//! Maps that are pictures, in which colours say what cells are.

use super::env::Env;
use super::grid::picture::{Color, Picture};
use super::grid::{MAX_READ, Meaning, Occupancy, Raster, formats, labelled};
use hyperplan_syntax::Diagnostic;
use hyperplan_syntax::ast::Text;
use rustc_hash::{FxHashMap, FxHashSet};

/// Colours to which the problem file gives a meaning.
pub(super) type Colors = Vec<(Color, Meaning)>;

const WHITE: Color = [255; 4];
const BLACK: Color = [0, 0, 0, 255];

/// More colours without a meaning are not worth telling one by one.
const MAX_ERRORS: usize = 5;

/// The colour of `#rrggbb`, or of `#rrggbbaa` where it is not opaque.
pub(super) fn color(text: &str) -> Option<Color> {
    let digits = text.strip_prefix('#').filter(|digits| digits.is_ascii())?;
    let channel = |at: usize| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok();
    let alpha = match digits.len() {
        6 => u8::MAX,
        8 => channel(6)?,
        _ => return None,
    };
    Some([channel(0)?, channel(2)?, channel(4)?, alpha])
}

/// A colour as a legend names it.
fn name([r, g, b, alpha]: Color) -> String {
    let opaque = format!("#{r:02x}{g:02x}{b:02x}");
    if alpha == u8::MAX { opaque } else { format!("{opaque}{alpha:02x}") }
}

/// The map that a picture is: white is free, black an obstacle, and other colours are what the legend says. `None` after a
/// message.
pub(super) fn read(file: &Text, bytes: &[u8], legend: &Colors, env: &mut Env) -> Option<Raster> {
    match formats::read(bytes, MAX_READ) {
        Ok(picture) => to_map(file, &picture, legend, env),
        Err(message) => {
            let message = format!("`{}`: {message}", file.text);
            env.diagnostics.refuse(Diagnostic::error("bad-map", file.span, message))
        }
    }
}

/// What a colour stands for: something without a label, or a label by its position.
#[derive(Clone, Copy)]
enum Found {
    Plain(Occupancy),
    Label(usize),
}

fn to_map(file: &Text, picture: &Picture, legend: &Colors, env: &mut Env) -> Option<Raster> {
    let mut map = Raster::new(picture.width, picture.height);
    let mut known: FxHashMap<Color, Found> = [(WHITE, Occupancy::Free), (BLACK, Occupancy::Obstacle)]
        .map(|(color, what)| (color, Found::Plain(what)))
        .into_iter()
        .collect();
    for (color, meaning) in legend {
        known.insert(
            *color,
            match meaning {
                Meaning::Free => Found::Plain(Occupancy::Free),
                Meaning::Obstacle => Found::Plain(Occupancy::Obstacle),
                Meaning::Labelled(label) => Found::Label(labelled(&mut map.labels, label, None)),
            },
        );
    }
    let (width, height) = (picture.width, picture.height);
    let mut strange: FxHashSet<Color> = FxHashSet::default();
    let mut last = (WHITE, known.get(&WHITE).copied());
    // By column and from the bottom, as the cells of labels are sorted.
    for x in 0..width {
        for y in 0..height {
            let color = picture.color(x, height - 1 - y);
            if color != last.0 {
                last = (color, known.get(&color).copied());
            }
            match last.1 {
                Some(Found::Plain(Occupancy::Free)) => {}
                Some(Found::Plain(what)) => {
                    let at = map.index((x, y));
                    map.cells[at] = what;
                }
                Some(Found::Label(index)) => map.labels[index].cells.push((x, y)),
                None if strange.len() < MAX_ERRORS && strange.insert(color) => {
                    let name = name(color);
                    let message = format!(
                        "`{}` has the colour {name} at x = {x}, y = {y}, which has no meaning",
                        file.text
                    );
                    let help = format!(
                        "say what it is: `legend '{name}' = NAME;` or `legend '{name}' = #;`; a map of ROS is given by \
                         the YAML file that names its picture"
                    );
                    env.diagnostics
                        .push(Diagnostic::error("unknown-color", file.span, message).with_help(help));
                }
                None => {}
            }
        }
    }
    strange.is_empty().then_some(map)
}
