//! Pictures as PNG and PDF, with a font that comes along: what they look like does not depend on the machine.

use crate::drawing::Drawing;
use crate::panel::Purpose;
use crate::style::FONT;
use crate::{Error, Scene};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::sync::{Arc, LazyLock};
use svg2pdf::{ConversionOptions, PageOptions};

/// Points of a PNG for each of the drawing, where the picture does not get too large so.
pub(crate) const DENSITY: f32 = 2.0;
/// The most points of a side.
pub(crate) const MOST_POINTS: f32 = 4000.0;

/// The one font that there is, for all families.
static FONTS: LazyLock<Arc<fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    let family = FONT.split(',').next().unwrap_or(FONT);
    fonts.set_sans_serif_family(family);
    fonts.set_serif_family(family);
    fonts.set_monospace_family(family);
    Arc::new(fonts)
});

/// The picture as PNG.
///
/// # Errors
/// As [`crate::svg`], and if it cannot be written so.
pub fn png(scene: Scene<'_>) -> Result<Vec<u8>, Error> {
    png_of(&Drawing::of(scene)?.text(Purpose::default()))
}

/// The picture as PDF, its text as text.
///
/// # Errors
/// As [`crate::svg`], and if it cannot be written so.
pub fn pdf(scene: Scene<'_>) -> Result<Vec<u8>, Error> {
    let tree = tree(&Drawing::of(scene)?.text(Purpose::default()), "PDF")?;
    let file = svg2pdf::to_pdf(&tree, ConversionOptions::default(), PageOptions::default())
        .map_err(|error| Error::Format { format: "PDF", reason: error.to_string() })?;
    Ok(ordered(&file))
}

/// The file with the entries of each table of resources in order, which `svg2pdf` writes as a hash table has them. Objects
/// stay where they are, as their places are in the file: an entry is a line, and no line gets into another object.
fn ordered(file: &[u8]) -> Vec<u8> {
    let mut lines: Vec<&[u8]> = file.split(|byte| *byte == b'\n').collect();
    for entries in lines.chunk_by_mut(|a, b| is_resource(a) && is_resource(b)) {
        if entries.len() > 1 {
            entries.sort_unstable();
        }
    }
    lines.join(&b'\n')
}

/// Whether a line is an entry of such a table: a name and a reference, such as `/po4 17 0 R`.
fn is_resource(line: &[u8]) -> bool {
    let Ok(line) = std::str::from_utf8(line) else { return false };
    let words: Vec<&str> = line.split(' ').filter(|word| !word.is_empty()).collect();
    let is_number = |word: &str| word.bytes().all(|byte| byte.is_ascii_digit());
    match words.as_slice() {
        [name, object, "0", "R"] => {
            name.starts_with('/') && name.ends_with(|c: char| c.is_ascii_digit()) && is_number(object)
        }
        _ => false,
    }
}

/// A drawing as PNG.
pub(crate) fn png_of(svg: &str) -> Result<Vec<u8>, Error> {
    let pixmap = pixmap(svg, DENSITY, MOST_POINTS, "PNG")?;
    pixmap.encode_png().map_err(|error| Error::Format { format: "PNG", reason: error.to_string() })
}

/// A drawing as points.
pub(crate) fn pixmap(svg: &str, density: f32, most: f32, format: &'static str) -> Result<Pixmap, Error> {
    let tree = tree(svg, format)?;
    let (width, height) = (tree.size().width(), tree.size().height());
    let density = density.min(most / width.max(height));
    let points = |length: f32| (length * density).ceil().max(1.0) as u32;
    let mut pixmap = Pixmap::new(points(width), points(height))
        .ok_or_else(|| Error::Format { format, reason: format!("{width} x {height} is no size") })?;
    resvg::render(&tree, Transform::from_scale(density, density), &mut pixmap.as_mut());
    Ok(pixmap)
}

/// A drawing of the same size as another, as points of the same density.
pub(crate) fn pixmap_of(svg: &str, like: &Pixmap, format: &'static str) -> Result<Pixmap, Error> {
    let tree = tree(svg, format)?;
    let mut pixmap = like.clone();
    pixmap.fill(Color::TRANSPARENT);
    let density = like.width() as f32 / tree.size().width().max(1.0);
    resvg::render(&tree, Transform::from_scale(density, density), &mut pixmap.as_mut());
    Ok(pixmap)
}

fn tree(svg: &str, format: &'static str) -> Result<Tree, Error> {
    let options = Options { fontdb: Arc::clone(&FONTS), ..Options::default() };
    Tree::from_str(svg, &options).map_err(|error| Error::Format { format, reason: error.to_string() })
}
