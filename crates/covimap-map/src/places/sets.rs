//! The log as refinement reads it: the different sets of landmarks seen, and how often each was.

use rayon::prelude::*;

use crate::SightingLog;

/// Different sets of at least two landmarks, in lexical order, so that neighbours in the list are
/// neighbours in space.
pub(crate) struct SeenSets {
    starts: Vec<usize>,
    seen: Vec<u32>,
    times: Vec<u32>,
}

impl SeenSets {
    /// The sets of every component that is given; landmarks are numbered by their places in their component.
    ///
    /// A step whose sightings lie in several components is a set of each: what it shows of another one is
    /// a recognition error in its eyes.
    pub fn by_component(log: &SightingLog, components: &[Vec<u32>]) -> Vec<Self> {
        let mut place = vec![(usize::MAX, 0); log.names().len()];
        for (component, members) in components.iter().enumerate() {
            for (k, &member) in members.iter().enumerate() {
                place[member as usize] = (component, k as u32);
            }
        }
        let mut steps = vec![Vec::new(); components.len()];
        for step in 0..log.steps() {
            let of = |&landmark: &u32| place[landmark as usize].0;
            let seen = log.step(step);
            for (k, component) in seen.iter().map(of).enumerate() {
                // At the second of the landmarks that lie in this component.
                if component < components.len()
                    && seen[..k].iter().filter(|other| of(other) == component).count() == 1
                {
                    steps[component].push(step);
                }
            }
        }
        let sets = |(component, steps)| Self::of_steps(log, component, steps, &place);
        steps.into_iter().enumerate().map(sets).collect()
    }

    /// The sets of steps that show at least two landmarks of a component; `place` tells of every landmark of the
    /// log its component and place in it.
    pub fn of_steps(
        log: &SightingLog,
        component: usize,
        mut steps: Vec<usize>,
        place: &[(usize, u32)],
    ) -> Self {
        let set = |step: usize| {
            let places = log.step(step).iter().map(|&landmark| place[landmark as usize]);
            places.filter(|place| place.0 == component).map(|place| place.1)
        };
        steps.par_sort_unstable_by(|&a, &b| set(a).cmp(set(b)));
        let mut sets = Self { starts: vec![0], seen: Vec::new(), times: Vec::new() };
        for equal in steps.chunk_by(|&a, &b| set(a).eq(set(b))) {
            sets.seen.extend(set(equal[0]));
            sets.starts.push(sets.seen.len());
            sets.times.push(equal.len() as u32);
        }
        sets
    }

    /// At most about `most` of the sets, evenly spread; each stands for those left out after it.
    pub fn sample(&self, most: usize) -> Self {
        let stride = self.stride(most);
        let mut sample = Self { starts: vec![0], seen: Vec::new(), times: Vec::new() };
        for first in (0..self.len()).step_by(stride) {
            sample.seen.extend_from_slice(self.seen(first));
            sample.starts.push(sample.seen.len());
            sample.times.push(self.times[first..self.len().min(first + stride)].iter().sum());
        }
        sample
    }

    /// How many sets [`SeenSets::sample`] has.
    pub fn sampled(&self, most: usize) -> usize {
        self.len().div_ceil(self.stride(most))
    }

    fn stride(&self, most: usize) -> usize {
        self.len().div_ceil(most.max(1)).max(1)
    }

    /// Number of different sets.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// The landmarks of a set, ascending.
    pub fn seen(&self, set: usize) -> &[u32] {
        &self.seen[self.starts[set]..self.starts[set + 1]]
    }

    /// Number of steps that show exactly this set.
    pub fn times(&self, set: usize) -> f64 {
        f64::from(self.times[set])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_sets_are_counted_and_lone_sightings_left_out() {
        let log = SightingLog::from_steps([
            vec!["A", "B"],
            vec!["C"],
            vec!["D", "E"],
            vec!["B", "A"],
            vec![],
            vec!["A", "B", "C"],
        ]);
        let [sets, other] = &SeenSets::by_component(&log, &[vec![0, 1, 2], vec![3, 4]])[..] else {
            panic!("one list of sets a component");
        };
        assert_eq!(sets.len(), 2);
        assert_eq!((other.len(), other.seen(0), other.times(0)), (1, [0, 1].as_slice(), 1.0));
        assert_eq!((sets.seen(0), sets.times(0)), ([0, 1].as_slice(), 2.0));
        assert_eq!((sets.seen(1), sets.times(1)), ([0, 1, 2].as_slice(), 1.0));
    }

    #[test]
    fn a_step_is_a_set_of_every_component_that_it_shows_twice() {
        let log = SightingLog::from_steps([
            vec!["A", "B", "C", "D", "E"],
            vec!["A", "B", "D"],
            vec!["C", "D", "E"],
            vec!["A", "D"],
        ]);
        // A, B and C; D and E: a step that shows but one of the two says nothing of them.
        let [abc, de] = &SeenSets::by_component(&log, &[vec![0, 1, 2], vec![3, 4]])[..] else {
            panic!("one list of sets a component");
        };
        assert_eq!((abc.len(), abc.seen(0), abc.times(0)), (2, [0, 1].as_slice(), 1.0));
        assert_eq!((abc.seen(1), abc.times(1)), ([0, 1, 2].as_slice(), 1.0));
        assert_eq!((de.len(), de.seen(0), de.times(0)), (1, [0, 1].as_slice(), 2.0));
    }

    #[test]
    fn a_sample_stands_for_all_sets() {
        let steps = (0..10).map(|i| vec![i.to_string(), "last".to_owned()]);
        let sets = &SeenSets::by_component(&SightingLog::from_steps(steps), &[(0..11).collect()])[0];
        let sample = sets.sample(4);
        // Every third of ten: three sets for three each, the last for itself.
        assert_eq!((sample.len(), sample.times(0), sample.times(3)), (4, 3.0, 1.0));
        assert_eq!(sample.seen(1), sets.seen(3));
        assert_eq!(sets.sample(10).len(), 10);
        assert_eq!(sets.sample(0).len(), 1);
    }
}
