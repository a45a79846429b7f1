//! PNG pictures, as shades of gray.

use super::picture::Picture;
use ::png::{Decoder, Transformations};
use std::io::Cursor;

/// Reads a picture of at most so many pixels. A pixel's shade is the mean of its channels, transparency among them, as
/// the `map_server` of ROS has it for maps of two shades.
pub(super) fn read(bytes: &[u8], most: usize) -> Result<Picture, String> {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let (width, height) = reader.info().size();
    if (width as usize).saturating_mul(height as usize) > most {
        return Err(format!("the picture has more than {most} pixels"));
    }
    let size = reader.output_buffer_size().ok_or("the picture is too large")?;
    let mut pixels = vec![0; size];
    let frame = reader.next_frame(&mut pixels).map_err(|error| error.to_string())?;
    let channels = frame.color_type.samples();
    let mean = |pixel: &[u8]| pixel.iter().map(|c| u16::from(*c)).sum::<u16>() / channels as u16;
    let shades = pixels[..frame.buffer_size()].chunks_exact(channels).map(mean).collect();
    Ok(Picture { width, height, white: 255, shades })
}
