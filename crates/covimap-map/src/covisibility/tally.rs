//! Counts how often each number of `0..n` occurs, in memory O(n) and time O(what occurs).

/// Counters, and which of them are not 0.
pub(super) struct Tally {
    counters: Vec<u32>,
    /// Bit j: counter j is not 0.
    touched: Vec<u64>,
    /// Bit w: word w of `touched` is not 0.
    touched_words: Vec<u64>,
}

impl Tally {
    /// Counters of `0..size`, all 0.
    pub(super) fn new(size: usize) -> Self {
        let words = size.div_ceil(64);
        Self { counters: vec![0; size], touched: vec![0; words], touched_words: vec![0; words.div_ceil(64)] }
    }

    /// Counts a number.
    pub(super) fn add(&mut self, number: u32) {
        let index = number as usize;
        let counter = &mut self.counters[index];
        if *counter == 0 {
            let word = index / 64;
            self.touched[word] |= 1 << (index % 64);
            self.touched_words[word / 64] |= 1 << (word % 64);
        }
        *counter += 1;
    }

    /// Hands over all numbers that occurred, ascending, with their counts, and starts from 0.
    pub(super) fn drain(&mut self, mut take: impl FnMut(u32, u32)) {
        for (high, words) in self.touched_words.iter_mut().enumerate() {
            for low in ones(std::mem::take(words)) {
                let word = high as u32 * 64 + low;
                for bit in ones(std::mem::take(&mut self.touched[word as usize])) {
                    let number = word * 64 + bit;
                    take(number, std::mem::take(&mut self.counters[number as usize]));
                }
            }
        }
    }
}

/// The places of the ones in a word, ascending.
fn ones(word: u64) -> impl Iterator<Item = u32> {
    let mut rest = word;
    std::iter::from_fn(move || {
        let place = rest.trailing_zeros();
        rest &= rest.wrapping_sub(1);
        (place < 64).then_some(place)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_ascending_with_their_counts_and_are_forgotten() {
        let size = 64 * 64 + 70;
        let mut tally = Tally::new(size as usize);
        for numbers in [vec![size - 1, 0, 63, 64, 0, 4096, 4095, size - 1, 0], vec![], vec![65, 1]] {
            let mut wanted: Vec<(u32, u32)> = Vec::new();
            let mut sorted = numbers.clone();
            sorted.sort_unstable();
            for same in sorted.chunk_by(|a, b| a == b) {
                wanted.push((same[0], u32::try_from(same.len()).unwrap()));
            }
            for &number in &numbers {
                tally.add(number);
            }
            let mut found = Vec::new();
            tally.drain(|number, count| found.push((number, count)));
            assert_eq!(found, wanted);
        }
    }

    #[test]
    fn nothing_to_count() {
        Tally::new(0).drain(|number, _| panic!("{number} was never counted"));
    }
}
