//! All landmarks at once: one step of Gauss and Newton, the places of the steps being solved for on the way.
//!
//! To first order a range that misses by `e` asks for `u'(dx - dy) = e`, `u` being the direction from the place to
//! the landmark. For given moves `dx` of the landmarks the best move of a place is `A^-1 sum w u (u'dx - e)` with `A =
//! sum w u u'` over its ranges. Put in, equations for the landmarks alone are left,
//!
//! ```text
//! sum w u (v - u' A^-1 sum w u v) = 0,    v = e - u'dx,
//! ```
//!
//! with a block for any two landmarks that have ranges in the same step. They are solved by a sparse factorisation: errors
//! that bend a map as a whole are what ranges are to take out, and an iteration that goes from landmark to landmark
//! takes as many rounds as the map is wide.

use covimap_embed::{EmbedError, LowerTriangle, Point, SparseCholesky};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::noise::{NORMAL, Noise, median};
use super::normal::{Normal, dot, sub, times};
use super::readings::Readings;
use super::sweep::{Edge, Sweep};

/// Share of the curvature of a place that is added to both axes: landmarks on a line leave it free across.
const RIDGE: f64 = 1e-6;
/// Share of its curvature that is added to every landmark: the whole is free to turn, and nearly so to shift.
const NUDGE: f64 = 1e-9;
/// A standard deviation is at least this share of the median range: no sensor is more exact, and what is exact to the
/// last digit still needs a width.
const LEAST: f64 = 1e-3;
/// Ranges that the noise is fitted to, about.
const SAMPLE: usize = 100_000;
/// Draws of errors by which it is told how closely the landmarks follow the edges.
const DRAWS: usize = 4;
/// Sum of the freedom of all edges from which on their misses tell by how much they are off.
const TELLING: f64 = 20.0;
/// Least share of its error that an edge is taken to miss.
const LEAST_FREE: f64 = 0.05;

/// Sets the noise to what the misses of a sweep tell, each made larger by what its own place took away from it.
pub(super) fn fit_noise(sweep: &mut Sweep) {
    let readings = sweep.readings;
    let every = readings.all().len().div_ceil(SAMPLE).max(1);
    let look = |place: usize| {
        let (toward, miss) = sweep.look(place);
        let reading = readings.all()[place];
        let inverse = places_normal(sweep, reading.step as usize).inverse(RIDGE);
        // The share of its own that the range has in the place of its step.
        let leverage = sweep.weights[place] * dot(toward, times(inverse, toward));
        (leverage < 0.9).then(|| (reading.metres - miss, miss / (1.0 - leverage).sqrt()))
    };
    let looks = (0..readings.all().len()).into_par_iter().step_by(every).filter_map(look).collect();
    sweep.noise = Noise::fit(looks, (LEAST * sweep.median).powi(2));
}

/// What the ranges of a step say of its place.
fn places_normal(sweep: &Sweep, step: usize) -> Normal {
    let mut normal = Normal::default();
    for place in sweep.readings.of_step(step) {
        normal.add(sweep.look(place).0, 0.0, sweep.weights[place]);
    }
    normal
}

/// Sets the share by which the map is off in the length of its edges to what they miss. `freedom` is the share of its own error
/// that each misses, the rest being followed by the landmarks.
///
/// Where ranges are few the landmarks follow the edges, and what is missed tells too little: then it stays as it is.
pub(super) fn fit_held(sweep: &mut Sweep, freedom: &[f64]) {
    let seen = || (0..sweep.edges.len()).filter(|&k| sweep.edges[k].seen);
    let free = seen().map(|k| freedom[k]).sum::<f64>();
    if free < TELLING {
        return;
    }
    let mut misses: Vec<f64> = seen().map(|k| sweep.strain(k).1.abs() / sweep.edges[k].length).collect();
    let free = (free / misses.len() as f64).max(LEAST_FREE);
    sweep.held = median(&mut misses).map_or(sweep.held, |miss| (NORMAL * miss / free.sqrt()).max(LEAST));
}

/// What the equations of a round say.
pub(super) struct Solved {
    /// How every landmark is to move.
    pub moves: Vec<Point>,
    /// Expected square of what each edge still misses afterwards, by the variance of its error, if all weights are the inverse
    /// variances of independent errors.
    pub freedom: Vec<f64>,
}

/// The equations of one component.
pub(super) struct Equations {
    matrix: LowerTriangle<2>,
    /// The block of each edge.
    of_edges: Vec<usize>,
    /// The factor of the last round, whose order serves the next.
    factor: Option<SparseCholesky<2>>,
}

