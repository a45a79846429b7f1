//! One script under construction, and the table that leads back from its values to paths.

use crate::atom::PathAtoms;
use crate::explicit::{ExplicitPath, FixedPath, Instances, Names};
use crate::inputs::{Move, Start};
use crate::path::{Instance, Known, Path, Shape};
use crate::reach::{Layers, Question, layers};
use crate::symbolic::{Builder, SymbolicPath};
use crate::unroll::Unroller;
use crate::{Encoder, Error, Graph, States};
use hyperplan_problem::PathId;
use hyperplan_smt::{Model, Script, Term};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// The paths over which the formula is unrolled, by path variable.
pub type Env = Vec<Option<Rc<Path>>>;

/// One script under construction.
pub struct Query<'e, 'a> {
    encoder: &'e Encoder<'a>,
    /// What has been asserted so far, and the terms.
    pub script: Script,
    /// Paths that are constants throughout, for pruning.
    fixed: Vec<Option<FixedPath>>,
    layers: FxHashMap<(PathId, bool), Rc<Layers>>,
    instances: Instances,
    /// How many copies of each path variable there are, for names.
    copies: FxHashMap<PathId, u32>,
}

pub(crate) fn names<'a>(encoder: &Encoder<'a>, path: PathId, copy: u32) -> Names<'a> {
    let name = &encoder.objective.paths[path].name;
    let path_name = if copy == 0 { name.clone() } else { format!("{name}!{copy}") };
    Names { problem: encoder.problem, system: encoder.system(path), path: path_name }
}

impl<'e, 'a> Query<'e, 'a> {
    /// An empty script for a question in which some paths are known.
    #[must_use]
    pub fn new(encoder: &'e Encoder<'a>, known: &[Option<Known>]) -> Self {
        let fixed = encoder
            .objective
            .paths
            .keys()
            .map(|path| match known.get(usize::from(path)) {
                Some(Some(Known::Explicit(fixed))) => Some(fixed.clone()),
                _ => None,
            })
            .collect();
        Query {
            encoder,
            script: Script::new(),
            fixed,
            layers: FxHashMap::default(),
            instances: Instances::default(),
            copies: FxHashMap::default(),
        }
    }

    /// An environment without paths.
    #[must_use]
    pub fn empty_env(&self) -> Env {
        vec![None; self.encoder.objective.paths.len()]
    }

