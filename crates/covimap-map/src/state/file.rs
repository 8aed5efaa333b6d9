//! The file of a [`MapState`].
//!
//! Numbers are little-endian; varints are those of [`crate::bytes`]. `n` landmarks of the log, `m` of the map:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `covistat` |
//! | 4 | format, 2 |
//! | 8 + b | length b of the map in its binary form, and the map |
//! | 8 + h | length h of the rules, and the rules of all components: JSON |
//! | 8 | sightings when all was last solved at once |
//! | 16 m | x and y of least stress, 64-bit floats |
//! | 8 m | sightings and links that each landmark was last solved with |
//! | 8, 8 | n, and the length t of all IDs of the log together |
//! | 4 n, t | length of each ID, the IDs in UTF-8 |
//! | 8, 8 + l | steps of the log; length l of the sightings, and those: for each step its size and what each landmark is beyond the one before, varints |
//! | 8, 8 + r | number of ranges; length r of those, and for each how many steps it is beyond the one before and the landmark, varints, and the metres, a 64-bit float; not in format 1 |
//! | 8 + c | length c of the counts: for each landmark the number of later partners, and of each what it is beyond the one before, and `n_ij`, varints |
//! | 4 | CRC-32 of all bytes before |
//!
//! The bytes depend on the state alone, and give back an equal state.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use super::{Ground, MapState, Rules, Settled, members};
use crate::bytes::{Rest, Summed, check_sum, names, write_names, write_varint};
use crate::{CoVisibility, GlobalMap, LandmarkId, MapError, Range, SightingLog, output};

const MAGIC: &[u8] = b"covistat";
/// Format number that this build writes; it reads those before, too.
const FORMAT: u32 = 2;
/// The first format that has ranges.
const WITH_RANGES: u32 = 2;

/// Whether bytes begin as those of a state.
pub(crate) fn is_state(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

impl MapState {
    /// Writes the state to a file, whole or not at all.
    ///
    /// # Errors
    /// [`MapError::Unwritable`] when the path cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), MapError> {
        output::write_whole(path, |out| self.write(out))
    }

    /// Writes the bytes of the file.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut out = Summed::new(out);
        out.write_all(MAGIC)?;
        out.write_all(&FORMAT.to_le_bytes())?;
        let mut map = Vec::new();
        self.map.write_binary(&mut map)?;
        write_block(&mut out, &map)?;
        let Ground { polished, settled, rules, whole } = &self.ground;
        write_block(&mut out, &serde_json::to_vec(rules)?)?;
        out.write_all(&whole.to_le_bytes())?;
        for coordinate in polished.iter().flatten() {
            out.write_all(&coordinate.to_le_bytes())?;
        }
        for Settled { sightings, partners } in settled {
            out.write_all(&sightings.to_le_bytes())?;
            out.write_all(&partners.to_le_bytes())?;
        }
        let letters: usize = self.log.names().iter().map(str::len).sum();
        for size in [self.log.names().len(), letters] {
            out.write_all(&(size as u64).to_le_bytes())?;
        }
        write_names(&mut out, self.log.names())?;
        out.write_all(&(self.log.steps() as u64).to_le_bytes())?;
        write_block(&mut out, &packed_steps(&self.log))?;
        out.write_all(&(self.log.ranges().len() as u64).to_le_bytes())?;
        write_block(&mut out, &packed_ranges(&self.log))?;
        write_block(&mut out, &packed_pairs(&self.counts))?;
        out.finish()
    }

    /// Reads a state that [`MapState::save`] wrote.
    ///
    /// # Errors
    /// [`MapError::Io`] when the file cannot be read, otherwise those of [`MapState::parse`].
    pub fn load(path: &Path) -> Result<Self, MapError> {
        let bytes = fs::read(path).map_err(|source| MapError::Io {
            path: path.to_owned(),
            what: "cannot be read; give a state, as `covimap build --state` writes it".to_owned(),
            source,
        })?;
        Self::parse(&bytes, &path.display().to_string())
    }

    /// Reads the bytes of a state; `file` is what errors call it.
    ///
    /// # Errors
    /// [`MapError::DamagedState`] for bytes that are not as they were written or no state at all,
    /// [`MapError::StateFormat`] for another format.
    pub fn parse(bytes: &[u8], file: &str) -> Result<Self, MapError> {
        let damaged = |what: String| MapError::DamagedState { file: file.to_owned(), what };
        let mut rest = Rest(bytes);
        let begin = |rest: &mut Rest| {
            if rest.take(MAGIC.len())? != MAGIC {
                return Err("it does not begin as one".to_owned());
            }
            rest.number()
        };
        let found = begin(&mut rest).map_err(damaged)?;
        if !(1..=FORMAT).contains(&found) {
            return Err(MapError::StateFormat { file: file.to_owned(), found, known: FORMAT });
        }
        check_sum(bytes).and_then(|()| contents(&mut rest, found)).map_err(damaged)
    }
}

fn write_block(out: &mut dyn Write, block: &[u8]) -> io::Result<()> {
    out.write_all(&(block.len() as u64).to_le_bytes())?;
    out.write_all(block)
}

