//! Options of the world.

use covimap_sim::{Floor, WorldSpec};

use super::{refuse_left, set};

/// Lengths in metres; each world has those that its shape needs.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Landmarks per square metre of free space [default: 10; of the paper's room see --side]
    #[arg(long, value_name = "N")]
    density: Option<f64>,
    /// Paper-room: side of the room [default: 1.5]
    #[arg(long, value_name = "M")]
    pub side: Option<f64>,
    /// How many times denser landmarks stand at the right end than at the left [default: 1]
    #[arg(long, value_name = "RATIO")]
    contrast: Option<f64>,
    /// Diameter of the landmarks; above 0 they are solid and hide each other [default: 0; paper-room: 0.048]
    #[arg(long, value_name = "M")]
    diameter: Option<f64>,
    /// Least gap between landmarks, and to walls [default: 0; paper-room: 0.1]
    #[arg(long, value_name = "M")]
    min_gap: Option<f64>,
    /// What landmark IDs begin with [default: L; paper-room: ob]
    #[arg(long, value_name = "TEXT")]
    id_prefix: Option<String>,
    /// Blocks: width of a street, in proportion to --building [default: 1]
    #[arg(long, value_name = "M")]
    street: Option<f64>,
    /// Blocks: side of a building [default: 2]
    #[arg(long, value_name = "M")]
    building: Option<f64>,
    /// Spiral, corridor-tree: width of a corridor [default: 1.6 in a spiral, 1 in a tree]
    #[arg(long, value_name = "M")]
    corridor: Option<f64>,
    /// Spiral: thickness of the wall between two turns [default: 0.2]
    #[arg(long, value_name = "M")]
    wall: Option<f64>,
    /// Corridor-tree: distance between two crossings, in proportion to --corridor [default: 3]
    #[arg(long, value_name = "M")]
    pitch: Option<f64>,
    /// Office: side of a room, about [default: 3]
    #[arg(long, value_name = "M")]
    room: Option<f64>,
    /// Office, two-rooms: width of a door [default: 0.9]
    #[arg(long, value_name = "M")]
    door: Option<f64>,
    /// Office: share of walls between rooms that have no door [default: 0.1]
    #[arg(long, value_name = "SHARE")]
    missing_doors: Option<f64>,
}

impl Options {
    /// Changes the world by what was given.
    ///
    /// # Errors
    /// A conflict, exit code 2, for a length that the world does not have.
    pub fn apply(mut self, spec: &mut WorldSpec, paper_room: bool) -> anyhow::Result<()> {
        if paper_room {
            refuse_left([("--density", self.density.is_some() && self.side.is_some())], "--side")?;
            self.side = None;
        }
        set(&mut spec.density, &mut self.density);
        set(&mut spec.contrast, &mut self.contrast);
        set(&mut spec.diameter, &mut self.diameter);
        set(&mut spec.min_gap, &mut self.min_gap);
        set(&mut spec.id_prefix, &mut self.id_prefix);
        self.apply_lengths(&mut spec.floor);
        let left = [
            ("--side", self.side.is_some()),
            ("--street", self.street.is_some()),
            ("--building", self.building.is_some()),
            ("--corridor", self.corridor.is_some()),
            ("--wall", self.wall.is_some()),
            ("--pitch", self.pitch.is_some()),
            ("--room", self.room.is_some()),
            ("--door", self.door.is_some()),
            ("--missing-doors", self.missing_doors.is_some()),
        ];
        refuse_left(left, if paper_room { super::PAPER_ROOM } else { spec.floor.name() })
    }

    fn apply_lengths(&mut self, floor: &mut Floor) {
        match floor {
            Floor::Hall {} | Floor::Ring {} | Floor::Horseshoe {} => {}
            Floor::Blocks { street, building } => {
                set(street, &mut self.street);
                set(building, &mut self.building);
            }
            Floor::Spiral { corridor, wall } => {
                set(corridor, &mut self.corridor);
                set(wall, &mut self.wall);
            }
            Floor::Office { room, door, missing_doors } => {
                set(room, &mut self.room);
                set(door, &mut self.door);
                set(missing_doors, &mut self.missing_doors);
            }
            Floor::TwoRooms { door } => set(door, &mut self.door),
            Floor::CorridorTree { corridor, pitch } => {
                set(corridor, &mut self.corridor);
                set(pitch, &mut self.pitch);
            }
        }
    }
}
