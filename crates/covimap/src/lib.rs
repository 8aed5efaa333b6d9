//! A log of which landmarks were seen together becomes a map that robots can use.
//!
//! What goes in is a [`SightingLog`]: for every step the IDs that were seen together, and nothing
//! else. What comes out is a [`GlobalMap`]: a position for every landmark, in
//! map units, with the evidence
//! behind it and a report. [`Mapper`] does it in one call.
//!
//! # Tour
//!
//! ```
//! use covimap::evaluate::{self, EvaluateParams};
//! use covimap::{LogFormat, Mapper, MapperParams, Method, SightingLog, Silent, Truth};
//!
//! // A log: from files with `SightingLog::read`, from a stream, or from memory.
//! let text = "A B\nB C\nC D\nD A\nA B C\nC D A\n";
//! let log = SightingLog::read_from(text.as_bytes(), "square", Some(LogFormat::Text), &Silent)?;
//! assert_eq!(log.summary().landmarks, 4);
//!
//! // A map. All settings have defaults; `Silent` may be an observer that shows progress.
//! let map = Mapper::new(MapperParams::default())?.build(&log, &Silent)?;
//! assert_eq!(map.names().iter().collect::<Vec<_>>(), ["A", "B", "C", "D"]);
//! assert_eq!(map.report().pairs, 5);
//!
//! // How good it is, if somebody surveyed the landmarks.
//! let truth = Truth::parse(b"id,x,y\nA,0,0\nB,1,0\nC,1,1\nD,0,1\n", "survey")?;
//! let found = evaluate::against(&map, &truth, &EvaluateParams::default())?;
//! assert_eq!(found.orientation_error, Some(0.0));
//!
//! // The same by the method of the CoviMap paper.
//! let mut params = MapperParams::default();
//! params.method = Method::Classical;
//! let classical = Mapper::new(params)?.build(&log, &Silent)?;
//! assert_eq!(classical.len(), 4);
//! # Ok::<(), covimap::MapError>(())
//! ```
//!
//! # Stages
//!
//! Every stage can be called by itself; each product is immutable.
//!
//! 1. [`SightingLog::read`]: text to steps.
//! 2. [`CoVisibility::count`]: steps to counts.
//! 3. [`LinkGraph::from_counts`]: counts to distances and weights.
//! 4. [`Mapper::build`]: all of it, then regions, local maps, stitching, polish and
//!    refinement.
//! 5. [`GlobalMap::save`], [`export`], [`mod@evaluate`]: what to do with a map.
//! 6. [`plan::MapIndex`], [`plan::Roads`], [`plan::align()`]: a map in a planner's hands.
//!
//! The engine below, [`embed`], knows nothing of landmarks: distances in, coordinates out.

pub use covimap_embed as embed;
#[doc(inline)]
pub use covimap_map::*;
#[doc(inline)]
pub use covimap_plan as plan;

/// The documents, so that their Rust code is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Documents;