fn packed_steps(log: &SightingLog) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(3 * log.sightings() + log.steps());
    for step in log.iter() {
        write_varint(&mut bytes, step.len() as u32);
        let mut last = 0;
        for &landmark in step {
            write_varint(&mut bytes, landmark - last);
            last = landmark;
        }
    }
    bytes
}

fn packed_ranges(log: &SightingLog) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(12 * log.ranges().len());
    let mut last = 0;
    for range in log.ranges() {
        write_varint(&mut bytes, (range.step - last) as u32);
        write_varint(&mut bytes, range.landmark);
        bytes.extend(range.metres.to_le_bytes());
        last = range.step;
    }
    bytes
}

pub(super) fn packed_pairs(counts: &CoVisibility) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(4 * counts.pair_count());
    for landmark in 0..counts.landmarks() as u32 {
        let (partners, together) = counts.row(LandmarkId(landmark));
        let later = partners.partition_point(|&partner| partner < landmark);
        write_varint(&mut bytes, (partners.len() - later) as u32);
        let mut last = landmark;
        for (&partner, &both) in partners[later..].iter().zip(&together[later..]) {
            write_varint(&mut bytes, partner - last);
            write_varint(&mut bytes, both);
            last = partner;
        }
    }
    bytes
}

/// What stands between the format and the check sum.
fn contents(rest: &mut Rest, format: u32) -> Result<MapState, String> {
    let length = rest.size()?;
    let map = GlobalMap::parse_binary(rest.take(length)?, "its map").map_err(|error| error.to_string())?;
    let length = rest.size()?;
    let rules: Vec<Rules> =
        serde_json::from_slice(rest.take(length)?).map_err(|error| format!("its rules, {error}"))?;
    let whole = rest.size()? as u64;
    let polished = rest.list(map.len(), f64::from_le_bytes, 2)?.as_chunks().0.to_vec();
    let settled = rest.list(map.len(), u32::from_le_bytes, 2)?;
    let settled = settled.as_chunks().0.iter();
    let settled = settled.map(|&[sightings, partners]| Settled { sightings, partners }).collect();
    let [landmarks, letters] = [rest.size()?, rest.size()?];
    let names = names(rest.numbers(landmarks)?, rest.take(letters)?)?;
    let steps = rest.size()?;
    let length = rest.size()?;
    let (starts, seen) = steps_of(Rest(rest.take(length)?), steps, landmarks)?;
    let mut sightings = vec![0; landmarks];
    seen.iter().for_each(|&landmark| sightings[landmark as usize] += 1);
    let ranges = if format >= WITH_RANGES {
        let (count, length) = (rest.size()?, rest.size()?);
        ranges_of(Rest(rest.take(length)?), count)?
    } else {
        Vec::new()
    };
    let length = rest.size()?;
    let rows = pairs_of(Rest(rest.take(length)?), landmarks)?;
    rest.end()?;
    let counts = CoVisibility::from_later_partners(steps as u64, sightings, &rows)
        .map_err(|error| format!("its counts, {error}"))?;
    if rules.len() != members(&map).len() {
        return Err(format!("it has {} rules for {} components", rules.len(), members(&map).len()));
    }
    let log = SightingLog::from_numbers(names, starts, seen);
    let log = log.with_ranges(ranges).map_err(|error| format!("its ranges, {error}"))?;
    Ok(MapState { log, counts, map, ground: Ground { polished, settled, rules, whole } })
}

fn steps_of(mut rest: Rest, steps: usize, landmarks: usize) -> Result<(Vec<usize>, Vec<u32>), String> {
    // Every number takes a byte at least. Memory that is never written to is not taken.
    let mut starts = Vec::with_capacity(steps.min(rest.0.len()) + 1);
    let mut seen = Vec::with_capacity(rest.0.len());
    starts.push(0);
    for step in 0..steps {
        let mut last = 0;
        for _ in 0..rest.varint()? {
            last =
                beyond(last, rest.varint()?, landmarks).ok_or_else(|| format!("its step {step} is wrong"))?;
            seen.push(last);
        }
        starts.push(seen.len());
    }
    Ok((starts, seen))
}

fn ranges_of(mut rest: Rest, count: usize) -> Result<Vec<Range>, String> {
    let mut ranges = Vec::with_capacity(count.min(rest.0.len()));
    let mut step = 0;
    for _ in 0..count {
        step += rest.varint()? as usize;
        let landmark = rest.varint()?;
        ranges.push(Range { step, landmark, metres: rest.list(1, f64::from_le_bytes, 1)?[0] });
    }
    Ok(ranges)
}

fn pairs_of(mut rest: Rest, landmarks: usize) -> Result<Vec<Vec<(u32, u32)>>, String> {
    let mut row = |landmark: u32| {
        let mut last = landmark;
        let partners = rest.varint()?;
        let mut row = Vec::with_capacity(rest.0.len().min(partners as usize));
        for _ in 0..partners {
            let wrong = || format!("its partners of landmark {landmark} are wrong");
            last = beyond(last, rest.varint()?, landmarks).ok_or_else(wrong)?;
            row.push((last, rest.varint()?));
        }
        Ok(row)
    };
    (0..landmarks as u32).map(&mut row).collect()
}

/// The landmark so far beyond another one, if there is one.
fn beyond(last: u32, by: u32, landmarks: usize) -> Option<u32> {
    last.checked_add(by).filter(|&landmark| (landmark as usize) < landmarks)
}
