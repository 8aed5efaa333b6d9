//! Which steps of a log are about which component.

use crate::SightingLog;

/// Component and place in it of the landmarks of a log; component `u32::MAX` for those in none.
pub(crate) struct Membership {
    of: Vec<(u32, u32)>,
}

/// The steps of one component, in the order of time.
pub(crate) struct ComponentSteps<'a> {
    log: &'a SightingLog,
    membership: &'a Membership,
    component: u32,
    steps: Vec<usize>,
}

impl Membership {
    /// `components[c]` are the landmarks of component `c`, each landmark of the log in one of them at most.
    pub fn new(landmarks: usize, components: &[Vec<u32>]) -> Self {
        let mut of = vec![(u32::MAX, 0); landmarks];
        for (component, members) in (0..).zip(components) {
            for (place, &member) in (0..).zip(members) {
                of[member as usize] = (component, place);
            }
        }
        Self { of }
    }
}

impl<'a> ComponentSteps<'a> {
    /// The steps of each of so many components: those whose first landmark belongs to it.
    pub fn of_all(log: &'a SightingLog, membership: &'a Membership, components: usize) -> Vec<Self> {
        let mut steps = vec![Vec::new(); components];
        for (step, seen) in log.iter().enumerate() {
            if let Some(&first) = seen.first()
                && let Some(steps) = steps.get_mut(membership.of[first as usize].0 as usize)
            {
                steps.push(step);
            }
        }
        let of_one = |(component, steps)| Self { log, membership, component, steps };
        (0..).zip(steps).map(of_one).collect()
    }

    /// Number of steps.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// The landmarks of the component that a step shows, by their places in it, ascending.
    pub fn read(&self, step: usize, seen: &mut Vec<u32>) {
        let own = |&landmark: &u32| {
            let (component, place) = self.membership.of[landmark as usize];
            (component == self.component).then_some(place)
        };
        seen.clear();
        seen.extend(self.log.step(self.steps[step]).iter().filter_map(own));
    }
}
