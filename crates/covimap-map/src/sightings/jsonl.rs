//! JSONL: `{"t": 12.5, "seen": ["A", "B"]}` a line.
//!
//! Almost every line is plain: the keys `t` and `seen`, strings without escapes, small integers.
//! [`scan`] takes such lines apart by itself, several times faster than a JSON parser. It gives up
//! on everything else, and [`parse`] has `serde_json` decide: so a line means what it means to
//! `serde_json`, and only that parser ever says what is wrong with it.

use std::borrow::Cow;
use std::fmt;

use super::lines::excerpt;
use super::shown::Shown;
use serde::Deserialize;
use serde::de::{Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// Reads one line; `false` if it is blank.
pub(super) fn parse_line<'a>(line: &'a str, shown: &mut Shown<'a>) -> Result<bool, String> {
    let start = shown.ids.len();
    if scan(line.as_bytes(), line, &mut shown.ids).is_some() {
        return Ok(true);
    }
    shown.ids.truncate(start);
    if line.bytes().all(|byte| byte.is_ascii_whitespace()) {
        return Ok(false);
    }
    let Step { seen, ranges } = parse(line)?;
    for (id, metres) in ranges {
        let place = seen.iter().position(|other| *other == id).ok_or_else(|| {
            format!(
                "a range to {}, which `seen` does not list; list it, or leave the range out",
                excerpt(&id)
            )
        })?;
        if !(metres > 0.0 && metres.is_finite()) {
            return Err(format!("the range to {} is {metres}; give metres above 0", excerpt(&id)));
        }
        shown.ranges.push((start + place, metres));
    }
    shown.ids.extend(seen);
    Ok(true)
}

/// The fast way; `None` for a line that is not plain (or not right).
fn scan<'a>(bytes: &[u8], line: &'a str, ids: &mut Vec<Cow<'a, str>>) -> Option<()> {
    let mut cursor = Cursor { bytes, at: 0 };
    let (mut seen, mut time) = (false, false);
    cursor.expect(b'{')?;
    loop {
        cursor.expect(b'"')?;
        if !seen && cursor.take(b"seen\"") {
            seen = true;
            cursor.expect(b':')?;
            scan_ids(&mut cursor, line, ids)?;
        } else if !time && cursor.take(b"t\"") {
            time = true;
            cursor.expect(b':')?;
            cursor.skip_time()?;
        } else {
            return None;
        }
        match cursor.next()? {
            b',' => {}
            b'}' if seen && cursor.at_end() => return Some(()),
            _ => return None,
        }
    }
}

/// A list of strings and integers.
fn scan_ids<'a>(cursor: &mut Cursor<'_>, line: &'a str, ids: &mut Vec<Cow<'a, str>>) -> Option<()> {
    cursor.expect(b'[')?;
    if cursor.peek()? == b']' {
        cursor.at += 1;
        return Some(());
    }
    loop {
        let (start, end) = match cursor.peek()? {
            b'"' => cursor.string()?,
            _ => cursor.integer()?,
        };
        ids.push(Cow::Borrowed(&line[start..end]));
        match cursor.next()? {
            b',' => {}
            b']' => return Some(()),
            _ => return None,
        }
    }
}

/// A place in a line.
struct Cursor<'b> {
    bytes: &'b [u8],
    at: usize,
}

impl Cursor<'_> {
    fn skip_space(&mut self) {
        while matches!(self.bytes.get(self.at), Some(b' ' | b'\t' | b'\r')) {
            self.at += 1;
        }
    }

    /// The next byte that is no space, left in place.
    fn peek(&mut self) -> Option<u8> {
        self.skip_space();
        self.bytes.get(self.at).copied()
    }

    fn next(&mut self) -> Option<u8> {
        let byte = self.peek()?;
        self.at += 1;
        Some(byte)
    }

    fn expect(&mut self, byte: u8) -> Option<()> {
        (self.next()? == byte).then_some(())
    }

    /// Steps over `word` if it comes next.
    fn take(&mut self, word: &[u8]) -> bool {
        let comes = self.bytes[self.at..].starts_with(word);
        if comes {
            self.at += word.len();
        }
        comes
    }

    fn at_end(&mut self) -> bool {
        self.peek().is_none()
    }

    /// Content of a string without escapes.
    fn string(&mut self) -> Option<(usize, usize)> {
        let start = self.at + 1;
        let length = self.bytes[start..].iter().position(|&byte| ENDS_PLAIN[byte as usize])?;
        self.at = start + length;
        (self.bytes[self.at] == b'"').then(|| {
            self.at += 1;
            (start, start + length)
        })
    }

    /// An integer whose text is its decimal text: no leading zero, not `-0`, not too long.
    fn integer(&mut self) -> Option<(usize, usize)> {
        let start = self.at;
        let first = start + usize::from(self.bytes.get(start) == Some(&b'-'));
        self.at = first;
        let digits = self.skip_digits();
        let plain = match (digits, self.bytes[first..].first()) {
            (1, Some(b'0')) => first == start,
            (1..=MAX_PLAIN_DIGITS, Some(b'1'..=b'9')) => true,
            _ => false,
        };
        plain.then_some((start, self.at))
    }

    fn skip_digits(&mut self) -> usize {
        let start = self.at;
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_digit) {
            self.at += 1;
        }
        self.at - start
    }

    /// `null`, or a number without exponent.
    fn skip_time(&mut self) -> Option<()> {
        if self.peek()? == b'n' {
            return self.take(b"null").then_some(());
        }
        self.at += usize::from(self.bytes[self.at] == b'-');
        let leading_zero = self.bytes.get(self.at) == Some(&b'0');
        let digits = self.skip_digits();
        if digits == 0 || digits > 1 && leading_zero || digits > MAX_PLAIN_DIGITS {
            return None;
        }
        if self.take(b".") && self.skip_digits() == 0 {
            return None;
        }
        // What may follow is checked by the caller; `1e5` and the like end there.
        Some(())
    }
}

