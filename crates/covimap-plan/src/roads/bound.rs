//! What any way between two landmarks costs at least.
//!
//! Give every landmark a place `y_i` in the plane, and let
//!
//! `rate = min over roads of cost_ij / |y_i - y_j|`.
//!
//! Then no way from a to b costs less than `rate |y_a - y_b|`, whatever the places are: its roads lead from the one to the
//! other. Searches that are drawn to their goal look at the fewer landmarks the nearer this is to the true cost.
//!
//! Where roads cost their length, places are positions, and the rate is 1. Where they cost something else, a few roads
//! are cheap for their length, and they alone would decide the rate: over a million landmarks it is a quarter of what
//! roads cost as a rule, because somewhere two landmarks of the many were seen together in 8 of 9 steps by chance. So the ends of
//! cheap roads are drawn together, and those of roads that become cheap thereby, until all cost about the rate that most had to begin with. That
//! moves landmarks by less than a road as a rule, and what is far apart stays so.
//!
//! # Complexity
//! `O(m)` for `m` roads; only cheap ones and those around them are looked at more than twice.

use covimap_embed::Point;
use covimap_map::{GlobalMap, LandmarkId};
use rayon::prelude::*;

/// Share of the roads that are cheap.
const CHEAP: f64 = 0.15;
/// Roads whose rates are looked at, about.
const SAMPLE: usize = 10_000;
/// How often the ends of cheap roads are drawn together, at most.
const ROUNDS: usize = 1000;
/// Share by which a road may be longer than it should, and be let alone.
const CLOSE: f64 = 1e-3;

/// See the module.
#[derive(Debug, Clone)]
pub(super) struct Bound {
    places: Vec<Point>,
    rate: f64,
}

impl Bound {
    /// For roads that cost their length.
    pub fn of_lengths(map: &GlobalMap) -> Self {
        Self { places: positions(map), rate: 1.0 }
    }

    /// For roads that cost anything above 0; `costs` by their places in the rows of the lines of sight.
    pub fn of_costs(map: &GlobalMap, costs: &[f64]) -> Self {
        let roads = Priced { map, costs };
        let mut places = positions(map);
        let usual = roads.usual_rate(&places);
        roads.draw_together(&mut places, usual);
        let rate = roads.least_rate(&places);
        Self { places, rate }
    }

    /// The same where landmark `order[i]` has the number i.
    pub fn reordered(&self, order: &[LandmarkId]) -> Self {
        Self { places: order.iter().map(|id| self.places[id.index()]).collect(), rate: self.rate }
    }

    /// What every way between the two costs at least.
    pub fn at_least(&self, from: LandmarkId, to: LandmarkId) -> f64 {
        self.rate * distance(self.places[from.index()], self.places[to.index()])
    }
}

fn positions(map: &GlobalMap) -> Vec<Point> {
    map.landmarks().iter().map(|placed| placed.position).collect()
}

fn distance(a: Point, b: Point) -> f64 {
    ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt()
}

/// Lines of sight with their costs.
struct Priced<'a> {
    map: &'a GlobalMap,
    costs: &'a [f64],
}

impl Priced<'_> {
    fn from(&self, landmark: u32) -> impl Iterator<Item = (u32, f64)> {
        let (lines, id) = (self.map.sight_lines(), LandmarkId(landmark));
        lines.of(id).iter().map(|line| line.to.0).zip(self.costs[lines.row(id)].iter().copied())
    }

    /// The rate that all but [`CHEAP`] roads reach, of a sample of landmarks.
    fn usual_rate(&self, places: &[Point]) -> f64 {
        let stride = (self.costs.len() / SAMPLE).max(1);
        let of = |from: usize| {
            let rate = move |(to, cost)| cost / distance(places[from], places[to as usize]);
            self.from(from as u32).map(rate)
        };
        let mut rates: Vec<f64> = (0..places.len()).step_by(stride).flat_map(of).collect();
        if rates.is_empty() {
            return 0.0;
        }
        let cheap = (CHEAP * rates.len() as f64) as usize;
        *rates.select_nth_unstable_by(cheap, f64::total_cmp).1
    }

    /// Draws the ends of roads together that cost less than this rate, each by as much as the other.
    fn draw_together(&self, places: &mut [Point], rate: f64) {
        let mut open: Vec<u32> = (0..places.len() as u32).collect();
        for _ in 0..ROUNDS {
            let mut moved = Vec::new();
            for &from in &open {
                for (to, cost) in self.from(from) {
                    let [a, b] = [from, to].map(|end| places[end as usize]);
                    let length = distance(a, b);
                    if rate * length > (1.0 + CLOSE) * cost {
                        let by = 0.5 * (1.0 - cost / (rate * length));
                        let step = [by * (b[0] - a[0]), by * (b[1] - a[1])];
                        places[from as usize] = [a[0] + step[0], a[1] + step[1]];
                        places[to as usize] = [b[0] - step[0], b[1] - step[1]];
                        moved.extend([from, to]);
                    }
                }
            }
            moved.sort_unstable();
            moved.dedup();
            if moved.is_empty() {
                break;
            }
            open = moved;
        }
    }

    /// No road costs less than this for the distance between the places of its ends. 0 without a road.
    fn least_rate(&self, places: &[Point]) -> f64 {
        let of = |from: u32| {
            let rate = |(to, cost)| cost / distance(places[from as usize], places[to as usize]);
            self.from(from).map(rate).fold(f64::INFINITY, f64::min)
        };
        let least = (0..places.len() as u32).into_par_iter().map(of).reduce(|| f64::INFINITY, f64::min);
        // Without a road between two places, nothing is known of the cost of one.
        if least.is_finite() { least } else { 0.0 }
    }
}

#[cfg(test)]
mod tests;
