//! The binary form of a map file, for maps that are loaded often or are large.
//!
//! Numbers are little-endian; lists have no padding. `n` landmarks and `m` lines of sight:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `covimap` and a zero byte |
//! | 4 | format, 1 |
//! | 8 + h | length h of the head, and the head: JSON of settings, report, alignment, sensors and occluded pairs |
//! | 8, 8, 8 | n, m, and the length t of all IDs together |
//! | 4 n, t | length of each ID, the IDs in UTF-8 |
//! | 16 n | x and y, 64-bit floats |
//! | 24 n | component, region, sightings, partners, branch, and 1 if it is loose or 0 |
//! | 24 n | detectability, deviation and warp, 64-bit floats, unless the head has no sensors |
//! | 12 m | number of the first landmark, of the second, and steps that show both |
//! | 4 | CRC-32 of all bytes before |
//!
//! The bytes depend on the map alone, and give back an equal map.

use std::io::{self, Write};

use super::{FORMAT, Head, Parts, SENSED, in_file, object, without_warp};
use crate::bytes::{Rest, Summed, check_sum, names, write_names};
use crate::{GlobalMap, LandmarkId, MapError, PlacedLandmark, Sensed, Sensing};

/// Ending of names of files in this form.
pub(super) const BINARY_EXTENSION: &str = "covimap";

const MAGIC: &[u8] = b"covimap\0";

/// Whether these are the first bytes of a map file in this form.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

impl GlobalMap {
    /// Writes the binary form of the map file.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_binary(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut out = Summed::new(out);
        let head = serde_json::to_vec(&Head {
            settings: object(self.params())?,
            report: self.report().clone(),
            alignment: self.alignment().to_vec(),
            sensors: self.sensing().map_or(Vec::new(), |sensing| sensing.sensors().to_vec()),
            occluded: self.sensing().into_iter().flat_map(Sensing::occluded_pairs).collect(),
            sensed: SENSED,
        })?;
        out.write_all(MAGIC)?;
        out.write_all(&(FORMAT as u32).to_le_bytes())?;
        out.write_all(&(head.len() as u64).to_le_bytes())?;
        out.write_all(&head)?;
        let letters = self.names().iter().map(str::len).sum::<usize>();
        for size in [self.len(), self.sight_lines().count(), letters] {
            out.write_all(&(size as u64).to_le_bytes())?;
        }
        write_names(&mut out, self.names())?;
        for coordinate in self.landmarks().iter().flat_map(|placed| placed.position) {
            out.write_all(&coordinate.to_le_bytes())?;
        }
        for placed in self.landmarks() {
            let PlacedLandmark { component, region, sightings, partners, branch, loose, .. } = *placed;
            for number in [component, region, sightings, partners, branch, u32::from(loose)] {
                out.write_all(&number.to_le_bytes())?;
            }
        }
        if let Some(sensing) = self.sensing() {
            for id in (0..self.len() as u32).map(LandmarkId) {
                let Sensed { detectability, deviation, warp } = *sensing.of(id);
                for number in [detectability, deviation, warp] {
                    out.write_all(&number.to_le_bytes())?;
                }
            }
        }
        for number in self.sight_lines().pairs().flat_map(|(a, b, steps)| [a.0, b.0, steps]) {
            out.write_all(&number.to_le_bytes())?;
        }
        out.finish()
    }

    /// Reads the binary form of a map file; `file` is what errors call it.
    ///
    /// # Errors
    /// [`MapError::DamagedMap`] for bytes that are not as they were written, [`MapError::MapFormat`]
    /// for another format, [`MapError::InvalidMap`] for landmarks that contradict each other.
    pub fn parse_binary(bytes: &[u8], file: &str) -> Result<Self, MapError> {
        let damaged = |what: String| MapError::DamagedMap { file: file.to_owned(), what };
        let mut rest = Rest(bytes);
        let begin = |rest: &mut Rest| {
            if rest.take(MAGIC.len())? != MAGIC {
                return Err("it does not begin as one".to_owned());
            }
            rest.number()
        };
        let found = u64::from(begin(&mut rest).map_err(damaged)?);
        if found != FORMAT {
            return Err(MapError::MapFormat { file: file.to_owned(), found, known: FORMAT });
        }
        check_sum(bytes).map_err(damaged)?;
        let (head, parts) = contents(&mut rest).map_err(damaged)?;
        head.complete(parts).map_err(|error| in_file(error, file))
    }
}

/// What stands between the format and the check sum.
fn contents(rest: &mut Rest) -> Result<(Head, Parts), String> {
    let length = rest.size()?;
    let head: Head =
        serde_json::from_slice(rest.take(length)?).map_err(|error| format!("its head, {error}"))?;
    let [landmarks, lines, letters] = [rest.size()?, rest.size()?, rest.size()?];
    let names = names(rest.numbers(landmarks)?, rest.take(letters)?)?;
    let coordinates = rest.list(landmarks, f64::from_le_bytes, 2)?;
    let numbers = rest.list(landmarks, u32::from_le_bytes, 6)?;
    let placed = |(&position, numbers): (&_, &[u32; 6])| {
        let [component, region, sightings, partners, branch, loose] = *numbers;
        PlacedLandmark { position, component, region, sightings, partners, branch, loose: loose != 0 }
    };
    if !(without_warp()..=SENSED).contains(&head.sensed) {
        return Err(format!("its head tells {} numbers of each landmark", head.sensed));
    }
    let known = if head.sensors.is_empty() { 0 } else { landmarks };
    let known = rest.list(known, f64::from_le_bytes, head.sensed)?;
    let sensed = |numbers: &[f64]| Sensed {
        detectability: numbers[0],
        deviation: numbers[1],
        warp: numbers.get(2).copied().unwrap_or(0.0),
    };
    let links = rest.list(lines, u32::from_le_bytes, 3)?;
    let link = |&[a, b, steps]: &[u32; 3]| (LandmarkId(a), LandmarkId(b), steps);
    let parts = Parts {
        names,
        landmarks: coordinates.as_chunks().0.iter().zip(numbers.as_chunks().0).map(placed).collect(),
        sensed: known.chunks_exact(head.sensed).map(sensed).collect(),
        links: links.as_chunks().0.iter().map(link).collect(),
    };
    rest.end()?;
    Ok((head, parts))
}

#[cfg(test)]
mod tests;
