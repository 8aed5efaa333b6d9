//! Where a step was made, given what was seen: the posterior over a grid of places.

use covimap_embed::Point;

use super::scoring::{Scores, SharedScores, Term};
use super::{Model, Sensor};
use crate::LinkGraph;

/// Grid spacing, as a share of the range.
const SPACING: f64 = 0.2;
/// Radius of the grid around the middle of the landmarks seen, as a share of the range.
const GRID: f64 = 1.0;
/// Landmarks further than this from that middle, as a share of the range, say nothing.
const NEAR: f64 = 2.2;
/// Probability `e` of a sighting that should not be.
const FALSE_SIGHTING: f64 = 1e-3;
/// Cells below this share of the most likely one are passed over.
const NEGLIGIBLE: f64 = 1e-3;
/// Entries of the table of the visibility curve over squared distance.
const TABLE: usize = 4096;

/// The visibility curve `1 / (1 + exp((d - R) / s))`, tabulated over `d^2`.
struct Curve {
    values: Vec<f64>,
    per_square: f64,
}

impl Curve {
    fn new(sensor: Sensor) -> Self {
        let most = (NEAR + GRID) * sensor.range;
        let per_square = TABLE as f64 / (most * most);
        let values = (0..=TABLE)
            .map(|k| {
                let distance = ((k as f64 + 0.5) / per_square).sqrt();
                1.0 / (1.0 + ((distance - sensor.range) / sensor.edge).exp())
            })
            .collect();
        Self { values, per_square }
    }

    fn at(&self, square: f64) -> f64 {
        self.values[((square * self.per_square) as usize).min(TABLE)]
    }
}

/// A landmark that a step says something about.
#[derive(Clone, Copy)]
struct Witness {
    landmark: u32,
    /// Position relative to the middle of the grid.
    at: Point,
    detectability: f64,
    seen: bool,
}

/// What the expectation step needs of the present model.
pub(super) struct Posterior<'a> {
    graph: &'a LinkGraph,
    model: &'a Model,
    curve: Curve,
    /// Grid places relative to its middle, from there outwards: the likely ones come first.
    grid: Vec<Point>,
}

/// Memory of one worker, used again for every step.
pub(super) struct Workspace {
    /// Links from the landmarks seen in the step, for every landmark; zero between steps.
    links: Vec<u32>,
    nearby: Vec<u32>,
    witnesses: Vec<Witness>,
    likelihood: Vec<f64>,
    /// Scores of the landmarks in `touched`; zero elsewhere.
    scores: Vec<Scores>,
    touched: Vec<u32>,
    shared: SharedScores,
}

impl Workspace {
    pub fn new(landmarks: usize) -> Self {
        Self {
            links: vec![0; landmarks],
            nearby: Vec::new(),
            witnesses: Vec::new(),
            likelihood: Vec::new(),
            scores: vec![Scores::default(); landmarks],
            touched: Vec::new(),
            shared: SharedScores::default(),
        }
    }

    /// The scores gathered since the last call, by landmark.
    pub fn take(&mut self) -> (Vec<(u32, Scores)>, SharedScores) {
        self.touched.sort_unstable();
        let touched = self
            .touched
            .drain(..)
            .map(|landmark| (landmark, std::mem::take(&mut self.scores[landmark as usize])))
            .collect();
        (touched, std::mem::take(&mut self.shared))
    }
}

