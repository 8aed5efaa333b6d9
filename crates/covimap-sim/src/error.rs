//! What can go wrong before a simulation starts.

/// Why a world could not be built or a simulation not be set up.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A setting is outside its range.
    #[error("{name} is {value}; it must be {range}")]
    Setting {
        /// The setting, as in the specification.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// There is no world or motion of this name.
    #[error("there is no {kind} `{name}`; choose one of {known}")]
    UnknownName {
        /// What was named.
        kind: &'static str,
        /// What was given.
        name: String,
        /// All names.
        known: String,
    },
    /// The start of landmark IDs has characters that log formats give a meaning.
    #[error("id prefix `{prefix}` may only have letters, digits, `-` and `_`; choose another")]
    IdPrefix {
        /// What was given.
        prefix: String,
    },
    /// A door is wider than the wall that it is in.
    #[error(
        "a door of {door} m does not fit a wall of {wall:.3} m; place more landmarks or make it narrower"
    )]
    DoorTooWide {
        /// Width of the door, metres.
        door: f64,
        /// Length of the wall, metres.
        wall: f64,
    },
    /// The landmarks do not fit on the floor at the wanted distance.
    #[error(
        "only {placed} of {wanted} landmarks found a place {gap} m apart; lower density, diameter or gap"
    )]
    Crowded {
        /// Landmarks that found a place.
        placed: usize,
        /// Landmarks asked for.
        wanted: usize,
        /// The gap asked for between surfaces, metres.
        gap: f64,
    },
    /// A visual angle is to be measured, but landmarks are points.
    #[error("landmarks of diameter 0 have no visual angle; give them a diameter or recognise them by range")]
    SolidNeeded,
    /// The robot does not fit anywhere.
    #[error("no free place for a robot that keeps {clearance} m clear; lower the clearance or the density")]
    NoFreePlace {
        /// The robot's clearance, metres.
        clearance: f64,
    },
    /// Openings are too narrow for the robot to reach every part of the floor.
    #[error(
        "{cut_off} of {patches} patches of floor are out of reach for a robot that keeps {clearance} m clear; \
         lower the clearance or let it wander"
    )]
    OutOfReach {
        /// Patches that the robot cannot get to.
        cut_off: usize,
        /// All patches.
        patches: usize,
        /// The robot's clearance, metres.
        clearance: f64,
    },
}
