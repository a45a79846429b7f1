//! PNG pictures.

use super::picture::{Picture, Pixels};
use ::png::{ColorType, Decoder, Transformations};
use std::io::Cursor;

/// Reads a picture of at most so many pixels, with eight bits a channel.
pub(super) fn read(bytes: &[u8], most: usize) -> Result<Picture, String> {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let (width, height) = reader.info().size();
    if (width as usize).saturating_mul(height as usize) > most {
        return Err(format!("the picture has more than {most} pixels"));
    }
    let size = reader.output_buffer_size().ok_or("the picture is too large")?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(|error| error.to_string())?;
    bytes.truncate(frame.buffer_size());
    let pixels = match frame.color_type {
        ColorType::Grayscale => Pixels::Gray(bytes.into_iter().map(u16::from).collect(), 255),
        ColorType::GrayscaleAlpha => {
            Pixels::Color(bytes.chunks_exact(2).map(|p| [p[0], p[0], p[0], p[1]]).collect(), true)
        }
        ColorType::Rgb => {
            Pixels::Color(bytes.chunks_exact(3).map(|p| [p[0], p[1], p[2], u8::MAX]).collect(), false)
        }
        ColorType::Rgba => {
            Pixels::Color(bytes.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect(), true)
        }
        ColorType::Indexed => return Err("its colours have no values".into()),
    };
    Ok(Picture { width, height, pixels })
}
