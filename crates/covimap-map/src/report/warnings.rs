//! Findings in counts and graph that a reader of the map should know of.

use super::{ComponentReport, Hinge, SeamsReport, Warning};
use crate::{CoVisibility, HonestyReport, LandmarkId, LandmarkNames, LinkGraph, PlacedLandmark};

/// IDs named in a warning; the rest is only counted.
const EXAMPLES: usize = 10;
/// Share of misrecognised sightings from which on a reader is told.
const NOTABLE: f64 = 0.002;

/// Share of dropped seams from which on a reader is told.
const CONTESTED: f64 = 0.25;

/// All warnings of a build, in a fixed order.
pub(crate) fn warnings(
    counts: &CoVisibility,
    graph: &LinkGraph,
    honesty: HonestyReport,
    placed: &[PlacedLandmark],
    components: &[ComponentReport],
    names: &LandmarkNames,
) -> Vec<Warning> {
    let landmarks = || (0..graph.landmarks() as u32).map(LandmarkId);
    let warn = |kind: &str, found: &mut dyn Iterator<Item = LandmarkId>, message: &str| {
        let mut examples = Vec::new();
        let mut count = 0;
        for landmark in found {
            count += 1;
            if examples.len() < EXAMPLES {
                examples.push(names.name(landmark).to_owned());
            }
        }
        (count > 0).then(|| Warning { kind: kind.to_owned(), count, examples, message: message.to_owned() })
    };
    let alone = |id: LandmarkId| counts.row(id).0.is_empty();
    let stranded = |id: LandmarkId| graph.of(id.0).is_empty() && !alone(id);
    let loose = |id: LandmarkId| (1..3).contains(&graph.of(id.0).len());
    let twin = |id: LandmarkId| {
        let (partners, together) = counts.row(id);
        let own = counts.sightings()[id.index()];
        own > 1
            && partners
                .iter()
                .zip(together)
                .any(|(&other, &both)| both == own && counts.sightings()[other as usize] == own)
    };
    let mut warnings: Vec<Warning> = [
        warn(
            "seen_once",
            &mut landmarks().filter(|id| counts.sightings()[id.index()] == 1),
            "seen in a single step; their places are guesses until they are seen again",
        ),
        warn(
            "never_together",
            &mut landmarks().filter(|&id| alone(id)),
            "never seen together with another landmark; each is a component of its own and has no place \
             relative to the others",
        ),
        warn(
            "all_links_doubtful",
            &mut landmarks().filter(|&id| stranded(id)),
            "seen together with others no more often than recognition errors alone would have it; each is a \
             component of its own and has no place relative to the others",
        ),
        warn(
            "few_partners",
            &mut landmarks().filter(|&id| loose(id) && graph.landmarks() > 3),
            "seen together with fewer than three others, which leaves a choice of places; look for steps that \
             show them with more",
        ),
        warn(
            "partners_on_a_line",
            &mut landmarks().filter(|id| placed[id.index()].loose && graph.of(id.0).len() >= 3),
            "seen together with landmarks on a line only, so that they may lie on its other side; look for steps \
             that show them with one beside the line",
        ),
        warn(
            "twins",
            &mut landmarks().filter(|&id| twin(id)),
            "always seen together with the same other landmark and never without it, so the two cannot be told \
             apart",
        ),
    ]
    .into_iter()
    .flatten()
    .collect();
    warnings.extend(warnings_without_ids(honesty, components));
    warnings
}

/// The warning about IDs that were found in several places, and split into as many landmarks or not.
pub(crate) fn aliases_warning<'a>(ids: impl ExactSizeIterator<Item = &'a str>, split: bool) -> Warning {
    let count = ids.len() as u64;
    let warn = |kind: &str, message: &str| Warning {
        kind: kind.to_owned(),
        count,
        examples: ids.take(EXAMPLES).map(str::to_owned).collect(),
        message: message.to_owned(),
    };
    warn(
        "aliases",
        if split {
            "IDs that are seen in places far from each other; each place has a landmark of its own on the map, such \
             as A#1 and A#2"
        } else {
            "IDs that seem to be seen in places far from each other; if several things bear them, build with \
             split_aliases (--split-aliases) to give each place a landmark of its own"
        },
    )
}

