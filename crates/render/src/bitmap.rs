//! Pictures of cells inside of drawings.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// The cells of a map of that size as a picture in a link: so coloured where they are, and nothing elsewhere.
pub(crate) fn data((width, height): (u32, u32), cells: &[(u32, u32)], color: &str) -> String {
    let bytes_a_row = (width as usize).div_ceil(8);
    let mut rows = vec![0_u8; bytes_a_row * height as usize];
    for &(x, y) in cells.iter().filter(|(x, y)| *x < width && *y < height) {
        let row = (height - 1 - y) as usize;
        rows[row * bytes_a_row + x as usize / 8] |= 0x80 >> (x % 8);
    }
    let part =
        |at: usize| color.get(at..at + 2).and_then(|hex| u8::from_str_radix(hex, 16).ok()).unwrap_or(0);
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::One);
    encoder.set_palette(vec![255, 255, 255, part(1), part(3), part(5)]);
    encoder.set_trns(vec![0, 255]);
    encoder.set_compression(png::Compression::High);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&rows));
    // What is written into memory, in the size that was said, is written.
    written.expect("a picture of that many bits");
    format!("data:image/png;base64,{}", STANDARD.encode(file))
}
