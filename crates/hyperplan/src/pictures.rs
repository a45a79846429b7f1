//! Pictures of a map, of a strategy's paths, and of those that it has to cope with, as files.

use crate::failure::{Failure, Result};
use crate::files::write_bytes;
use crate::plans::with_name;
use hyperplan::draw::{Kind, Subject};
use hyperplan_render::Film;
use std::fs;
use std::path::{Path, PathBuf};

/// A file to draw into, its kind known from its name.
#[derive(Clone)]
pub(crate) struct Picture {
    path: PathBuf,
    kind: Kind,
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

/// Draws into a file.
pub(crate) fn draw(subject: &Subject<'_>, picture: &Picture) -> Result<()> {
    let drawn = subject.draw(picture.kind).map_err(Failure::input)?;
    write_bytes(&picture.path, &drawn)
}

/// Draws a picture for each time into a folder, which is made if it is not there.
pub(crate) fn frames(subject: &Subject<'_>, folder: &Path, as_svg: bool) -> Result<usize> {
    let film = subject.with_scene(Film::of).map_err(Failure::input)?;
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
