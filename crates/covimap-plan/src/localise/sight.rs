//! What a look says of the places in one neighbourhood: eq. (1) of the module above.

use std::f64::consts::PI;

use covimap_embed::Point;
use covimap_map::{GlobalMap, LandmarkId};

use super::surroundings::Surroundings;
use super::{Look, distance};

/// Places further than this from the middle of the neighbourhood, as a share of the range, are not looked
/// at.
pub(super) const PLACES: f64 = 1.2;
/// Landmarks further than this from a place, in edges beyond the range, are out of sight: the chance to see
/// them is below 1 in 3000.
const OUT_OF_SIGHT: f64 = 8.0;
/// Pairs up to this share of the range have been tested for occlusion.
const TESTED: f64 = 1.2;
/// Products below this are put away as logarithms.
const SMALL: f64 = 1e-200;

/// A landmark that a look says something of.
struct Witness {
    landmark: LandmarkId,
    at: Point,
    detectability: f64,
    /// Edge of its visibility, its own uncertainty included.
    edge: f64,
    seen: bool,
}

/// A look, ready to be judged from places in one neighbourhood.
pub(super) struct Sight {
    witnesses: Vec<Witness>,
    /// IDs seen of which no landmark is near.
    elsewhere: usize,
    /// Chance `e` of a false sighting of one landmark.
    falsely: f64,
    /// Range of the sensor.
    pub range: f64,
}

impl Sight {
    /// Gathers what can be seen from places within [`PLACES`] ranges of `middle`.
    pub fn new(
        surroundings: &Surroundings,
        map: &GlobalMap,
        look: &Look,
        component: u32,
        middle: Point,
        falsely: f64,
    ) -> Self {
        let sensing = map.sensing().expect("a localiser has one (bug in covimap)");
        let sensor = sensing.sensor(component);
        let reach = PLACES * sensor.range + sensor.range + OUT_OF_SIGHT * sensor.edge;
        let near: Vec<LandmarkId> = surroundings
            .around(component, middle, reach)
            .filter(|id| distance(map.landmarks()[id.index()].position, middle) < reach)
            .collect();
        let seen = look.candidates();
        let is_seen = |id: &LandmarkId| seen.binary_search(id).is_ok();
        let at = |id: LandmarkId| map.landmarks()[id.index()].position;
        let seen_near: Vec<LandmarkId> = near.iter().copied().filter(is_seen).collect();
        let in_sight = |id: LandmarkId| {
            let tested = |&&other: &&LandmarkId| distance(at(id), at(other)) < TESTED * sensor.range;
            let (mut company, mut occluded) = (0, 0);
            for other in seen_near.iter().filter(tested) {
                company += 1;
                occluded += usize::from(sensing.occluded_from(id).binary_search(&other.0).is_ok());
            }
            occluded == 0 || 2 * occluded < company
        };
        let witness = |id: LandmarkId| {
            // A logistic edge of width s has the standard deviation s pi / sqrt(3).
            let sensed = sensing.of(id);
            let blur = sensed.deviation * 3f64.sqrt() / PI;
            let edge = sensor.edge.hypot(blur);
            Witness {
                landmark: id,
                at: at(id),
                detectability: sensed.detectability,
                edge,
                seen: is_seen(&id),
            }
        };
        let mut witnesses: Vec<Witness> =
            near.iter().copied().filter(|id| is_seen(id) || in_sight(*id)).map(witness).collect();
        witnesses.sort_unstable_by_key(|witness| witness.landmark);
        // Copies of an ID stand far from each other: one of them is near at most.
        let elsewhere = look.ids().saturating_sub(seen_near.len());
        Self { witnesses, elsewhere, falsely, range: sensor.range }
    }

    /// `ln L(y)` at a place, for looks of each of these qualities. The edges are softened by `blur` more, so that a
    /// coarse grid misses nothing.
    pub fn log_likelihoods<const N: usize>(&self, place: Point, qualities: [f64; N], blur: f64) -> [f64; N] {
        // A look without a sighting has no false one either.
        let elsewhere = if self.elsewhere > 0 { self.elsewhere as f64 * self.falsely.ln() } else { 0.0 };
        let mut logs = [elsewhere; N];
        let mut products = [1.0; N];
        for witness in &self.witnesses {
            let from_here = self.chance(witness, place, blur);
            for ((log, product), quality) in logs.iter_mut().zip(&mut products).zip(qualities) {
                let chance = quality * from_here;
                *product *=
                    if witness.seen { self.falsely + (1.0 - self.falsely) * chance } else { 1.0 - chance };
                if *product < SMALL {
                    *log += product.ln();
                    *product = 1.0;
                }
            }
        }
        std::array::from_fn(|k| logs[k] + products[k].ln())
    }

    /// Whether a landmark is more likely truly seen from a place than falsely.
    pub fn explains(&self, landmark: LandmarkId, place: Point) -> bool {
        let found = self.witnesses.binary_search_by_key(&landmark, |witness| witness.landmark);
        found.is_ok_and(|k| self.chance(&self.witnesses[k], place, 0.0) > self.falsely)
    }

    /// `p_i v_i(y)`.
    fn chance(&self, witness: &Witness, place: Point, blur: f64) -> f64 {
        let edge = (witness.edge * witness.edge + blur * blur).sqrt();
        let [x, y] = [witness.at[0] - place[0], witness.at[1] - place[1]];
        let beyond = ((x * x + y * y).sqrt() - self.range) / edge;
        if beyond > OUT_OF_SIGHT { 0.0 } else { witness.detectability / (1.0 + beyond.exp()) }
    }
}