/// The warning about charts that new steps have joined to others, each by one of its IDs.
pub(crate) fn carried_warning<'a>(ids: impl Iterator<Item = &'a str>) -> Option<Warning> {
    let ids: Vec<String> = ids.map(str::to_owned).collect();
    let warn = |kind: &str, message: &str| Warning {
        kind: kind.to_owned(),
        count: ids.len() as u64,
        examples: ids.iter().take(EXAMPLES).cloned().collect(),
        message: message.to_owned(),
    };
    let joined = warn(
        "charts_joined",
        "charts that new steps have tied to larger ones; each was carried into the frame of the larger one, so that \
         all its landmarks have new coordinates, turned and perhaps mirrored",
    );
    (!ids.is_empty()).then_some(joined)
}

fn warnings_without_ids(
    honesty: HonestyReport,
    components: &[ComponentReport],
) -> impl Iterator<Item = Warning> {
    let warn = |kind: &str, count: usize, message: String| {
        (count > 0).then(|| Warning {
            kind: kind.to_owned(),
            count: count as u64,
            examples: Vec::new(),
            message,
        })
    };
    let misread = honesty.misrecognition.filter(|&rate| rate >= NOTABLE);
    let several = components.len() > 1;
    let unfinished = components.iter().filter(|component| !component.converged).count();
    let hinges = || components.iter().flat_map(|component| &component.seams.hinges);
    let contested = |seams: &&SeamsReport| seams.dropped.len() as f64 > CONTESTED * seams.count as f64;
    let dropped =
        components.iter().map(|component| &component.seams).filter(contested).map(|s| s.dropped.len()).sum();
    let networks = components.iter().filter(|component| component.network).count();
    let pulled = components.iter().filter(|component| component.path_pull > 0.0).count() - networks;
    let tiny = components.len() == 1 && components[0].landmarks <= 3;
    [
        warn(
            "misrecognition",
            misread.map_or(0, |_| honesty.set_aside as usize),
            format!(
                "pairs seem to be seen together by mistake only and are not linked: about {:.1} % of the sightings \
                 show another landmark than was there; look at the recogniser",
                100.0 * misread.unwrap_or(0.0)
            ),
        ),
        warn(
            "components",
            if several { components.len() } else { 0 },
            "parts of the log have no sighting in common; each is a chart of its own, and nothing tells how they \
             lie to each other"
                .to_owned(),
        ),
        warn("hinges", hinges().count(), hinges().next().map(hinge_message).unwrap_or_default()),
        warn(
            "dropped_seams",
            dropped,
            "pairs of overlapping regions contradict the rest of the map in how they lie to each other and were \
             left out; the map is least sure there"
                .to_owned(),
        ),
        warn(
            "shape_from_paths",
            pulled,
            "components whose links are so few that most sides are guesses; the lengths of paths along links were \
             used as well, which unfolds the map and makes its bends and loops too wide"
                .to_owned(),
        ),
        warn(
            "network",
            networks,
            "components in which being seen together tells little of being near: no distances in a plane fit; paths \
             along links made the map, which shows its large shape and hardly who is whose neighbour"
                .to_owned(),
        ),
        warn(
            "not_converged",
            unfinished,
            "components whose last steps still lowered the stress; raise auto.polish_stop.max_iterations".to_owned(),
        ),
        warn(
            "too_few_landmarks",
            usize::from(tiny),
            "with three landmarks or fewer any set of distances fits, so the map cannot be checked".to_owned(),
        ),
    ]
    .into_iter()
    .flatten()
}

fn hinge_message(first: &Hinge) -> String {
    let Hinge { seam, landmarks } = first;
    format!(
        "places where the side of all that lies beyond is a guess: a part of {landmarks} landmarks hangs on {} that \
         regions {} and {} share, and its mirror image fits nearly as well; look for steps there that show more \
         landmarks at once",
        seam.shared, seam.regions[0], seam.regions[1]
    )
}

#[cfg(test)]
mod tests;
