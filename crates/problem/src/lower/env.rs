//! What lowering a system takes.

use super::Loader;
use super::base::Actions;
use super::consts::Consts;
use super::diagnostics::Diagnostics;
use hyperplan_syntax::SourceMap;

/// What lowering a system needs besides its syntax.
pub(crate) struct Env<'a> {
    pub(crate) consts: &'a Consts,
    pub(crate) actions: &'a mut Actions,
    pub(crate) diagnostics: &'a mut Diagnostics,
    pub(crate) sources: &'a mut SourceMap,
    pub(crate) loader: &'a dyn Loader,
}