    fn names(&mut self, path: PathId) -> Names<'a> {
        let copy = self.copies.entry(path).or_insert(0);
        let number = *copy;
        *copy += 1;
        names(self.encoder, path, number)
    }

    /// What can matter of a path for the formula to have the value `want`.
    fn layers(&mut self, path: PathId, want: bool) -> Result<Rc<Layers>, Error> {
        if let Some(known) = self.layers.get(&(path, want)) {
            return Ok(known.clone());
        }
        let encoder = self.encoder;
        let question = Question {
            problem: encoder.problem,
            objective: encoder.objective,
            graph: explicit_graph(encoder, path),
            path,
            horizon: encoder.horizon(path),
            want,
            fixed: &self.fixed,
        };
        let found = Rc::new(layers(&question, &encoder.limits)?);
        self.layers.insert((path, want), found.clone());
        Ok(found)
    }

    fn builder<'n>(&self, path: PathId, names: &'n Names<'a>) -> Builder<'n>
    where
        'e: 'n,
    {
        let model = self.encoder.model(path);
        Builder {
            names,
            moves: model.moves.as_deref().expect("symbolic paths have moves"),
            live: model.live.as_deref(),
            horizon: self.encoder.horizon(path),
        }
    }

    fn path(&self, path: PathId, shape: Shape) -> Rc<Path> {
        Rc::new(Path { shape, moves: self.encoder.model(path).moves.clone() })
    }

    /// A path that the solver chooses, for a formula that is to have the value `want`.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn declare(&mut self, path: PathId, want: bool) -> Result<Rc<Path>, Error> {
        let names = self.names(path);
        let shape = match self.encoder.states {
            States::Onehot => {
                let layers = self.layers(path, want)?;
                let graph = explicit_graph(self.encoder, path);
                Shape::Explicit(ExplicitPath::declare(&mut self.script, &names, graph, &layers))
            }
            States::Bitvec => {
                let declared = self.builder(path, &names).declare(&mut self.script);
                Shape::Symbolic(declared)
            }
        };
        Ok(self.path(path, shape))
    }

    /// A path under a quantifier: the path, the bound variables, and the condition that they describe a path.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn bind(&mut self, path: PathId, want: bool) -> Result<(Rc<Path>, Vec<Term>, Term), Error> {
        let names = self.names(path);
        let (shape, bound, guard) = match self.encoder.states {
            States::Onehot => {
                let layers = self.layers(path, want)?;
                let graph = explicit_graph(self.encoder, path);
                let (path, bound, guard) = ExplicitPath::bind(&mut self.script.terms, &names, graph, &layers);
                (Shape::Explicit(path), bound, guard)
            }
            States::Bitvec => {
                let builder = self.builder(path, &names);
                let (path, bound, guard) = builder.bind(&mut self.script.terms);
                (Shape::Symbolic(path), bound, guard)
            }
        };
        Ok((self.path(path, shape), bound, guard))
    }

    /// A known path, as constants.
    #[must_use]
    pub fn fix(&self, path: PathId, known: &Known) -> Rc<Path> {
        let shape = match known {
            Known::Explicit(fixed) => Shape::Explicit(ExplicitPath::fix(fixed)),
            Known::Symbolic(fixed) => {
                let names = names(self.encoder, path, 0);
                Shape::Symbolic(self.builder(path, &names).fix(fixed))
            }
        };
        self.path(path, shape)
    }

    /// An instance of a path whose player wants the formula at `want`: the path, and the condition that it is one.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn instantiate(
        &mut self,
        path: PathId,
        instance: &Instance,
        env: &Env,
        want: bool,
    ) -> Result<(Rc<Path>, Term), Error> {
        let (shape, guard) = match instance {
            Instance::Explicit(inputs) => {
                let layers = self.layers(path, want)?;
                let graph = explicit_graph(self.encoder, path);
                let others: Vec<Option<&ExplicitPath>> =
                    env.iter().map(|p| p.as_deref().and_then(explicit)).collect();
                let terms = &mut self.script.terms;
                let (path, guard) = self.instances.build(terms, graph, &layers, inputs, &others);
                (Shape::Explicit(path), guard)
            }
            Instance::Symbolic(inputs) => {
                let names = names(self.encoder, path, 0);
                let builder = self.builder(path, &names);
                let others: Vec<Option<&SymbolicPath>> =
                    env.iter().map(|p| p.as_deref().and_then(symbolic)).collect();
                let (path, guard) = builder.instantiate(&mut self.script.terms, inputs, &others);
                (Shape::Symbolic(path), guard)
            }
        };
        Ok((self.path(path, shape), guard))
    }

    /// Whether a declared path is like a counterexample: starts like it and takes the actions that the instance
    /// made of it gives outright. Used to ask for a different one.
    pub fn resembles(&mut self, terms: &Path, instance: &Instance) -> Term {
        let script_terms = &mut self.script.terms;
        let mut parts = Vec::new();
        match (&terms.shape, instance) {
            (Shape::Explicit(path), Instance::Explicit(inputs)) => {
                if let Start::State(state) = inputs.start {
                    parts.push(path.layers[0].is(state));
                }
                for (step, movement) in path.steps.iter().zip(&inputs.moves) {
                    if let Move::Act(action, _) = *movement {
                        parts.push(step.took(action));
                    }
                }
            }
            (Shape::Symbolic(path), Instance::Symbolic(inputs)) => {
                if let Start::State(row) = &inputs.start {
                    for (value, &code) in path.states[0].iter().zip(row) {
                        parts.push(crate::value::equal(script_terms, value, code));
                    }
                }
                for (step, movement) in path.steps.iter().zip(&inputs.moves) {
                    if let Move::Act(action, _) = *movement {
                        parts.push(step.took(action));
                    }
                }
            }
            _ => {}
        }
        script_terms.and(&parts)
    }

    /// The formula over these paths, which must be all that it reads.
    pub fn formula(&mut self, env: &Env) -> Term {
        let encoder = self.encoder;
        let atoms = PathAtoms::new(encoder.problem, encoder.objective, env);
        let mut unroller = Unroller::new(&encoder.objective.formula, encoder.objective.mode, atoms);
        unroller.root(&mut self.script.terms)
    }

    /// The path that a model describes; `None` if it is none, which a right model cannot cause.
    #[must_use]
    pub fn decode(&self, path: PathId, terms: &Path, model: &Model) -> Option<Known> {
        match &terms.shape {
            Shape::Explicit(explicit) => explicit.decode(model).map(Known::Explicit),
            Shape::Symbolic(symbolic) => {
                let moves = terms.moves.as_deref()?;
                symbolic.decode(self.encoder.system(path), moves, model).map(Known::Symbolic)
            }
        }
    }
}

fn explicit(path: &Path) -> Option<&ExplicitPath> {
    match &path.shape {
        Shape::Explicit(path) => Some(path),
        Shape::Symbolic(_) => None,
    }
}

fn symbolic(path: &Path) -> Option<&SymbolicPath> {
    match &path.shape {
        Shape::Symbolic(path) => Some(path),
        Shape::Explicit(_) => None,
    }
}

fn explicit_graph<'e>(encoder: &'e Encoder<'_>, path: PathId) -> &'e Rc<Graph> {
    encoder.graph(path).expect("onehot encodings enumerate every system")
}
