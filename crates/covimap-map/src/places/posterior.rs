//! Where a step was made, given what was seen: the posterior over a grid of places.

use std::ops::Range;

use covimap_embed::{Point, wide};

use super::Model;
use super::grid::{CELLS, Cells, Cutting, NEAR, Sight};
use crate::LinkGraph;

/// Places below this share of the most likely one are passed over.
const NEGLIGIBLE: f32 = 1e-2;
/// Landmarks after which the product over them is brought back to one: no factor is below 1e-3, so
/// that this many cannot make it vanish.
const SCALED: usize = 8;

/// A landmark that a step says something about.
#[derive(Debug, Clone, Copy)]
pub(super) struct Witness {
    pub landmark: u32,
    pub cutting: Cutting,
    pub detectability: f32,
    pub seen: bool,
}

/// A step with the posterior of its place.
pub(super) struct Step<'a> {
    pub witnesses: &'a [Witness],
    /// Posterior weights of the places, which sum to 1.
    pub places: &'a Cells,
    /// Rows in which there are any.
    pub rows: Range<usize>,
}

/// What the expectation step needs of the present model.
pub(super) struct Posterior<'a> {
    model: &'a Model,
    neighbours: &'a Neighbours,
    sight: Sight,
}

/// Which landmarks are linked to which, and nothing else: it is read for every step.
pub(super) struct Neighbours {
    starts: Vec<usize>,
    linked: Vec<u32>,
}

impl Neighbours {
    pub fn new(graph: &LinkGraph) -> Self {
        let mut neighbours = Self { starts: vec![0], linked: Vec::with_capacity(2 * graph.link_count()) };
        for landmark in 0..graph.landmarks() as u32 {
            neighbours.linked.extend(graph.of(landmark).iter().map(|link| link.to));
            neighbours.starts.push(neighbours.linked.len());
        }
        neighbours
    }

    pub fn landmarks(&self) -> usize {
        self.starts.len() - 1
    }

    fn of(&self, landmark: u32) -> &[u32] {
        &self.linked[self.starts[landmark as usize]..self.starts[landmark as usize + 1]]
    }
}

/// Memory of one worker, used again for every step.
pub(super) struct Workspace {
    /// Links from the landmarks seen in the step, for every landmark; zero between steps.
    links: Vec<u32>,
    nearby: Vec<u32>,
    witnesses: Vec<Witness>,
    places: Cells,
}

impl Workspace {
    pub fn new(landmarks: usize) -> Self {
        Self {
            links: vec![0; landmarks],
            nearby: Vec::new(),
            witnesses: Vec::new(),
            places: [[0.0; CELLS]; CELLS],
        }
    }
}

impl<'a> Posterior<'a> {
    pub fn new(neighbours: &'a Neighbours, model: &'a Model) -> Self {
        Self { model, neighbours, sight: Sight::new(model.sensor) }
    }

    pub fn sight(&self) -> &Sight {
        &self.sight
    }

    /// The posterior of the place of a step that shows `seen`.
    pub fn of<'w>(&self, seen: &[u32], workspace: &'w mut Workspace) -> Step<'w> {
        self.find_witnesses(seen, workspace);
        let Workspace { witnesses, places, .. } = workspace;
        let rows = wide(
            #[inline(always)]
            || {
                self.multiply(witnesses, places);
                normalise(places)
            },
        );
        Step { witnesses, places, rows }
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
            for &linked in self.neighbours.of(landmark) {
                let count = &mut links[linked as usize];
                if *count == 0 {
                    nearby.push(linked);
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
                let detectability = self.model.detectability[landmark as usize] as f32;
                witnesses.push(Witness {
                    landmark,
                    cutting: Cutting::of(at, self.sight.spacing),
                    detectability,
                    seen,
                });
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

    /// Probability of the step's sightings from every place, eq. (2), up to a common factor.
    #[inline(always)]
    fn multiply(&self, witnesses: &[Witness], places: &mut Cells) {
        *places = [[1.0; CELLS]; CELLS];
        let e = self.sight.false_sighting;
        for some in witnesses.chunks(SCALED) {
            for witness in some {
                let by_sight = witness.detectability - e;
                let (constant, factor) = if witness.seen { (e, by_sight) } else { (1.0 - e, -by_sight) };
                for (row, places) in places.iter_mut().enumerate() {
                    let visibility = self.sight.visibility(witness.cutting, row);
                    for (place, v) in places.iter_mut().zip(visibility) {
                        *place *= constant + factor * v;
                    }
                }
            }
            let most = largest(places);
            places.as_flattened_mut().iter_mut().for_each(|place| *place /= most);
        }
    }
}

#[inline(always)]
fn largest(places: &Cells) -> f32 {
    let mut most = [0.0f32; CELLS];
    for row in places {
        for (most, &place) in most.iter_mut().zip(row) {
            *most = most.max(place);
        }
    }
    most.into_iter().fold(0.0, f32::max)
}

/// Drops the negligible places and makes the others sum to 1; returns the rows that hold any.
#[inline(always)]
fn normalise(places: &mut Cells) -> Range<usize> {
    let floor = NEGLIGIBLE * largest(places);
    let mut total = 0.0;
    let (mut first, mut end) = (CELLS, 0);
    for (row, places) in places.iter_mut().enumerate() {
        let mut sum = 0.0;
        for place in places {
            if *place <= floor {
                *place = 0.0;
            }
            sum += *place;
        }
        if sum > 0.0 {
            first = first.min(row);
            end = row + 1;
        }
        total += sum;
    }
    for place in places.as_flattened_mut() {
        *place /= total;
    }
    first..end
}