impl<'a> Posterior<'a> {
    pub fn new(graph: &'a LinkGraph, model: &'a Model) -> Self {
        let spacing = SPACING * model.sensor.range;
        let half = (GRID / SPACING).ceil() as i32;
        let mut grid: Vec<Point> = (-half..=half)
            .flat_map(|x| (-half..=half).map(move |y| [f64::from(x), f64::from(y)]))
            .filter(|[x, y]| x.hypot(*y) * SPACING <= GRID)
            .map(|[x, y]| [x * spacing, y * spacing])
            .collect();
        grid.sort_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])));
        Self { graph, model, curve: Curve::new(model.sensor), grid }
    }

    /// Adds the scores of `times` steps that show exactly `seen`.
    pub fn score(&self, seen: &[u32], times: f64, workspace: &mut Workspace) {
        let middle = self.middle(seen);
        self.find_witnesses(seen, middle, workspace);
        let Workspace { witnesses, likelihood, scores, touched, shared, .. } = workspace;
        likelihood.clear();
        let mut most = 0.0f64;
        for &place in &self.grid {
            let value = self.likelihood(place, witnesses, NEGLIGIBLE * most);
            most = most.max(value);
            likelihood.push(value);
        }
        // Nothing is left of the likelihood where the sightings contradict each other altogether.
        if most <= 0.0 {
            return;
        }
        let total: f64 = likelihood.iter().filter(|&&value| value > NEGLIGIBLE * most).sum();
        shared.log_likelihood += times * (total / self.grid.len() as f64).ln();
        for (&place, &value) in
            self.grid.iter().zip(&*likelihood).filter(|(_, value)| **value > NEGLIGIBLE * most)
        {
            let weight = times * value / total;
            for witness in &*witnesses {
                let offset = [witness.at[0] - place[0], witness.at[1] - place[1]];
                let square = offset[0] * offset[0] + offset[1] * offset[1];
                let own = &mut scores[witness.landmark as usize];
                if own.is_empty() {
                    touched.push(witness.landmark);
                }
                let visibility = self.curve.at(square);
                let term = Term {
                    seen: witness.seen,
                    probability: probability(witness.detectability, visibility),
                    detectability: witness.detectability,
                    visibility,
                    offset,
                    distance: square.sqrt(),
                };
                own.gather(&term, weight, self.model.sensor, shared);
            }
        }
    }

    /// Median of the coordinates: a false sighting does not move it far.
    fn middle(&self, seen: &[u32]) -> Point {
        [0, 1].map(|axis| {
            let mut values: Vec<f64> = seen.iter().map(|&i| self.model.points[i as usize][axis]).collect();
            let half = values.len() / 2;
            let (below, &mut upper, _) = values.select_nth_unstable_by(half, f64::total_cmp);
            if seen.len() % 2 == 1 {
                upper
            } else {
                (upper + below.iter().copied().fold(f64::MIN, f64::max)) / 2.0
            }
        })
    }

    fn find_witnesses(&self, seen: &[u32], middle: Point, workspace: &mut Workspace) {
        let Workspace { links, nearby, witnesses, .. } = workspace;
        nearby.clear();
        for &landmark in seen {
            for link in self.graph.of(landmark) {
                let count = &mut links[link.to as usize];
                if *count == 0 {
                    nearby.push(link.to);
                }
                *count += 1;
            }
        }
        witnesses.clear();
        let mut add = |landmark: u32, seen: bool| {
            let point = self.model.points[landmark as usize];
            let at = [point[0] - middle[0], point[1] - middle[1]];
            if at[0].hypot(at[1]) < NEAR * self.model.sensor.range {
                let detectability = self.model.detectability[landmark as usize];
                witnesses.push(Witness { landmark, at, detectability, seen });
            }
        };
        for &landmark in seen {
            add(landmark, true);
        }
        for landmark in nearby.drain(..) {
            let count = std::mem::take(&mut links[landmark as usize]);
            if 2 * count as usize >= seen.len() && seen.binary_search(&landmark).is_err() {
                add(landmark, false);
            }
        }
    }

    /// Probability of the step's sightings from a place, eq. (2); 0 as soon as it is known to be below
    /// `floor`, for no factor exceeds 1.
    fn likelihood(&self, place: Point, witnesses: &[Witness], floor: f64) -> f64 {
        let mut product = 1.0;
        for witness in witnesses {
            let (dx, dy) = (witness.at[0] - place[0], witness.at[1] - place[1]);
            let seen = probability(witness.detectability, self.curve.at(dx * dx + dy * dy));
            product *= if witness.seen { seen } else { 1.0 - seen };
            if product < floor {
                return 0.0;
            }
        }
        product
    }
}

/// Eq. (1).
fn probability(detectability: f64, visibility: f64) -> f64 {
    FALSE_SIGHTING + (detectability - FALSE_SIGHTING) * visibility
}
