//! One round after the other: places of the steps, scale, landmarks.

use covimap_embed::Point;
use rayon::prelude::*;

/// Gauss-Newton steps of a place in one round.
const STEPS: usize = 3;
/// Share of the mean curvature added to both axes: landmarks on a line leave a place free across it.
const RIDGE: f64 = 0.01;
/// The map holds a landmark within this share of a median range.
const HELD: f64 = 0.2;
/// Weights fall from this many standard deviations on.
const FAR: f64 = 3.0;
/// Standard deviation over the median of the absolute values, of a normal distribution.
const NORMAL: f64 = 1.4826;

/// A range within a component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading {
    pub landmark: u32,
    pub metres: f64,
}

/// All unknowns.
pub(super) struct Sweep<'a> {
    steps: &'a [Vec<Reading>],
    /// Where the map has the landmarks.
    map: Vec<Point>,
    pub points: Vec<Point>,
    places: Vec<Point>,
    /// Metres a map unit.
    pub scale: f64,
    /// Standard deviation of the ranges, metres.
    pub deviation: f64,
    /// Median of all ranges, metres.
    median: f64,
}

/// Normal equations of a point: xx, xy, yy and the right side.
#[derive(Debug, Clone, Copy, Default)]
struct Normal {
    matrix: [f64; 3],
    side: Point,
}

impl Normal {
    /// Adds the wish to go `by` along the unit vector.
    fn add(&mut self, [x, y]: Point, by: f64, weight: f64) {
        let terms = [x * x, x * y, y * y];
        self.matrix.iter_mut().zip(terms).for_each(|(sum, term)| *sum += weight * term);
        self.side = [self.side[0] + weight * by * x, self.side[1] + weight * by * y];
    }

    fn solve(&self, ridge: f64) -> Point {
        let [xx, xy, yy] = [self.matrix[0] + ridge, self.matrix[1], self.matrix[2] + ridge];
        let determinant = xx * yy - xy * xy;
        if determinant <= 0.0 {
            return [0.0; 2];
        }
        let [x, y] = self.side;
        [(yy * x - xy * y) / determinant, (xx * y - xy * x) / determinant]
    }
}

impl<'a> Sweep<'a> {
    /// Places in the middle of what their steps show, and the scale that the median range then has. `None` without a
    /// length.
    pub fn start(steps: &'a [Vec<Reading>], points: &[Point]) -> Option<Self> {
        let middle = |step: &Vec<Reading>| {
            let sum = step.iter().fold([0.0; 2], |sum, reading| add(sum, points[reading.landmark as usize]));
            sum.map(|c| c / step.len() as f64)
        };
        let places: Vec<Point> = steps.iter().map(middle).collect();
        let mut ranges: Vec<f64> = steps.iter().flatten().map(|reading| reading.metres).collect();
        let each = steps.iter().zip(&places);
        let mut lengths: Vec<f64> = each
            .flat_map(|(step, &place)| {
                step.iter().map(move |reading| length(sub(points[reading.landmark as usize], place)))
            })
            .collect();
        let (range, away) = (median(&mut ranges)?, median(&mut lengths)?);
        (away > 0.0).then(|| Self {
            steps,
            map: points.to_vec(),
            points: points.to_vec(),
            places,
            scale: range / away,
            deviation: range,
            median: range,
        })
    }

    fn weight(&self, miss: f64) -> f64 {
        let squared = (FAR * self.deviation).powi(2);
        (squared / (squared + miss * miss)).powi(2)
    }

    /// From the place to the landmark, as a unit vector, and by how much the range is longer than that, in metres.
    fn look(&self, place: Point, reading: &Reading) -> (Point, f64) {
        let way = sub(self.points[reading.landmark as usize], place);
        let away = length(way).max(f64::MIN_POSITIVE);
        (way.map(|c| c / away), reading.metres - self.scale * away)
    }

    /// Every place to where the ranges of its step fit best.
    pub fn place_steps(&mut self) {
        let best = |(step, &start): (&Vec<Reading>, &Point)| {
            let mut place = start;
            for _ in 0..STEPS {
                let mut normal = Normal::default();
                for reading in step {
                    let (toward, miss) = self.look(place, reading);
                    normal.add(toward, -miss / self.scale, self.weight(miss));
                }
                let ridge = RIDGE * (normal.matrix[0] + normal.matrix[2]);
                place = add(place, normal.solve(ridge));
            }
            place
        };
        self.places = self.steps.par_iter().zip(&self.places).map(best).collect();
    }

    /// Eq. (1), and the deviation that is then left.
    pub fn fit_scale(&mut self) {
        let (mut across, mut square) = (0.0, 0.0);
        for (step, &place) in self.steps.iter().zip(&self.places) {
            for reading in step {
                let away = length(sub(self.points[reading.landmark as usize], place));
                let weight = self.weight(self.look(place, reading).1);
                across += weight * reading.metres * away;
                square += weight * away * away;
            }
        }
        if across > 0.0 && square > 0.0 {
            self.scale = across / square;
        }
        // Two of the ranges of every step went into its place.
        let mut misses: Vec<f64> = self.misses().into_iter().map(f64::abs).collect();
        let free = misses.len() as f64 / (misses.len() as f64 - 2.0 * self.steps.len() as f64).max(1.0);
        let middle = median(&mut misses).unwrap_or(0.0);
        // What is exact to the last digit still needs a width.
        self.deviation = (NORMAL * middle * free.sqrt()).max(1e-9 * self.median);
    }

    /// Every landmark to where the ranges to it fit best, held by the map.
    pub fn move_landmarks(&mut self) {
        let mut normals = vec![Normal::default(); self.points.len()];
        for (step, &place) in self.steps.iter().zip(&self.places) {
            for reading in step {
                let (toward, miss) = self.look(place, reading);
                normals[reading.landmark as usize].add(toward, miss / self.scale, self.weight(miss));
            }
        }
        let hold = (self.deviation / (HELD * self.median)).powi(2);
        for ((point, &home), normal) in self.points.iter_mut().zip(&self.map).zip(&mut normals) {
            let back = sub(home, *point);
            normal.side = add(normal.side, back.map(|c| hold * c));
            *point = add(*point, normal.solve(hold));
        }
    }

    /// By how much every range is longer than the map has it, metres.
    pub fn misses(&self) -> Vec<f64> {
        let of_step = |(step, place): (&Vec<Reading>, &Point)| {
            step.iter().map(|reading| self.look(*place, reading).1).collect::<Vec<_>>()
        };
        self.steps.iter().zip(&self.places).flat_map(of_step).collect()
    }

    /// Standard error of eq. (1).
    pub fn scale_error(&self) -> f64 {
        let lengths = self.steps.iter().zip(&self.places).flat_map(|(step, &place)| {
            step.iter().map(move |reading| length(sub(self.points[reading.landmark as usize], place)))
        });
        self.deviation / lengths.map(|away| away * away).sum::<f64>().sqrt()
    }
}

fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1]]
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn length([x, y]: Point) -> f64 {
    x.hypot(y)
}

/// `None` of nothing.
fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
