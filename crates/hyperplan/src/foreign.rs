//! Files of other tools, in place of a problem file: what they mean.

use hyperplan_import::{Imported, Input, Options, import};
use hyperplan_problem::{Lowered, NoFiles, Overrides, lower};
use hyperplan_syntax::{Diagnostic, SourceMap, print};

/// Models and formulas, with their texts.
#[derive(Clone, Debug)]
pub(crate) struct Foreign {
    pub(crate) inputs: Vec<Input>,
    pub(crate) options: Options,
}

impl Foreign {
    /// What the files mean, and what is wrong with them.
    pub(crate) fn lower(&self, overrides: &Overrides) -> (Lowered, SourceMap) {
        let (lowered, sources, _) = self.read(overrides);
        (lowered, sources)
    }

    /// The same, with what the files became.
    pub(crate) fn read(&self, overrides: &Overrides) -> (Lowered, SourceMap, Imported) {
        let mut sources = SourceMap::new();
        let mut imported = import(&self.inputs, &self.options, &mut sources);
        for diagnostic in &mut imported.diagnostics {
            match diagnostic.code {
                "unbounded-operator" => diagnostic.help = Some("say it with `--bound K`".to_owned()),
                "other-precedence" => {
                    let help =
                        "this is read as it does; parentheses make it plain, and `--dialect` names another";
                    diagnostic.help = Some(help.to_owned());
                }
                _ => {}
            }
        }
        let mut diagnostics = std::mem::take(&mut imported.diagnostics);
        if diagnostics.iter().any(Diagnostic::is_error) {
            return (Lowered { diagnostics, ..Lowered::default() }, sources, imported);
        }
        let mut lowered = lower(&imported.file, &mut sources, &NoFiles, overrides);
        diagnostics.append(&mut lowered.diagnostics);
        // What stands in a model is not there for one formula alone: nothing of it is called unused.
        let unused = std::mem::take(&mut imported.doubts);
        (Lowered { diagnostics, unused, ..lowered }, sources, imported)
    }
}

/// What files became, as a problem file that says where things come from.
pub(crate) fn text(imported: &Imported) -> String {
    format!("{}\n{}", imported.about, print(&imported.file, ""))
}
