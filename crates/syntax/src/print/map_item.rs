//! Items that say how the cells of a map come about.

use super::system::quoted;
use super::{Printer, end};
use crate::ast::MapItem;

impl Printer<'_> {
    /// The item without its `;`; where what it says ends.
    pub(super) fn map_item(&mut self, item: &MapItem) -> usize {
        self.layout.text(format!("{} ", item.word()));
        match item {
            MapItem::Scenario { file, row } => {
                self.layout.text(format!("{} ", quoted(&file.text)));
                self.arithmetic(row);
                end(row)
            }
            MapItem::Unknown(rule) => {
                self.layout.text(rule.name.clone());
                rule.span.end as usize
            }
            MapItem::Inflate { by, metres } => {
                self.arithmetic(by);
                let Some(metres) = metres else { return end(by) };
                self.layout.text(" m");
                metres.end as usize
            }
            MapItem::Clearance { name, most } => {
                self.layout.text(format!("{} ", name.name));
                self.arithmetic(most);
                end(most)
            }
            MapItem::Scale(by) => {
                self.arithmetic(by);
                end(by)
            }
            MapItem::Crop(part) => {
                let (x, y) = (&part.x, &part.y);
                self.range(&x.0, &x.1);
                self.layout.text(", ");
                self.range(&y.0, &y.1);
                end(&y.1)
            }
        }
    }
}
