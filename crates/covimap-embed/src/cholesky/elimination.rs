//! In which order the unknowns of a sparse system are eliminated.
//!
//! The order decides how much a factor fills. That of approximate minimum degree fills little. It also makes a forest:
//! the parent of an unknown is the next one that its elimination changes. Subtrees do not know of each other, so that a
//! large system falls into *parts*, each some subtrees, that can be handled at the same time, and a rest that waits for
//! them all.
//!
//! # References
//! P. R. Amestoy, T. A. Davis, I. S. Duff, "An approximate minimum degree ordering algorithm", SIAM J. Matrix Anal.
//! Appl. 17(4), 1996;
//! J. W. H. Liu, "The role of elimination trees in sparse factorization", SIAM J. Matrix Anal. Appl. 11(1), 1990.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

use crate::EmbedError;

/// Unknowns below which a system has no parts.
const LARGE: usize = 20_000;
/// Parts of a large system, about: enough for a few threads to be busy to the end.
const PARTS: usize = 24;
/// No parent.
const ROOT: u32 = u32::MAX;

/// An order of elimination, with the parts that do not depend on each other.
pub(crate) struct Elimination {
    /// Unknown at each place.
    pub order: Vec<u32>,
    /// Place of each unknown.
    pub places: Vec<u32>,
    /// Where each part ends; the first one starts at 0, and what comes after the last one is the rest.
    pub parts: Vec<u32>,
}

impl Elimination {
    /// Of a graph of `n` unknowns, its edges `(i, j)` each once, in any order.
    pub fn of(n: usize, edges: impl Iterator<Item = (u32, u32)> + Clone) -> Result<Self, EmbedError> {
        let graph = Graph::new(n, edges);
        let order = graph.minimum_degree()?;
        Ok(if n < LARGE { Self::whole(order) } else { Self::in_parts(&graph, order) })
    }

    fn whole(order: Vec<u32>) -> Self {
        Self { places: places(&order), order, parts: Vec::new() }
    }

    /// Puts the parts first, the rest last, and leaves the order within each as it is.
    fn in_parts(graph: &Graph, order: Vec<u32>) -> Self {
        let n = order.len();
        let parents = graph.forest(&order);
        let mut sizes = vec![1_u32; n];
        for (place, &parent) in parents.iter().enumerate() {
            if parent != ROOT {
                sizes[parent as usize] += sizes[place];
            }
        }
        let most = n.div_ceil(PARTS) as u32;
        // The top of the subtree that a place belongs to; its own for those of the rest, whose subtrees are too large.
        let mut top: Vec<u32> = (0..n as u32).collect();
        for place in (0..n).rev() {
            let parent = parents[place];
            if sizes[place] <= most && parent != ROOT && sizes[parent as usize] <= most {
                top[place] = top[parent as usize];
            }
        }
        let is_rest = |place: u32| sizes[place as usize] > most;
        let mut rearranged: Vec<u32> = (0..n as u32).collect();
        rearranged
            .sort_by_key(|&place| (is_rest(place), if is_rest(place) { place } else { top[place as usize] }));
        let mut parts = Vec::new();
        let mut begun = 0;
        for (at, &place) in (0..).zip(&rearranged) {
            if is_rest(place) {
                break;
            }
            let ends = top[place as usize] == place;
            if ends && at + 1 - begun >= most / 2 {
                parts.push(at + 1);
                begun = at + 1;
            }
        }
        Self { parts, ..Self::whole(rearranged.into_iter().map(|place| order[place as usize]).collect()) }
    }
}

fn places(order: &[u32]) -> Vec<u32> {
    let mut places = vec![0; order.len()];
    order.iter().zip(0..).for_each(|(&unknown, place)| places[unknown as usize] = place);
    places
}

/// Who is next to whom: the neighbours of `i` are `others[starts[i]..starts[i + 1]]`.
struct Graph {
    starts: Vec<u32>,
    others: Vec<u32>,
}

impl Graph {
    fn new(n: usize, edges: impl Iterator<Item = (u32, u32)> + Clone) -> Self {
        let mut starts = vec![0_u32; n + 1];
        for (i, j) in edges.clone() {
            starts[i as usize + 1] += 1;
            starts[j as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut others = vec![0; starts[n] as usize];
        let mut put = |to: u32, other: u32| {
            others[next[to as usize] as usize] = other;
            next[to as usize] += 1;
        };
        for (i, j) in edges {
            put(i, j);
            put(j, i);
        }
        Self { starts, others }
    }

    fn unknowns(&self) -> usize {
        self.starts.len() - 1
    }

    fn of(&self, unknown: u32) -> &[u32] {
        &self.others[self.starts[unknown as usize] as usize..self.starts[unknown as usize + 1] as usize]
    }

    /// The order of approximate minimum degree.
    fn minimum_degree(&self) -> Result<Vec<u32>, EmbedError> {
        let n = self.unknowns();
        let out_of_memory = || EmbedError::OutOfMemory { what: "ordering a sparse matrix", order: n };
        let scratch = amd::order_maybe_unsorted_scratch::<u32>(n, self.others.len());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| out_of_memory())?;
        let (mut order, mut places) = (vec![0; n], vec![0; n]);
        amd::order_maybe_unsorted(
            &mut order,
            &mut places,
            SymbolicSparseColMatRef::new_unsorted_checked(n, n, &self.starts, None, &self.others),
            amd::Control::default(),
            MemStack::new(&mut memory),
        )
        .map_err(|_| out_of_memory())?;
        Ok(order)
    }

    /// The parent of each place of an order in the forest of elimination, or [`ROOT`].
    fn forest(&self, order: &[u32]) -> Vec<u32> {
        let places = places(order);
        let mut parents = vec![ROOT; order.len()];
        // The highest place known to be above each: what is between need not be climbed again.
        let mut above = vec![ROOT; order.len()];
        for (place, &unknown) in (0..).zip(order) {
            for &other in self.of(unknown) {
                let mut climbing = places[other as usize];
                while climbing < place {
                    let next = std::mem::replace(&mut above[climbing as usize], place);
                    if next == ROOT {
                        parents[climbing as usize] = place;
                        break;
                    }
                    climbing = next;
                }
            }
        }
        parents
    }
}
