//! Items that say how the cells of a map come about.

use super::{Parse, Parser};
use crate::ast::{Area, Expr, MapItem};
use crate::token::Tok;

impl Parser<'_> {
    /// The item behind its word, without the `;`, and what may stand there instead of it.
    pub(super) fn map_item(&mut self, word: &str) -> Parse<(MapItem, &'static str)> {
        Ok(match word {
            "scenario" => {
                let file = self.string("the name of a file with scenarios in quotes")?;
                if self.peek() == Tok::Semi {
                    let help = "say which of its scenarios: `scenario \"a.scen\" 1;` is the first";
                    return self.fail_with("a number", Some(help.to_owned()));
                }
                (MapItem::Scenario { file, row: self.arithmetic()? }, "an operator or `;`")
            }
            "unknown" => (MapItem::Unknown(self.name("`obstacle` or `free`")?), "`;`"),
            "inflate" => {
                let by = self.arithmetic()?;
                let metres = self.eat_word("m").map(|token| token.span);
                let expected = if metres.is_some() { "`;`" } else { "an operator, `m` or `;`" };
                (MapItem::Inflate { by, metres }, expected)
            }
            "clearance" => {
                let name = self.name("the name of a label")?;
                if self.peek() == Tok::Semi {
                    let help = "say up to how many cells are counted: `clearance gap 4;`";
                    return self.fail_with("a number", Some(help.to_owned()));
                }
                (MapItem::Clearance { name, most: self.arithmetic()? }, "an operator or `;`")
            }
            "scale" => (MapItem::Scale(self.arithmetic()?), "an operator or `;`"),
            _ => {
                let x = self.columns_or_rows()?;
                self.expect(Tok::Comma, "`,` and the range of rows, as in `crop 0..9, 0..9;`")?;
                (MapItem::Crop(Box::new(Area { x, y: self.columns_or_rows()? })), "an operator or `;`")
            }
        })
    }

    fn columns_or_rows(&mut self) -> Parse<(Expr, Expr)> {
        let first = self.arithmetic()?;
        self.expect(Tok::DotDot, "`..` and the upper end of the range")?;
        Ok((first, self.arithmetic()?))
    }
}
