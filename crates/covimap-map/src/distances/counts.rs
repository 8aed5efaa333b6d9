//! What the log says of pairs of landmarks: all of it, and block of time by block of time for a sample.

use covimap_embed::{Observation, PairDistances};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::steps::ComponentSteps;
use crate::{CoVisibility, LandmarkId, LinkGraph};

/// Pairs of the sample, at most: enough for a curve of a few parameters.
const SAMPLE: usize = 40_000;
/// Blocks of consecutive steps.
const BLOCKS: usize = 16;

/// How often the two landmarks of a link were seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PairCount {
    /// `n`: steps that show both.
    pub together: u32,
    /// `m`: steps that show at least one.
    pub either: u32,
}

impl PairCount {
    /// The frequency shrunken by half a step, which lies strictly between 0 and 1.
    pub fn frequency(self) -> f64 {
        (f64::from(self.together) + 0.5) / (f64::from(self.either) + 1.0)
    }
}

/// The counts of every link `i < j`, in the order of [`LinkGraph::to_pairs`]; `members[k]` is
/// what the log calls landmark `k` of the graph.
pub(super) fn of_links(graph: &LinkGraph, counts: &CoVisibility, members: &[u32]) -> Vec<PairCount> {
    let mut pairs = Vec::with_capacity(graph.link_count());
    for i in 0..graph.landmarks() as u32 {
        let (partners, together) = counts.row(LandmarkId(members[i as usize]));
        let own = counts.sightings()[members[i as usize] as usize];
        let mut at = 0;
        for link in graph.of(i).iter().filter(|link| link.to > i) {
            let other = members[link.to as usize];
            // Both lists ascend: walk them together.
            at += partners[at..].partition_point(|&partner| partner < other);
            let both = together[at];
            pairs.push(PairCount { together: both, either: own - both + counts.sightings()[other as usize] });
        }
    }
    pairs
}

/// Some links, with their counts in every block of time.
///
/// Steps that follow each other show almost the same. Counts of different blocks are nearly
/// independent: a curve fitted to some can be judged by others.
pub(super) struct Sample {
    /// Places in the list of links, ascending.
    pub links: Vec<usize>,
    /// Landmarks of the graph.
    pub ends: Vec<[u32; 2]>,
    /// Counts of each in every block.
    blocks: Vec<[PairCount; BLOCKS]>,
}

impl Sample {
    /// Draws links and counts them over the steps of their component, in one pass.
    pub fn draw(pairs: &PairDistances, steps: &ComponentSteps, seed: u64) -> Self {
        let total = pairs.pairs().len();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut links = rand::seq::index::sample(&mut rng, total, total.min(SAMPLE)).into_vec();
        links.sort_unstable();
        let ends: Vec<[u32; 2]> = links.iter().map(|&link| pairs.pairs()[link]).map(|p| [p.i, p.j]).collect();
        let blocks = count_blocks(&ends, pairs.objects(), steps);
        Self { links, ends, blocks }
    }

    /// A sample of pairs with these counts, whatever landmarks they are of.
    #[cfg(test)]
    pub fn of_blocks(blocks: Vec<[PairCount; BLOCKS]>) -> Self {
        Self { links: (0..blocks.len()).collect(), ends: vec![[0, 1]; blocks.len()], blocks }
    }

    /// The pairs whose length is told, and these lengths.
    pub fn told(&self, lengths: &[Option<f64>]) -> (Self, Vec<f64>) {
        let told = || (0..self.len()).filter(|&pair| lengths[pair].is_some());
        let sample = Self {
            links: told().map(|pair| self.links[pair]).collect(),
            ends: told().map(|pair| self.ends[pair]).collect(),
            blocks: told().map(|pair| self.blocks[pair]).collect(),
        };
        (sample, lengths.iter().flatten().copied().collect())
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.links.len()
    }

    /// Counts in one half of the time - blocks of even number, or of odd - as observations at the given
    /// distances. Only of pairs that were seen together in the other half: to be a link, a pair must
    /// have been seen together at all, and counts that made it one are no fair sample.
    pub fn half(&self, distances: &[f64], odd: bool) -> Vec<Observation> {
        let (own, other) = (usize::from(odd), usize::from(!odd));
        let sum = |blocks: &[PairCount; BLOCKS], half: usize| {
            let blocks = || blocks.iter().skip(half).step_by(2);
            let together: u32 = blocks().map(|block| block.together).sum();
            [f64::from(together), blocks().map(|block| f64::from(block.either)).sum()]
        };
        let observe = |(blocks, &distance)| {
            let [together, either] = sum(blocks, own);
            (sum(blocks, other)[0] > 0.0 && either > 0.0).then_some(Observation {
                distance,
                together,
                either,
            })
        };
        self.blocks.iter().zip(distances).filter_map(observe).collect()
    }

    /// How many steps tell as much as one independent look: the variance of the counts of blocks over
    /// that of independent steps,
    ///
    /// `tau = b/(b - 1) sum (n_b - f m_b)^2 / sum f (1 - f) m_b`,
    ///
    /// the sums over pairs and blocks. Above 1 where a slow robot repeats itself; below 1 where it
    /// covers the ground more evenly than chance. 1 if the log cannot tell.
    pub fn repetition(&self) -> f64 {
        let (mut found, mut expected) = (0.0, 0.0);
        for blocks in &self.blocks {
            let total =
                |of: fn(&PairCount) -> u32| blocks.iter().map(|block| f64::from(of(block))).sum::<f64>();
            let (n, m) = (total(|block| block.together), total(|block| block.either));
            let f = n / m;
            let miss = |block: &PairCount| f64::from(block.together) - f * f64::from(block.either);
            found += blocks.iter().map(|block| miss(block).powi(2)).sum::<f64>();
            expected += f * (1.0 - f) * m;
        }
        let tau = found / expected * BLOCKS as f64 / (BLOCKS - 1) as f64;
        if tau > 0.0 && tau.is_finite() { tau } else { 1.0 }
    }
}

/// Counts of every pair in every block. `O(sightings * pairs a landmark)`.
fn count_blocks(ends: &[[u32; 2]], landmarks: usize, steps: &ComponentSteps) -> Vec<[PairCount; BLOCKS]> {
    // Where the pairs of each first landmark begin.
    let starts: Vec<usize> =
        (0..=landmarks).map(|i| ends.partition_point(|pair| (pair[0] as usize) < i)).collect();
    let mut sightings = vec![[0_u32; BLOCKS]; landmarks];
    let mut together = vec![[0_u32; BLOCKS]; ends.len()];
    let mut last_seen = vec![usize::MAX; landmarks];
    let mut seen = Vec::new();
    for step in 0..steps.len() {
        let block = step * BLOCKS / steps.len();
        steps.read(step, &mut seen);
        for &landmark in &seen {
            last_seen[landmark as usize] = step;
            sightings[landmark as usize][block] += 1;
        }
        for &landmark in &seen {
            for pair in starts[landmark as usize]..starts[landmark as usize + 1] {
                let both = last_seen[ends[pair][1] as usize] == step;
                together[pair][block] += u32::from(both);
            }
        }
    }
    let count = |(ends, together): (&[u32; 2], &[u32; BLOCKS])| {
        let [a, b] = ends.map(|end| &sightings[end as usize]);
        std::array::from_fn(|k| PairCount { together: together[k], either: a[k] + b[k] - together[k] })
    };
    ends.iter().zip(&together).map(count).collect()
}

#[cfg(test)]
mod tests;
