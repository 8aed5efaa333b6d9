//! What can go wrong between a map and an answer.

use covimap_embed::{EmbedError, Point};
use covimap_map::MapError;

/// Why a question could not be answered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// An ID that the map does not have.
    #[error("the map has no landmark {id:?}; {}", hint(.nearest))]
    UnknownLandmark {
        /// The ID asked for.
        id: String,
        /// The most similar ID of the map, if one is similar.
        nearest: Option<String>,
    },
    /// A number that no landmark of the map has.
    #[error("the map has no landmark number {number}, it has {landmarks}; numbers count from 0")]
    UnknownNumber {
        /// The number asked for.
        number: u32,
        /// Landmarks of the map.
        landmarks: usize,
    },
    /// A component that the map does not have.
    #[error("the map has no component {component}, it has {components}; numbers count from 0")]
    UnknownComponent {
        /// The component asked for.
        component: u32,
        /// Components of the map.
        components: usize,
    },
    /// Landmarks whose frames have nothing to do with each other.
    #[error(
        "{:?} lies in component {} and {:?} in component {}, and nothing tells how the two lie to each other; \
         give landmarks of one component, or a look that shows landmarks of both",
        ids[0], components[0], ids[1], components[1]
    )]
    Apart {
        /// Two of the landmarks.
        ids: [String; 2],
        /// Their components.
        components: [u32; 2],
    },
    /// A landmark that is named twice where different ones are asked.
    #[error("landmark {id:?} is named twice; give different landmarks")]
    Repeated {
        /// The landmark.
        id: String,
    },
    /// A landmark at the very place from which it is looked at.
    #[error("landmark {id:?} lies at the place itself, so it has no direction from there; leave it out")]
    NoDirection {
        /// The landmark.
        id: String,
    },
    /// A place that is nowhere.
    #[error("the place is ({}, {}), coordinates must be finite", position[0], position[1])]
    Nowhere {
        /// Its coordinates.
        position: Point,
    },
    /// A radius that is no length.
    #[error("the radius is {radius}; give a finite one of 0 or more, in the units of the map")]
    BadRadius {
        /// The radius.
        radius: f64,
    },
    /// A map that does not say which landmarks were seen together.
    #[error("the map holds no lines of sight, so it knows no way; build it again from its log")]
    NoSightLines,
    /// Two landmarks of a component between which all ways are weaker than asked.
    #[error(
        "no way from {from:?} to {to:?} whose neighbours were seen together in {min_steps} steps or more; \
         ask for fewer"
    )]
    NoRoute {
        /// Where it begins.
        from: String,
        /// Where it should end.
        to: String,
        /// Steps that were asked of every leg.
        min_steps: u32,
    },
    /// A search that came back with landmarks that are no way.
    #[error(
        "the search went from {from:?} to {to:?}, which no road joins; a leg must be a road of the graph"
    )]
    NoSuchRoad {
        /// Where the leg begins.
        from: String,
        /// Where it ends.
        to: String,
    },
    /// A search of one's own came back with something else than a way from the one landmark to the other.
    #[error(
        "the search for a way from {from:?} to {to:?} found none that begins at the one, ends at the other and stays on \
         the map; see `RouteSearch`"
    )]
    Astray {
        /// Where the way was to begin.
        from: String,
        /// Where it was to end.
        to: String,
    },
    /// Nothing given to align a map with.
    #[error("nothing to align the map with; give known positions, known distances or a known turn")]
    NothingKnown,
    /// Known positions that carry no component of the map.
    #[error(
        "the known positions are of {anchors} landmarks of the map, and no component has three that are not in \
         line, or two and a known turn; survey more landmarks of one component"
    )]
    TooFewAnchors {
        /// Landmarks that both know.
        anchors: usize,
    },
    /// Known distances between landmarks that coincide on the map.
    #[error(
        "the known distances of component {component} are all between landmarks at one place of the map; measure others"
    )]
    NoLength {
        /// The component.
        component: u32,
    },
    /// A known distance that is no distance.
    #[error("the distance from {from:?} to {to:?} is {distance}; give a finite one above 0")]
    BadDistance {
        /// One end.
        from: String,
        /// The other end.
        to: String,
        /// The distance.
        distance: f64,
    },
    /// A known turn of three landmarks that lie nearly in line on the map.
    #[error(
        "{:?}, {:?} and {:?} lie nearly in line on the map, which shows their turn with probability {probability:.2} \
         only; give a wider triangle", ids[0], ids[1], ids[2]
    )]
    UncertainTurn {
        /// The three.
        ids: [String; 3],
        /// How likely the map shows their turn as it is.
        probability: f64,
    },
    /// A known turn that contradicts what else is known.
    #[error(
        "that {:?}, {:?} and {:?} turn left contradicts the known positions or another known turn; correct one \
         of them", ids[0], ids[1], ids[2]
    )]
    TurnContradicted {
        /// The three.
        ids: [String; 3],
    },
    /// A fit that the numbers do not allow.
    #[error(transparent)]
    Embed(#[from] EmbedError),
    /// A map that could not be put together.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A setting is out of its range.
    #[error("setting {name} is {value}; give {wanted}")]
    BadParameter {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is accepted.
        wanted: &'static str,
    },
    /// A map that does not know from where its landmarks are seen.
    #[error(
        "the map of {landmarks} landmarks does not know its sensor, so that no place can be told; build it again, from \
         a log with three or more landmarks in one component"
    )]
    NoSensor {
        /// Landmarks of the map.
        landmarks: usize,
    },
}

fn hint(nearest: &Option<String>) -> String {
    match nearest {
        Some(nearest) => format!("did you mean {nearest:?}?"),
        None => "`covimap export --to csv` lists the IDs".to_owned(),
    }
}
