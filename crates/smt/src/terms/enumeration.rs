//! Enumerations: datatypes whose constructors are constants.

use super::{EnumerationText, Terms};
use crate::name::Mangled;
use crate::term::{Enumeration, Term};
use crate::value::Value;

impl Terms {
    /// A new enumeration. It must have a constructor; its name has to differ from those of other sorts, and its
    /// constructors' from all other symbols, as SMT-LIB knows no overloading.
    pub fn enumeration<'n>(
        &mut self,
        name: &str,
        constructors: impl IntoIterator<Item = impl AsRef<str> + 'n>,
    ) -> Enumeration {
        let constructors: Vec<Mangled> =
            constructors.into_iter().map(|constructor| Mangled::new(constructor.as_ref())).collect();
        assert!(!constructors.is_empty(), "enumeration {name} has no constructors");
        self.add_enumeration(Mangled::new(name), constructors)
    }

    /// A new enumeration that is written exactly so, with at least one constructor.
    pub(crate) fn verbatim_enumeration(&mut self, name: &str, constructors: &[&str]) -> Enumeration {
        let constructors = constructors.iter().map(|constructor| Mangled::verbatim(constructor)).collect();
        self.add_enumeration(Mangled::verbatim(name), constructors)
    }

    fn add_enumeration(&mut self, name: Mangled, constructors: Vec<Mangled>) -> Enumeration {
        let number = u32::try_from(self.enumerations.len()).expect("fewer than 2^32 enumerations");
        self.enumerations.push(EnumerationText { name, constructors });
        Enumeration(number)
    }

    /// A constructor, by its position.
    pub fn constructor(&mut self, enumeration: Enumeration, position: u32) -> Term {
        self.constant(Value::Enum(enumeration, position))
    }

    /// How many constructors an enumeration has.
    #[must_use]
    pub fn constructors(&self, enumeration: Enumeration) -> u32 {
        self.enumerations[enumeration.0 as usize].constructors.len() as u32
    }

    /// Whether there is an enumeration.
    #[must_use]
    pub fn has_enumerations(&self) -> bool {
        !self.enumerations.is_empty()
    }

    /// The constructor that is written so, quotes included.
    #[must_use]
    pub fn constructor_called(&self, enumeration: Enumeration, text: &str) -> Option<Value> {
        let constructors = &self.enumerations[enumeration.0 as usize].constructors;
        let position = constructors.iter().position(|name| name.is_written(text))?;
        Some(Value::Enum(enumeration, position as u32))
    }

    pub(crate) fn enumeration_name(&self, enumeration: Enumeration) -> &Mangled {
        &self.enumerations[enumeration.0 as usize].name
    }

    pub(crate) fn constructor_names(&self, enumeration: Enumeration) -> &[Mangled] {
        &self.enumerations[enumeration.0 as usize].constructors
    }
}
