//! Which steps of a log are about which component.

use crate::SightingLog;

/// Component and place in it of every landmark of a log.
pub(crate) struct Places {
    of: Vec<(u32, u32)>,
}

/// The steps of one component, in the order of time.
pub(crate) struct ComponentSteps<'a> {
    log: &'a SightingLog,
    places: &'a Places,
    component: u32,
    steps: Vec<usize>,
}

impl Places {
    /// `components[c]` are the landmarks of component `c`, each landmark of the log in one of them.
    pub fn new(landmarks: usize, components: &[Vec<u32>]) -> Self {
        let mut of = vec![(0, 0); landmarks];
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
    pub fn of_all(log: &'a SightingLog, places: &'a Places, components: usize) -> Vec<Self> {
        let mut steps = vec![Vec::new(); components];
        for (step, seen) in log.iter().enumerate() {
            if let Some(&first) = seen.first() {
                steps[places.of[first as usize].0 as usize].push(step);
            }
        }
        let of_one = |(component, steps)| Self { log, places, component, steps };
        (0..).zip(steps).map(of_one).collect()
    }

    /// Number of steps.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// The landmarks of the component that a step shows, by their places in it, ascending.
    pub fn read(&self, step: usize, seen: &mut Vec<u32>) {
        let own = |&landmark: &u32| {
            let (component, place) = self.places.of[landmark as usize];
            (component == self.component).then_some(place)
        };
        seen.clear();
        seen.extend(self.log.step(self.steps[step]).iter().filter_map(own));
    }
}
