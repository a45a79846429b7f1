//! Pictures of maps.

/// A picture; row 0 is the top one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) pixels: Pixels,
}

/// Row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Pixels {
    /// Shades of gray, and that of white.
    Gray(Vec<u16>, u16),
    /// Colours, and whether the picture says how opaque they are.
    Color(Vec<Color>, bool),
}

/// Red, green, blue, and how opaque, of 255 each.
pub(crate) type Color = [u8; 4];

impl Picture {
    /// The position of a pixel, by column and row from the top.
    fn index(&self, x: u32, row: u32) -> usize {
        row as usize * self.width as usize + x as usize
    }

    /// How bright a pixel is, from 0 to 1: the mean of its colours, and on request of how opaque it is too, where the picture
    /// says that.
    pub(crate) fn brightness(&self, x: u32, row: u32, with_opacity: bool) -> f64 {
        match &self.pixels {
            Pixels::Gray(shades, white) => f64::from(shades[self.index(x, row)]) / f64::from(*white),
            Pixels::Color(colors, says_opacity) => {
                let color = &colors[self.index(x, row)];
                let channels = if with_opacity && *says_opacity { &color[..] } else { &color[..3] };
                let sum: u32 = channels.iter().map(|channel| u32::from(*channel)).sum();
                f64::from(sum) / (channels.len() * 255) as f64
            }
        }
    }

    /// Whether nothing shines through a pixel.
    pub(crate) fn is_opaque(&self, x: u32, row: u32) -> bool {
        match &self.pixels {
            Pixels::Gray(..) => true,
            Pixels::Color(colors, _) => colors[self.index(x, row)][3] == u8::MAX,
        }
    }

    /// The colour of a pixel; of a gray picture with more than 256 shades the nearest.
    pub(crate) fn color(&self, x: u32, row: u32) -> Color {
        match &self.pixels {
            Pixels::Gray(shades, white) => {
                let (shade, white) = (u32::from(shades[self.index(x, row)]), u32::from(*white));
                let gray = u8::try_from((shade * 255 + white / 2) / white).unwrap_or(u8::MAX);
                [gray, gray, gray, u8::MAX]
            }
            Pixels::Color(colors, _) => colors[self.index(x, row)],
        }
    }
}
