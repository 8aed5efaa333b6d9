//! Worlds: a floor with walls, and landmarks on it whose places are known.

mod blocks;
mod corridor_tree;
mod doors;
mod hall;
mod office;
mod ring;
mod spiral;
mod two_rooms;

#[cfg(test)]
mod tests;

use covimap_map::LandmarkNames;

use crate::error::SimError;
use crate::floor_plan::FloorPlan;
use crate::geometry::Point;
use crate::landmarks;
use crate::seed::{Stream, stream};
use crate::spec::{Floor, WorldSpec};

/// A floor and its landmarks. The landmarks are numbered from 0.
#[derive(Debug, Clone, PartialEq)]
pub struct World {
    plan: FloorPlan,
    landmarks: Vec<Point>,
    diameter: f64,
    id_prefix: String,
    seed: u64,
}

impl World {
    /// Builds the floor and places the landmarks; the same specification and seed give the same world.
    ///
    /// # Errors
    /// [`SimError::Setting`] if a setting is out of its range, [`SimError::DoorTooWide`] if the world is too
    /// small for its doors, [`SimError::Crowded`] if the landmarks do not fit that far apart.
    pub fn new(spec: &WorldSpec, seed: u64) -> Result<Self, SimError> {
        spec.check()?;
        let plan = plan(spec, seed)?;
        let landmarks = landmarks::place(spec, &plan, &mut stream(seed, Stream::Landmarks))?;
        Ok(Self { plan, landmarks, diameter: spec.diameter, id_prefix: spec.id_prefix.clone(), seed })
    }

    /// Free space, walls and openings.
    #[must_use]
    pub fn plan(&self) -> &FloorPlan {
        &self.plan
    }

    /// Where each landmark stands, in the order of their numbers.
    #[must_use]
    pub fn landmarks(&self) -> &[Point] {
        &self.landmarks
    }

    /// Diameter of every landmark, metres; 0 for points, which block neither way nor sight.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        self.diameter
    }

    /// The ID of every landmark.
    #[must_use]
    pub fn names(&self) -> LandmarkNames {
        let mut names = LandmarkNames::default();
        for number in 0..self.landmarks.len() {
            names.push(&format!("{}{number}", self.id_prefix));
        }
        names
    }

    /// The seed of the world, which also gives its landmarks their traits.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.seed
    }
}

fn plan(spec: &WorldSpec, seed: u64) -> Result<FloorPlan, SimError> {
    let area = spec.landmarks as f64 / spec.density;
    let mut rng = stream(seed, Stream::Floor);
    match spec.floor {
        Floor::Hall {} => Ok(hall::plan(area)),
        Floor::Ring {} => Ok(ring::ring(area)),
        Floor::Horseshoe {} => Ok(ring::horseshoe(area)),
        Floor::Blocks { street, building } => Ok(blocks::plan(area, street, building)),
        Floor::Spiral { corridor, wall } => Ok(spiral::plan(area, corridor, wall)),
        Floor::Office { room, door, missing_doors } => {
            office::plan(area, room, door, missing_doors, &mut rng)
        }
        Floor::TwoRooms { door } => two_rooms::plan(area, door, &mut rng),
        Floor::CorridorTree { corridor, pitch } => Ok(corridor_tree::plan(area, corridor, pitch, &mut rng)),
    }
}
