//! When a path can matter in which states.

use crate::layers::Layers;
use hyperplan_space::StateIx;

/// When a path can matter in which states, as far as that was found out.
#[derive(Clone, Debug)]
pub(super) enum Presence {
    /// At each time in these.
    Layers(Layers),
    /// In each before some time, as a bound says.
    Until(Vec<u32>),
}

impl Presence {
    /// Whether the path can matter in a state at a time.
    pub(super) fn allows(&self, state: StateIx, time: u32) -> bool {
        match self {
            Presence::Layers(Layers { at }) => {
                at.get(time as usize).is_none_or(|layer| layer.binary_search(&state).is_ok())
            }
            Presence::Until(until) => time < until[state as usize],
        }
    }

    /// By state, the first time from which on it cannot matter any more. Of what is beyond the layers nothing is known.
    pub(super) fn until(&self, states: usize, end: u32) -> Vec<u32> {
        match self {
            Presence::Layers(Layers { at }) if at.len() <= end as usize => vec![u32::MAX; states],
            Presence::Layers(Layers { at }) => {
                let mut until = vec![0; states];
                for (time, layer) in (1..).zip(at) {
                    layer.iter().for_each(|&state| until[state as usize] = time);
                }
                until
            }
            Presence::Until(until) => until.clone(),
        }
    }
}