impl Equations {
    /// With a block for any two landmarks that share a step or an edge.
    pub fn new(readings: &Readings, edges: &[Edge], landmarks: usize) -> Self {
        let mut ends: Vec<[u32; 2]> = edges.iter().map(|edge| edge.ends).collect();
        ends.iter_mut().for_each(|ends| ends.sort_unstable());
        let mut later = vec![Vec::new(); landmarks];
        ends.iter().for_each(|&[a, b]| later[a as usize].push(b));
        let column = |(landmark, mut later): (usize, Vec<u32>)| {
            later.push(landmark as u32);
            for place in readings.of_landmark(landmark) {
                later.extend(readings.after(place).iter().map(|reading| reading.landmark));
            }
            later.sort_unstable();
            later.dedup();
            later
        };
        let columns: Vec<Vec<u32>> = later.into_par_iter().enumerate().map(column).collect();
        let mut starts = vec![0];
        starts.extend(columns.iter().scan(0, |end, column| {
            *end += column.len() as u32;
            Some(*end)
        }));
        let rows = columns.concat();
        let blocks = vec![[[0.0; 2]; 2]; rows.len()];
        let matrix = LowerTriangle { starts, rows, blocks };
        let of_edges = ends.iter().map(|&[a, b]| block_of(&matrix, a, b)).collect();
        Self { matrix, of_edges, factor: None }
    }

    /// Solves for the moves of all landmarks from the present state of a sweep.
    pub fn solve(&mut self, sweep: &Sweep) -> Result<Solved, EmbedError> {
        let toward: Vec<Point> =
            (0..sweep.weights.len()).into_par_iter().map(|place| sweep.look(place).0).collect();
        let inverse = |step: usize| places_normal(sweep, step).inverse(RIDGE);
        let inverses: Vec<[f64; 3]> = (0..sweep.readings.steps()).into_par_iter().map(inverse).collect();
        let linear = Linear { sweep, toward: &toward, inverses: &inverses };
        self.assemble(&linear);
        let factor = match self.factor.take() {
            None => SparseCholesky::new(&self.matrix),
            Some(last) => last.refactor(&self.matrix),
        }?;
        let signs = Signs::draw(sweep.weights.len() + sweep.edges.len());
        // In the first column what is missed, in the others errors that are drawn.
        let drawn = |k: usize, weight: f64, miss: f64| -> [f64; 1 + DRAWS] {
            let deviation = if weight > 0.0 { weight.powf(-0.5) } else { 0.0 };
            std::array::from_fn(|column| match column {
                0 => miss,
                draw => signs.of(k, draw - 1) * deviation,
            })
        };
        let of_edge = |k: usize| drawn(sweep.weights.len() + k, sweep.edges[k].weight, sweep.strain(k).1);
        let mut rows = linear.sides(|place| drawn(place, sweep.weights[place], sweep.look(place).1), of_edge);
        factor.solve(rows.as_flattened_mut());
        self.factor = Some(factor);
        let freedom = (0..sweep.edges.len()).map(|k| {
            let Edge { ends: [a, b], weight, .. } = sweep.edges[k];
            let (along, errors) = (sweep.strain(k).0, of_edge(k));
            let left = |draw: usize| {
                let by = |end: u32| [0, 1].map(|axis| rows[end as usize][axis][draw]);
                errors[draw] - dot(along, sub(by(b), by(a)))
            };
            (1..=DRAWS).map(|draw| weight * left(draw).powi(2)).sum::<f64>() / DRAWS as f64
        });
        Ok(Solved {
            freedom: freedom.collect(),
            moves: rows.iter().map(|row| row.map(|columns| columns[0])).collect(),
        })
    }

    fn assemble(&mut self, linear: &Linear) {
        let LowerTriangle { starts, rows, blocks } = &mut self.matrix;
        let mut left = blocks.as_mut_slice();
        let own = |ends: &[u32]| {
            let length = (ends[1] - ends[0]) as usize;
            left.split_off_mut(..length).expect("columns fill the blocks (bug in covimap)")
        };
        let columns: Vec<&mut [[[f64; 2]; 2]]> = starts.windows(2).map(own).collect();
        columns.into_par_iter().enumerate().for_each(|(landmark, blocks)| {
            let rows = &rows[starts[landmark] as usize..starts[landmark + 1] as usize];
            linear.column(landmark, rows, blocks);
        });
        let diagonal = |landmark: u32| starts[landmark as usize] as usize;
        for (k, (edge, &block)) in linear.sweep.edges.iter().zip(&self.of_edges).enumerate() {
            let along = linear.sweep.strain(k).0;
            accumulate(&mut blocks[block], along, along, -edge.weight);
            edge.ends
                .iter()
                .for_each(|&end| accumulate(&mut blocks[diagonal(end)], along, along, edge.weight));
        }
        for landmark in 0..starts.len() as u32 - 1 {
            let own = &mut blocks[diagonal(landmark)];
            let trace = own[0][0] + own[1][1];
            // A landmark without ranges and edges stays where it is.
            let alone = f64::from(u8::from(trace <= 0.0));
            (0..2).for_each(|k| own[k][k] += NUDGE * trace + alone);
        }
    }
}

