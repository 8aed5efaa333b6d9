//! Where a step was made, given what was seen: the posterior over a grid of places.

use covimap_embed::Point;

use super::Model;
use super::sensor::Curve;
use crate::LinkGraph;

/// Grid spacing, as a share of the range.
const SPACING: f64 = 0.2;
/// Radius of the grid around the middle of the landmarks seen, as a share of the range.
const GRID: f64 = 1.0;
/// Landmarks further than this from that middle, as a share of the range, say nothing.
const NEAR: f64 = 2.2;
/// Places below this share of the most likely one are passed over.
const NEGLIGIBLE: f64 = 1e-2;

/// A landmark that a step says something about.
#[derive(Debug, Clone, Copy)]
pub(super) struct Witness {
    pub landmark: u32,
    /// Position relative to the middle of the grid.
    pub at: Point,
    pub detectability: f64,
    pub seen: bool,
}

/// A step with the posterior of its place.
pub(super) struct Step<'a> {
    pub witnesses: &'a [Witness],
    /// Places, relative to the middle of the grid, and their posterior weights, which sum to 1.
    pub places: &'a [(Point, f64)],
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
    places: Vec<(Point, f64)>,
}

impl Workspace {
    pub fn new(landmarks: usize) -> Self {
        Self { links: vec![0; landmarks], nearby: Vec::new(), witnesses: Vec::new(), places: Vec::new() }
    }
}

impl<'a> Posterior<'a> {
    pub fn new(graph: &'a LinkGraph, model: &'a Model) -> Self {
        let range = model.sensor.range;
        let half = (GRID / SPACING).ceil() as i32;
        let mut grid: Vec<Point> = (-half..=half)
            .flat_map(|x| (-half..=half).map(move |y| [f64::from(x) * SPACING, f64::from(y) * SPACING]))
            .filter(|[x, y]| x.hypot(*y) <= GRID)
            .map(|[x, y]| [x * range, y * range])
            .collect();
        grid.sort_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])));
        Self { graph, model, curve: Curve::new(model.sensor, (NEAR + GRID) * range), grid }
    }

    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// The posterior of the place of a step that shows `seen`. No places where the sightings
    /// contradict each other altogether.
    pub fn of<'w>(&self, seen: &[u32], workspace: &'w mut Workspace) -> Step<'w> {
        self.find_witnesses(seen, workspace);
        let Workspace { witnesses, places, .. } = workspace;
        places.clear();
        let mut most = 0.0f64;
        for &place in &self.grid {
            let value = self.likelihood(place, witnesses, NEGLIGIBLE * most);
            most = most.max(value);
            places.push((place, value));
        }
        places.retain(|&(_, value)| value > NEGLIGIBLE * most);
        let total: f64 = places.iter().map(|place| place.1).sum();
        for place in places.iter_mut() {
            place.1 /= total;
        }
        Step { witnesses, places }
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

    fn find_witnesses(&self, seen: &[u32], workspace: &mut Workspace) {
        let middle = self.middle(seen);
        let Workspace { links, nearby, witnesses, .. } = workspace;
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
        let near = NEAR * self.model.sensor.range;
        let mut add = |landmark: u32, seen: bool| {
            let point = self.model.points[landmark as usize];
            let at = [point[0] - middle[0], point[1] - middle[1]];
            if at[0] * at[0] + at[1] * at[1] < near * near {
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
            let [visibility, _] = self.curve.at(dx * dx + dy * dy);
            let seen = self.model.sensor.probability(witness.detectability, visibility);
            product *= if witness.seen { seen } else { 1.0 - seen };
            if product < floor {
                return 0.0;
            }
        }
        product
    }
}
