//! Enumerations whose values have names.

/// The names of an enumeration's values: to write, to read, and to list.
macro_rules! names {
    ($vis:vis $type:ident: $($value:ident $name:literal),*) => {
        impl $type {
            /// All values.
            $vis const ALL: [Self; [$($name),*].len()] = [$(Self::$value),*];

            /// The value's name, as it is written.
            #[must_use]
            $vis fn name(self) -> &'static str {
                match self { $(Self::$value => $name),* }
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl std::str::FromStr for $type {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                let found = Self::ALL.into_iter().find(|value| value.name() == text);
                found.ok_or_else(|| format!("`{text}` is none of {}", Self::ALL.map(Self::name).join(", ")))
            }
        }
    };
}

pub(crate) use names;
