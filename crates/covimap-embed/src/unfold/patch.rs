//! A seed, what is mirrored around it, what moves, and what is held.

use crate::stress::{Incidence, distance};
use crate::{PairDistances, Point};

use super::{LINES, WORTHWHILE};

/// Most objects that move: a seed linked to more is left as it is.
const MOST: usize = 400;
/// Of the step of eq. (1).
const RELAXATION: f64 = 1.6;
/// Sweeps over all objects that move.
const SWEEPS: usize = 300;
/// A sweep that gains less than this share of the stress is the last.
const SETTLED: f64 = 1e-5;
/// A trial is given up if so many sweeps like the last would not bring it below the present stress.
const PATIENCE: f64 = 50.0;

/// The surroundings of a seed, each list ascending.
pub(super) struct Patch {
    seed: u32,
    /// The seed and its neighbours.
    core: Vec<u32>,
    /// The core and its neighbours.
    free: Vec<u32>,
    /// Neighbours of those, held.
    ring: Vec<u32>,
}

/// The pairs of the objects that move: those of number `k` are `springs[starts[k]..starts[k + 1]]`.
struct Springs {
    starts: Vec<usize>,
    springs: Vec<Spring>,
}

struct Spring {
    /// Place in the list of free objects and then of the ring.
    to: usize,
    length: f64,
    weight: f64,
}

impl Patch {
    /// `None` if too much hangs on the seed.
    pub fn around(seed: u32, incidence: &Incidence) -> Option<Self> {
        let core = with_neighbours(&[seed], incidence);
        if core.len() > MOST {
            return None;
        }
        let free = with_neighbours(&core, incidence);
        if free.len() > MOST {
            return None;
        }
        let mut ring = with_neighbours(&free, incidence);
        ring.retain(|object| free.binary_search(object).is_err());
        Some(Self { seed, core, free, ring })
    }

    pub fn seed(&self) -> u32 {
        self.seed
    }

    pub fn core(&self) -> impl Iterator<Item = u32> {
        self.core.iter().copied()
    }

    pub fn free(&self) -> impl Iterator<Item = u32> {
        self.free.iter().copied()
    }

    /// All objects that a trial reads or moves.
    pub fn objects(&self) -> impl Iterator<Item = u32> {
        self.free.iter().chain(&self.ring).copied()
    }

    /// Better places for the free objects, if mirroring leads to some.
    pub fn mend(&self, pairs: &PairDistances, incidence: &Incidence, points: &[Point]) -> Option<Vec<Point>> {
        let springs = self.springs(pairs, incidence);
        let present: Vec<Point> = self.objects().map(|object| points[object as usize]).collect();
        let (present, stress) = springs.settled(present, f64::INFINITY)?;
        let mut best = (None, stress * (1.0 - WORTHWHILE));
        for some in self.mirrored_parts(&springs) {
            for line in 0..LINES {
                let angle = std::f64::consts::PI * line as f64 / LINES as f64;
                let mirrored = mirrored(&present, &some, angle);
                if let Some((places, stress)) = springs.settled(mirrored, best.1) {
                    best = (Some(places), stress);
                }
            }
        }
        best.0.map(|mut places| {
            places.truncate(self.free.len());
            places
        })
    }

    /// Places in the list of free objects of the core, and of its half that is nearest to the seed.
    fn mirrored_parts(&self, springs: &Springs) -> [Vec<usize>; 2] {
        let place = |own| self.free.binary_search(own).expect("the core is free (bug in covimap)");
        let seed = place(&self.seed);
        let mut near: Vec<&Spring> = springs.of(seed).iter().collect();
        near.sort_by(|a, b| a.length.total_cmp(&b.length).then(a.to.cmp(&b.to)));
        near.truncate(near.len() / 2);
        let half = std::iter::once(seed).chain(near.iter().map(|spring| spring.to)).collect();
        [self.core.iter().map(place).collect(), half]
    }

    fn springs(&self, pairs: &PairDistances, incidence: &Incidence) -> Springs {
        let mut starts = vec![0];
        let mut springs = Vec::new();
        let place = |object: &u32| match self.free.binary_search(object) {
            Ok(place) => place,
            Err(_) => {
                let held = self.ring.binary_search(object);
                self.free.len() + held.expect("neighbours are free or held (bug in covimap)")
            }
        };
        for &own in &self.free {
            for (other, pair) in incidence.of(own as usize) {
                let pair = pairs.pairs()[*pair as usize];
                springs.push(Spring { to: place(other), length: pair.distance, weight: pair.weight });
            }
            starts.push(springs.len());
        }
        Springs { starts, springs }
    }
}

impl Springs {
    /// The nearest minimum of the stress and its value, unless that is not below `below`.
    fn settled(&self, mut places: Vec<Point>, below: f64) -> Option<(Vec<Point>, f64)> {
        let mut stress = self.stress(&places);
        for _ in 0..SWEEPS {
            self.sweep(&mut places);
            let next = self.stress(&places);
            let gain = stress - next;
            stress = next;
            if gain <= SETTLED * stress || stress - PATIENCE * gain > below {
                break;
            }
        }
        (stress < below).then_some((places, stress))
    }

    fn sweep(&self, places: &mut [Point]) {
        for own in 0..self.starts.len() - 1 {
            let here = places[own];
            let (mut pull, mut total) = ([0.0; 2], 0.0);
            for spring in self.of(own) {
                let there = places[spring.to];
                let r = distance(here, there);
                let stretch = if r > 0.0 { spring.length / r } else { 0.0 };
                for axis in 0..2 {
                    pull[axis] += spring.weight * (1.0 - stretch) * (there[axis] - here[axis]);
                }
                total += spring.weight;
            }
            places[own] = [0, 1].map(|axis| here[axis] + RELAXATION * pull[axis] / total);
        }
    }

    /// The stress of all pairs with a free end, those with two counted once.
    fn stress(&self, places: &[Point]) -> f64 {
        let free = self.starts.len() - 1;
        let of_object = |own: usize| {
            let share = |spring: &Spring| {
                let miss = distance(places[own], places[spring.to]) - spring.length;
                let once = if spring.to < free { 0.5 } else { 1.0 };
                once * spring.weight * miss * miss
            };
            self.of(own).iter().map(share).sum::<f64>()
        };
        (0..free).map(of_object).sum()
    }

    fn of(&self, own: usize) -> &[Spring] {
        &self.springs[self.starts[own]..self.starts[own + 1]]
    }
}

/// The objects and their neighbours, ascending.
fn with_neighbours(objects: &[u32], incidence: &Incidence) -> Vec<u32> {
    let neighbours = |&object: &u32| incidence.of(object as usize).iter().map(|&(other, _)| other);
    let mut all: Vec<u32> = objects.iter().flat_map(neighbours).chain(objects.iter().copied()).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Places with those of `some` mirrored about the line through their centre at an angle to the x axis.
fn mirrored(places: &[Point], some: &[usize], angle: f64) -> Vec<Point> {
    let (sin, cos) = (2.0 * angle).sin_cos();
    let count = some.len() as f64;
    let centre = [0, 1].map(|axis| some.iter().map(|&own| places[own][axis]).sum::<f64>() / count);
    let mut places = places.to_vec();
    for &own in some {
        let [x, y] = [0, 1].map(|axis| places[own][axis] - centre[axis]);
        places[own] = [centre[0] + cos * x + sin * y, centre[1] + sin * x - cos * y];
    }
    places
}
