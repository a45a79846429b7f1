//! The files that problems name.

use super::env::Env;
use super::grid::formats;
use hyperplan_syntax::Diagnostic;
use hyperplan_syntax::ast::Text;

/// The text of a file that the problem names, where `wanted` is expected; without a byte order mark.
pub(super) fn load_text(file: &Text, wanted: &str, env: &mut Env) -> Option<String> {
    let bytes = load(file, env)?;
    text_of(file, bytes, wanted, env)
}

/// The bytes of a file; `None` after a message.
pub(super) fn load(file: &Text, env: &mut Env) -> Option<Vec<u8>> {
    env.loader.load(&file.text).map_or_else(
        |reason| {
            let help = "paths are relative to the problem file";
            let message = format!("cannot read `{}`: {reason}", file.text);
            env.diagnostics.refuse(Diagnostic::error("cannot-read", file.span, message).with_help(help))
        },
        Some,
    )
}

/// The bytes of a file as a text; `None` after a message.
pub(super) fn text_of(file: &Text, bytes: Vec<u8>, wanted: &str, env: &mut Env) -> Option<String> {
    let (path, span) = (&file.text, file.span);
    if formats::is_picture(&bytes) {
        let message = format!("`{path}` is a picture, not {wanted}");
        let help = "a map of ROS is given by the YAML file that names its picture: `grid(\"map.yaml\")`; pictures in PNG are \
                    maps themselves";
        return env.diagnostics.refuse(Diagnostic::error("not-text", span, message).with_help(help));
    }
    match String::from_utf8(bytes) {
        Ok(mut text) if !text.contains('\0') => {
            if text.starts_with('\u{feff}') {
                text.drain(..'\u{feff}'.len_utf8());
            }
            Some(text)
        }
        _ => {
            let message = format!("`{path}` is not a text file");
            env.diagnostics.refuse(Diagnostic::error("not-text", span, message))
        }
    }
}