/// So many digits are in range for any parser.
const MAX_PLAIN_DIGITS: usize = 18;

/// Bytes at which a plain string ends or stops being plain: quote, backslash, control characters.
const ENDS_PLAIN: [bool; 256] = {
    let mut table = [false; 256];
    let mut byte = 0;
    while byte < 0x20 {
        table[byte] = true;
        byte += 1;
    }
    table[b'"' as usize] = true;
    table[b'\\' as usize] = true;
    table
};

/// What to do about a line that is no step.
const ADVICE: &str = r#"a step is a line like {"t": 12.5, "seen": ["A", "B"]}"#;

/// The IDs of a line, as `serde_json` reads it.
fn parse(line: &str) -> Result<Step<'_>, String> {
    serde_json::from_str(line).map_err(|error| {
        let kind = if error.is_data() { "not a step" } else { "invalid JSON" };
        let place = format!(" at line {} column {}", error.line(), error.column());
        let text = error.to_string();
        let reason: String = text.strip_suffix(&place).unwrap_or(&text).chars().take(MAX_REASON).collect();
        format!("{kind}: {reason} at column {}; {ADVICE}", error.column())
    })
}

/// Characters of a parser's message that are passed on: it may quote the input.
const MAX_REASON: usize = 200;

struct Step<'a> {
    seen: Vec<Cow<'a, str>>,
    /// Metres to some of those seen.
    ranges: Vec<(Cow<'a, str>, f64)>,
}

impl<'de: 'a, 'a> Deserialize<'de> for Step<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(StepVisitor)
    }
}

struct StepVisitor;

impl<'de> Visitor<'de> for StepVisitor {
    type Value = Step<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object with a list `seen`")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let (mut seen, mut ranges, mut time) = (None, None, false);
        while let Some(key) = map.next_key::<Cow<'de, str>>()? {
            match key.as_ref() {
                "seen" if seen.is_some() => return Err(A::Error::duplicate_field("seen")),
                "seen" => seen = Some(map.next_value::<Ids<'de>>()?.0),
                "t" if time => return Err(A::Error::duplicate_field("t")),
                "t" => {
                    map.next_value::<Time>()?;
                    time = true;
                }
                "ranges" if ranges.is_some() => return Err(A::Error::duplicate_field("ranges")),
                "ranges" => ranges = Some(map.next_value::<Ranges<'de>>()?.0),
                _ => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
        }
        let ranges = ranges.unwrap_or_default();
        seen.map(|seen| Step { seen, ranges }).ok_or_else(|| A::Error::missing_field("seen"))
    }
}

/// Checked, but of no use to a map.
#[derive(Deserialize)]
#[serde(untagged, expecting = "`t` must be a number or null")]
enum Time {
    Number(#[expect(dead_code, reason = "only its type matters")] f64),
    Missing(()),
}

struct Ranges<'a>(Vec<(Cow<'a, str>, f64)>);

impl<'de: 'a, 'a> Deserialize<'de> for Ranges<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(RangesVisitor)
    }
}

struct RangesVisitor;

impl<'de> Visitor<'de> for RangesVisitor {
    type Value = Ranges<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("`ranges` to be an object of metres by ID")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut ranges: Vec<(Cow<'de, str>, f64)> = Vec::new();
        while let Some(Id(id)) = map.next_key()? {
            if ranges.iter().any(|other| other.0 == id) {
                return Err(A::Error::custom(format_args!("two ranges to `{id}`")));
            }
            ranges.push((id, map.next_value()?));
        }
        Ok(Ranges(ranges))
    }
}

struct Ids<'a>(Vec<Cow<'a, str>>);

impl<'de: 'a, 'a> Deserialize<'de> for Ids<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(IdsVisitor)
    }
}

struct IdsVisitor;

impl<'de> Visitor<'de> for IdsVisitor {
    type Value = Ids<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("`seen` to be a list of IDs")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        let mut ids = Vec::new();
        while let Some(Id(id)) = list.next_element()? {
            ids.push(id);
        }
        Ok(Ids(ids))
    }
}

struct Id<'a>(Cow<'a, str>);

impl<'de: 'a, 'a> Deserialize<'de> for Id<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(IdVisitor)
    }
}

struct IdVisitor;

impl<'de> Visitor<'de> for IdVisitor {
    type Value = Id<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an ID, which is a string or an integer of at most 64 bits")
    }

    fn visit_borrowed_str<E: Error>(self, id: &'de str) -> Result<Self::Value, E> {
        Ok(Id(Cow::Borrowed(id)))
    }

    fn visit_str<E: Error>(self, id: &str) -> Result<Self::Value, E> {
        Ok(Id(Cow::Owned(id.to_owned())))
    }

    fn visit_u64<E: Error>(self, id: u64) -> Result<Self::Value, E> {
        Ok(Id(Cow::Owned(id.to_string())))
    }

    fn visit_i64<E: Error>(self, id: i64) -> Result<Self::Value, E> {
        Ok(Id(Cow::Owned(id.to_string())))
    }
}

#[cfg(test)]
mod tests;
