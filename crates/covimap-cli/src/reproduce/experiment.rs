//! What an experiment is: a table of settings, each run in several layouts, each log mapped by several methods.

use covimap_map::{MapperParams, Method, Phi};
use covimap_sim::SimSpec;

/// One of the paper's simulation experiments.
#[derive(Debug, Clone)]
pub struct Experiment {
    /// Name on the command line and of the files.
    pub name: &'static str,
    /// Heading of the figure.
    pub title: &'static str,
    /// The paper's figure, or figures.
    pub figure: &'static str,
    /// What is compared.
    pub settings: Vec<Setting>,
    /// Placings of the objects, each a world of its own.
    pub layouts: u64,
    /// Walks from random starts in each layout.
    pub walks: u64,
    /// Steps after which maps are made, ascending; all of them are maps of prefixes of one log.
    pub steps: Vec<usize>,
    /// Methods, all on the same logs.
    pub methods: Vec<MapMethod>,
    /// What the figure shows.
    pub view: View,
}

/// One of the things compared.
#[derive(Debug, Clone)]
pub struct Setting {
    /// Name in the legend, with its unit.
    pub label: String,
    /// World and run.
    pub spec: SimSpec,
}

/// What a figure shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// Both errors against the number of steps.
    Steps,
    /// The orientation error against the number of steps and against the co-visibility information.
    Information,
    /// Both errors against the spread and the evenness of the observations, a dot a run.
    Exploration,
}

/// A way to make a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapMethod {
    /// The best the project has.
    Auto,
    /// The paper's method with one of its distance functions, with or without the triangle-inequality constraint.
    Classical(Phi, bool),
}

impl MapMethod {
    /// The paper's choice after Sim 1.
    pub const PAPER: Self = Self::Classical(Phi::Phi2, true);

    pub fn label(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Classical(Phi::Phi1, false) => "phi1",
            Self::Classical(Phi::Phi1, true) => "phi1 + TIC",
            Self::Classical(Phi::Phi2, false) => "phi2",
            Self::Classical(Phi::Phi2, true) => "classical",
        }
    }

    pub fn params(self) -> MapperParams {
        let mut params = MapperParams::default();
        if let Self::Classical(phi, tic) = self {
            params.method = Method::Classical;
            params.classical.phi = phi;
            params.classical.tic = tic;
        }
        params
    }
}

/// The two errors of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Delaunay error, eq. (7).
    Delaunay,
    /// Triangle-orientation error, eq. (8).
    Orientation,
}

impl Measure {
    pub const BOTH: [Self; 2] = [Self::Delaunay, Self::Orientation];

    /// The paper's name for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Delaunay => "Errdel",
            Self::Orientation => "Errori",
        }
    }

    pub fn in_words(self) -> &'static str {
        match self {
            Self::Delaunay => "Delaunay error",
            Self::Orientation => "Triangle orientation error",
        }
    }
}