/// Where the block of two landmarks is, the earlier one first.
fn block_of(matrix: &LowerTriangle<2>, column: u32, row: u32) -> usize {
    let [start, end] = [0, 1].map(|k| matrix.starts[column as usize + k] as usize);
    start + matrix.rows[start..end].binary_search(&row).expect("its pair has a block (bug in covimap)")
}

/// Adds `w u v'`.
fn accumulate(block: &mut [[f64; 2]; 2], u: Point, v: Point, w: f64) {
    for (row, u) in block.iter_mut().zip(u) {
        row.iter_mut().zip(v).for_each(|(entry, v)| *entry += w * u * v);
    }
}

/// A sweep to first order.
struct Linear<'a> {
    sweep: &'a Sweep<'a>,
    /// From place to landmark, for every range.
    toward: &'a [Point],
    /// `A^-1` of every step.
    inverses: &'a [[f64; 3]],
}

impl Linear<'_> {
    /// What the ranges put into the blocks of a landmark with itself and later ones, `rows`.
    fn column(&self, landmark: usize, rows: &[u32], blocks: &mut [[[f64; 2]; 2]]) {
        let Sweep { readings, weights, .. } = self.sweep;
        blocks.fill([[0.0; 2]; 2]);
        for place in readings.of_landmark(landmark) {
            let (toward, weight) = (self.toward[place], weights[place]);
            let own = times(self.inverses[readings.all()[place].step as usize], toward);
            accumulate(&mut blocks[0], toward, toward, weight * (1.0 - weight * dot(toward, own)));
            let mut at = 1;
            for (other, reading) in (place + 1..).zip(readings.after(place)) {
                at += rows[at..].partition_point(|&row| row < reading.landmark);
                let shared = weight * weights[other] * dot(self.toward[other], own);
                accumulate(&mut blocks[at], self.toward[other], toward, -shared);
            }
        }
    }

    /// What ranges and edges that miss by so much ask of the landmarks, less what the places do themselves: for each
    /// landmark x and y of every column.
    fn sides<const K: usize>(
        &self,
        range: impl Fn(usize) -> [f64; K] + Sync,
        edge: impl Fn(usize) -> [f64; K],
    ) -> Vec<[[f64; K]; 2]> {
        let Self { sweep, toward, inverses } = *self;
        let place_moves = |step: usize| {
            let mut side = [[0.0; K]; 2];
            for place in sweep.readings.of_step(step) {
                pull(&mut side, toward[place], range(place), sweep.weights[place]);
            }
            let [xx, xy, yy] = inverses[step];
            let [x, y] = side;
            [0, 1].map(|axis| {
                let [a, b] = [[xx, xy], [xy, yy]][axis];
                std::array::from_fn(|k| a * x[k] + b * y[k])
            })
        };
        let own: Vec<[[f64; K]; 2]> = (0..sweep.readings.steps()).into_par_iter().map(place_moves).collect();
        let landmark = |landmark: usize| {
            let mut side = [[0.0; K]; 2];
            for place in sweep.readings.of_landmark(landmark) {
                let [u, v] = toward[place];
                let [x, y] = own[sweep.readings.all()[place].step as usize];
                let mut left = range(place);
                left.iter_mut().enumerate().for_each(|(k, left)| *left -= u * x[k] + v * y[k]);
                pull(&mut side, toward[place], left, sweep.weights[place]);
            }
            side
        };
        let mut sides: Vec<[[f64; K]; 2]> = (0..sweep.points.len()).into_par_iter().map(landmark).collect();
        for (k, held) in sweep.edges.iter().enumerate() {
            let along = sweep.strain(k).0;
            let [a, b] = held.ends.map(|end| end as usize);
            pull(&mut sides[a], along, edge(k), -held.weight);
            pull(&mut sides[b], along, edge(k), held.weight);
        }
        sides
    }
}

/// Adds `w u e` in every column.
fn pull<const K: usize>(side: &mut [[f64; K]; 2], along: Point, misses: [f64; K], weight: f64) {
    for (axis, along) in side.iter_mut().zip(along) {
        axis.iter_mut().zip(misses).for_each(|(sum, miss)| *sum += weight * miss * along);
    }
}

/// Signs of independent errors, `DRAWS` for each of some numbers; the same in every round.
struct Signs(Vec<u64>);

impl Signs {
    fn draw(count: usize) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(0);
        Self((0..(count * DRAWS).div_ceil(64)).map(|_| random.next_u64()).collect())
    }

    fn of(&self, number: usize, draw: usize) -> f64 {
        let bit = number * DRAWS + draw;
        if self.0[bit / 64] >> (bit % 64) & 1 == 1 { 1.0 } else { -1.0 }
    }
}
