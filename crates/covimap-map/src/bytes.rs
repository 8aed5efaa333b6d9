//! What binary files are made of: lists of little-endian numbers, names, and a check sum (CRC-32) at the end.
//!
//! Numbers that are small as a rule are written as varints: seven bits a byte, the lowest first, the highest bit of a
//! byte telling that more follow.

use std::io::{self, Write};

use crate::LandmarkNames;

/// Whether the last four bytes are the check sum of all before.
pub(crate) fn check_sum(bytes: &[u8]) -> Result<(), String> {
    let (body, sum) = bytes.split_last_chunk().ok_or("it ends too early")?;
    let (told, found) = (u32::from_le_bytes(*sum), crc32fast::hash(body));
    let what = || format!("its check sum is {found:08x} instead of {told:08x}");
    if found == told { Ok(()) } else { Err(what()) }
}

/// Writes the length of every name, then the names.
pub(crate) fn write_names(out: &mut dyn Write, names: &LandmarkNames) -> io::Result<()> {
    for name in names.iter() {
        out.write_all(&(name.len() as u32).to_le_bytes())?;
    }
    for name in names.iter() {
        out.write_all(name.as_bytes())?;
    }
    Ok(())
}

/// Names of these lengths, from their text.
pub(crate) fn names(lengths: Vec<u32>, text: &[u8]) -> Result<LandmarkNames, String> {
    let text = std::str::from_utf8(text).map_err(|error| format!("its IDs are no text, {error}"))?;
    let mut names = LandmarkNames::default();
    let mut start = 0;
    for length in lengths {
        let end = start + length as usize;
        names.push(text.get(start..end).ok_or("the lengths of its IDs do not add up")?);
        start = end;
    }
    Ok(names)
}

/// What is not read yet. Errors say what is wrong with the file.
pub(crate) struct Rest<'a>(pub &'a [u8]);

impl<'a> Rest<'a> {
    /// So many bytes.
    pub fn take(&mut self, length: usize) -> Result<&'a [u8], String> {
        let short = || format!("it ends {} bytes too early", length - self.0.len());
        let (taken, rest) = self.0.split_at_checked(length).ok_or_else(short)?;
        self.0 = rest;
        Ok(taken)
    }

    /// So many groups of `group` values of `N` bytes.
    pub fn list<const N: usize, T>(
        &mut self,
        count: usize,
        value: impl Fn([u8; N]) -> T,
        group: usize,
    ) -> Result<Vec<T>, String> {
        let length = count.checked_mul(N * group).ok_or("its sizes are beyond any memory")?;
        Ok(self.take(length)?.as_chunks().0.iter().copied().map(value).collect())
    }

    /// So many 32-bit numbers.
    pub fn numbers(&mut self, count: usize) -> Result<Vec<u32>, String> {
        self.list(count, u32::from_le_bytes, 1)
    }

    /// A 32-bit number.
    pub fn number(&mut self) -> Result<u32, String> {
        Ok(self.numbers(1)?[0])
    }

    /// A 64-bit number that counts something in memory.
    pub fn size(&mut self) -> Result<usize, String> {
        let size = self.list(1, u64::from_le_bytes, 1)?[0];
        usize::try_from(size).map_err(|_| "its sizes are beyond any memory".to_owned())
    }

    /// A number as [`write_varint`] writes it.
    pub fn varint(&mut self) -> Result<u32, String> {
        let mut number = 0;
        for (place, &byte) in self.0.iter().enumerate().take(5) {
            number |= u64::from(byte & 0x7f) << (7 * place);
            if byte < 0x80 {
                self.0 = &self.0[place + 1..];
                return u32::try_from(number).map_err(|_| "a number has more than 32 bits".to_owned());
            }
        }
        Err(if self.0.len() < 5 { "it ends within a number" } else { "a number has more than 32 bits" }
            .to_owned())
    }

    /// Nothing but the check sum may be left.
    pub fn end(&self) -> Result<(), String> {
        match self.0.len() {
            4 => Ok(()),
            left => Err(format!("{left} bytes are left where 4 should be")),
        }
    }
}

/// Writes a number in seven bits a byte, the lowest first; all bytes but the last have the highest bit set.
pub(crate) fn write_varint(out: &mut Vec<u8>, mut number: u32) {
    while number >= 0x80 {
        out.push(number as u8 | 0x80);
        number >>= 7;
    }
    out.push(number as u8);
}

/// Writes and keeps the check sum of what was written.
pub(crate) struct Summed<'a> {
    out: &'a mut dyn Write,
    sum: crc32fast::Hasher,
}

impl<'a> Summed<'a> {
    /// Nothing is written yet.
    pub fn new(out: &'a mut dyn Write) -> Self {
        Self { out, sum: crc32fast::Hasher::new() }
    }

    /// Appends the check sum.
    pub fn finish(self) -> io::Result<()> {
        let sum = self.sum.finalize();
        self.out.write_all(&sum.to_le_bytes())
    }
}

impl Write for Summed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.sum.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn varints_come_back_and_take_the_bytes_that_they_need() {
        // 7 bits a byte: 2^7 - 1, 2^14 - 1, 2^21 - 1 and 2^28 - 1 are the largest of their lengths.
        for (number, length) in
            [(0, 1), (127, 1), (128, 2), (16_383, 2), (16_384, 3), (1 << 28, 5), (u32::MAX, 5)]
        {
            let mut bytes = Vec::new();
            write_varint(&mut bytes, number);
            assert_eq!(bytes.len(), length);
            let mut rest = Rest(&bytes);
            assert_eq!(rest.varint(), Ok(number));
            assert!(rest.0.is_empty());
            assert_eq!(Rest(&bytes[..length - 1]).varint().unwrap_err(), "it ends within a number");
        }
        for wrong in [&[0xff, 0xff, 0xff, 0xff, 0x10][..], &[0xff; 6]] {
            assert_eq!(Rest(wrong).varint().unwrap_err(), "a number has more than 32 bits");
        }
    }
}
