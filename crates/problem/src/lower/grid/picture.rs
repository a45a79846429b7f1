//! Gray pictures of maps.

/// A gray picture; row 0 is the top one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// The shade of white.
    pub(crate) white: u16,
    /// Row by row.
    pub(crate) shades: Vec<u16>,
}

impl Picture {
    /// The shade of a pixel inside the picture.
    pub(crate) fn at(&self, x: u32, row: u32) -> u16 {
        self.shades[row as usize * self.width as usize + x as usize]
    }
}
