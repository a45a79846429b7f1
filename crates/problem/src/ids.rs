//! Ids: small integers that cannot be mixed up.

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub u32);

        impl From<usize> for $name {
            fn from(index: usize) -> Self {
                $name(u32::try_from(index).expect("fewer than 2^32 of everything"))
            }
        }

        impl From<$name> for usize {
            fn from(id: $name) -> usize {
                id.0 as usize
            }
        }
    )*};
}

ids! {
    /// A system of a problem.
    SystemId;
    /// A state variable of one system.
    VarId;
    /// A label of one system.
    LabelId;
    /// A cost of one system.
    CostId;
    /// A number that the transitions of one graph carry.
    AttributeId;
    /// An action name; the same name in two systems is the same action.
    ActionId;
    /// A path variable of one objective, in the order of quantification.
    PathId;
    /// A node of one objective's formula; children have smaller ids than their parents.
    FormulaId;
}
